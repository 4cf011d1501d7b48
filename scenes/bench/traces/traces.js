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
  return makeTable("totals-table", [
    textColumn("traces", (row) => row.traces), textColumn("display", (row) => displayText(row.display)),
    textColumn("controller", (row) => row.controller), ...kScoreColumns,
    numberColumn("dropped per 1,000", (row) => row.dropped_per_thousand, null, -1),
  ], run.results, listAndDisplay);
}

function makeTraceTable() {
  const rows = run.results.flatMap((result) =>
    result.rows.map((row) => ({ ...row, traces: result.traces, display: result.display, controller: result.controller })));
  return makeTable("rows-table", [
    textColumn("traces", (row) => row.traces), textColumn("display", (row) => displayText(row.display)),
    textColumn("trace", (row) => row.trace), textColumn("kind", (row) => row.kind),
    textColumn("controller", (row) => row.controller), ...kScoreColumns,
    numberColumn("dropped for the processor", (row) => row.cpu_dropped),
  ], rows, (row) => `${listAndDisplay(row)}|${row.trace}`);
}

// Curves are [frame, value, frame, value, ...]: a value holds until the next.
function stepsOf(curve) {
  const points = [];
  for (let i = 0; i < curve.length; i += 2) points.push({ x: curve[i], y: curve[i + 1] });
  return points;
}

// Three panels over one axis of time: loads, resolutions, and a row of dropped refreshes for each controller.
function drawTime(host, trace, names) {
  const chosen = names.map((name) => ({
    name, curve: trace.curves[controllerNames.indexOf(name)], colour: colourOf(controllerNames.indexOf(name)) }));
  const line = (label, curve, axis, colour, dashed = false) => {
    const points = stepsOf(curve);
    return { label, yAxisID: axis, borderColor: colour, borderWidth: 1.4, borderDash: dashed ? [4, 3] : [], stepped: "before",
      pointRadius: 0, pointHitRadius: 0, showLine: true, data: [...points, { x: page.frames, y: points.at(-1).y }] };
  };
  const drops = chosen.map(({ name, curve, colour }, row) => {
    const data = stepsOf(curve.dropped);
    return { label: `drops of ${name}`, yAxisID: "drops", data: data.map(({ x }) => ({ x, y: row })), pointStyle: "line",
      rotation: 90, pointRadius: 8, pointBorderWidth: 3, pointHoverBorderWidth: 3, pointHitRadius: 4, borderColor: colour,
      explain: (i) => `${name}: ${data[i].y} dropped at ${(data[i].x / page.refresh_hz).toFixed(2)} s` };
  });
  const counts = chosen.map(({ curve }) =>
    stepsOf(curve.dropped).filter(({ x }) => x >= run.warm_up_frames).reduce((sum, { y }) => sum + y, 0));
  const panel = (stackWeight, title, more) => ({ axis: "y", position: "left", stack: "panels", stackWeight, offset: true, min: 0, title: titled(title, "center"), ...more });
  draw(host, `${trace.name}: load, resolution and dropped frames over time`, {
    type: "scatter",
    data: { datasets: [
      line("load", trace.load, "load", css("--ink")), line("the processor's load", trace.cpu, "load", css("--quiet"), true),
      ...chosen.map(({ name, curve, colour }) => line(name, curve.area, "area", colour)),
      line("the oracle's resolution", trace.oracle, "area", css("--quiet"), true), ...drops,
    ] },
    options: {
      plugins: { legend: { labels: { filter: ({ text }) => !text.startsWith("drops of") } } },
      scales: {
        x: { min: 0, max: page.frames, ticks: { stepSize: 5 * page.refresh_hz, callback: (frame) => `${short(frame / page.refresh_hz)} s` } },
        drops: panel(1, "dropped", {
          min: -0.5, max: chosen.length - 0.5, reverse: true, afterBuildTicks: atTicks(() => chosen.map((_, row) => row)),
          ticks: { callback: (row) => `${chosen[row].name}: ${counts[row]}` }, grid: { display: false },
        }),
        area: panel(4, "part of the output's pixels", { max: 1.04, ticks: { includeBounds: false } }),
        load: panel(2, "load, targets", { grace: "8%", suggestedMax: 1 }),
      },
    },
  });
}

function showTime() {
  const host = plot("time-plot", 560);
  const first = Math.max(0, page.traces.findIndex((one) => one.name.startsWith("step up")));
  const chosen = controls([
    ["Trace", "time-trace", page.traces.map((one, i) => [i, `${one.list}: ${one.name}`]), first],
    ["Controller", "time-controller", controllerNames, controllerNames[0]],
    ["beside", "time-beside", withAll(controllerNames, "none"), controllerNames[1] || ""],
  ], () => show());
  const show = () => {
    const [trace, ...names] = chosen.values();
    drawTime(host, page.traces[Number(trace)], unique(names).filter(Boolean));
  };
  section("time", "Over time", el("p", {},
    `Of the first display (${displayText(run.results[0].display)}) and seed ${run.seeds[0]}. The load is that of a frame at the output's resolution, in targets. Every controller starts at the top; the first ${run.warm_up_frames} frames count in no figure.`),
    chosen.node, host);
  keepDrawn(show);
}

function showRows() {
  const table = makeTraceTable();
  const names = unique(page.traces.map((one) => one.name));
  const filter = (trace, controller) => table.show((row) =>
    (trace === "" || row.trace === trace) && (controller === "" || row.controller === controller));
  const chosen = controls([
    ["Trace", "rows-trace", withAll(names), names[0]], ["Controller", "rows-controller", withAll(controllerNames), ""],
  ], filter);
  filter(...chosen.values());
  section("rows", "Each trace", chosen.node, table.node);
}

const kFacts = [
  ["command", el("code", {}, page.command)],
  ["ladder", `${run.output[0]}×${run.output[1]}, scale ${run.min_scale} to ${run.max_scale} on each axis`],
  ["seeds", `${run.seeds.join(", ")}; figures are means over them`],
  ["dropped", "refreshes without a new frame, of one seed, over the feasible traces; frames that wait for the processor do not count"],
  ["pixels", "mean area drawn over that of an oracle that knows each frame's load and fits it into one refresh"],
  ["settles", "frames until the area stays within 5 % of its final mean after a step of the load that lowers or raises it"],
  ["development, held-out", "the constants of the predictive controller were searched on the first list alone"],
  ["stand-ins", "controllers with -like in their name are written from public descriptions and are not the products"],
];

head("Resolution controllers",
  `${controllerNames.length} controllers over ${page.traces.length} loads on a simulated display with vertical synchronisation: what they drop and what they draw.`);
section("totals", "All traces",
  quiet("Over the feasible traces of a list. Choose a column's title to sort by it. Bold: the best of its list and display."),
  makeTotalsTable().node);
if (hasPlots) showTime();
showRows();
section("method", "How it was measured", terms("facts", kFacts));
