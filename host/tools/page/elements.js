// SPDX-License-Identifier: MIT
// Holds the parts that the scripts of every page share; loaded first.
"use strict";

const page = JSON.parse(document.getElementById("data").textContent);
const kColours = 8;

const byId = (id) => document.getElementById(id);
const unique = (values) => [...new Set(values)];

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

const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
const colourOf = (index) => `var(--c${index % kColours})`;

function options(select, entries, chosen) {
  for (const [value, text] of entries) {
    select.append(el("option", { value, selected: String(value) === String(chosen) ? "" : null }, String(text)));
  }
}

function linearTicks(low, high, count) {
  const raw = (high - low) / count;
  const power = Math.pow(10, Math.floor(Math.log10(raw)));
  const step = [1, 2, 5, 10].map((s) => s * power).find((s) => s >= raw);
  const ticks = [];
  for (let tick = Math.ceil(low / step); tick <= Math.floor(high / step + 1e-9); ++tick) ticks.push(tick * step);
  return ticks;
}

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
