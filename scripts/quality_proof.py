#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs quincunx-render at a few frame rates with each controller and says how wrong the pictures are that it showed.

Usage: scripts/quality_proof.py OUT [--scenes A,B] [--budgets B,B] [--methods M,M] [--output WxH] [--frames N]
Writes OUT/quality.csv, which scripts/quality_diagram.py draws, and OUT/quality.md, its table. Runs that are in OUT
already are not run again.

A budget of 1 is the time that a frame at scale 1 takes, drawn and shown as it is: the median of a run without a target.
Every run draws the same moments of a scene. Its error is the mean FLIP against supersampled truth over the display's
refreshes: a frame that is shown again is compared with the truth of that refresh's time. The first frames do not
count, while all controllers come down from the highest scale. Controllers:
  quality                  scale and method, by a front measured on this machine for the scene at that rate (--calibrate)
  quality, built-in front  the same without that measurement
  predictive, METHOD       scale alone
  fixed scale 1            nothing: what is drawn is shown
"""
import argparse
import csv
import json
import os
import pathlib
import subprocess

RENDER = "build/release/bin/quincunx-render"
FIRST = 12  # frame that counts first


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--scenes", default="courtyard,flight,cables,particles")
    parser.add_argument("--budgets", default="0.7,1.2,2.5", help="times what a frame at scale 1 takes")
    parser.add_argument("--methods", default="bilinear,quincunx:reprojected,temporal:fast,temporal:balanced,"
                                             "temporal:quality")
    parser.add_argument("--output", default="320x180")
    parser.add_argument("--frames", type=int, default=48)
    return parser.parse_args()


def cache(args, name):
    return {**os.environ, "QUINCUNX_CACHE_DIR": str((args.out / f"cache-{name}").resolve())}


def calibrate(args, scene, fps):
    costs = args.out / f"{scene}-{fps}-costs.json"
    if not costs.exists():
        command = [RENDER, "--scene", scene, "--output", args.output, "--fps", str(fps), "--calibrate", str(costs),
                   "--quiet"]
        subprocess.run(command, check=True, env=cache(args, f"{scene}-{fps}"), stdout=subprocess.DEVNULL)


PLAIN = ("fixed scale 1", ["--controller", "fixed", "--scale", "1", "--method", "bilinear"], "empty")


def controllers(scene, fps, methods):
    """Name, options and cache of each."""
    yield "quality", ["--controller", "quality"], f"{scene}-{fps}"
    yield "quality, built-in front", ["--controller", "quality"], "empty"
    for method in methods:
        jitter = ["--jitter", "halton"] if method.startswith("temporal") else []
        yield f"predictive, {method}", ["--controller", "predictive", "--method", method, *jitter], "empty"
    yield PLAIN


def run(args, scene, fps, name, options, cache_name):
    base = args.out / f"{scene}-{fps}-{name.replace(', ', '-').replace(' ', '_').replace(':', '_')}"
    report = base.with_name(base.name + ".json")
    if not report.exists():
        command = [RENDER, "--scene", scene, "--output", args.output, "--frames", str(args.frames), "--target-fps",
                   str(fps), "--score", "3", "--report", str(base), "--quiet", *options]
        subprocess.run(command, check=True, env=cache(args, cache_name), stdout=subprocess.DEVNULL)
    return json.loads(report.read_text(encoding="utf-8"))


def time_at_scale_1(args, scene):
    """Milliseconds."""
    return run(args, scene, 10, *PLAIN)["pacing"][0]["summary"]["median_busy_ms"]


def mean(values):
    return sum(values) / len(values)


def row_of(scene, fps, name, report):
    scores = [frame for frame in report["scores"]["frames"] if frame["index"] >= FIRST]
    shown = [flip for frame in scores for flip in (frame["flip"], *frame["repeated_flip"])]
    pacing = report["pacing"][0]
    frames = [frame for frame in pacing["frames"] if frame["index"] >= FIRST]
    output = report["output"][0] * report["output"][1]
    return {"traces": "renderer", "machine": scene, "budget": round(1000 / fps, 2), "controller": name,
            "flip": round(mean(shown), 5), "flip of frames": round(mean([frame["flip"] for frame in scores]), 5),
            "dropped": len(shown) - len(scores), "refreshes": len(shown),
            "area": round(mean([frame["render"][0] * frame["render"][1] for frame in frames]) / output, 3),
            "changes": len(pacing["method_changes"])}


def table(rows):
    names = list(dict.fromkeys(row["controller"] for row in rows))
    lines = ["| scene, frames a second | " + " | ".join(names) + " |", "|---" * (len(names) + 1) + "|"]
    for scene, budget in dict.fromkeys((row["machine"], row["budget"]) for row in rows):
        cells = {row["controller"]: row for row in rows if (row["machine"], row["budget"]) == (scene, budget)}
        least = min(cells.values(), key=lambda row: row["flip"])["controller"]
        values = []
        for name in names:
            value = f"{cells[name]['flip']:.4f} ({cells[name]['dropped']})"
            values.append(f"**{value}**" if name == least else value)
        lines.append(f"| {scene}, {1000 / budget:.0f} | " + " | ".join(values) + " |")
    means = [mean([row["flip"] for row in rows if row["controller"] == name]) for name in names]
    lines.append("| mean | " + " | ".join(f"{value:.4f}" for value in means) + " |")
    return "\n".join(lines) + "\n"


def main():
    args = arguments()
    args.out.mkdir(parents=True, exist_ok=True)
    rows = []
    for scene in args.scenes.split(","):
        whole = time_at_scale_1(args, scene)
        for fps in (round(1000 / (float(budget) * whole), 1) for budget in args.budgets.split(",")):
            calibrate(args, scene, fps)
            for name, options, cache_name in controllers(scene, fps, args.methods.split(",")):
                rows.append(row_of(scene, fps, name, run(args, scene, fps, name, options, cache_name)))
                print(*rows[-1].values(), sep="  ", flush=True)
    with open(args.out / "quality.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    (args.out / "quality.md").write_text(table(rows), encoding="utf-8")


main()
