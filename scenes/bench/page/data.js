// SPDX-License-Identifier: MIT
// The figures of the page of speed against error.

const result = page.result;

const sceneNames = result.scenes.map((scene) => scene.name);
const scales = unique(result.rows.map((row) => row.scale)).sort((a, b) => a - b);
const methodNames = result.methods.map((method) => method.name);
// The scale that the findings speak of.
const headlineScale = scales.reduce((best, s) => (Math.abs(s - 0.7) < Math.abs(best - 0.7) ? s : best), scales[0]);

const megabytes = (bytes) => number(bytes / 1e6) + " MB";
const plusMinus = (spread) => {
  const half = spread.median > 0 ? (50 * (spread.high - spread.low)) / spread.median : 0;
  return "±" + (half < 10 ? half.toFixed(1) : half.toFixed(0)) + " %";
};

const measureNamed = (name) => page.measures.find((measure) => measure.name === name);
const isDecibels = (name) => name.startsWith("psnr");
const ofWholePicture = (name) => name === "psnr" || name === "psnr_linear";
// Returns one figure of a row's quality; null only where there is none. An infinite ratio of the whole picture is
// Infinity.
function errorOf(row, name) {
  const value = row.quality[name];
  return value === null && ofWholePicture(name) ? Infinity : value;
}

// Ratios of power are averaged as errors, not as decibels.
function meanError(values, name) {
  const there = values.filter((value) => value !== null);
  if (there.length === 0) return null;
  if (!isDecibels(name)) return mean(there);
  return -10 * Math.log10(mean(there.map((value) => Math.pow(10, -value / 10))));
}

// Points of a plot: one for each method; `scene` "" is the mean of all.
function pointsOf(scene, scale, measure) {
  const points = [];
  for (const name of methodNames) {
    const rows = result.rows.filter(
      (row) => row.method === name && row.scale === scale && (scene === "" || row.scene === scene));
    const error = rows.length ? meanError(rows.map((row) => errorOf(row, measure)), measure) : null;
    if (error === null || !Number.isFinite(error)) continue;
    const spread = (field) => mean(rows.map((row) => row.speed.ms[field]));
    points.push({
      name, error, rows, index: methodNames.indexOf(name),
      ms: spread("median"), low: spread("low"), high: spread("high"),
      ratio: mean(rows.map((row) => row.speed.ratio.median)),
    });
  }
  return points;
}

// Those that no other point beats: cheapest first, each better than all cheaper ones.
function frontOf(points, higher) {
  const sign = higher ? -1 : 1;
  const sorted = [...points].sort((a, b) => a.ms - b.ms || sign * (a.error - b.error));
  const front = [];
  for (const point of sorted) {
    if (front.length === 0 || sign * point.error < sign * front[front.length - 1].error) front.push(point);
  }
  return front;
}

const copyMs = (scene, scale) =>
  mean(result.copies.filter((row) => row.scale === scale && (scene === "" || row.scene === scene))
    .map((row) => row.ms.median));

const sceneEntries = (all) => (sceneNames.length > 1 ? [["", all]] : []).concat(sceneNames.map((name) => [name, name]));
const firstScene = sceneNames.length > 1 ? "" : sceneNames[0];
