// SPDX-License-Identifier: MIT
// The report of a run: what it suffers from, scores, times and resolution over its frames, passes, settings.

const run = page.run;
const kPlotHeight = 240;

const kMeasures = [
  ["psnr_tone_mapped", "PSNR, tone mapped (dB)", "more is better; a frame that equals its truth has no mark"],
  ["psnr_linear", "PSNR, linear (dB)", "more is better; a frame that equals its truth has no mark"],
  ["ssim", "SSIM", "1 is the truth"],
  ["flip", "FLIP, 67 pixels a degree", "0 is the truth"],
  ["error_p99", "99th percentile of the error", "0 is the truth"],
  ["flicker", "flicker", "change from frame to frame that the truth has not; 0 is none"],
];

function show(id, is) {
  byId(id).hidden = !is;
  if (is) document.querySelector("nav").append(el("a", { href: `#${id}` }, byId(`${id}-title`).textContent));
}

// Where the curve has values; a gap ends a piece.
function pathOf(points) {
  let path = "";
  let open = false;
  for (const [x, y] of points) {
    if (y !== null) path += `${open ? "L" : "M"}${x.toFixed(1)},${y.toFixed(1)}`;
    open = y !== null;
  }
  return path;
}

function rangeOf(series, fromZero) {
  const values = series.flatMap((one) => one.values).filter((value) => value !== null);
  const low = fromZero ? 0 : Math.min(...values);
  const high = Math.max(...values);
  const pad = (high - low) * 0.06 || Math.abs(high) * 0.05 || 1;
  return [fromZero ? 0 : low - pad, high + pad];
}

// Every frame explains itself where there is room to point at it.
function addMarks(chart, one, frames, x, y) {
  const room = frames.length <= 400;
  one.values.forEach((value, i) => {
    if (value === null || !room) return;
    chart.append(svg("circle", { class: "part", cx: x(frames[i]), cy: y(value), r: frames.length > 100 ? 2 : 3, fill: one.colour,
      ...explains(`frame ${frames[i]}: ${number(value, 4)} ${one.unit}\n${one.name}`) }));
  });
}

function addAxes(chart, area, range, frames, x, y) {
  for (const tick of linearTicks(range[0], range[1], 5)) {
    chart.append(svg("path", { class: "grid", d: `M${area.left},${y(tick)}H${area.right}` }),
      svg("text", { class: "tick", x: area.left - 6, y: y(tick) + 4, "text-anchor": "end" }, String(Number(tick.toPrecision(6)))));
  }
  for (const tick of unique(linearTicks(frames[0], Math.max(frames[frames.length - 1], frames[0] + 1), 8).map(Math.round))) {
    if (tick > frames[frames.length - 1]) continue;
    chart.append(svg("text", { class: "tick", x: x(tick), y: area.bottom + 18, "text-anchor": "middle" }, String(tick)));
  }
}

// Series of values, null where there is none, over the frames' numbers.
function drawOverFrames(host, frames, series, fromZero) {
  const width = Math.max(host.clientWidth, 280);
  const area = { left: 58, right: width - 14, top: 30, bottom: kPlotHeight - 26 };
  const range = rangeOf(series, fromZero);
  const wide = Math.max(frames[frames.length - 1] - frames[0], 1);
  const x = (frame) => area.left + ((frame - frames[0]) / wide) * (area.right - area.left);
  const y = (value) => area.bottom - ((value - range[0]) / (range[1] - range[0])) * (area.bottom - area.top);
  const chart = svg("svg", { viewBox: `0 0 ${width} ${kPlotHeight}`, height: kPlotHeight, role: "group", "aria-label": series.map((one) => one.name).join(", ") });
  addAxes(chart, area, range, frames, x, y);
  let at = area.left;
  for (const one of series) {
    chart.append(svg("rect", { x: at, y: 4, width: 12, height: 12, rx: 2, fill: one.colour }), svg("text", { x: at + 17, y: 14 }, one.name));
    at += one.name.length * 6.8 + 40;
    chart.append(svg("path", { class: "curve", fill: "none", stroke: one.colour, "stroke-width": 1.5,
      d: pathOf(one.values.map((value, i) => [x(frames[i]), value === null ? null : y(value)])) }));
    addMarks(chart, one, frames, x, y);
  }
  host.replaceChildren(chart);
}

const isKnown = (series) => series.values.some((value) => value !== null);
const column = (rows, take, name, unit, index) => ({ name, unit, values: rows.map(take), colour: colourOf(index) });

// Some frames: what was made, the truth, and maps of what is wrong.
class FrameViewer extends PictureViewer {
  constructor(host) {
    const frame = el("select");
    super(host, page.pictures, [["Frame ", frame]], ["0", "FLIP 1; of changes .25"]);
    this.number = frame;
    this.decoded = new Map();
    const { frames, kinds } = page.pictures;
    options(frame, frames.map((one) => [one.index, one.index]), frames[frames.length - 1].index);
    const entries = kinds.map((kind, i) => [i, kind.name]);
    options(this.choices[0], entries, kinds.findIndex((kind) => kind.name === "picture"));
    options(this.choices[1], entries, kinds.findIndex((kind) => kind.name === "truth"));
    this.load();
  }

  caption(kind) {
    const row = run.scores.frames.find((one) => String(one.index) === this.number.value);
    const figures = {
      truth: "", picture: row.psnr_tone_mapped === null ? "equals the truth" : `${number(row.psnr_tone_mapped, 4)} dB`, error: `FLIP ${number(row.flip)}`,
      flicker: row.flicker === null ? "no frame before it" : `mean ${number(row.flicker)}`,
      ghosts: row.flicker === null ? "no frame before it" : "",
    };
    return [el("b", {}, kind.name), figures[kind.name]];
  }

  decodedPicture(frame, index) {
    const key = `${frame.index}|${index}`;
    const paint = page.pictures.kinds[index].map ? paintMap : (picture) => picture;
    if (!this.decoded.has(key)) this.decoded.set(key, decode(frame.pngs[index]).then(paint));
    return this.decoded.get(key);
  }

  async load() {
    const wanted = [this.number, ...this.choices].map((select) => select.value);
    const frame = page.pictures.frames.find((one) => String(one.index) === wanted[0]);
    const indices = wanted.slice(1).map(Number);
    const pictures = await Promise.all(indices.map((index) => this.decodedPicture(frame, index)));
    // Another choice may have overtaken this one.
    if (wanted.some((value, i) => value !== [this.number, ...this.choices][i].value)) return;
    this.show(pictures, indices.map((index) => this.caption(page.pictures.kinds[index])));
  }
}

function drawScores() {
  hideTip();
  const rows = run.scores.frames;
  const [field, label, meaning] = kMeasures.find(([name]) => name === byId("score-measure").value);
  const series = column(rows, (row) => row[field], label, "", 0);
  const average = run.scores.mean[field];
  byId("scores-lead").textContent = `Mean of ${rows.length} frames: ${average === null ? "∞" : number(average, 4)}. ${meaning[0].toUpperCase()}${meaning.slice(1)}.`;
  if (isKnown(series)) drawOverFrames(byId("score-plot"), rows.map((row) => row.index), [series], false);
  else byId("score-plot").replaceChildren("No frame has a value of this measure.");
}

function drawTimes() {
  const frames = run.frames.map((row) => row.index);
  const series = [
    column(run.frames, (row) => row.frame_ms, "the whole frame, ms", "ms", 0),
    column(run.frames, (row) => row.device_ms, "OpenCL passes, ms", "ms", 1),
  ].filter(isKnown);
  if (series.length) drawOverFrames(byId("time-plot"), frames, series, true);
}

function drawRatios() {
  const series = [column(run.frames, (row) => row.ratio[0], "across", "of the output", 2)];
  if (run.frames.some((row) => row.ratio[0] !== row.ratio[1])) series.push(column(run.frames, (row) => row.ratio[1], "down", "of the output", 3));
  drawOverFrames(byId("ratio-plot"), run.frames.map((row) => row.index), series, true);
}

function drawPasses() {
  const rows = [...run.passes, ...run.steps].filter((row) => row.median_ms !== null);
  const host = byId("pass-plot");
  const width = Math.max(host.clientWidth, 280);
  const left = Math.min(190, width * 0.4);
  const line = 26;
  const height = rows.length * line + 8;
  const most = Math.max(...rows.map((row) => Math.max(row.median_ms, row.p95_ms || 0)), 1e-6);
  const x = (ms) => left + (ms / most) * (width - left - 76);
  const chart = svg("svg", { viewBox: `0 0 ${width} ${height}`, height, role: "group", "aria-label": "Passes and steps" });
  rows.forEach((row, i) => {
    const top = 4 + i * line;
    const bytes = row.bytes === null ? "" : `\n${number(row.bytes / 1e6)} MB a frame`;
    const text = `${row.name}: median ${number(row.median_ms)} ms, least ${number(row.min_ms)}, 95 % within ${number(row.p95_ms)}\nby ${row.clock}, ${row.count} frames${bytes}`;
    chart.append(svg("g", { class: "part", ...explains(text) },
      svg("rect", { x: left, y: top + 4, width: Math.max(x(row.median_ms) - left, 1), height: 14, fill: i < run.passes.length ? "var(--resolve)" : "var(--draw)" }),
      svg("path", { class: "front", d: `M${left},${top + 11}H${x(row.p95_ms)}` })),
      svg("text", { x: left - 8, y: top + 15, "text-anchor": "end" }, row.name),
      svg("text", { class: "tick", x: x(Math.max(row.median_ms, row.p95_ms)) + 6, y: top + 15 }, `${number(row.median_ms)} ms`));
  });
  host.replaceChildren(chart);
}

function factList() {
  const joined = (...parts) => parts.filter(Boolean).join(", ");
  return [
    ["scene", joined(run.scene, run.scene_summary)], ["seed", run.seed], ["method", run.method],
    ["output", `${run.output[0]}×${run.output[1]}, targets of ${run.target[0]}×${run.target[1]}`],
    ...Object.entries(run.settings),
    ["OpenCL", joined(run.cl.device, run.cl.platform, run.cl.driver)], ["OpenGL", joined(run.gl.renderer, run.gl.version)],
    ["interop", joined(run.interop, run.interop_reason)],
    ["busy", Object.entries(run.busy_seconds).map(([what, seconds]) => `${what} ${number(seconds)} s`).join(", ")],
    ["memory", run.peak_memory_bytes === null ? null : `${number(run.peak_memory_bytes / 1e6)} MB at most`],
    ["files", run.files.join(" … ")],
  ].filter(([, text]) => text !== null && text !== undefined && text !== "");
}

const terms = (entries) => entries.flatMap(([term, text]) => [el("dt", {}, term), el("dd", {}, String(text))]);

function start() {
  const took = run.wall_seconds === null ? "" : ` in ${number(run.wall_seconds)} s`;
  document.title = `${run.program}: ${run.method}`;
  byId("title").textContent = `${run.program}: run report`;
  byId("lead").append(`${run.frames.length} frames of ${run.output[0]}×${run.output[1]} by ${run.method}${took}. `, el("code", {}, run.command_line || ""));
  byId("warning-list").append(...run.warnings.map((text) => el("li", {}, text)));
  byId("fact-list").append(...terms([["version", run.version], ...factList()]));
  byId("left-out-list").append(...terms(run.left_out.map((item) => [item.what, item.why])));
  options(byId("score-measure"), kMeasures.map(([name, label]) => [name, label]), "psnr_tone_mapped");
  if (run.scores.frames.length) byId("score-measure").addEventListener("change", drawScores);
  const drawn = [
    ["scores", run.scores.frames.length > 0, drawScores], ["time", run.frames.some((row) => row.frame_ms !== null || row.device_ms !== null), drawTimes],
    ["resolution", run.frames.length > 0, drawRatios], ["passes", run.passes.length + run.steps.length > 0, drawPasses],
  ];
  show("warnings", run.warnings.length > 0);
  show("pictures", page.pictures !== null);
  if (page.pictures) new FrameViewer(byId("viewer"));
  for (const [id, is] of drawn) show(id, is);
  show("facts", true);
  show("left-out", run.left_out.length > 0);
  return () => drawn.filter(([, is]) => is).forEach(([, , draw]) => draw());
}

const drawAll = start();
let drawnWidth = 0;
new ResizeObserver(() => {
  if (document.body.clientWidth === drawnWidth) return;
  drawnWidth = document.body.clientWidth;
  // Later: drawing changes the height, and an observer must not resize what it observes.
  requestAnimationFrame(drawAll);
}).observe(document.body);
