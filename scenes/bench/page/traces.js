// SPDX-License-Identifier: MIT
// Resolution controllers over load traces: tables, and load, resolution and dropped frames over time.

const run = page.run;
const controllerNames = unique(run.results.map((result) => result.controller));
const displayText = (display) => `${display.refresh_hz} Hz, ${display.buffers} buffers, timers ${display.timer_latency_frames} late`;
const listAndDisplay = (row) => `${row.traces}|${displayText(row.display)}`;

const kScoreColumns = [
  numberColumn("dropped", (row) => row.dropped, (row) => number(row.dropped), -1),
  numberColumn("pixels over the oracle's", (row) => row.pixels_over_oracle, (row) => row.pixels_over_oracle.toFixed(3), 1),
  numberColumn("changes/s", (row) => row.changes_per_second, null, -1),
  numberColumn("oscillation: reversals/s", (row) => row.reversals_per_second, null, -1),
  numberColumn("settles down, frames", (row) => row.settle_up_frames, null, -1),
  numberColumn("settles up, frames", (row) => row.settle_down_frames, null, -1),
];

function makeTotalsTable() {
  return makeTable([
    textColumn("traces", (row) => row.traces), textColumn("display", (row) => displayText(row.display)),
    textColumn("controller", (row) => row.controller), ...kScoreColumns,
    numberColumn("dropped per 1,000", (row) => row.dropped_per_thousand, null, -1),
  ], run.results, listAndDisplay);
}

function makeTraceTable() {
  const rows = run.results.flatMap((result) =>
    result.rows.map((row) => ({ ...row, traces: result.traces, display: result.display, controller: result.controller })));
  return makeTable([
    textColumn("traces", (row) => row.traces), textColumn("display", (row) => displayText(row.display)),
    textColumn("trace", (row) => row.trace), textColumn("kind", (row) => row.kind),
    textColumn("controller", (row) => row.controller), ...kScoreColumns,
    numberColumn("dropped for the processor", (row) => row.cpu_dropped),
  ], rows, (row) => `${listAndDisplay(row)}|${row.trace}`);
}

// Curves are [frame, value, frame, value, ...]: a value holds until the next.
function stepPath(curve, x, y) {
  let path = "";
  for (let i = 0; i < curve.length; i += 2) {
    path += i === 0 ? `M${x(curve[0])},${y(curve[1])}` : `H${x(curve[i])}V${y(curve[i + 1])}`;
  }
  return `${path}H${x(page.frames)}`;
}
const highest = (curves) => Math.max(...curves.flatMap((curve) => curve.filter((_, i) => i % 2 === 1)));

function panelOf(chart, area, x, most, title) {
  const y = (value) => area.bottom - (value / most) * (area.bottom - area.top);
  chart.append(svg("text", { class: "axis", x: area.left, y: area.top - 6 }, title));
  for (const tick of linearTicks(0, most, 4)) {
    chart.append(svg("path", { class: "grid", d: `M${area.left},${y(tick)}H${area.right}` }),
      svg("text", { class: "tick", x: area.left - 6, y: y(tick) + 4, "text-anchor": "end" }, String(Number(tick.toPrecision(4)))));
  }
  return y;
}

function line(kind, curve, x, y, colour, dashed) {
  return svg("path", { class: kind, d: stepPath(curve, x, y), fill: "none", stroke: colour, "stroke-width": 1.4, "stroke-dasharray": dashed ? "4 3" : null });
}

function drawDropped(chart, area, x, chosen) {
  chart.append(svg("text", { class: "axis", x: area.left, y: area.top - 6 }, "dropped refreshes"));
  chosen.forEach(({ name, curve, colour }, i) => {
    const top = area.top + 24 * i;
    const counts = (value, at, all) => at % 2 === 1 && all[at - 1] >= run.warm_up_frames;
    const count = curve.dropped.filter(counts).reduce((sum, value) => sum + value, 0);
    chart.append(svg("path", { class: "grid", d: `M${area.left},${top + 18}H${area.right}` }));
    for (let at = 0; at < curve.dropped.length; at += 2) {
      const seconds = (curve.dropped[at] / page.refresh_hz).toFixed(2);
      chart.append(svg("rect", { class: "drop part", x: x(curve.dropped[at]) - 1.5, y: top + 2, width: 3, height: 16, fill: colour,
        ...explains(`${name}: ${curve.dropped[at + 1]} dropped at ${seconds} s`) }));
    }
    chart.append(svg("text", { x: area.right, y: top + 12, "text-anchor": "end", fill: colour, "paint-order": "stroke", stroke: "var(--paper)", "stroke-width": 3 }, `${name}: ${count}`));
  });
}

function drawTime(host, trace, names) {
  const width = Math.max(host.clientWidth, 280);
  const chosen = names.filter((name) => name !== "").map((name) => ({
    name, curve: trace.curves[controllerNames.indexOf(name)], colour: colourOf(controllerNames.indexOf(name)) }));
  const height = 520 + 24 * chosen.length;
  const left = 46;
  const right = width - 8;
  const x = (frame) => left + (frame / page.frames) * (right - left);
  const chart = svg("svg", { viewBox: `0 0 ${width} ${height}`, height, role: "group", "aria-label": `${trace.name}: load, resolution and dropped frames over time` });
  const load = { left, right, top: 22, bottom: 160 };
  const loadY = panelOf(chart, load, x, Math.max(1, highest([trace.load, trace.cpu])) * 1.08, "load at the output's resolution, targets; dashed: the processor's");
  chart.append(line("load", trace.load, x, loadY, "var(--ink)"), line("cpu", trace.cpu, x, loadY, "var(--quiet)", true));
  const area = { left, right, top: 196, bottom: 440 };
  const areaY = panelOf(chart, area, x, 1.04, "resolution: part of the output's pixels; dashed: the oracle's");
  chart.append(line("oracle", trace.oracle, x, areaY, "var(--quiet)", true));
  for (const { curve, colour } of chosen) chart.append(line("area", curve.area, x, areaY, colour));
  const drops = { left, right, top: 470, bottom: 470 + 24 * chosen.length };
  drawDropped(chart, drops, x, chosen);
  for (const tick of linearTicks(0, page.frames / page.refresh_hz, 8)) {
    chart.append(svg("text", { class: "tick", x: x(tick * page.refresh_hz), y: height - 8, "text-anchor": tick * page.refresh_hz < page.frames ? "middle" : "end" }, `${tick} s`));
  }
  host.replaceChildren(chart);
}

function startTime() {
  const trace = byId("time-trace");
  const controller = byId("time-controller");
  const beside = byId("time-beside");
  const first = Math.max(0, page.traces.findIndex((one) => one.name.startsWith("step up")));
  options(trace, page.traces.map((one, i) => [i, `${one.list}: ${one.name}`]), first);
  options(controller, controllerNames.map((name) => [name, name]), controllerNames[0]);
  options(beside, [["", "none"], ...controllerNames.map((name) => [name, name])], controllerNames[1] || "");
  byId("time-lead").append(`Of the first display (${displayText(run.results[0].display)}) and seed ${run.seeds[0]}. Every controller starts at the top; the first ${run.warm_up_frames} frames count in no figure.`);
  const draw = () => {
    hideTip();
    drawTime(byId("time-plot"), page.traces[Number(trace.value)], unique([controller.value, beside.value]));
  };
  for (const select of [trace, controller, beside]) select.addEventListener("change", draw);
  return draw;
}

function startTables() {
  byId("totals-table").append(makeTotalsTable().node);
  const table = makeTraceTable();
  const trace = byId("rows-trace");
  const controller = byId("rows-controller");
  const names = unique(page.traces.map((one) => one.name));
  options(trace, [["", "all"], ...names.map((name) => [name, name])], names[0]);
  options(controller, [["", "all"], ...controllerNames.map((name) => [name, name])], "");
  const filter = () => table.show((row) =>
    (trace.value === "" || row.trace === trace.value) && (controller.value === "" || row.controller === controller.value));
  for (const select of [trace, controller]) select.addEventListener("change", filter);
  filter();
  byId("rows-table").append(table.node);
}

function showFacts() {
  byId("lead").append(`${controllerNames.length} controllers over ${page.traces.length} loads on a simulated display with vertical synchronisation: what they drop and what they draw.`);
  const facts = [
    ["command", el("code", {}, page.command)],
    ["ladder", `${run.output[0]}×${run.output[1]}, scale ${run.min_scale} to ${run.max_scale} on each axis`],
    ["seeds", `${run.seeds.join(", ")}; figures are means over them`],
    ["dropped", "refreshes without a new frame, of one seed, over the feasible traces; frames that wait for the processor do not count"],
    ["pixels", "mean area drawn over that of an oracle that knows each frame's load and fits it into one refresh"],
    ["settles", "frames until the area stays within 5 % of its final mean after a step of the load that lowers or raises it"],
    ["development, held-out", "the constants of the predictive controller were searched on the first list alone"],
    ["stand-ins", "controllers with -like in their name are written from public descriptions and are not the products"],
  ];
  byId("facts").append(...facts.flatMap(([term, text]) => [el("dt", {}, term), el("dd", {}, text)]));
}

showFacts();
startTables();
const drawAll = startTime();
let drawnWidth = 0;
new ResizeObserver(() => {
  if (document.body.clientWidth === drawnWidth) return;
  drawnWidth = document.body.clientWidth;
  // Later: drawing changes the height, and an observer must not resize what it observes.
  requestAnimationFrame(drawAll);
}).observe(document.body);
