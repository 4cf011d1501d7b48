// SPDX-License-Identifier: MIT
// The figures of the page and what all parts use.
"use strict";

const page = JSON.parse(document.getElementById("data").textContent);
const result = page.result;
const kColours = 8;

const byId = (id) => document.getElementById(id);
const unique = (values) => [...new Set(values)];
const sceneNames = result.scenes.map((scene) => scene.name);
const scales = unique(result.rows.map((row) => row.scale)).sort((a, b) => a - b);
const methodNames = result.methods.map((method) => method.name);
// The scale that the findings speak of.
const headlineScale = scales.reduce((best, s) => (Math.abs(s - 0.7) < Math.abs(best - 0.7) ? s : best), scales[0]);

function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (value !== null && value !== undefined) node.setAttribute(name, value);
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}
const el = (tag, attributes = {}, ...children) => fill(document.createElement(tag), attributes, children);
const svg = (tag, attributes = {}, ...children) =>
  fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);

// 3 significant digits without an exponent; "∞" where a picture equals the truth.
function number(value, digits = 3) {
  if (value === null || value === undefined) return "–";
  if (!Number.isFinite(value)) return "∞";
  if (value === 0) return "0";
  const magnitude = Math.floor(Math.log10(Math.abs(value)));
  if (magnitude < -5) return value.toExponential(1);
  return value.toFixed(Math.max(0, digits - 1 - magnitude));
}
const megabytes = (bytes) => number(bytes / 1e6) + " MB";
const plusMinus = (spread) => {
  const half = spread.median > 0 ? (50 * (spread.high - spread.low)) / spread.median : 0;
  return "±" + (half < 10 ? half.toFixed(1) : half.toFixed(0)) + " %";
};

const measureNamed = (name) => page.measures.find((measure) => measure.name === name);
const isDecibels = (name) => name.startsWith("psnr");
// Of a row's quality; null only where there is none, an infinite ratio is Infinity.
function errorOf(row, name) {
  const value = row.quality[name];
  return value === null && isDecibels(name) ? Infinity : value;
}

const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;

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

const colourOf = (index) => `var(--c${index % kColours})`;

function options(select, entries, chosen) {
  for (const [value, text] of entries) {
    select.append(el("option", { value, selected: String(value) === String(chosen) ? "" : null }, String(text)));
  }
}
const sceneEntries = (all) => (sceneNames.length > 1 ? [["", all]] : []).concat(sceneNames.map((name) => [name, name]));
const firstScene = sceneNames.length > 1 ? "" : sceneNames[0];

const tip = byId("tip");
function showTip(text, target) {
  tip.textContent = text;
  tip.hidden = false;
  const box = target.getBoundingClientRect();
  const left = Math.min(box.right + 10, document.documentElement.clientWidth - tip.offsetWidth - 8);
  const above = box.top - tip.offsetHeight - 8;
  tip.style.left = `${Math.max(8, left) + window.scrollX}px`;
  tip.style.top = `${(above > 0 ? above : box.bottom + 8) + window.scrollY}px`;
}
const hideTip = () => { tip.hidden = true; };
// The attributes of a node that explains itself to mouse and keyboard.
const explains = (text) => ({
  tabindex: 0, role: "img", "aria-label": text,
  onmouseenter: (event) => showTip(text, event.currentTarget), onmouseleave: hideTip,
  onfocus: (event) => showTip(text, event.currentTarget), onblur: hideTip,
});
document.addEventListener("keydown", (event) => { if (event.key === "Escape") hideTip(); });
