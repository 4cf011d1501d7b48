#!/usr/bin/env python3
"""Measures what the constants and the rules of the temporal upscaler are worth.

  scripts/constants.py                    25 % less and more of each constant: docs/lab/constants.md
  scripts/constants.py --rules            each rule of RULES switched off alone: a table on standard output
  scripts/constants.py --only GAIN_MAX,CHANGE_RANGE --scenes still,wheel --out /dev/stdout

Needs a static build of quincunx-dump and quincunx-resolve (--build) in the Ninja generator. Scenes are drawn once, as
sequences with truth, and kept in --work. For each row the kernels are copied and edited there, embedded, and linked
into a quincunx-resolve of its own: the tree and its build stay as they are, and the library needs no switch for it. A
constant is replaced where it is used, so that only those kernels are compiled anew.

Figures are means over frames of FLIP and flicker, and what a row adds to them: in the scene that loses most, and in
the mean of all scenes.
"""
import argparse
import concurrent.futures
import datetime
import json
import os
import re
import shlex
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
HEADERS = ["temporal/constants.h", "layers/constants.h"]  # below kernels/include; those that are there
ALL_SCENES = ("chart pan wires wheel occluders particles flight still zoom cut sparkles shadows cables fence backdrop "
              "cutout faults courtyard").split()
FEW_SCENES = ["still", "shadows", "wheel", "wires"]
SCALE, OUTPUT, START, FRAMES, TRUTH = 0.5, "320x180", {"cut": 3.85}, 24, 2
SCORED = "8-23"  # frames
QUALITY = ["SHARPENING", "EDGE_SMOOTHING", "EDGE_SHARPENING", "EDGE_GRADIENT", "LONG_CUBIC"]  # preset quality alone

LIGHT, JUDGE = "temporal/temporal_light.cl", "include/temporal/judge_samples.h"
# Each rule: what stands in for which text of which kernel where it is off. White space counts as one blank.
RULES = {
    "relighting of 3x3 tiles": [(LIGHT, "const bool is_local = changes &&", "const bool is_local = false &&")],
    "… only where seven of ten samples agree": [
        (LIGHT, "change.is_agreed = around->brighter * change.direction > RELIGHT_MAJORITY_MIN * around->count;",
         "change.is_agreed = true;")],
    "… only away from motion edges": [
        (LIGHT, "return !around->has_motion_edge && change->is_agreed", "return change->is_agreed")],
    "… only after two frames": [
        (LIGHT, "tile.persistence * change.direction > PERSISTENCE_MIN", "tile.persistence > -2.0f")],
    "… changes of luma below .01 do not count": [
        (JUDGE, "where(change > LUMA_CHANGE_MIN, evidence.count) - where(change < -LUMA_CHANGE_MIN, evidence.count);",
         "where(change > 0.0f, evidence.count) - where(change < 0.0f, evidence.count);")],
    "broad gain": [(LIGHT, "return fabs(change) > GAIN_CHANGE_MIN ?", "return false ?")],
    "… only as far as tiles agree": [(LIGHT, "return fabs(mean) > fabs(usual) ? usual * usual / mean : mean;", "return mean;")],
    "… of which the judge is told": [(LIGHT, "const float explained = (broad - 1.0f) *", "const float explained = 0.0f *")],
    "a relit picture is no cut": [
        (LIGHT, "const bool relit = is_widespread && is_relit(total);", "const bool relit = false && is_relit(total);")],
    "rejection by cut": [
        (LIGHT, "const float by_cut = is_widespread && !relit ?", "const float by_cut = false && is_widespread && !relit ?")],
    "judging of cells": [(LIGHT, "if (!is_local && any(asked)) {", "if (false) {")],
    "… that change by more than they flicker": [
        (LIGHT, "(changed > FLICKER_RATIO_MIN * cells.flicker) &", "(changed > 0.0f) &")],
    "… that change at all": [
        (LIGHT, "& (max(changed, fabs(cells.drift)) > JUDGED_CHANGE_MIN);", ";")],
    "rigid tiles wait for a second frame": [
        (LIGHT, "const bool waits = way.is_rigid && around.confirmation < RIGID_TILE_CONFIRMATION_MAX;",
         "const bool waits = false;")],
    "… unless one was confirmed lately": [
        (LIGHT, "const bool waits = way.is_rigid && around.confirmation < RIGID_TILE_CONFIRMATION_MAX;",
         "const bool waits = way.is_rigid;")],
    "outliers are held back": [(LIGHT, "tile.holds_back = around.outliers > 0.0f &&", "tile.holds_back = false &&")],
    "… only the first of late": [(LIGHT, "around.recent_outliers < OUTLIER_REARM_MAX", "true")],
}


def constants(header):
    """Yields (name, value, unit and meaning) of each constant of a header."""
    with open(os.path.join(ROOT, "kernels/include", header), encoding="utf-8") as file:
        for line in file:
            found = re.match(r"#define (\w+) (-?[\d.][\w.]*(?:[ep][+-]?\d+f?)?)\s*//\s*(.*)", line)
            if found:
                yield found.groups()


def scaled(value, factor):
    """A literal of OpenCL C times a factor, as a literal."""
    text = value.strip("()").rstrip("f")
    if re.fullmatch(r"-?\d+", text):
        return str(round(int(text) * factor))
    number = float.fromhex(text) if "x" in text else float(text)
    return "(%rf)" % (number * factor)


def replaced(text, old, new):
    """`text` with `old` replaced, white space apart, or None where it is not there exactly once."""
    pattern = r"\s+".join(re.escape(word) for word in old.split())
    pattern = (r"\s+" if old[0] == " " else "") + pattern + (r"\s+" if old[-1] == " " else "")
    return re.sub(pattern, lambda _: new, text) if len(re.findall(pattern, text)) == 1 else None


class Programs:
    """quincunx-resolve with other kernels than its build has."""

    def __init__(self, build, work):
        self.build, self.work = os.path.abspath(build), os.path.abspath(work)
        self.compile = self.command("kernels/CMakeFiles/quincunx_kernels.dir/embedded_kernel_files.cpp.o")
        self.link = self.command("bin/quincunx-resolve")
        source = next(word for word in shlex.split(self.compile) if word.endswith("embedded_kernel_files.cpp"))
        self.object_source = source

    def command(self, target):
        shown = subprocess.run(["ninja", "-C", self.build, "-t", "commands", target], check=True, text=True,
                               capture_output=True).stdout
        return [line for line in shown.splitlines() if target.split("/")[-1] in line][-1]

    def make(self, name, edit):
        """Links the program after `edit(path, text)` of each kernel file. Returns its path."""
        folder = os.path.join(self.work, "programs", re.sub(r"\W+", "_", name))
        program = os.path.join(folder, "quincunx-resolve")
        shutil.rmtree(folder, ignore_errors=True)
        kernels = os.path.join(folder, "kernels")
        shutil.copytree(os.path.join(ROOT, "kernels"), kernels)
        files = []
        for place, _, names in os.walk(kernels):
            for path in (os.path.join(place, n) for n in sorted(names) if n.endswith((".cl", ".h"))):
                with open(path, encoding="utf-8") as file:
                    text = file.read()
                with open(path, "w", encoding="utf-8") as file:
                    file.write(edit(os.path.relpath(path, kernels), text))
                files.append(path)
        source, made = os.path.join(folder, "kernels.cpp"), os.path.join(folder, "kernels.o")
        subprocess.run(["cmake", "-D", "OUTPUT=" + source, "-D",
                        "FUNCTION=quincunx::embedded_kernel_files", "-D", "FILES=" + "|".join(files), "-D",
                        "ROOTS=%s/include|%s" % (kernels, kernels), "-P", os.path.join(ROOT, "cmake/embed.cmake")],
                       check=True)
        words = [word for word in shlex.split(self.compile) if word not in ("-O3", "-MD")]
        skip = {"-MT", "-MF", "-o"}
        words = [word for i, word in enumerate(words) if word not in skip and (i == 0 or words[i - 1] not in skip)]
        words = [source if word == self.object_source else word for word in words] + ["-O0", "-o", made]
        subprocess.run(words, cwd=self.build, check=True)
        # The object comes first, so that the linker does not take the library's.
        link = self.link.replace("-o bin/quincunx-resolve", "-o %s %s" % (shlex.quote(program), shlex.quote(made)))
        subprocess.run(link, shell=True, cwd=self.build, check=True)
        return program


def draw(build, work, scene, output=OUTPUT, scale=SCALE, frames=FRAMES, truth=TRUTH, name=None):
    """Draws a scene as a sequence with truth, unless it is there. Returns its folder, called `name` or as the scene."""
    folder = os.path.join(work, "sequences", name or scene)
    if not os.path.exists(os.path.join(folder, "done")):
        os.makedirs(folder, exist_ok=True)
        subprocess.run([os.path.join(build, "bin/quincunx-dump"), "--scene", scene, "--output", output, "--scale",
                        str(scale), "--jitter", "halton", "--start", str(START.get(scene, 1)), "--frames", str(frames),
                        "--truth", str(truth), "--sequence", folder + "/frame.%04d.exr", "-q"], check=True)
        open(os.path.join(folder, "done"), "w", encoding="utf-8").close()
    return folder


def score(program, folder, preset, work):
    """Returns (FLIP, flicker) of a sequence, and the device."""
    out = os.path.join(work, "out", os.path.basename(os.path.dirname(program)) + os.path.basename(folder) + preset)
    os.makedirs(out, exist_ok=True)
    shown = subprocess.run([program, folder + "/frame.%04d.exr", "--out", out + "/out.%04d.exr", "--method",
                            "temporal:" + preset, "--truth", folder + "/truth.%04d.exr", "--frames", SCORED, "--json",
                            "-q"], check=True, text=True, capture_output=True,
                           env=dict(os.environ, QUINCUNX_CACHE_DIR=os.path.join(work, "cache"))).stdout
    shutil.rmtree(out)
    report = json.loads(shown)
    mean = report["scores"]["mean"]
    return (mean["flip"], mean["flicker"]), "%s, %s" % (report["cl"]["driver"], report["cl"]["device"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(ROOT, "build/release"))
    parser.add_argument("--work", default=os.path.join(ROOT, "build/constants"))
    parser.add_argument("--rules", action="store_true", help="rules instead of constants")
    parser.add_argument("--scenes", help="default: %s; of rules: all" % ",".join(FEW_SCENES))
    parser.add_argument("--only", help="these constants, or rules that contain one of these words")
    parser.add_argument("--preset", default="balanced", help="of rules, and of constants that all presets have")
    parser.add_argument("--jobs", type=int, default=2, help="scenes at a time")
    parser.add_argument("--out", default=None)
    options = parser.parse_args()
    scenes = options.scenes.split(",") if options.scenes else ALL_SCENES if options.rules else FEW_SCENES
    programs = Programs(options.build, options.work)
    folders = [draw(options.build, options.work, scene) for scene in scenes]
    pool = concurrent.futures.ThreadPoolExecutor(options.jobs)
    device = []

    def scores(name, edit, preset):
        program = programs.make(name, edit)
        found = list(pool.map(lambda folder: score(program, folder, preset, options.work), folders))
        device[:] = [found[0][1]]
        shutil.rmtree(os.path.dirname(program))
        return [figures for figures, _ in found]

    bases = {}

    def added(name, edit, preset):
        """What a row adds to FLIP and flicker: of each (the largest magnitude, its scene, the mean)."""
        if preset not in bases:
            bases[preset] = scores("base_" + preset, lambda _, text: text, preset)
        now, result = scores(name, edit, preset), []
        for i in range(2):
            differences = [after[i] - before[i] for after, before in zip(now, bases[preset])]
            worst = max(range(len(scenes)), key=lambda s: abs(differences[s]))
            result.append((differences[worst], scenes[worst], sum(differences) / len(differences)))
        print(name, preset, *("%+.4f (%s)" % figure[:2] for figure in result), file=sys.stderr, flush=True)
        return result

    rows = []
    wanted = options.only.split(",") if options.only else None
    if options.rules:
        for name, edits in RULES.items():
            if wanted and not any(word in name for word in wanted):
                continue

            def edit(path, text, edits=edits):
                for file, old, new in edits:
                    if file == path:
                        text = replaced(text, old, new)
                        if text is None:
                            sys.exit("%s: not there once: %s" % (file, old))
                return text

            (flip, where, flip_mean), (flicker, also, flicker_mean) = added(name, edit, options.preset)
            rows.append("| %s | %+.4f (%s) | %+.4f | %+.4f (%s) | %+.4f |" % (
                name, flip, where, flip_mean, flicker, also, flicker_mean))
        head = ["| off | FLIP, most | FLIP, mean | flicker, most | flicker, mean |", "|---|---|---|---|---|"]
    else:
        for header in HEADERS:
            if not os.path.exists(os.path.join(ROOT, "kernels/include", header)):
                continue
            for name, value, meaning in constants(header):
                if wanted and name not in wanted or not wanted and "[N]" in meaning:
                    continue
                preset = "quality" if name.startswith(tuple(QUALITY)) else options.preset
                cells = []
                for factor in (0.75, 1.25):
                    literal = scaled(value, factor)

                    def edit(path, text, name=name, literal=literal):
                        if path.endswith("constants.h"):
                            return text
                        return re.sub(r"\b%s\b" % name, literal, text)

                    (flip, _, _), (flicker, _, _) = added("%s_%s" % (name, factor), edit, preset)
                    cells += ["%+.4f" % flip, "%+.4f" % flicker]
                unit = re.sub(r"\s*\[\w+\]$", "", meaning)
                rows.append("| `%s` | %s | %s | %s |" % (name, value.strip("()").rstrip("f"), unit, " | ".join(cells)))
        head = ["| name | value | unit: meaning | −25 %: FLIP | flicker | +25 %: FLIP | flicker |",
                "|---|---|---|---|---|---|---|"]
    commit = subprocess.run(["git", "-C", ROOT, "log", "-1", "--format=%h"], text=True, capture_output=True).stdout.strip()
    note = ("Made by `%s` on %s, commit %s, %s. Scenes %s: %s from a scale of %g, frames %s, truth of %d × %d samples. "
            "What a row adds to the mean of the scored frames, in the scene where it changes most." % (
                " ".join(["scripts/constants.py"] + [shlex.quote(a) for a in sys.argv[1:]]),
                datetime.date.today().isoformat(), commit, device[0] if device else "no device", ", ".join(scenes), OUTPUT,
                SCALE, SCORED.replace("-", " to "), TRUTH, TRUTH))
    title = "" if options.rules else "# What the constants are worth\n\n"
    text = title + "\n".join([note, ""] + head + rows) + "\n"
    out = options.out or (None if options.rules else os.path.join(ROOT, "docs/lab/constants.md"))
    if out is None:
        print(text, end="")
    else:
        with open(out, "w", encoding="utf-8") as file:
            file.write(text)


if __name__ == "__main__":
    main()
