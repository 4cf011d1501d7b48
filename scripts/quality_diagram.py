#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws error over the time a frame has, a line for each controller, as SVG.

Expected errors, of traces: docs/images/quality_budget.svg
  quincunx-bench --traces --quality --budgets 0.6,0.8,1,1.5,2.5 --out DIR
  scripts/quality_diagram.py DIR/quality.csv > docs/images/quality_budget.svg
Errors of what quincunx-render showed: docs/images/quality_shown.svg
  scripts/quality_proof.py DIR
  scripts/quality_diagram.py DIR/quality.csv > docs/images/quality_shown.svg
Of traces, the held-out ones count. A panel is a machine or a scene.
"""
import csv
import math
import sys

WIDTH = 960
PANEL_WIDTH, PANEL_HEIGHT = 330, 310
ROW_HEIGHT = PANEL_HEIGHT + 90
TOP, LEFT = 64, 60
LINES = (("oracle", "#1f2026", "6 3"), ("quality", "#c0392b", ""), ("quality, built-in front", "#e8a33d", ""),
         ("predictive, bilinear", "#9a9aa2", ""), ("predictive, quincunx:reprojected", "#2e8b57", ""),
         ("predictive, temporal:fast", "#4a7fc1", ""), ("predictive, temporal:balanced", "#8e5aa8", ""),
         ("predictive, temporal:quality", "#5bb5b0", ""), ("fixed scale 1", "#1f2026", "2 3"))


def text(x, y, words, size=13, anchor="start", weight="normal", fill="#1f2026"):
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" '
            f'font-weight="{weight}" fill="{fill}">{words}</text>')


def rows_of(path):
    known = {name for name, _, _ in LINES}
    with open(path, newline="", encoding="utf-8") as file:
        return [row for row in csv.DictReader(file)
                if row["traces"] in ("held-out", "renderer") and row["controller"] in known]


def ticks(range_y):
    step = next(step for step in (0.005, 0.01, 0.02, 0.05, 0.1, 0.2) if range_y[1] - range_y[0] <= 9 * step)
    return [step * i for i in range(math.ceil(range_y[0] / step), math.floor(range_y[1] / step) + 1)]


def panel(rows, left, top, range_x, range_y):
    def place(budget, flip):
        x = math.log(budget / range_x[0]) / math.log(range_x[1] / range_x[0])
        y = (flip - range_y[0]) / (range_y[1] - range_y[0])
        return left + x * PANEL_WIDTH, top + (1 - y) * PANEL_HEIGHT

    of_traces = rows[0]["traces"] != "renderer"
    title = rows[0]["machine"] + (" machine" if of_traces else "")
    shapes = [text(left, top - 14, title, 15, weight="bold")]
    for flip in ticks(range_y):
        y = place(range_x[0], flip)[1]
        shapes.append(f'<line x1="{left}" y1="{y:.1f}" x2="{left + PANEL_WIDTH}" y2="{y:.1f}" stroke="#dedee3"/>')
        shapes.append(text(left - 6, y + 4, f"{flip:.3g}", 12, "end"))
    for budget in sorted({float(row["budget"]) for row in rows}):
        shapes.append(text(place(budget, 0)[0], top + PANEL_HEIGHT + 18, f"{budget:.3g}", 12, "middle"))
    shapes.append(f'<svg x="{left}" y="{top}" width="{PANEL_WIDTH}" height="{PANEL_HEIGHT}" '
                  f'viewBox="{left} {top} {PANEL_WIDTH} {PANEL_HEIGHT}">')  # cuts off what lies higher
    for name, colour, dashes in LINES:
        points = sorted((float(row["budget"]), float(row["flip"])) for row in rows if row["controller"] == name)
        path = " ".join("{:.1f},{:.1f}".format(*place(*point)) for point in points)
        shapes.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2.2" '
                      f'stroke-dasharray="{dashes or "none"}"/>')
    shapes.append("</svg>")
    words = "time of a frame, of what it is written for" if of_traces else "time of a frame, ms"
    shapes.append(text(left + PANEL_WIDTH / 2, top + PANEL_HEIGHT + 40, words, 12, "middle"))
    return shapes


def ranges(rows):
    budgets = [float(row["budget"]) for row in rows]
    least = min(float(row["flip"]) for row in rows)
    most = min(max(float(row["flip"]) for row in rows), 2.2 * least)
    margin = 0.04 * (most - least)
    return (min(budgets), max(budgets)), (least - margin, most + margin)


def main():
    rows = rows_of(sys.argv[1])
    machines = list(dict.fromkeys(row["machine"] for row in rows))
    drawn = {row["controller"] for row in rows}
    height = TOP + ROW_HEIGHT * math.ceil(len(machines) / 2)
    shapes = [f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>']
    for index, machine in enumerate(machines):
        own = [row for row in rows if row["machine"] == machine]
        # Machines err alike and are compared; scenes do not.
        range_x, range_y = ranges(rows if rows[0]["traces"] != "renderer" else own)
        shapes += panel(own, LEFT + index % 2 * (PANEL_WIDTH + 50), TOP + index // 2 * ROW_HEIGHT, range_x, range_y)
    for index, (name, colour, dashes) in enumerate(line for line in LINES if line[0] in drawn):
        y = TOP + 14 + index * 24
        x = LEFT + 2 * (PANEL_WIDTH + 50) - 34
        shapes.append(f'<line x1="{x}" y1="{y - 4}" x2="{x + 20}" y2="{y - 4}" stroke="{colour}" stroke-width="3" '
                      f'stroke-dasharray="{dashes or "none"}"/>')
        shapes.append(text(x + 26, y, name.replace("predictive, ", "")))
    words = "FLIP of what was shown" if rows[0]["traces"] == "renderer" else "expected FLIP"
    shapes.append(text(12, 18, f"{words}, dropped frames included", 12))
    print(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" '
          f'font-family="DejaVu Sans, sans-serif">\n' + "\n".join(shapes) + "\n</svg>")


main()
