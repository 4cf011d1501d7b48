// SPDX-License-Identifier: MIT
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
      scale, rows, parts: kParts.map(([part]) => of(part)),
      whole: of("frame"), low: of("frame", "low"), high: of("frame", "high"),
    };
  });
}

function explainFrame(step, clock) {
  const what = clock === "" ? "ms on the wall" : "ms of processor time";
  const lines = [`scale ${step.scale}: ${number(step.whole)} ${what}`];
  kParts.forEach(([, label], i) => lines.push(`${label}: ${number(step.parts[i])}`));
  lines.push(`whole: ${number(step.low)} to ${number(step.high)} (95 %)`);
  return lines.join("\n");
}

function legendOfParts(width) {
  const nodes = [];
  let x = 4;
  let y = 14;
  for (const [part, label] of kParts) {
    const wide = label.length * 6.6 + 30;
    if (x + wide > width && x > 4) { x = 4; y += 18; }
    nodes.push(svg("rect", { x, y: y - 10, width: 12, height: 12, rx: 2, fill: `var(--${part})` }), svg("text", { x: x + 17, y }, label));
    x += wide;
  }
  return { nodes, height: y + 14 };
}

function drawFrames(host, scene, clock) {
  const steps = frameSteps(scene, clock);
  const width = Math.max(host.clientWidth, 280);
  const legend = legendOfParts(width);
  const height = 330 + legend.height;
  const area = { left: 46, right: width - 8, top: legend.height + 22, bottom: height - 44 };
  const most = Math.max(...steps.map((step) => Math.max(step.whole, step.high, step.parts.reduce((a, b) => a + b))));
  const y = (ms) => area.bottom - (ms / most) * (area.bottom - area.top);
  const band = (area.right - area.left) / steps.length;
  const bar = Math.min(84, band * 0.66);
  const chart = svg("svg", { viewBox: `0 0 ${width} ${height}`, height, role: "group", "aria-label": "Frame time over scale" });
  chart.append(...legend.nodes);
  for (const tick of linearTicks(0, most, 5)) {
    chart.append(svg("path", { class: "grid", d: `M${area.left},${y(tick)}H${area.right}` }),
      svg("text", { class: "tick", x: area.left - 6, y: y(tick) + 4, "text-anchor": "end" }, String(Number(tick.toPrecision(4)))));
  }
  steps.forEach((step, i) => {
    const centre = area.left + band * (i + 0.5);
    const group = svg("g", { class: "part", ...explains(explainFrame(step, clock)) });
    let base = 0;
    kParts.forEach(([part], k) => {
      group.append(svg("rect", {
        x: centre - bar / 2, width: bar, y: y(base + step.parts[k]), height: Math.max(0.5, y(base) - y(base + step.parts[k])), fill: `var(--${part})`,
      }));
      base += step.parts[k];
    });
    group.append(svg("path", { class: "front", d: `M${centre},${y(step.low)}V${y(step.high)}` }),
      svg("text", { x: centre, y: y(Math.max(base, step.high)) - 6, "text-anchor": "middle" }, number(step.whole)));
    const render = scene === "" || !step.rows[0] ? step.rows[0].render : step.rows[0].render;
    chart.append(group, svg("text", { class: "tick", x: centre, y: area.bottom + 17, "text-anchor": "middle" }, String(step.scale)));
    if (band > 64) chart.append(svg("text", { class: "tick", x: centre, y: area.bottom + 33, "text-anchor": "middle" }, `${render.width}×${render.height}`));
  });
  chart.append(svg("text", { class: "axis", x: 4, y: area.top - 10 }, "ms a frame"));
  host.replaceChildren(chart);
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
  const width = Math.max(host.clientWidth, 280);
  const left = 84;
  const line = 34;
  const height = rows.length * line + 48;
  const most = Math.max(1, ...rows.flatMap((row) => [row.wall, row.processor])) * 1.02;
  const x = (ratio) => left + (ratio / most) * (width - left - 46);
  const chart = svg("svg", { viewBox: `0 0 ${width} ${height}`, height, role: "group", "aria-label": "Frame time ratio" });
  chart.append(svg("rect", { x: left, y: 4, width: 12, height: 12, rx: 2, fill: "var(--c0)" }), svg("text", { x: left + 17, y: 14 }, "time on the wall"),
    svg("rect", { x: left + 136, y: 4, width: 12, height: 12, rx: 2, fill: "var(--c4)" }), svg("text", { x: left + 153, y: 14 }, "processor time"));
  const area = headlineScale * headlineScale;
  for (const [value, label] of [[0, "0"], [area, `${Math.round(100 * area)} % pixels`], [1, "1"]]) {
    chart.append(svg("path", { class: "grid", d: `M${x(value)},26V${height - 22}`, "stroke-dasharray": value === area ? "4 3" : null }),
      svg("text", { class: "tick", x: x(value), y: height - 6, "text-anchor": "middle" }, label));
  }
  rows.forEach((row, i) => {
    const top = 28 + i * line;
    const bars = svg("g", { class: "part", ...explains(`${row.name}: ${(100 * row.wall).toFixed(0)} % of the time on the wall, ${(100 * row.processor).toFixed(0)} % of the processor time (drawing alone: ${(100 * row.draw).toFixed(0)} %)`) });
    [["wall", "--c0"], ["processor", "--c4"]].forEach(([field, colour], k) => {
      bars.append(svg("rect", { x: x(0), y: top + k * 14, width: x(row[field]) - x(0), height: 12, fill: `var(${colour})` }),
        svg("text", { class: "tick", x: x(row[field]) + 5, y: top + k * 14 + 10 }, `${(100 * row[field]).toFixed(0)} %`));
    });
    chart.append(bars, svg("text", { x: left - 8, y: top + 17, "text-anchor": "end", "font-weight": row.name === "mean" ? 600 : 400 }, row.name));
  });
  host.replaceChildren(chart);
}
