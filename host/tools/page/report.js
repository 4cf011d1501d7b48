// SPDX-License-Identifier: MIT
// The report of a run: what it suffers from, scores, times and resolution over its frames, passes, settings.

const run = page.run;

const kMeasures = [
  ["psnr_tone_mapped", "PSNR, tone mapped (dB)", "more is better; a frame that equals its truth has no mark"],
  ["psnr_linear", "PSNR, linear (dB)", "more is better; a frame that equals its truth has no mark"],
  ["ssim", "SSIM", "1 is the truth"],
  ["flip", "FLIP, 67 pixels a degree", "0 is the truth"],
  ["error_p99", "99th percentile of the error", "0 is the truth"],
  ["flicker", "flicker", "change from frame to frame that the truth has not; 0 is none"],
];

// A table that is made when it is opened; at once where there are no plots.
function asTable(make) {
  const node = el("details", {}, el("summary", {}, "as a table"));
  node.addEventListener("toggle", () => { if (node.childElementCount === 1) node.append(make()); });
  node.open = !hasPlots;
  return node;
}

const indices = (rows) => rows.map((row) => row.index);
const column = (rows, take, name, unit, index) => ({ name, unit, index, values: rows.map(take) });
const isKnown = (series) => series.values.some((value) => value !== null);

// Draws series of values, null where there is none, over the frames' numbers. Frames have marks, and explain themselves,
// where there is room to point at one.
function drawOverFrames(host, frames, series, fromZero) {
  const radius = frames.length > 400 ? 0 : frames.length > 100 ? 2 : 3;
  const datasets = series.map((one) => ({
    label: one.name, data: one.values.map((y, i) => ({ x: frames[i], y })), borderColor: colourOf(one.index),
    backgroundColor: colourOf(one.index), pointRadius: radius, pointHitRadius: radius, clip: false,
    explain: (i) => `frame ${frames[i]}: ${number(one.values[i], 4)} ${one.unit}\n${one.name}`,
  }));
  draw(host, series.map((one) => one.name).join(", "), {
    type: "line", data: { datasets },
    options: { scales: {
      x: { type: "linear", min: frames[0], max: Math.max(frames.at(-1), frames[0] + 1), ticks: { precision: 0, callback: String }, title: titled("frame") },
      y: { beginAtZero: fromZero, grace: "6%", ticks: { callback: short } },
    } },
  });
}

// Shows some frames: what was made, the truth, and maps of what is wrong.
function showPictures() {
  const host = el("div", { id: "viewer" });
  section("pictures", "Frames beside their truth", quiet(el("b", {}, "error"), " is FLIP's map. ", el("b", {}, "flicker"),
    " is the change since the frame before that the truth has not. ", el("b", {}, "ghosts"),
    " is the change since the frame before, read where motion says that each pixel was: trails and whatever else motion does not explain."), host);
  const { frames, kinds } = page.pictures;
  const caption = (kind, [index]) => {
    const row = run.scores.frames.find((one) => String(one.index) === index);
    const figures = {
      truth: "", picture: row.psnr_tone_mapped === null ? "equals the truth" : `${number(row.psnr_tone_mapped, 4)} dB`,
      error: `FLIP ${number(row.flip)}`, flicker: row.flicker === null ? "no frame before it" : `mean ${number(row.flicker)}`,
      ghosts: row.flicker === null ? "no frame before it" : "",
    };
    return [el("b", {}, kinds[kind].name), figures[kinds[kind].name]];
  };
  const named = (name) => kinds.findIndex((kind) => kind.name === name);
  new PictureViewer(host, {
    size: page.pictures, selects: [["Frame", "frame", indices(frames), frames.at(-1).index]],
    choices: kinds.map((kind, i) => [i, kind.name]), shown: [named("picture"), named("truth")],
    picture: (kind, [index]) => decode(frames.find((one) => String(one.index) === index).pngs[kind], kinds[kind].map),
    caption, legend: ["0", "FLIP 1; of changes .25"],
  });
}

function showScores() {
  const rows = run.scores.frames;
  const host = plot("score-plot", 240);
  const lead = el("p", { id: "scores-lead", class: "quiet" });
  const measure = controls([["Measure", "score-measure", kMeasures, "psnr_tone_mapped"]], () => show());
  const table = () => makeTable("scores-table", [
    numberColumn("frame", (row) => row.index, (row) => String(row.index)),
    ...kMeasures.map(([name, label]) => numberColumn(label, (row) => row[name], (row) => number(row[name] ?? (name.startsWith("psnr") ? Infinity : null), 4))),
  ], rows).node;
  section("scores", "Against the truth", lead, measure.node, host, asTable(table));
  const show = () => {
    const [field, label, meaning] = kMeasures.find(([name]) => name === measure.values()[0]);
    const average = run.scores.mean[field];
    lead.textContent = `Mean of ${rows.length} frames: ${average === null ? "∞" : number(average, 4)}. ${meaning[0].toUpperCase()}${meaning.slice(1)}.`;
    const series = column(rows, (row) => row[field], label, "", 0);
    if (!hasPlots) return;
    if (isKnown(series)) drawOverFrames(host, indices(rows), [series], false);
    else host.replaceChildren("No frame has a value of this measure.");
  };
  show();
  keepDrawn(show);
}

function showTimes() {
  const host = plot("time-plot", 240);
  const table = () => makeTable("frames-table", [
    numberColumn("frame", (row) => row.index, (row) => String(row.index)),
    numberColumn("the whole frame, ms", (row) => row.frame_ms), numberColumn("OpenCL passes, ms", (row) => row.device_ms),
    numberColumn("across, of the output", (row) => row.ratio[0]), numberColumn("down, of the output", (row) => row.ratio[1]),
  ], run.frames).node;
  const lead = "A frame's time reaches from its start to the next one's, files included. The passes' is what OpenCL spent on it.";
  section("time", "Time of each frame", quiet(lead), host, asTable(table));
  const series = [
    column(run.frames, (row) => row.frame_ms, "the whole frame, ms", "ms", 0),
    column(run.frames, (row) => row.device_ms, "OpenCL passes, ms", "ms", 1),
  ].filter(isKnown);
  keepDrawn(() => drawOverFrames(host, indices(run.frames), series, true));
}

function showResolution() {
  const host = plot("ratio-plot", 240);
  section("resolution", "Resolution of each frame", quiet("The viewport's part of the output on each axis."), host);
  const series = [column(run.frames, (row) => row.ratio[0], "across", "of the output", 2)];
  if (run.frames.some((row) => row.ratio[0] !== row.ratio[1])) series.push(column(run.frames, (row) => row.ratio[1], "down", "of the output", 3));
  keepDrawn(() => drawOverFrames(host, indices(run.frames), series, true));
}

function showPasses() {
  const all = [...run.passes, ...run.steps];
  const rows = all.filter((row) => row.median_ms !== null);
  const host = plot("pass-plot", rows.length * 26 + 40);
  const ms = (title, field) => numberColumn(title, (row) => row[field]);
  const table = () => makeTable("passes-table", [
    textColumn("pass or step", (row) => row.name), textColumn("by", (row) => row.clock), ms("median, ms", "median_ms"),
    ms("least", "min_ms"), ms("95 % within", "p95_ms"), numberColumn("frames", (row) => row.count, (row) => String(row.count)),
    numberColumn("MB a frame", (row) => row.bytes, (row) => (row.bytes === null ? "" : number(row.bytes / 1e6))),
  ], all).node;
  const lead = "Bars are medians over the run; the thin line reaches to the time that 95 % of the frames keep.";
  section("passes", "Passes and steps", quiet(lead), host, asTable(table));
  const explain = (i) => {
    const row = rows[i];
    const bytes = row.bytes === null ? "" : `\n${number(row.bytes / 1e6)} MB a frame`;
    return `${row.name}: median ${number(row.median_ms)} ms, least ${number(row.min_ms)}, 95 % within ${number(row.p95_ms)}\nby ${row.clock}, ${row.count} frames${bytes}`;
  };
  const overlay = (context, { x, y }) => rows.forEach((row, i) => {
    const at = y.getPixelForValue(i);
    rule(context, x.getPixelForValue(0), at, x.getPixelForValue(row.p95_ms), at);
    write(context, `${number(row.median_ms)} ms`, x.getPixelForValue(Math.max(row.median_ms, row.p95_ms)) + 6, at);
  });
  const most = Math.max(...rows.map((row) => Math.max(row.median_ms, row.p95_ms)), 1e-6);
  keepDrawn(() => draw(host, "Passes and steps", {
    type: "bar",
    data: { labels: rows.map((row) => row.name), datasets: [{
      data: rows.map((row) => row.median_ms), explain, barThickness: 14,
      backgroundColor: rows.map((_, i) => css(i < run.passes.length ? "--resolve" : "--draw")),
    }] },
    options: {
      indexAxis: "y", plugins: { legend: { display: false } },
      scales: { x: { max: most * 1.15, display: false }, y: { grid: { display: false }, ticks: { color: css("--ink"), autoSkip: false } } },
    },
  }, overlay));
}

function factList() {
  const joined = (...parts) => parts.filter(Boolean).join(", ");
  return [
    ["version", run.version], ["scene", joined(run.scene, run.scene_summary)], ["seed", run.seed], ["method", run.method],
    ["output", `${run.output[0]}×${run.output[1]}, targets of ${run.target[0]}×${run.target[1]}`],
    ...Object.entries(run.settings),
    ["OpenCL", joined(run.cl.device, run.cl.platform, run.cl.driver)], ["OpenGL", joined(run.gl.renderer, run.gl.version)],
    ["interop", joined(run.interop, run.interop_reason)],
    ["busy", Object.entries(run.busy_seconds).map(([what, seconds]) => `${what} ${number(seconds)} s`).join(", ")],
    ["memory", run.peak_memory_bytes === null ? null : `${number(run.peak_memory_bytes / 1e6)} MB at most`],
    ["files", run.files.join(" … ")],
  ].filter(([, text]) => text !== null && text !== undefined && text !== "");
}

const took = run.wall_seconds === null ? "" : ` in ${number(run.wall_seconds)} s`;
document.title = `${run.program}: ${run.method}`;
head(`${run.program}: run report`, `${run.frames.length} frames of ${run.output[0]}×${run.output[1]} by ${run.method}${took}. `,
  el("code", {}, run.command_line || ""));
if (run.warnings.length) section("warnings", "Warnings", el("ul", { id: "warning-list" }, ...run.warnings.map((text) => el("li", {}, text))));
if (page.pictures) showPictures();
if (run.scores.frames.length) showScores();
if (run.frames.some((row) => row.frame_ms !== null || row.device_ms !== null)) showTimes();
if (run.frames.length && hasPlots) showResolution();
if (run.passes.length + run.steps.length) showPasses();
section("facts", "The run", terms("fact-list", factList()));
if (run.left_out.length) {
  const parts = run.left_out.map((item) => [item.what, item.why]);
  section("left-out", "Left out, because this scene does not need it", terms("left-out-list", parts));
}
