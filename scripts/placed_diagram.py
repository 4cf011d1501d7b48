#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws docs/images/placed_targets.svg: where two frames lie with viewport targets and with placed ones.

Usage: scripts/placed_diagram.py > docs/images/placed_targets.svg
Areas are to scale: the planes of 1280x720 targets, frame n at 0.5 and frame n + 1 at 0.7.
"""

LARGEST = (1280, 720)
# Name, bytes a texel, fill.
PLANES = (("colour", 8, "#e8a33d"), ("depth", 4, "#78cd8c"), ("velocity", 4, "#6fa8dc"), ("reactive", 1, "#c58bd6"))
FRAMES = (("frame n", 640, 360), ("frame n + 1", 896, 504))
WIDTH, HEIGHT = 920, 462
UNUSED = "#d9d9de"


def text(x, y, words, size=14, anchor="start", weight="normal"):
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" '
            f'font-weight="{weight}" fill="#1f2026">{words}</text>')


def box(x, y, width, height, fill):
    return (f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" fill="{fill}" '
            'stroke="#55565e" stroke-width="1"/>')


def viewport_frame(x, y, width, height):
    """The four targets beside each other; a part of each is in use."""
    shapes = []
    for name, texel, fill in PLANES:
        scale = 0.062 * texel ** 0.5
        w, h = LARGEST[0] * scale, LARGEST[1] * scale
        shapes += [box(x, y, w, h, UNUSED), box(x, y, width * scale, height * scale, fill),
                   text(x, y + h + 15, name, 12)]
        x += w + 14
    return shapes


def placed_memory(x, y, length, height):
    """One allocation: a half for each frame, and in it a region for each plane."""
    shapes = []
    total = sum(texel for _, texel, _ in PLANES)
    for frame, (name, w, h) in enumerate(FRAMES):
        part = w * h / (LARGEST[0] * LARGEST[1])
        left = x + frame * length / 2
        shapes.append(text(left, y + height + 18, f"{name}: {w}×{h}", 13))
        for _, texel, fill in PLANES:
            region = length / 2 * texel / total
            shapes += [box(left, y, region, height, UNUSED), box(left, y, region * part, height, fill)]
            left += region
    middle = x + length / 2
    shapes.append(f'<line x1="{middle:.1f}" y1="{y - 8}" x2="{middle:.1f}" y2="{y + height + 8}" stroke="#1f2026" '
                  'stroke-width="2.5"/>')
    return shapes


def main():
    shapes = [f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
              text(24, 30, "--targets viewport: a part of large targets", 16, weight="bold")]
    y = 48
    for name, w, h in FRAMES:
        shapes += [text(24, y + 70, f"{name}: {w}×{h}", 13), *viewport_frame(196, y, w, h)]
        y += 160
    shapes += [text(24, 388, "--targets placed: one allocation, a half for each of two frames, images of just "
                             "the viewport's size", 16, weight="bold"),
               *placed_memory(24, 404, WIDTH - 48, 28)]
    print(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
          f'font-family="DejaVu Sans, sans-serif">')
    print("\n".join(shapes))
    print("</svg>")


if __name__ == "__main__":
    main()
