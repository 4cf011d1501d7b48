// SPDX-License-Identifier: MIT
// The parts that all pages share: elements, sections, tables that sort, and plots by Chart.js. Loaded first.
"use strict";

const page = JSON.parse(document.getElementById("data").textContent);
const hasPlots = typeof Chart !== "undefined";

const byId = (id) => document.getElementById(id);
const unique = (values) => [...new Set(values)];
const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;

// Returns an element; attributes that are null are left out, those named "on…" are listeners, and so are children.
function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (value !== null && value !== undefined) node.setAttribute(name, value);
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

// Returns 3 significant digits without an exponent; "∞" where a picture equals the truth.
function number(value, digits = 3) {
  if (value === null || value === undefined) return "–";
  if (!Number.isFinite(value)) return "∞";
  if (value === 0) return "0";
  const magnitude = Math.floor(Math.log10(Math.abs(value)));
  if (magnitude < -5) return value.toExponential(1);
  return value.toFixed(Math.max(0, digits - 1 - magnitude));
}

// Fills the head of the page; `lead` are texts and nodes.
function head(title, ...lead) {
  byId("title").append(title);
  byId("lead").append(...lead);
  if (hasPlots) return;
  const words = "This page has tables only, because Debian's package libjs-chart.js was not there when it was made.";
  byId("lead").after(el("p", { id: "no-plots", class: "quiet" }, words));
}

// Adds a section and a link to it.
function section(id, title, ...children) {
  const heading = el("h2", { id: `${id}-title` }, title);
  document.querySelector("nav").append(el("a", { href: `#${id}` }, title));
  document.querySelector("main").append(el("section", { id, "aria-labelledby": `${id}-title` }, heading, ...children));
}

const quiet = (...children) => el("p", { class: "quiet" }, ...children);
const terms = (id, entries) =>
  el("dl", { id }, ...entries.flatMap(([term, text]) => [el("dt", {}, term), el("dd", {}, text)]));

// Returns a row of selects, [label, id, entries, chosen] each, where an entry is a value or [value, text]; `changed` is
// called with all values when one changes.
function controls(selects, changed) {
  const nodes = selects.map(([, id, entries, chosen]) => fillSelect(el("select", { id }), entries, chosen));
  const values = () => nodes.map((node) => node.value);
  for (const node of nodes) node.addEventListener("change", () => changed(...values()));
  const labels = selects.map(([label], i) => el("label", {}, `${label} `, nodes[i]));
  return { node: el("div", { class: "controls" }, ...labels), nodes, values };
}

function fillSelect(select, entries, chosen) {
  for (const entry of entries) {
    const [value, text] = Array.isArray(entry) ? entry : [entry, entry];
    select.append(el("option", { value, selected: String(value) === String(chosen) ? "" : null }, String(text)));
  }
  return select;
}
const withAll = (values, all = "all") => [["", all], ...values];

// Tables.

const textColumn = (title, value, long = false) => ({ title, value, long });
const numberColumn = (title, value, text, best = 0) => ({
  title, value, number: true, best, text: text || ((row) => number(value(row))),
});

// columns: {title, value(row) to sort by, text(row) to show, number, best: -1 less is better, 1 more is better}
// group(row): rows among which the best value is marked.
function makeTable(id, columns, rows, group) {
  const body = el("tbody");
  const heads = columns.map((column, i) => {
    const button = el("button", { type: "button", onclick: () => sortBy(i) }, column.title);
    return el("th", { class: column.number ? "number" : "", scope: "col" }, button);
  });
  const best = bestValues(columns, rows, group);
  const lines = rows.map((row) => ({ row, node: lineOf(columns, row, group, best) }));
  let sorted = -1;
  let direction = 1;

  function sortBy(index) {
    const column = columns[index];
    direction = sorted === index ? -direction : column.best === 1 ? -1 : 1;
    sorted = index;
    heads.forEach((cell, i) => {
      if (i === index) cell.setAttribute("aria-sort", direction > 0 ? "ascending" : "descending");
      else cell.removeAttribute("aria-sort");
    });
    const missing = (value) => value === null || value === undefined;
    lines.sort((a, b) => {
      const x = column.value(a.row);
      const y = column.value(b.row);
      if (missing(x) || missing(y)) return missing(x) - missing(y);
      return direction * (typeof x === "string" ? x.localeCompare(y) : x - y);
    });
    body.replaceChildren(...lines.map((line) => line.node));
  }

  body.append(...lines.map((line) => line.node));
  const table = el("table", {}, el("thead", {}, el("tr", {}, ...heads)), body);
  return {
    node: el("div", { id, class: "table", tabindex: 0, role: "region", "aria-label": "Table" }, table),
    show: (wanted) => lines.forEach((line) => { line.node.hidden = !wanted(line.row); }),
  };
}

function bestValues(columns, rows, group) {
  const best = new Map();
  if (!group) return best;
  for (const row of rows) {
    columns.forEach((column, i) => {
      const value = column.value(row);
      if (!column.best || value === null || value === undefined) return;
      const key = `${group(row)}|${i}`;
      if (!best.has(key) || column.best * (value - best.get(key)) > 0) best.set(key, value);
    });
  }
  return best;
}

function lineOf(columns, row, group, best) {
  return el("tr", {}, ...columns.map((column, i) => {
    const kinds = [column.number ? "number" : column.long ? "text" : ""];
    if (column.best && best.get(`${group && group(row)}|${i}`) === column.value(row)) kinds.push("best");
    return el("td", { class: kinds.join(" ").trim() }, column.text ? column.text(row) : String(column.value(row)));
  }));
}

// Plots. A canvas has no styles, so that plots are drawn again when the scheme of colours changes.

const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const colourOf = (index) => css(`--c${index % 8}`);
const plot = (id, height) => el("div", { id, class: "plot", hidden: hasPlots ? null : "", style: `height:${height}px` });
const short = (value) => String(Number(value.toPrecision(4)));
const atTicks = (values) => (scale) => { scale.ticks = values(scale).map((value) => ({ value })); };
const titled = (text, align = "end") => ({ display: true, text, align });

const drawings = [];
function keepDrawn(draw) {
  if (!hasPlots) return;
  drawings.push(draw);
  draw();
}

function setColours() {
  const { defaults } = Chart;
  defaults.animation = false;
  defaults.maintainAspectRatio = false;
  defaults.color = css("--quiet");
  defaults.borderColor = css("--line");
  defaults.font.family = getComputedStyle(document.body).fontFamily;
  defaults.elements.line.borderWidth = 1.5;
  Object.assign(defaults.plugins.legend, { align: "start" });
  Object.assign(defaults.plugins.legend.labels, { boxWidth: 12, boxHeight: 12, color: css("--ink") });
  Object.assign(defaults.plugins.tooltip, {
    displayColors: false, backgroundColor: css("--ink"), bodyColor: css("--paper"), padding: 9,
    filter: (item) => Boolean(item.dataset.explain),
  });
  const { scatter } = Chart.overrides;  // which has words of its own
  for (const callbacks of [defaults.plugins.tooltip.callbacks, scatter.plugins.tooltip.callbacks])
    Object.assign(callbacks, { title: () => [], label: ({ dataset, dataIndex }) => dataset.explain(dataIndex).split("\n") });
  scatter.interaction.mode = "nearest";
}

// Draws a chart into `host` in place of the one before. `config` is one of Chart.js, whose datasets may have
// explain(index), the words that mouse and arrow keys show; `label` says what the chart shows, and overlay(context,
// scales, area) draws what Chart.js has no element for.
function draw(host, label, config, overlay = () => {}) {
  const old = host.querySelector("canvas");
  if (old) Chart.getChart(old).destroy();
  const keys = { ArrowLeft: -1, ArrowRight: 1 };
  const canvas = el("canvas", { tabindex: 0, role: "img", "aria-label": label, onkeydown: (event) => {
    if (keys[event.key]) walk(chart, keys[event.key]);
  } });
  host.replaceChildren(canvas);
  const plugins = [{ id: "overlay", afterDatasetsDraw: ({ ctx, scales, chartArea }) => overlay(ctx, scales, chartArea) }];
  const chart = new Chart(canvas, { ...config, plugins });
  return chart;
}

// Goes to the next explained point of a chart, as its tooltip and for those who hear the page.
function walk(chart, by) {
  const points = chart.data.datasets.flatMap((dataset, datasetIndex) =>
    (dataset.explain ? dataset.data.map((_, index) => ({ datasetIndex, index })) : []).filter(({ index }) =>
      dataset.data[index] !== null && [dataset.pointHitRadius].flat()[index] !== 0));
  if (points.length === 0) return;
  chart.at = ((chart.at ?? (by > 0 ? -1 : 0)) + by + points.length) % points.length;
  const { datasetIndex, index } = points[chart.at];
  const { x, y } = chart.getDatasetMeta(datasetIndex).data[index];
  chart.setActiveElements([points[chart.at]]);
  chart.tooltip.setActiveElements([points[chart.at]], { x, y });
  chart.canvas.setAttribute("aria-label", chart.data.datasets[datasetIndex].explain(index));
  chart.render();
}

// For overlays, in pixels.
function write(context, words, x, y, { align = "left", bold = false, colour = css("--ink") } = {}) {
  context.font = `${bold ? 600 : 400} 12px ${Chart.defaults.font.family}`;
  context.textAlign = align;
  context.textBaseline = "middle";
  context.lineWidth = 3;
  context.strokeStyle = css("--paper");
  context.strokeText(words, x, y);
  context.fillStyle = colour;
  context.fillText(words, x, y);
}
function rule(context, x0, y0, x1, y1, width = 1.5) {
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.lineWidth = width;
  context.strokeStyle = css("--front");
  context.stroke();
}

if (hasPlots) {
  setColours();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    setColours();
    drawings.forEach((again) => again());
  });
}
