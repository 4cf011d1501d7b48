// SPDX-License-Identifier: MIT
// Speed against error: findings, error over time, frame time over scale, pictures, all figures, how it was measured.

const { result } = page;

const sceneNames = result.scenes.map((scene) => scene.name);
const scales = unique(result.rows.map((row) => row.scale)).sort((a, b) => a - b);
const methodNames = result.methods.map((method) => method.name);
// The scale that the findings speak of.
const headlineScale = scales.reduce((best, s) => (Math.abs(s - 0.7) < Math.abs(best - 0.7) ? s : best), scales[0]);
const sceneEntries = sceneNames.length > 1 ? withAll(sceneNames, "mean of all") : sceneNames;

const plusMinus = (spread) => {
  const half = spread.median > 0 ? (50 * (spread.high - spread.low)) / spread.median : 0;
  return "±" + (half < 10 ? half.toFixed(1) : half.toFixed(0)) + " %";
};

const isDecibels = (name) => name.startsWith("psnr");
// Returns one figure of a row's quality; null only where there is none. An infinite ratio of the whole picture is
// Infinity.
function errorOf(row, name) {
  const value = row.quality[name];
  return value === null && (name === "psnr" || name === "psnr_linear") ? Infinity : value;
}

// Ratios of power are averaged as errors, not as decibels.
function meanError(values, name) {
  const there = values.filter((value) => value !== null);
  if (there.length === 0) return null;
  if (!isDecibels(name)) return mean(there);
  return -10 * Math.log10(mean(there.map((value) => Math.pow(10, -value / 10))));
}

// Error over milliseconds.

// Points of a plot: one for each method; `scene` "" is the mean of all.
function pointsOf(scene, scale, measure) {
  const points = [];
  for (const [index, name] of methodNames.entries()) {
    const rows = result.rows.filter(
      (row) => row.method === name && row.scale === scale && (scene === "" || row.scene === scene));
    const error = rows.length ? meanError(rows.map((row) => errorOf(row, measure.name)), measure.name) : null;
    if (error === null || !Number.isFinite(error)) continue;
    const spread = (field) => mean(rows.map((row) => row.speed.ms[field]));
    const ratio = mean(rows.map((row) => row.speed.ratio.median));
    points.push({ name, error, rows, index, ratio, ms: spread("median"), low: spread("low"), high: spread("high") });
  }
  return points;
}

// Those that no other point beats: cheapest first, each better than all cheaper ones.
function frontOf(points, higher) {
  const sign = higher ? -1 : 1;
  const sorted = [...points].sort((a, b) => a.ms - b.ms || sign * (a.error - b.error));
  const front = [];
  for (const point of sorted) {
    if (front.length === 0 || sign * point.error < sign * front.at(-1).error) front.push(point);
  }
  return front;
}

// 1, 2, 5, 10, ... between the ends of an axis; at least two of them where there are any.
function logTicks({ min, max }) {
  const ticks = [];
  for (let decade = Math.floor(Math.log10(min)); decade <= Math.ceil(Math.log10(max)); ++decade) {
    for (const step of max / min > 30 ? [1, 3] : [1, 1.5, 2, 3, 5, 7]) {
      const tick = step * Math.pow(10, decade);
      if (tick >= min * 0.999 && tick <= max * 1.001) ticks.push(tick);
    }
  }
  return ticks;
}

// The axes' ranges; the same for all plots of one kind.
function rangesOf(points) {
  const ms = points.flatMap((point) => [point.low, point.high, point.ms]);
  const low = Math.min(...ms);
  const high = Math.max(...ms);
  const wide = Math.max(high / low, 1.6);
  const errors = points.map((point) => point.error);
  const [least, most] = [Math.min(...errors), Math.max(...errors)];
  const pad = most > least ? (most - least) * 0.12 : Math.abs(most) * 0.05 || 1;
  return { ms: [low / Math.pow(wide, 0.1), high * Math.pow(wide, 0.25)], error: [least - pad, most + pad] };
}

// One mark for each family, what stands before a colon, and one for all methods that have none; and its radius, so that
// all look equally large.
const kMarks = [["circle", 1], ["rectRot", 1.3], ["rect", 1.3], ["triangle", 1.2]];
const families = unique(methodNames.map((name) => (name.includes(":") ? name.split(":")[0] : "")).filter(Boolean));
const markOf = (name) => kMarks[(1 + families.indexOf(name.split(":")[0])) % kMarks.length];

// Returns a mark with its error bar for each point, and the front.
function errorDatasets(points, higher, ranges, radius, explain) {
  const front = frontOf(points, higher).map((point) => ({ x: point.ms, y: point.error }));
  const away = ranges.error[higher ? 0 : 1];
  const marks = points.map((point) => {
    const [pointStyle, size] = markOf(point.name);
    const inMiddle = (value) => [0, value, 0];
    return {
      label: point.name, pointStyle, explain: () => explain(point), showLine: true,
      data: [point.low, point.ms, point.high].map((x) => ({ x, y: point.error })),
      pointRadius: inMiddle(radius * size), pointHoverRadius: inMiddle(radius * size + 1), pointHitRadius: inMiddle(radius),
      borderColor: colourOf(point.index) + "8c", backgroundColor: colourOf(point.index), borderWidth: radius > 3 ? 2 : 0,
      pointBorderColor: css("--paper"), pointHoverBorderColor: css("--ink"), pointBorderWidth: radius > 3 ? 1.5 : 0,
    };
  });
  const corners = [{ x: ranges.ms[0], y: away }, { x: front[0].x, y: away }, ...front, { x: ranges.ms[1], y: front.at(-1).y }];
  return [...marks, {
    label: "front", data: corners, showLine: true, stepped: "before", pointRadius: 0, pointHitRadius: 0,
    borderColor: css("--front"), backgroundColor: css("--front-fill"), fill: higher ? "end" : "start",
  }];
}

function explainPoint(point, measure, scale) {
  const lines = [`${point.name} at scale ${scale}`,
    `${measure.label}: ${number(point.error, 4)}`,
    `${number(point.ms)} ms (${number(point.low)} to ${number(point.high)}), ${number(point.ratio)} × copy`];
  if (point.rows.length > 1) return [...lines, `mean of ${point.rows.length} scenes`].join("\n");
  const { render, speed } = point.rows[0];
  lines.push(`${render.width}×${render.height}, ${number(speed.bytes / 1e6)} MB at ${number(speed.gigabytes_per_second)} GB/s`);
  lines.push(`p95 ${number(speed.ms.p95)} ms; ${speed.kernels}`);
  return lines.join("\n");
}

// Writes the points' names where they touch neither a point nor a name, the nearest places first.
function writeNames(context, points, { x, y }, area, front) {
  const at = points.map((point) => [x.getPixelForValue(point.ms), y.getPixelForValue(point.error)]);
  const boxes = at.map(([px, py]) => ({ l: px - 8, r: px + 8, t: py - 8, b: py + 8 }));
  const hits = (box) => boxes.some((o) => box.l < o.r && box.r > o.l && box.t < o.b && box.b > o.t);
  const inside = (box) => box.l >= area.left - 30 && box.r <= area.right + 4 && box.t >= area.top && box.b <= area.bottom;
  points.forEach((point, i) => {
    const [px, py] = at[i];
    const width = point.name.length * 6.6 + 4;
    const boxAt = (dx, dy) => ({ l: px + dx, r: px + dx + width, t: py + dy - 8, b: py + dy + 8 });
    const places = [0, -16, 16, -32, 32, -48, 48, -64, 64, -80, 80].flatMap((dy) => [boxAt(12, dy), boxAt(-12 - width, dy)]);
    const box = places.find((place) => inside(place) && !hits(place)) || places.find(inside) || places[0];
    boxes.push(box);
    const middle = (box.t + box.b) / 2;
    const isLeft = box.l < px;
    if (Math.abs(middle - py) > 20) rule(context, px, py, isLeft ? box.r : box.l, middle, 0.8);
    write(context, point.name, isLeft ? box.r - 4 : box.l, middle, { align: isLeft ? "right" : "left", bold: front.includes(point) });
  });
}

// The large plot.
function drawPlot(host, scene, scale, measure) {
  const points = pointsOf(scene, scale, measure);
  if (points.length === 0) {
    host.replaceChildren(quiet(`There is no ${measure.label} here: no pixel counts for it, or only one frame was measured.`));
    return;
  }
  const ranges = rangesOf(points);
  const copies = result.copies.filter((row) => row.scale === scale && (scene === "" || row.scene === scene));
  const copy = mean(copies.map((row) => row.ms.median));
  const ticks = { callback: (value) => String(Number(value.toPrecision(3))), maxRotation: 0 };
  const axis = (part) => ({ type: "logarithmic", min: part[0], max: part[1], afterBuildTicks: atTicks(logTicks), ticks });
  const front = frontOf(points, measure.higher);
  draw(host, `${measure.label} over milliseconds`, {
    type: "scatter",
    data: { datasets: errorDatasets(points, measure.higher, ranges, 6, (point) => explainPoint(point, measure, scale)) },
    options: {
      plugins: { legend: { display: false } },
      scales: {
        x: { ...axis(ranges.ms), title: titled("ms a frame, median (log) · ← better") },
        y: { min: ranges.error[0], max: ranges.error[1], ticks: { callback: short, includeBounds: false },
          title: titled(`${measure.label} ${measure.higher ? "↑ better" : "↓ better"}`) },
        copies: { ...axis(ranges.ms.map((ms) => ms / copy)), axis: "x", position: "top", grid: { drawOnChartArea: false },
          title: titled("× float4 copy") },
      },
    },
  }, (context, axes, area) => writeNames(context, points, axes, area, front));
}

// One plot of the overview: no words, the column's and row's own axes.
function drawSmall(host, points, higher, ranges) {
  const side = (part) => ({ display: false, min: part[0], max: part[1] });
  draw(host, "", {
    type: "scatter", data: { datasets: errorDatasets(points, higher, ranges, 2.5) },
    options: {
      events: [], layout: { padding: 4 }, plugins: { legend: { display: false }, tooltip: { enabled: false } },
      scales: { x: { type: "logarithmic", ...side(ranges.ms) }, y: side(ranges.error) },
    },
  }).canvas.tabIndex = -1;
}

function drawSmallPlots(host, chosen, measure, choose) {
  for (const canvas of host.querySelectorAll("canvas")) Chart.getChart(canvas).destroy();
  host.style.gridTemplateColumns = `max-content repeat(${scales.length}, max-content)`;
  host.replaceChildren(el("span"), ...scales.map((scale) => el("span", { class: "head" }, String(scale))));
  const ms = scales.map((scale) => rangesOf(sceneNames.flatMap((scene) => pointsOf(scene, scale, measure))).ms);
  for (const scene of sceneNames) {
    host.append(el("span", { class: "side" }, scene));
    const row = scales.map((scale) => pointsOf(scene, scale, measure));
    for (const [i, points] of row.entries()) {
      if (points.length === 0) {
        host.append(el("span", { class: "head" }, "–"));
        continue;
      }
      const place = el("div", { class: "small" });
      host.append(el("button", {
        type: "button", "aria-label": `${scene} at scale ${scales[i]}`,
        "aria-pressed": String(chosen.scene === scene && chosen.scale === scales[i]),
        onclick: () => choose(scene, scales[i]),
      }, place));
      drawSmall(place, points, measure.higher, { ...rangesOf(row.flat()), ms: ms[i] });
    }
  }
}

function showErrors() {
  const host = plot("plot", 500);
  const small = el("div", { id: "small-plots" });
  const chosen = controls([
    ["Scene", "plot-scene", sceneEntries, sceneEntries.length > 1 ? "" : sceneNames[0]], ["Scale", "plot-scale", scales, headlineScale],
    ["Error", "plot-measure", page.measures.map((measure) => [measure.name, measure.label]), "flip"],
  ], () => show());
  section("error", "Error over time", el("p", {},
    "Each point is a method: how long it takes to make the picture, and how far the picture is from the truth. The line joins those that no other method beats in both: the Pareto front. Bars show how well the times are known."),
    chosen.node, host, el("h3", {}, "Every scene at every scale"),
    quiet("The same plot, small; the axes are those of its column and row. Choose one to see it large."),
    el("div", { class: "scroll", tabindex: 0, role: "group", "aria-label": "Small plots" }, small));
  const show = () => {
    const [scene, scale, name] = chosen.values();
    const measure = page.measures.find((one) => one.name === name);
    drawPlot(host, scene, Number(scale), measure);
    drawSmallPlots(small, { scene, scale: Number(scale) }, measure, (...place) => {
      place.forEach((value, i) => { chosen.nodes[i].value = value; });
      show();
      byId("error").scrollIntoView({ block: "start" });
    });
  };
  keepDrawn(show);
}

// Whole frames: stacked bars over scale, and the 70 % figure.

const kParts = [
  ["draw", "draw: OpenGL"],
  ["interop", "interop: to OpenCL and back"],
  ["resolve", "resolve and present: OpenCL"],
];

// Frames of a scene by scale; "" is the mean of all scenes.
function frameSteps(scene, clock) {
  return scales.map((scale) => {
    const rows = result.frames.filter((row) => row.scale === scale && (scene === "" || row.scene === scene));
    const of = (part, field = "median") => mean(rows.map((row) => row[`${part}_${clock}ms`][field]));
    return {
      scale, render: rows[0].render, parts: kParts.map(([part]) => of(part)),
      whole: of("frame"), low: of("frame", "low"), high: of("frame", "high"),
    };
  });
}

function explainFrame(step, clock) {
  const what = clock === "" ? "ms on the wall" : "ms of processor time";
  const parts = kParts.map(([, label], i) => `${label}: ${number(step.parts[i])}`);
  return [`scale ${step.scale}: ${number(step.whole)} ${what}`, ...parts,
    `whole: ${number(step.low)} to ${number(step.high)} (95 %)`].join("\n");
}

function drawFrames(host, scene, clock) {
  const steps = frameSteps(scene, clock);
  const top = (step) => Math.max(step.high, step.parts.reduce((a, b) => a + b));
  draw(host, "Frame time over scale", {
    type: "bar",
    data: {
      labels: steps.map(({ scale, render }) => [String(scale), `${render.width}×${render.height}`]),
      datasets: kParts.map(([part, label], i) => ({
        label, data: steps.map((step) => step.parts[i]), backgroundColor: css(`--${part}`), maxBarThickness: 84,
        explain: (at) => explainFrame(steps[at], clock),
      })),
    },
    options: { scales: {
      x: { stacked: true, grid: { display: false } },
      y: { stacked: true, max: 1.08 * Math.max(...steps.map(top)), ticks: { callback: short, includeBounds: false }, title: titled("ms a frame") },
    } },
  }, (context, { x, y }) => steps.forEach((step, i) => {
    const at = x.getPixelForValue(i);
    rule(context, at, y.getPixelForValue(step.low), at, y.getPixelForValue(step.high));
    write(context, number(step.whole), at, y.getPixelForValue(top(step)) - 10, { align: "center" });
  }));
}

// Frame time at the headline scale as part of that at 1, for each scene and both clocks.
function seventyRows() {
  if (Math.abs(headlineScale - 0.7) > 0.05 || !scales.includes(1)) return [];
  const at = (scene, scale) => result.frames.find((row) => row.scene === scene && row.scale === scale);
  const rows = sceneNames.map((name) => {
    const ratio = (field) => at(name, headlineScale)[field].median / at(name, 1)[field].median;
    return { name, wall: ratio("frame_ms"), processor: ratio("frame_processor_ms"), draw: ratio("draw_processor_ms") };
  });
  if (rows.length > 1) {
    const average = (field) => mean(rows.map((row) => row[field]));
    rows.push({ name: "mean", wall: average("wall"), processor: average("processor"), draw: average("draw") });
  }
  return rows;
}

function drawSeventy(host, rows) {
  const area = headlineScale * headlineScale;
  const percent = (part) => `${(100 * part).toFixed(0)} %`;
  const bars = [["wall", "time on the wall", 0], ["processor", "processor time", 4]];
  draw(host, "Frame time ratio", {
    type: "bar",
    data: { labels: rows.map((row) => row.name), datasets: bars.map(([field, label, colour]) => ({
      label, data: rows.map((row) => row[field]), backgroundColor: colourOf(colour), barThickness: 12,
      explain: (i) => `${rows[i].name}: ${percent(rows[i].wall)} of the time on the wall,\n${percent(rows[i].processor)} of the processor time (drawing alone: ${percent(rows[i].draw)})`,
    })) },
    options: { indexAxis: "y", scales: {
      x: {
        max: 1.08 * Math.max(1, ...rows.flatMap((row) => [row.wall, row.processor])), afterBuildTicks: atTicks(() => [0, area, 1]),
        grid: { borderDash: ({ index }) => (index === 1 ? [4, 3] : []) },
        ticks: { callback: (value) => (value === area ? `${percent(area)} pixels` : String(value)) },
      },
      y: { grid: { display: false }, ticks: { color: css("--ink"), autoSkip: false } },
    } },
  }, (context, { x, y }) => rows.forEach((row, i) => bars.forEach(([field], k) => {
    write(context, percent(row[field]), x.getPixelForValue(row[field]) + 5, y.getPixelForValue(i) + 13 * (k - 0.5), { colour: css("--quiet") });
  })));
}

function showFrames() {
  const host = plot("frame-plot", 350);
  const chosen = controls([
    ["Scene", "frame-scene", sceneEntries, sceneEntries.length > 1 ? "" : sceneNames[0]],
    ["Clock", "frame-clock", [["", "time on the wall"], ["processor_", "processor time: a stand-in for power"]], ""],
  ], () => drawFrames(host, ...chosen.values()));
  const rows = seventyRows();
  const seventy = plot("seventy-plot", rows.length * 34 + 80);
  section("frame", "Frame time over scale",
    el("p", {}, `A whole frame with ${result.frames[0].method}: OpenGL draws it, it is handed to OpenCL, resolved, presented and handed back; one step after the other, nothing overlaps.`),
    chosen.node, host, ...(rows.length === 0 ? [] : [
      el("h3", {}, `At scale ${headlineScale}: what remains of the frame time at 1`),
      quiet("Below one, a smaller viewport pays; the dashed line is the part of the pixels that is left to draw."), seventy]));
  keepDrawn(() => {
    drawFrames(host, ...chosen.values());
    if (rows.length > 0) drawSeventy(seventy, rows);
  });
}

// Pictures: crops of every scene and scale, by every method, with their errors.

// Row y of picture k is row y * names.length + k of the sheet.
function unpack(sheet, k) {
  const { width, height, names } = page.gallery;
  const picture = new ImageData(width, height);
  for (let y = 0; y < height; ++y) {
    const start = (y * names.length + k) * width * 4;
    picture.data.set(sheet.data.subarray(start, start + width * 4), y * width * 4);
  }
  return picture;
}

function showPictures() {
  const { width, height, frame, names, scenes } = page.gallery;
  const host = el("div", { id: "viewer" });
  section("pictures", "Pictures", el("p", {},
    `${width}×${height} pixels of measured frame ${frame + 1}, where the methods err most in the mean, as they are: no scaling. Tone mapped as the errors are measured. Error maps show FLIP.`), host);
  const choices = names.map((name, i) => [`picture ${i}`, name])
    .concat(names.slice(1).map((name, i) => [`error ${i + 1}`, `error of ${name}`]));
  const sceneOf = ([name]) => scenes.find((scene) => scene.name === name);
  new PictureViewer(host, {
    size: { width, height }, corner: (values) => ({ x: sceneOf(values).x, y: sceneOf(values).y }),
    selects: [["Scene", "viewer-scene", scenes.map((scene) => scene.name), scenes[0].name],
      ["Scale", "viewer-scale", scenes[0].sheets.map((sheet) => sheet.scale), scenes[0].sheets[0].scale]],
    choices, shown: [`picture ${names.length - 1}`, "picture 0"],
    picture: async (choice, values) => {
      const [kind, index] = choice.split(" ");
      const sheet = sceneOf(values).sheets.find((one) => String(one.scale) === values[1]);
      return unpack(await (kind === "error" ? decode(sheet.errors, true) : decode(sheet.pictures)), Number(index));
    },
    caption: (choice, [scene, scale]) => {
      const [kind, index] = choice.split(" ");
      const row = result.rows.find((r) => r.scene === scene && String(r.scale) === scale && r.method === names[index]);
      const figures = row ? `FLIP ${number(row.quality.flip)}, ${number(errorOf(row, "psnr"), 4)} dB, ${number(row.speed.ms.median)} ms` : `${result.conditions.truth_samples}² samples a pixel`;
      return [el("b", {}, kind === "error" ? `error of ${names[index]}` : names[index]), figures];
    },
    legend: ["FLIP 0", "1"],
  });
}

// Tables.

const kCaseColumns = [
  textColumn("scene", (row) => row.scene),
  numberColumn("scale", (row) => row.scale, (row) => String(row.scale)),
];
const renderColumn = numberColumn("render", (row) => row.render.width * row.render.height, (row) => `${row.render.width}×${row.render.height}`);
// A median, with its noise or without it.
const median = (title, of, best = 0) => numberColumn(title, (row) => of(row).median, null, best);
const noisy = (title, of, best = 0) =>
  numberColumn(title, (row) => of(row).median, (row) => `${number(of(row).median)} ${plusMinus(of(row))}`, best);

function makeRowsTable() {
  const errors = page.measures.map((measure) => numberColumn(
    measure.label, (row) => errorOf(row, measure.name),
    (row) => number(errorOf(row, measure.name), isDecibels(measure.name) ? 4 : 3), measure.higher ? 1 : -1));
  return makeTable("rows-table", [
    ...kCaseColumns, textColumn("method", (row) => row.method),
    noisy("ms, median", (row) => row.speed.ms, -1), numberColumn("ms, p95", (row) => row.speed.ms.p95),
    median("× copy", (row) => row.speed.ratio, -1), noisy("× copy, processor time", (row) => row.speed.processor_ratio, -1),
    ...errors,
    numberColumn("non-finite pixels", (row) => row.quality.non_finite, (row) => String(row.quality.non_finite)),
    numberColumn("MB", (row) => row.speed.bytes, (row) => number(row.speed.bytes / 1e6)),
    numberColumn("GB/s", (row) => row.speed.gigabytes_per_second),
    renderColumn, textColumn("kernels", (row) => row.speed.kernels),
  ], result.rows, (row) => `${row.scene}|${row.scale}`);
}

function makeFramesTable() {
  return makeTable("frames-table", [
    ...kCaseColumns, renderColumn, textColumn("method", (row) => row.method),
    median("draw, ms", (row) => row.draw_ms), median("interop, ms", (row) => row.interop_ms),
    median("resolve, ms", (row) => row.resolve_ms), noisy("frame, ms", (row) => row.frame_ms),
    numberColumn("p95", (row) => row.frame_ms.p95),
    median("processor: draw", (row) => row.draw_processor_ms), median("interop", (row) => row.interop_processor_ms),
    median("resolve", (row) => row.resolve_processor_ms), noisy("processor, frame", (row) => row.frame_processor_ms),
    numberColumn("moved, MB", (row) => row.interop_bytes, (row) => number(row.interop_bytes / 1e6)),
  ], result.frames);
}

function makeCopiesTable() {
  return makeTable("copies-table", [
    ...kCaseColumns, noisy("ms, median", (row) => row.ms), numberColumn("ms, p95", (row) => row.ms.p95),
    median("processor ms", (row) => row.processor_ms), numberColumn("GB/s", (row) => row.gigabytes_per_second),
  ], result.copies);
}

function makeScenesTable() {
  const part = (title, field) => numberColumn(
    title, (row) => row[field], (row) => (row[field] === null ? "" : `${number(100 * row[field])} %`));
  return makeTable("scenes-table", [
    textColumn("scene", (row) => row.name), textColumn("what is seen", (row) => row.summary, true),
    textColumn("what it tests", (row) => row.reason, true),
    numberColumn("flicker of truth", (row) => row.truth_flicker),
    part("disoccluded", "disoccluded"),
    part("region: thin things", "part_thin"), part("behind thin things", "part_behind_thin"),
    part("disoccluded, no thin thing near", "part_disoccluded"), part("edges of motion", "part_edge"),
    part("rest", "part_rest"),
  ], result.scenes);
}

function makeMethodsTable() {
  return makeTable("methods-table", [
    textColumn("method", (row) => row.name), textColumn("what it does", (row) => row.summary, true),
    textColumn("jitter of its frames", (row) => row.jitter),
    numberColumn("bias of texture detail at scale 1", (row) => row.lod_bias, (row) => String(row.lod_bias)),
  ], result.methods);
}

function showFigures() {
  const rows = makeRowsTable();
  const filter = (scene, scale, method) => rows.show((row) =>
    [[scene, row.scene], [scale, row.scale], [method, row.method]].every(([wanted, has]) => wanted === "" || wanted === String(has)));
  const chosen = controls([
    ["Scene", "table-scene", withAll(sceneNames), ""],
    ["Scale", "table-scale", withAll(scales), scales.length > 1 ? headlineScale : ""],
    ["Method", "table-method", withAll(methodNames), ""],
  ], filter);
  filter(...chosen.values());
  section("figures", "All figures",
    quiet("Choose a column's title to sort by it, again to turn the order. Bold: the best of its scene and scale."),
    chosen.node, rows.node, el("h3", {}, "Whole frames"), makeFramesTable().node,
    el("h3", {}, "The plain copy: the unit of cost"), makeCopiesTable().node);
}

function facts() {
  const { machine, conditions } = result;
  return [
    ["command", el("code", {}, result.command)],
    ["when", `${result.date}, ${number(result.wall_seconds / 60)} minutes; version ${result.version}`],
    ["OpenCL", `${machine.cl_device}; ${machine.cl_platform} ${machine.cl_driver}, ${machine.cl_version}`],
    ["OpenGL", `${machine.gl_renderer}; ${machine.gl_version}`],
    ["handed over by", machine.interop],
    ["machine", `${machine.processor}, ${machine.processors} processors, ${number(machine.memory_gib)} GiB; ${machine.system}`],
    ["load", `${number(machine.load_before)} before, ${number(machine.load_after)} after (processes that wanted to run, of the last minute)`],
    ["noise", `typical half width of a median's 95 % interval: ±${(100 * page.noise.cost).toFixed(1)} % of costs in copies, ±${(100 * page.noise.ms).toFixed(1)} % of milliseconds; ± in the tables is that of each`],
    ["frames", `${conditions.frames} measured after ${conditions.warm_up} that warm up, or ${conditions.history_warm_up ?? conditions.warm_up} of methods that accumulate; then ${conditions.rounds} timed rounds of ${conditions.frames} that follow on them; ${conditions.fps} a second from ${conditions.start} s, of a scene with cuts from its first one on; seed ${conditions.seed}`],
    ["order", "every frame is drawn once for each jitter, then each method resolves it, another going first each time, with one plain copy among them; truth and errors are computed outside of the timing"],
    ["truth", `${conditions.truth_samples}×${conditions.truth_samples} samples a pixel in a box, by the same renderer`],
    ["cost", `by ${page.cost_clock}, the steadier clock on this device, in copies of the picture: float4, read and written once`],
  ];
}

const kWords = [
  ["FLIP", "mean difference that an observer sees when both pictures are shown in turn, 67 pixels a degree (Andersson et al. 2020); 0 is equal"],
  ["PSNR", "of tone-mapped colour, max(c, 0)/(1 + c), sRGB encoded; over frames, that of the mean squared error. The linear one clips light to 0..1"],
  ["SSIM", "of tone-mapped luma, Gaussian windows of 11×11 (Wang et al. 2004); 1 is equal"],
  ["relative HDR error", "mean of (c − t)²/(t² + 0.01) over linear colour, whatever the exposure (Rousselle et al. 2011)"],
  ["99th percentile", "of |picture − truth| over tone-mapped colour values"],
  ["worst 16×16 window", "largest root mean square error of any 16×16 pixels in any frame, tone mapped"],
  ["flicker", "mean change of luma from frame to frame that the truth does not have; the truth's own change stands in the table of scenes"],
  ["ghosting", "root mean square error of the pixels that were hidden behind something nearer within the last two frames, by the true depth and velocity"],
  ["regions", "each pixel is in one: thin things (less than four pixels across), else within four pixels behind one, else disoccluded, else within two pixels of where two motions meet, else the rest; by the true depth and velocity"],
  ["×", "the plain copy's time in the same round; its bandwidth stands in its own table"],
];

function showHead() {
  const { conditions, machine } = result;
  const count = (list, word) => `${list.length} ${word}${list.length === 1 ? "" : "s"}`;
  head("Speed against error",
    `How far ${methodNames.length} ways to make a ${conditions.output.width}×${conditions.output.height} picture from a smaller frame are from the truth, and what each costs: `,
    `${count(sceneNames, "scene")} at ${count(scales, "scale")} on ${machine.cl_device} (${machine.cl_platform}), ${result.date}.`);
  document.querySelector("main").append(el("section", { id: "findings", "aria-label": "Findings" }, ...page.findings.map((finding) =>
    el("div", { class: "finding" }, el("b", {}, finding.figure), el("strong", {}, finding.heading), el("p", {}, finding.sentence)))));
}

showHead();
if (hasPlots) {
  showErrors();
  showFrames();
}
if (page.gallery.scenes.length > 0) showPictures();
showFigures();
section("method", "How it was measured", terms("facts", facts()), el("h3", {}, "Scenes"), makeScenesTable().node,
  el("h3", {}, "Methods"), makeMethodsTable().node, el("h3", {}, "What the words mean"), terms("words", kWords));
