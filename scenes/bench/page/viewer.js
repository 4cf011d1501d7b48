// SPDX-License-Identifier: MIT
// The viewer: two pictures of the same pixels, wiped or flipped.

// Perceptually even, dark to bright: every 16th colour of "magma" (van der Walt and Smith, 2015).
const kMagma = [[0, 0, 4], [11, 9, 36], [32, 17, 75], [59, 15, 112], [87, 21, 126], [114, 31, 129], [140, 41, 129], [168, 50, 125], [196, 60, 117],
  [222, 73, 104], [241, 96, 93], [250, 127, 94], [254, 159, 109], [254, 191, 132], [253, 222, 160], [252, 253, 191]];

function magma(t) {
  const at = Math.min(Math.max(t, 0), 1) * (kMagma.length - 1);
  const i = Math.min(Math.floor(at), kMagma.length - 2);
  return kMagma[i].map((value, c) => Math.round(value + (kMagma[i + 1][c] - value) * (at - i)));
}
const kMagmaTable = Array.from({ length: 256 }, (_, i) => magma(i / 255));

function decode(base64) {
  return new Promise((resolve, reject) => {
    const image = new Image();
    image.onload = () => {
      const canvas = el("canvas", { width: image.width, height: image.height });
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.drawImage(image, 0, 0);
      resolve(context.getImageData(0, 0, image.width, image.height));
    };
    image.onerror = () => reject(new Error("a picture of this page is damaged"));
    image.src = `data:image/png;base64,${base64}`;
  });
}

// Row y of picture k is row y * names.length + k of the sheet.
function unpack(sheet, k, isError) {
  const { width, height, names } = page.gallery;
  const picture = new ImageData(width, height);
  for (let y = 0; y < height; ++y) {
    const start = (y * names.length + k) * width * 4;
    picture.data.set(sheet.data.subarray(start, start + width * 4), y * width * 4);
  }
  for (let i = 0; isError && i < picture.data.length; i += 4) {
    const colour = kMagmaTable[picture.data[i]];
    picture.data.set(colour, i);
  }
  return picture;
}

class Viewer {
  constructor(host) {
    const { width, height, names, scenes } = page.gallery;
    this.sheets = new Map();
    this.pictures = [null, null];
    this.top = true;
    this.zoom = 0;
    this.canvases = [el("canvas", { width, height }), el("canvas", { width, height })];
    this.divider = el("div", { class: "divider" });
    this.frame = el("div", { class: "frame" }, ...this.canvases, this.divider);
    this.stage = el("div", { class: "stage", tabindex: 0, role: "img", "aria-label": "Two pictures, wiped" }, this.frame);
    this.scene = el("select");
    this.scale = el("select");
    this.choices = [el("select"), el("select")];
    options(this.scene, scenes.map((s) => [s.name, s.name]), scenes[0].name);
    options(this.scale, scenes[0].sheets.map((s) => [s.scale, s.scale]), scenes[0].sheets[0].scale);
    const entries = names.map((name, i) => [`picture ${i}`, name])
      .concat(names.slice(1).map((name, i) => [`error ${i + 1}`, `error of ${name}`]));
    options(this.choices[0], entries, `picture ${names.length - 1}`);
    options(this.choices[1], entries, "picture 0");
    this.wipe = el("input", { type: "range", class: "wipe", min: 0, max: 100, value: 50, step: 0.5, "aria-label": "Where the wipe stands" });
    this.flipping = el("button", { type: "button", "aria-pressed": "false", onclick: () => this.setMode(true) }, "flip");
    this.wiping = el("button", { type: "button", "aria-pressed": "true", onclick: () => this.setMode(false) }, "wipe");
    this.captions = [el("span"), el("span")];
    this.readout = el("div", { class: "readout" });
    this.magnification = el("span");
    host.append(...this.layout());
    this.listen();
    this.load();
  }

  layout() {
    const zoomButton = (text, step) => el("button", { type: "button", "aria-label": step > 0 ? "larger" : "smaller", onclick: () => this.setZoom(step) }, text);
    const bar = kMagmaTable.filter((_, i) => i % 15 === 0).map((c) => `rgb(${c})`).join(",");
    return [
      el("div", { class: "controls" },
        el("label", {}, "Scene ", this.scene), el("label", {}, "Scale ", this.scale),
        el("label", {}, "Left ", this.choices[0]), el("label", {}, "Right ", this.choices[1])),
      el("div", { class: "controls" }, this.wiping, this.flipping, zoomButton("−", -1), this.magnification, zoomButton("+", 1)),
      el("div", { class: "captions" }, ...this.captions), this.stage, this.wipe, this.readout,
      el("div", { class: "legend" }, "FLIP 0", el("i", { style: `background:linear-gradient(90deg,${bar})` }), "1"),
      el("p", { class: "keys" }, el("kbd", {}, "←"), " ", el("kbd", {}, "→"), " move the wipe · ", el("kbd", {}, "space"), " flip · ",
        el("kbd", {}, "["), " ", el("kbd", {}, "]"), " other method on the left · ", el("kbd", {}, "+"), " ", el("kbd", {}, "−"), " zoom (with the picture in focus)"),
    ];
  }

  listen() {
    for (const select of [this.scene, this.scale, ...this.choices]) select.addEventListener("change", () => this.load());
    this.wipe.addEventListener("input", () => { this.setMode(false); this.place(); });
    this.frame.addEventListener("pointermove", (event) => {
      this.read(event);
      if (event.pointerType === "mouse" ? !this.flip : event.buttons) this.wipeTo(event);
    });
    this.frame.addEventListener("pointerdown", (event) => { if (this.flip) this.turn(); else this.wipeTo(event); });
    this.stage.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => requestAnimationFrame(() => this.fit())).observe(this.stage);
  }

  key(event) {
    const shift = event.shiftKey ? 10 : 1;
    const actions = {
      ArrowLeft: () => this.move(-shift), ArrowRight: () => this.move(shift),
      " ": () => this.turn(), "+": () => this.setZoom(1), "=": () => this.setZoom(1), "-": () => this.setZoom(-1),
      "[": () => this.step(-1), "]": () => this.step(1),
    };
    if (!actions[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    actions[event.key]();
  }

  move(by) {
    this.setMode(false);
    this.wipe.value = Number(this.wipe.value) + by;
    this.place();
  }

  step(by) {
    const select = this.choices[0];
    select.selectedIndex = (select.selectedIndex + by + select.options.length) % select.options.length;
    this.load();
  }

  setMode(flip) {
    this.flip = flip;
    this.flipping.setAttribute("aria-pressed", String(flip));
    this.wiping.setAttribute("aria-pressed", String(!flip));
    this.place();
  }

  turn() {
    this.top = this.flip ? !this.top : false;
    this.setMode(true);
  }

  setZoom(step) {
    this.zoom = Math.min(Math.max(this.magnified + step, 1), 12);
    this.fit();
  }

  fit() {
    const { width, height } = page.gallery;
    const room = this.stage.clientWidth;
    this.magnified = this.zoom || Math.max(1, Math.min(8, Math.floor(room / width)));
    // Where not even one pixel a pixel fits, the picture shrinks.
    const factor = this.zoom ? this.magnified : Math.min(this.magnified, Math.max(room / width, 0.5));
    this.frame.style.width = `${Math.round(width * factor)}px`;
    this.frame.style.height = `${Math.round(height * factor)}px`;
    this.magnification.textContent = `${this.magnified} ×`;
  }

  wipeTo(event) {
    const box = this.frame.getBoundingClientRect();
    this.wipe.value = (100 * (event.clientX - box.left)) / box.width;
    this.place();
  }

  // The left picture lies on top.
  place() {
    const at = Number(this.wipe.value);
    const [left, right] = this.canvases;
    right.style.zIndex = 0;
    left.style.zIndex = 1;
    this.divider.style.zIndex = 2;
    this.divider.hidden = Boolean(this.flip);
    this.divider.style.display = this.flip ? "none" : "";
    this.divider.style.left = `${at}%`;
    left.style.clipPath = this.flip ? "none" : `inset(0 ${100 - at}% 0 0)`;
    left.style.visibility = this.flip && !this.top ? "hidden" : "visible";
    this.captions[0].style.visibility = this.flip && !this.top ? "hidden" : "visible";
    this.captions[1].style.visibility = this.flip && this.top ? "hidden" : "visible";
  }

  read(event) {
    const box = this.frame.getBoundingClientRect();
    const { width, height } = page.gallery;
    const x = Math.min(width - 1, Math.max(0, Math.floor((width * (event.clientX - box.left)) / box.width)));
    const y = Math.min(height - 1, Math.max(0, Math.floor((height * (event.clientY - box.top)) / box.height)));
    if (!this.pictures[0]) return;
    const at = (picture) => Array.from(picture.data.subarray(4 * (y * width + x), 4 * (y * width + x) + 3)).join(" ");
    this.readout.textContent = `pixel ${this.sceneEntry.x + x}, ${this.sceneEntry.y + y}   left ${at(this.pictures[0])}   right ${at(this.pictures[1])}`;
  }

  caption(choice) {
    const [kind, index] = choice.split(" ");
    const name = page.gallery.names[index];
    const row = result.rows.find((r) => r.scene === this.scene.value && String(r.scale) === this.scale.value && r.method === name);
    const figures = row ? `FLIP ${number(row.quality.flip)}, ${number(errorOf(row, "psnr"), 4)} dB, ${number(row.speed.ms.median)} ms` : `${result.conditions.truth_samples}² samples a pixel`;
    return [el("b", {}, kind === "error" ? `error of ${name}` : name), figures];
  }

  async sheet(entry, field) {
    const key = `${this.scene.value}|${entry.scale}|${field}`;
    if (!this.sheets.has(key)) this.sheets.set(key, decode(entry[field]));
    return this.sheets.get(key);
  }

  async load() {
    this.sceneEntry = page.gallery.scenes.find((s) => s.name === this.scene.value);
    const entry = this.sceneEntry.sheets.find((s) => String(s.scale) === this.scale.value);
    const wanted = this.choices.map((choice) => choice.value);
    const pictures = await Promise.all(wanted.map(async (choice) => {
      const [kind, index] = choice.split(" ");
      return unpack(await this.sheet(entry, kind === "error" ? "errors" : "pictures"), Number(index), kind === "error");
    }));
    // Another choice may have overtaken this one.
    if (wanted.some((choice, i) => choice !== this.choices[i].value)) return;
    this.pictures = pictures;
    pictures.forEach((picture, i) => {
      this.canvases[i].getContext("2d").putImageData(picture, 0, 0);
      this.captions[i].replaceChildren(...this.caption(wanted[i]));
    });
    this.stage.setAttribute("aria-label", `Left ${this.captions[0].textContent}; right ${this.captions[1].textContent}`);
    this.fit();
    this.place();
    this.stage.dataset.ready = "1";
  }
}
