// SPDX-License-Identifier: MIT
// Tables that sort by any column.

// columns: {title, value(row) to sort by, text(row) to show, number, best: -1 less is better, 1 more is better}
// group(row): rows among which the best value is marked.
function makeTable(columns, rows, group) {
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
    heads.forEach((head, i) => {
      if (i === index) head.setAttribute("aria-sort", direction > 0 ? "ascending" : "descending");
      else head.removeAttribute("aria-sort");
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
    node: el("div", { class: "table", tabindex: 0, role: "region", "aria-label": "Table" }, table),
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

const textColumn = (title, value, long = false) => ({ title, value, long });
const numberColumn = (title, value, text, best = 0) => ({
  title, value, number: true, best, text: text || ((row) => number(value(row))),
});
