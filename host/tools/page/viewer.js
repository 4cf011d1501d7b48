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

const decoded = { pictures: new Map(), maps: new Map() };

// Returns a promise of the ImageData of a PNG; of a map in colours. Keeps what it has decoded.
function decode(base64, isMap = false) {
  const kept = isMap ? decoded.maps : decoded.pictures;
  if (!kept.has(base64)) kept.set(base64, decodeAnew(base64).then(isMap ? paintMap : (picture) => picture));
  return kept.get(base64);
}
function decodeAnew(base64) {
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

// Grey values as colours, in place.
function paintMap(picture) {
  for (let i = 0; i < picture.data.length; i += 4) picture.data.set(kMagmaTable[picture.data[i]], i);
  return picture;
}

class PictureViewer {
  // `size`: width and height of the pictures, x and y of their upper left pixel. `selects`: those before left and right,
  // as controls() takes them. `choices`: the pictures there are; `shown`: which of them left and right show at first.
  // Where the selects have `values`, picture(choice, values) returns a promise of the ImageData of a choice, and
  // caption(choice, values) what is written above it; corner(values), if given, the x and y that hold then.
  // `legend`: what the ends of the scale of maps mean.
  constructor(host, { size, selects, choices, shown, picture, caption, legend, corner = () => size }) {
    const { width, height } = size;
    Object.assign(this, { size, picture, caption, corner, pictures: [null, null], top: true, zoom: 0 });
    this.canvases = [el("canvas", { width, height }), el("canvas", { width, height })];
    this.divider = el("div", { class: "divider" });
    this.frame = el("div", { class: "frame" }, ...this.canvases, this.divider);
    this.stage = el("div", { class: "stage", tabindex: 0, role: "img", "aria-label": "Two pictures, wiped" }, this.frame);
    this.controls = controls([...selects, ["Left", "left", choices, shown[0]], ["Right", "right", choices, shown[1]]], () => this.load());
    this.left = this.controls.nodes.at(-2);
    this.wipe = el("input", { type: "range", class: "wipe", min: 0, max: 100, value: 50, step: 0.5, "aria-label": "Where the wipe stands" });
    this.flipping = el("button", { type: "button", "aria-pressed": "false", onclick: () => this.setMode(true) }, "flip");
    this.wiping = el("button", { type: "button", "aria-pressed": "true", onclick: () => this.setMode(false) }, "wipe");
    this.captions = [el("span"), el("span")];
    this.readout = el("div", { class: "readout" });
    this.magnification = el("span");
    host.append(...this.layout(legend));
    this.listen();
    this.load();
  }

  layout(legend) {
    const zoomButton = (text, step) => el("button", { type: "button", "aria-label": step > 0 ? "larger" : "smaller", onclick: () => this.setZoom(step) }, text);
    const bar = kMagmaTable.filter((_, i) => i % 15 === 0).map((c) => `rgb(${c})`).join(",");
    return [
      this.controls.node,
      el("div", { class: "controls" }, this.wiping, this.flipping, zoomButton("−", -1), this.magnification, zoomButton("+", 1)),
      el("div", { class: "captions" }, ...this.captions), this.stage, this.wipe, this.readout,
      el("div", { class: "legend" }, legend[0], el("i", { style: `background:linear-gradient(90deg,${bar})` }), legend[1]),
      el("p", { class: "keys" }, el("kbd", {}, "←"), " ", el("kbd", {}, "→"), " move the wipe · ", el("kbd", {}, "space"), " flip · ",
        el("kbd", {}, "["), " ", el("kbd", {}, "]"), " another picture on the left · ", el("kbd", {}, "+"), " ", el("kbd", {}, "−"), " zoom (with the picture in focus)"),
    ];
  }

  listen() {
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
    const { options, selectedIndex } = this.left;
    this.left.selectedIndex = (selectedIndex + by + options.length) % options.length;
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
    const { width, height } = this.size;
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
    const { width, height } = this.size;
    const x = Math.min(width - 1, Math.max(0, Math.floor((width * (event.clientX - box.left)) / box.width)));
    const y = Math.min(height - 1, Math.max(0, Math.floor((height * (event.clientY - box.top)) / box.height)));
    if (!this.pictures[0]) return;
    const at = (picture) => Array.from(picture.data.subarray(4 * (y * width + x), 4 * (y * width + x) + 3)).join(" ");
    this.readout.textContent = `pixel ${this.size.x + x}, ${this.size.y + y}   left ${at(this.pictures[0])}   right ${at(this.pictures[1])}`;
  }

  // Shows what the selects say.
  async load() {
    const values = this.controls.values();
    const choices = values.slice(-2);
    const pictures = await Promise.all(choices.map((choice) => this.picture(choice, values)));
    // Another choice may have overtaken this one.
    if (values.some((value, i) => value !== this.controls.values()[i])) return;
    this.pictures = pictures;
    this.size = { ...this.size, ...this.corner(values) };
    pictures.forEach((picture, i) => {
      this.canvases[i].getContext("2d").putImageData(picture, 0, 0);
      this.captions[i].replaceChildren(...this.caption(choices[i], values));
    });
    this.stage.setAttribute("aria-label", `Left ${this.captions[0].textContent}; right ${this.captions[1].textContent}`);
    this.fit();
    this.place();
    this.stage.dataset.ready = "1";
  }
}
