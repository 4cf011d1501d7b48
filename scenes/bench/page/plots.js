// SPDX-License-Identifier: MIT
// Error over milliseconds, large and small; frame time over scale.

// 1, 2, 5, 10, ... between two values; at least two of them where there are any.
function logTicks(low, high) {
  const ticks = [];
  for (let decade = Math.floor(Math.log10(low)); decade <= Math.ceil(Math.log10(high)); ++decade) {
    for (const step of high / low > 30 ? [1, 3] : [1, 1.5, 2, 3, 5, 7]) {
      const tick = step * Math.pow(10, decade);
      if (tick >= low * 0.999 && tick <= high * 1.001) ticks.push(tick);
    }
  }
  return ticks;
}

function padded(values, part) {
  const low = Math.min(...values);
  const high = Math.max(...values);
  const pad = high > low ? (high - low) * part : Math.abs(high) * 0.05 || 1;
  return [low - pad, high + pad];
}

const kMarks = [
  (r) => `M0,${-r}A${r},${r} 0 1 1 0,${r}A${r},${r} 0 1 1 0,${-r}Z`,
  (r) => `M0,${-r * 1.25}L${r * 1.25},0L0,${r * 1.25}L${-r * 1.25},0Z`,
  (r) => `M${-r},${-r}H${r}V${r}H${-r}Z`,
  (r) => `M0,${-r * 1.2}L${r * 1.15},${r * 0.9}H${-r * 1.15}Z`,
];
// One mark for each family, what stands before a colon, and one for all methods that have none.
const families = unique(methodNames.map((name) => (name.includes(":") ? name.split(":")[0] : "")).filter(Boolean));
const familyOf = (name) => 1 + families.indexOf(name.split(":")[0]);
const markOf = (name, r) => kMarks[familyOf(name) % kMarks.length](r);

// Where labels go: the first place that touches neither a point nor a label, nearest places first.
function placeLabels(points, x, y, area) {
  const boxes = points.map((p) => ({ l: x(p.ms) - 8, r: x(p.ms) + 8, t: y(p.error) - 8, b: y(p.error) + 8 }));
  const hits = (box) => boxes.some((o) => box.l < o.r && box.r > o.l && box.t < o.b && box.b > o.t);
  return points.map((point) => {
    const width = point.name.length * 6.6 + 4;
    const px = x(point.ms);
    const py = y(point.error);
    const places = [];
    for (const away of [0, 16, 32, 48, 64, 80]) {
      for (const dy of away === 0 ? [0] : [-away, away]) places.push([12, dy], [-12 - width, dy]);
    }
    const boxAt = ([dx, dy]) => ({ l: px + dx, r: px + dx + width, t: py + dy - 8, b: py + dy + 8 });
    const inside = (box) => box.l >= area.left - 30 && box.r <= area.right + 4 && box.t >= area.top && box.b <= area.bottom;
    const place = places.find((p) => inside(boxAt(p)) && !hits(boxAt(p))) ||
      places.find((p) => inside(boxAt(p))) || places[0];
    boxes.push(boxAt(place));
    return { x: px + place[0], y: py + place[1], far: Math.abs(place[1]) > 20, px, py, left: place[0] < 0, width };
  });
}

// The axes' ranges; the same for all plots of one kind.
function rangesOf(points) {
  const ms = points.flatMap((point) => [point.low, point.high, point.ms]);
  const low = Math.min(...ms);
  const high = Math.max(...ms);
  const wide = Math.max(high / low, 1.6);
  return { ms: [low / Math.pow(wide, 0.1), high * Math.pow(wide, 0.25)], error: padded(points.map((p) => p.error), 0.12) };
}

function scalesOf(ranges, area) {
  const span = Math.log(ranges.ms[1] / ranges.ms[0]);
  return {
    x: (ms) => area.left + (Math.log(ms / ranges.ms[0]) / span) * (area.right - area.left),
    y: (error) => area.bottom - ((error - ranges.error[0]) / (ranges.error[1] - ranges.error[0])) * (area.bottom - area.top),
  };
}

function frontPath(points, higher, to, area) {
  const front = frontOf(points, higher);
  if (front.length === 0) return [];
  const end = higher ? area.top : area.bottom;
  const away = higher ? area.bottom : area.top;
  let path = `M${to.x(front[0].ms)},${away}V${to.y(front[0].error)}`;
  for (const point of front.slice(1)) path += `H${to.x(point.ms)}V${to.y(point.error)}`;
  path += `H${area.right}`;
  return [svg("path", { class: "under", d: `${path}V${end}H${area.left}V${away}Z` }), svg("path", { class: "front", d: path })];
}

function explainPoint(point, measure, scale) {
  const one = point.rows.length === 1 ? point.rows[0] : null;
  const lines = [`${point.name} at scale ${scale}`,
    `${measure.label}: ${number(point.error, 4)}`,
    `${number(point.ms)} ms (${number(point.low)} to ${number(point.high)}), ${number(point.ratio)} × copy`];
  if (one) {
    lines.push(`${one.render.width}×${one.render.height}, ${megabytes(one.speed.bytes)} at ${number(one.speed.gigabytes_per_second)} GB/s`);
    lines.push(`p95 ${number(one.speed.ms.p95)} ms; ${one.speed.kernels}`);
  } else {
    lines.push(`mean of ${point.rows.length} scenes`);
  }
  return lines.join("\n");
}

// The large plot.
function drawPlot(host, scene, scale, name) {
  const measure = measureNamed(name);
  const points = pointsOf(scene, scale, name);
  const width = Math.max(host.clientWidth, 280);
  const height = Math.min(520, Math.max(380, width * 0.5));
  const area = { left: 58, right: width - 12, top: 40, bottom: height - 48 };
  host.replaceChildren();
  if (points.length === 0) {
    host.append(el("p", { class: "quiet" }, `There is no ${measure.label} here: no pixel counts for it, or only one frame was measured.`));
    return;
  }
  const ranges = rangesOf(points);
  const to = scalesOf(ranges, area);
  const copy = copyMs(scene, scale);
  const chart = svg("svg", { viewBox: `0 0 ${width} ${height}`, height, role: "group", "aria-label": `${measure.label} over milliseconds` });
  chart.append(...gridOf(ranges, to, area, copy, width < 560));
  chart.append(svg("text", { class: "axis", x: area.left, y: 12 }, `${measure.label} ${measure.higher ? "↑ better" : "↓ better"}`));
  chart.append(svg("text", { class: "axis", x: area.right, y: height - 6, "text-anchor": "end" }, "ms a frame, median (log) · ← better"));
  chart.append(svg("text", { class: "axis", x: area.right, y: 12, "text-anchor": "end" }, "× float4 copy"));
  chart.append(...frontPath(points, measure.higher, to, area));
  const front = frontOf(points, measure.higher);
  const labels = placeLabels(points, to.x, to.y, area);
  points.forEach((point, i) => chart.append(pointNode(point, labels[i], to, measure, scale, front.includes(point))));
  host.append(chart);
}

function gridOf(ranges, to, area, copy, narrow) {
  const nodes = [];
  for (const tick of linearTicks(...ranges.error, 6)) {
    nodes.push(svg("path", { class: "grid", d: `M${area.left},${to.y(tick)}H${area.right}` }),
      svg("text", { class: "tick", x: area.left - 6, y: to.y(tick) + 4, "text-anchor": "end" }, String(Number(tick.toPrecision(6)))));
  }
  const thin = (ticks) => (narrow && ticks.length > 5 ? ticks.filter((_, i) => i % 2 === 0) : ticks);
  for (const tick of thin(logTicks(...ranges.ms))) {
    nodes.push(svg("path", { class: "grid", d: `M${to.x(tick)},${area.top}V${area.bottom}` }),
      svg("text", { class: "tick", x: to.x(tick), y: area.bottom + 17, "text-anchor": "middle" }, String(Number(tick.toPrecision(3)))));
  }
  for (const tick of thin(logTicks(ranges.ms[0] / copy, ranges.ms[1] / copy))) {
    nodes.push(svg("path", { class: "grid", d: `M${to.x(tick * copy)},${area.top}v-5` }),
      svg("text", { class: "tick", x: to.x(tick * copy), y: area.top - 9, "text-anchor": "middle" }, String(Number(tick.toPrecision(3)))));
  }
  return nodes;
}

function pointNode(point, label, to, measure, scale, onFront) {
  const x = to.x(point.ms);
  const y = to.y(point.error);
  const colour = colourOf(point.index);
  const text = explainPoint(point, measure, scale);
  return svg("g", { class: onFront ? "point on-front" : "point", "data-method": point.name, ...explains(text) },
    svg("path", { class: "whisker", stroke: colour, d: `M${to.x(point.low)},${y}H${to.x(point.high)}` }),
    label.far ? svg("path", { class: "leader", d: `M${x},${y}L${label.left ? label.x + label.width : label.x},${label.y}` }) : null,
    svg("path", { class: "mark", d: markOf(point.name, 6), fill: colour, transform: `translate(${x},${y})` }),
    svg("text", { x: label.left ? label.x + label.width - 4 : label.x, y: label.y + 4, "text-anchor": label.left ? "end" : "start" }, point.name));
}

// One plot of the overview: no words, the column's and row's own axes.
function smallPlot(points, higher, ranges) {
  const width = 118;
  const height = 78;
  const area = { left: 4, right: width - 4, top: 4, bottom: height - 4 };
  const to = scalesOf(ranges, area);
  const chart = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, "aria-hidden": "true" });
  chart.append(...frontPath(points, higher, to, area));
  for (const point of points) {
    chart.append(svg("path", { d: markOf(point.name, 3), fill: colourOf(point.index), transform: `translate(${to.x(point.ms)},${to.y(point.error)})` }));
  }
  return chart;
}

function drawSmallPlots(host, chosen, name, choose) {
  const measure = measureNamed(name);
  host.replaceChildren();
  host.style.gridTemplateColumns = `max-content repeat(${scales.length}, max-content)`;
  host.append(el("span"), ...scales.map((scale) => el("span", { class: "head" }, String(scale))));
  for (const scene of sceneNames) {
    host.append(el("span", { class: "side" }, scene));
    const row = scales.map((scale) => pointsOf(scene, scale, name));
    const all = row.flat();
    for (const [i, points] of row.entries()) {
      if (points.length === 0) {
        host.append(el("span", { class: "head" }, "–"));
        continue;
      }
      const ranges = { ...rangesOf(all), ms: rangesOf(sceneNames.flatMap((s) => pointsOf(s, scales[i], name))).ms };
      host.append(el("button", {
        type: "button", "aria-label": `${scene} at scale ${scales[i]}`,
        "aria-pressed": String(chosen.scene === scene && chosen.scale === scales[i]),
        onclick: () => choose(scene, scales[i]),
      }, smallPlot(points, measure.higher, ranges)));
    }
  }
}
