// SPDX-License-Identifier: MIT
// The gallery: crops of every scene and scale, by every method, with their errors.

// Row y of picture k is row y * names.length + k of the sheet.
function unpack(sheet, k, isError) {
  const { width, height, names } = page.gallery;
  const picture = new ImageData(width, height);
  for (let y = 0; y < height; ++y) {
    const start = (y * names.length + k) * width * 4;
    picture.data.set(sheet.data.subarray(start, start + width * 4), y * width * 4);
  }
  return isError ? paintMap(picture) : picture;
}

class Gallery extends PictureViewer {
  constructor(host) {
    const { width, height, names, scenes } = page.gallery;
    const scene = el("select");
    const scale = el("select");
    super(host, { width, height, x: 0, y: 0 }, [["Scene ", scene], ["Scale ", scale]], ["FLIP 0", "1"]);
    this.scene = scene;
    this.scale = scale;
    this.sheets = new Map();
    options(scene, scenes.map((s) => [s.name, s.name]), scenes[0].name);
    options(scale, scenes[0].sheets.map((s) => [s.scale, s.scale]), scenes[0].sheets[0].scale);
    const entries = names.map((name, i) => [`picture ${i}`, name])
      .concat(names.slice(1).map((name, i) => [`error ${i + 1}`, `error of ${name}`]));
    options(this.choices[0], entries, `picture ${names.length - 1}`);
    options(this.choices[1], entries, "picture 0");
    this.load();
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
    const scene = page.gallery.scenes.find((s) => s.name === this.scene.value);
    const entry = scene.sheets.find((s) => String(s.scale) === this.scale.value);
    const wanted = this.choices.map((choice) => choice.value);
    const pictures = await Promise.all(wanted.map(async (choice) => {
      const [kind, index] = choice.split(" ");
      return unpack(await this.sheet(entry, kind === "error" ? "errors" : "pictures"), Number(index), kind === "error");
    }));
    // Another choice may have overtaken this one.
    if (wanted.some((choice, i) => choice !== this.choices[i].value)) return;
    this.size = { ...this.size, x: scene.x, y: scene.y };
    this.show(pictures, wanted.map((choice) => this.caption(choice)));
  }
}
