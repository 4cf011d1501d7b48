#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws docs/images/quality_budget.svg: expected error over the time a frame has, a line for each controller.

Usage: quincunx-bench --traces --quality --budgets 0.6,0.8,1,1.5,2.5 --out DIR
       scripts/quality_diagram.py DIR/quality.csv > docs/images/quality_budget.svg
Held-out traces; the strong machine on the left, the weak one on the right.
"""
import csv
import math
import sys

WIDTH, HEIGHT = 960, 432
PANEL_WIDTH, PANEL_HEIGHT = 330, 310
TOP, LEFT = 64, 60
LINES = (("oracle", "#1f2026", "6 3"), ("quality", "#c0392b", ""), ("quality, built-in front", "#e8a33d", ""),
         ("predictive, bilinear", "#9a9aa2", ""), ("predictive, quincunx:reprojected", "#2e8b57", ""),
         ("predictive, temporal:fast", "#4a7fc1", ""), ("predictive, temporal:balanced", "#8e5aa8", ""),
         ("predictive, temporal:quality", "#5bb5b0", ""))


def text(x, y, words, size=13, anchor="start", weight="normal", fill="#1f2026"):
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" '
            f'font-weight="{weight}" fill="{fill}">{words}</text>')


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return [row for row in csv.DictReader(file) if row["traces"] == "held-out"]


def panel(rows, machine, left, range_x, range_y):
    def place(budget, flip):
        x = math.log(budget / range_x[0]) / math.log(range_x[1] / range_x[0])
        y = (flip - range_y[0]) / (range_y[1] - range_y[0])
        return left + x * PANEL_WIDTH, TOP + (1 - y) * PANEL_HEIGHT

    shapes = [text(left, TOP - 14, f"{machine} machine", 15, weight="bold")]
    flip = math.ceil(range_y[0] * 100) / 100
    while flip <= range_y[1]:
        y = place(range_x[0], flip)[1]
        shapes.append(f'<line x1="{left}" y1="{y:.1f}" x2="{left + PANEL_WIDTH}" y2="{y:.1f}" stroke="#dedee3"/>')
        shapes.append(text(left - 6, y + 4, f"{flip:.2f}", 12, "end"))
        flip += 0.01
    for budget in sorted({float(row["budget"]) for row in rows}):
        shapes.append(text(place(budget, 0)[0], TOP + PANEL_HEIGHT + 18, f"{budget:g}", 12, "middle"))
    for name, colour, dashes in LINES:
        points = sorted((float(row["budget"]), float(row["flip"])) for row in rows
                        if row["machine"] == machine and row["controller"] == name)
        path = " ".join("{:.1f},{:.1f}".format(*place(*point)) for point in points)
        shapes.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2.2" '
                      f'stroke-dasharray="{dashes or "none"}"/>')
    shapes.append(text(left + PANEL_WIDTH / 2, TOP + PANEL_HEIGHT + 40, "time of a frame, of what it is written for", 12,
                       "middle"))
    return shapes


def main():
    rows = rows_of(sys.argv[1])
    drawn = [row for row in rows if row["controller"] in {name for name, _, _ in LINES}]
    budgets = [float(row["budget"]) for row in drawn]
    flips = [float(row["flip"]) for row in drawn]
    range_x = (min(budgets), max(budgets))
    range_y = (min(flips) - 0.002, min(max(flips), 0.1) + 0.002)
    shapes = [f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>']
    for index, machine in enumerate(("strong", "weak")):
        shapes += panel(drawn, machine, LEFT + index * (PANEL_WIDTH + 50), range_x, range_y)
    for index, (name, colour, dashes) in enumerate(LINES):
        y = TOP + 14 + index * 24
        x = LEFT + 2 * (PANEL_WIDTH + 50) - 34
        shapes.append(f'<line x1="{x}" y1="{y - 4}" x2="{x + 20}" y2="{y - 4}" stroke="{colour}" stroke-width="3" '
                      f'stroke-dasharray="{dashes or "none"}"/>')
        shapes.append(text(x + 26, y, name.replace("predictive, ", "")))
    shapes.append(text(12, 18, "expected FLIP, dropped frames included", 12))
    print(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
          f'font-family="DejaVu Sans, sans-serif">\n' + "\n".join(shapes) + "\n</svg>")


main()
