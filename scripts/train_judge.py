#!/usr/bin/python3
"""Trains the network of temporal_light, which judges history cell by cell: kernels/include/temporal/judge_weights.h.

  scripts/train_judge.py      draws scenes and trains: about half an hour on two cores

Needs a static build (--build), and Debian's python3-torch and python3-openimageio. Sequences are drawn once, with
truth, and kept in --work. In each round they are resolved by the weights so far, at first by none, up to a frame in
which history is kept everywhere, and again with it rejected everywhere; after that frame nothing is rejected.
scripts/constants.py links programs that do so and print what the network is asked; the tree stays as it is.

To reject a cell is right where the second run has less squared error, as displayed, in that frame and some later ones,
and it matters as much as the two errors differ, in parts of the sequence's mean error. What rejecting loses counts less
(CAUTION), because what is wrong stays for longer than the frames that are compared. The weights are trained anew in
each round, always from the same seed.
"""
import argparse
import concurrent.futures
import os
import shutil
import subprocess

import numpy as np
import OpenImageIO as oiio
import torch

import constants

ROOT = constants.ROOT
HEADER = "kernels/include/temporal/judge_weights.h"
KERNEL = "temporal/temporal_light.cl"
SIZE, CELL = (640, 360), 4  # output pixels
INPUTS, HIDDEN = 15, 16
INPUT_MAX = next(float(value.rstrip("f")) for name, value, _ in constants.constants("temporal/constants.h")
                 if name == "JUDGE_INPUT_MAX")
LEVEL = RISE = 0.25  # rejection at even odds, and by how much it rises with their logarithm
CAUTION, WEIGHT_MAX = 0.3, 30  # the second: of a single cell
STEPS, BATCH, RATE = 5000, 500, 4e-3  # BATCH: cells of each sequence
# Runs of each sequence: the first frame, and how many to the one in which all is kept or rejected.
FRAMES, RUNS = 29, [(0, 7), (8, 7), (15, 7), (0, 14), (6, 14), (0, 21)]
LATER = {0: 1, 1: 1.5, 3: 2.5}  # how many frames after that one pictures are compared, and how many each stands for
# Scene, and how it is drawn (output size, scale). Drawn for 1280x720 textures are twice as sharp as fits: they alias as
# those of many engines do.
USUAL, SHARP, LARGE = ("640x360", 0.5), ("1280x720", 0.25), ("640x360", 0.667)
# Those that docs/control.md holds out are not trained on.
SETS = ([(scene, USUAL) for scene in "shadows still pan zoom wheel sparkles occluders wires".split()] +
        [(scene, SHARP) for scene in "shadows still pan zoom wheel".split()] +
        [(scene, LARGE) for scene in "shadows pan".split()])
PROOF = [(scene, USUAL) for scene in "fence chart flight".split()]

# Made here: walls whose textures are not filtered at all, in motion: pixels a frame, growth a frame, what changes them.
FLAT = {"flat-still": (0, 0, 1, ""), "flat-slow": (0.37, 0.11, 1, ""), "flat-drift": (-0.13, 0.26, 1, ""),
        "flat-fast": (-3.3, 1.7, 1, ""), "flat-zoom": (0, 0, 1.006, ""), "flat-shadow": (0, 0, 1, "shadow"),
        "flat-slow-shadow": (0.37, 0.11, 1, "shadow"), "flat-lamps": (0, 0, 1, "lamps"),
        "flat-slow-lamps": (0.37, 0.11, 1, "lamps"), "flat-fast-lamps": (-2.1, 0.9, 1, "lamps"),
        "flat-smoke": (0, 0, 1, "smoke"), "flat-slow-smoke": (0.37, 0.11, 1, "smoke")}
FLAT_FRAMES, FLAT_RUNS = 90, [(16, 60), (22, 60)]  # runs besides
SETS += [(name, USUAL) for name in FLAT]


def name_of(item):
    scene, (output, scale) = item
    return "%s-%s-%s" % (scene, output, scale)


def runs_of(item):
    return RUNS + (FLAT_RUNS if item[0] in FLAT else [])


def hashed(*numbers):
    """Numbers in [0, 1) that depend on integers as if at random."""
    mixed = np.zeros(numbers[0].shape, np.uint64)
    for number in numbers:
        mixed = (mixed ^ number.astype(np.int64).astype(np.uint64)) * np.uint64(0x9E3779B97F4A7C15)
        mixed ^= mixed >> np.uint64(29)
    return (mixed >> np.uint64(40)).astype(np.float32) / np.float32(1 << 24)


def flat_light(x, y):
    """Light of an endless wall: each of its squares has gratings, rings, checks or grains of its own."""
    column, row = np.floor(x / 72), np.floor(y / 72)
    kind, angle, size, contrast = (hashed(column, row, np.full_like(x, seed)) for seed in range(4))
    size = 0.7 * 16 ** size  # 0.7 to 11 pixels
    # Most lie along the axes and fit the pixels, or nearly: all samples of a square meet them alike, or beat slowly.
    fits = hashed(column, row, np.full_like(x, 10))
    size = np.where(fits < 0.6, np.round(2 * size) / 2 * np.where(fits < 0.3, 1, 1.02), size)
    angle = np.where(fits < 0.6, 0, angle)
    turned = x * np.cos(6.3 * angle) + y * np.sin(6.3 * angle), y * np.cos(6.3 * angle) - x * np.sin(6.3 * angle)
    i, j = np.floor(turned[0] / size), np.floor(turned[1] / size)
    far = (x - 72 * column - 36) ** 2 + (y - 72 * row - 36) ** 2
    rings, grains = np.cos(far / (3 * size)), hashed(i, j, column, row)
    pattern = np.select([kind < 0.25, kind < 0.45, kind < 0.65, kind < 0.85],
                        [i % 2, (i + j) % 2, rings * 0.5 + 0.5, grains > 0.4], grains)
    base = 0.1 + 1.2 * hashed(column, row, np.full_like(x, 9)) ** 2
    colour = np.stack([hashed(column, row, np.full_like(x, seed)) for seed in (5, 6, 7)], -1)
    return (base * (1 - 0.98 * contrast ** 0.3 * pattern))[..., None] * (0.6 + 0.4 * colour)


def lamps(x, y, frame):
    """How much light twelve lamps add, or take: half have a hard edge; they are switched, flicker, or fade."""
    generator = np.random.default_rng(7)
    light = np.ones_like(x)
    for lamp in range(12):
        centre, radius = generator.uniform(0, 1, 2) * SIZE, generator.uniform(20, 110)
        times, phase = (1.2 * 20 ** generator.uniform(0, 1)) ** generator.choice((-1, 1)), generator.uniform(0, 40)
        inside = np.clip((radius - np.hypot(x - centre[0], y - centre[1])) / (0.01 if lamp % 2 else radius), 0, 1)
        on = [(frame + phase) % 25 < 11, 0.5 + 0.5 * np.sin(frame * 1.9 + phase), abs((frame + phase) % 40 / 20 - 1)]
        light = light * (1 + (times - 1) * inside * on[lamp % 3])
    return light


def smoky(wall, x, y, frame):
    """The wall behind sixteen puffs of smoke or fire, which drift and have no velocity of their own."""
    generator = np.random.default_rng(8)
    for _ in range(16):
        place, step = generator.uniform(0, 1, 2) * SIZE, generator.uniform(-4, 4, 2)
        radius, thickness = generator.uniform(10, 60), generator.uniform(0.2, 0.9)
        colour = 2 * generator.uniform(0, 1) ** 2 * generator.uniform(0.5, 1, 3)
        distance = np.hypot(*((p - q - s * frame + n / 2) % n - n / 2 for p, q, s, n in zip((x, y), place, step, SIZE)))
        cover = (thickness * np.clip(1 - (distance / radius) ** 2, 0, 1))[..., None]
        wall = wall * (1 - cover) + colour * cover
    return wall


def draw_flat(folder, name):
    """Draws one of FLAT as the exchange format has it, with truth of 3x3 samples a pixel where it is asked."""
    move_x, move_y, growth, changed_by = FLAT[name]
    width, height = SIZE[0] // 2, SIZE[1] // 2
    generator = np.random.default_rng(1)

    def light(x, y, frame):
        grown = growth ** frame
        wall = flat_light((x - SIZE[0] / 2 - move_x * frame) / grown, (y - SIZE[1] / 2 - move_y * frame) / grown)
        if changed_by == "shadow":  # two bars, one upright
            dark = (np.abs((x - 5.1 * frame) % 220 - 60) < 30) | (np.abs((y + 0.4 * x - 1.3 * frame) % 190 - 60) < 9)
            wall = np.where(dark[..., None], 0.3 * wall, wall)
        if changed_by == "lamps":
            wall = wall * lamps(x, y, frame)[..., None]
        return smoky(wall, x, y, frame) if changed_by == "smoke" else wall

    def halton(index, base):
        value, part = 0.0, 1.0
        while index > 0:
            part /= base
            value, index = value + part * (index % base), index // base
        return value

    def write(path, names, pixels, attributes=()):
        spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], len(names), "float")
        spec.channelnames = names
        for key, kind, value in attributes:
            spec.attribute(key, kind, value) if kind else spec.attribute(key, value)
        file = oiio.ImageOutput.create(path)
        file.open(path, spec)
        file.write_image(np.ascontiguousarray(pixels, np.float32))
        file.close()

    compared = {first + count - 1 + later for first, count in RUNS + FLAT_RUNS for later in LATER}
    for frame in range(FLAT_FRAMES):
        jitter = halton(frame % 32 + 1, 2) - 0.5, halton(frame % 32 + 1, 3) - 0.5
        x, y = np.meshgrid((np.arange(width) + 0.5 + jitter[0]) * 2, (np.arange(height) + 0.5 + jitter[1]) * 2)
        back_x = (x - SIZE[0] / 2 - move_x * frame) * (1 / growth - 1) - move_x
        back_y = (y - SIZE[1] / 2 - move_y * frame) * (1 / growth - 1) - move_y
        planes = [np.ones_like(x), np.full_like(x, 10), back_x / 2, -back_y / 2]
        write("%s/frame.%04d.exr" % (folder, frame), ("R", "G", "B", "A", "Z", "backward.u", "backward.v"),
              np.concatenate([light(x, y, frame)] + [plane[..., None] for plane in planes], -1),
              (("quincunx:jitter", oiio.TypeDesc(oiio.FLOAT, oiio.VEC2), jitter), ("quincunx:depthKind", "", "linear"),
               ("quincunx:near", "", 0.1), ("quincunx:version", "int", 1), ("quincunx:frameIndex", "int", frame)))
        if frame in compared:
            x, y = np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1]))
            truth = sum(light(x + (i + generator.random(x.shape)) / 3, y + (j + generator.random(x.shape)) / 3, frame)
                        for i in range(3) for j in range(3)) / 9
            write("%s/truth.%04d.exr" % (folder, frame), ("R", "G", "B"), truth)


def draw(build, work, item):
    """Draws a sequence with truth, unless it is there. Returns its folder."""
    scene, (output, scale) = item
    name = name_of(item)
    if scene not in FLAT:
        return constants.draw(build, work, scene, output, scale, FRAMES, 2 if output == SHARP[0] else 4, name)
    folder = os.path.join(work, "sequences", name)
    if not os.path.exists(os.path.join(folder, "done")):
        os.makedirs(folder, exist_ok=True)
        draw_flat(folder, scene)
        open(os.path.join(folder, "done"), "w", encoding="utf-8").close()
    return folder


def read(path):
    """Returns the pixels of an EXR, height x width x channels, and the channels' names."""
    file = oiio.ImageInput.open(path)
    spec = file.spec()
    pixels = np.asarray(file.read_image("float")).reshape(spec.height, spec.width, -1)
    file.close()
    return pixels, list(spec.channelnames)


def displayed(path):
    """A picture of SIZE as it is scored: tone-mapped, in sRGB."""
    light = np.maximum(np.nan_to_num(read(path)[0][..., :3]), 0)
    while light.shape[1] > SIZE[0]:
        light = (light[::2, ::2] + light[1::2, ::2] + light[::2, 1::2] + light[1::2, 1::2]) / 4
    light = light / (1 + light)
    return np.where(light < 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def errors(picture, truth):
    """Mean squared error of each cell: rows of cells."""
    rows, columns = SIZE[1] // CELL, SIZE[0] // CELL
    return ((picture - truth) ** 2).mean(-1).reshape(rows, CELL, columns, CELL).mean((1, 3))


def motion(path):
    """Of each cell the mean motion in this frame, in cells: x, y."""
    pixels, names = read(path)
    height, width = pixels.shape[:2]
    rows, columns = SIZE[1] // CELL, SIZE[0] // CELL
    y, x = (((np.arange(n) + 0.5) * cells / n).astype(int) for n, cells in ((height, rows), (width, columns)))
    cell = (y[:, None] * columns + x[None]).ravel()
    moved = []
    for channel, cells in (("backward.u", -columns / width), ("backward.v", rows / height)):
        back = np.nan_to_num(pixels[..., names.index(channel)], posinf=0, neginf=0).ravel()
        number = np.maximum(np.bincount(cell, minlength=rows * columns), 1)
        moved.append((np.bincount(cell, back * cells, rows * columns) / number).reshape(rows, columns))
    return moved


def followed(cells, moved, frames):
    """Values of cells where those of `frames` frames ago have moved to; 0 outside."""
    rows, columns = cells.shape
    y, x = np.mgrid[:rows, :columns]
    x, y = np.rint(x + frames * moved[0]).astype(int), np.rint(y + frames * moved[1]).astype(int)
    inside = (x >= 0) & (x < columns) & (y >= 0) & (y < rows)
    return np.where(inside, cells[y.clip(0, rows - 1), x.clip(0, columns - 1)], 0)


def force(path, text, count, rejection):
    """An edit of kernels: frame `count` of a run rejects everywhere or nowhere; printed is what the network is asked.

    Frames are counted in TileLight's confirmation, which is at most 1: by 2 each.
    """
    if path != KERNEL:
        return text
    formats = " ".join(["%d"] + ["%.5g"] * INPUTS)
    prints = ""
    for lane in "xyzw":
        values = ", ".join("%s.%s" % (value, lane) for value in ["cells"] + ["inputs[%d]" % i for i in range(INPUTS)])
        prints += '\n  if (cells.%s >= 0) printf("%s\\n", %s);' % (lane, formats, values)
    for old, new in (
            ("static inline float4 judge(const float4* inputs) {",
             "static inline float4 judge(const float4* inputs, int4 cells) {" + prints),
            ("return judge(inputs);", "return judge(inputs, cells);"),
            ("const EvidenceAround* tiles) {", "const EvidenceAround* tiles, int4 cells) {"),
            ("own, &around);",
             "own, &around, select((int4)(-1), 2 * (y * %d + x) + (int4)(0, 1, %d, %d), asked & -(int)forced));"
             % (SIZE[0] // CELL, SIZE[0] // CELL, SIZE[0] // CELL + 1)),
            ("const TileLight before = previous[from_y * tiles_x + from_x];",
             "TileLight before = previous[from_y * tiles_x + from_x];\n"
             "  const float number = floor(0.5f * previous[i].confirmation);\n"
             "  before.confirmation = fmod(before.confirmation, 2.0f);\n"
             "  const bool forced = number == %d, kept = number >= %d;" % (count - 1, count - 1)),
            ("vload2(0, &previous[i].confirmation)",
             "(float2)(fmod(previous[i].confirmation, 2.0f), previous[i].recent_outliers)"),
            ("  return tile;\n}\n\n__kernel",
             "  if (kept) {\n    tile.rejection = forced ? %.1ff : 0.0f;\n    for (int c = 0; c < 4; ++c)\n"
             "      tile.cells[c].rejection = tile.rejection;\n  }\n"
             "  tile.confirmation += 2.0f * (number + 1.0f);\n  return tile;\n}\n\n__kernel" % rejection)):
        if text.count(old) != 1:
            raise SystemExit("%s: not there once: %s" % (path, old))
        text = text.replace(old, new)
    return text


def gather(programs, folder, item, work):
    """Returns (inputs, gains) of the judged cells of all runs: by how much rejecting lessens the squared error."""
    out = os.path.join(work, "out", name_of(item))
    os.makedirs(out, exist_ok=True)
    inputs, gains, kept_errors = [], [], []
    for first, count in runs_of(item):
        frame = first + count - 1
        frames = [frame + later for later in LATER]
        truths = [displayed("%s/truth.%04d.exr" % (folder, i)) for i in frames]
        moved, of_cells = motion("%s/frame.%04d.exr" % (folder, frame)), []
        for program in programs[count]:
            # One thread, so that what is printed stays in order.
            environment = dict(os.environ, QUINCUNX_CACHE_DIR=os.path.join(work, "cache"), POCL_MAX_PTHREAD_COUNT="1")
            printed = subprocess.run(
                [program, folder + "/frame.%04d.exr", "--out", out + "/out.%04d.exr", "--output", "%dx%d" % SIZE,
                 "--method", "temporal", "--two-way", "0", "--threads", "1", "-q", "--frames",
                 ",".join(map(str, frames)), "--warm-up", str(count - 1)], check=True, text=True,
                capture_output=True, env=environment).stdout
            of_cells.append([errors(displayed("%s/out.%04d.exr" % (out, i)), truth)
                             for i, truth in zip(frames, truths)])
        found = np.array(printed.split(), dtype=np.float32).reshape(-1, 1 + INPUTS)
        gain = sum(followed(kept - rejected, moved, later) * LATER[later]
                   for later, kept, rejected in zip(LATER, *of_cells))
        inputs.append(found[:, 1:])
        gains.append(gain.ravel()[found[:, 0].astype(int)])
        kept_errors.append(of_cells[0][0].mean())
    shutil.rmtree(out)
    gains = np.concatenate(gains) / (np.mean(kept_errors) * sum(LATER.values()))
    return np.concatenate(inputs).clip(-INPUT_MAX, INPUT_MAX), gains.astype(np.float32)


class Judge(torch.nn.Module):
    def __init__(self, sets):
        super().__init__()
        every = np.concatenate([inputs[::7] for inputs, _ in sets])
        self.scale = torch.from_numpy(1 / (np.abs(every).mean(0) + 1e-3)).float()
        self.hidden, self.out = torch.nn.Linear(INPUTS, HIDDEN), torch.nn.Linear(HIDDEN, 1)

    def forward(self, inputs):
        """The logarithm of the odds that rejecting is right."""
        return self.out(torch.relu(self.hidden(inputs * self.scale)))[:, 0]

    def weights(self):
        """Those of rejection: LEVEL + RISE x forward()."""
        return ((self.hidden.weight * self.scale).detach().numpy().T, self.hidden.bias.detach().numpy(),
                RISE * self.out.weight.detach().numpy()[0], LEVEL + RISE * float(self.out.bias.detach()))


def header_of(rows, biases, outputs, bias):
    def macro(name, lists):
        lines = [", ".join("%.6ef" % value for value in part) for values in lists for part in (values[:8], values[8:])]
        return "#define %s \\\n  %s\n" % (name, ", \\\n  ".join(lines))

    return ("// SPDX-License-Identifier: MIT\n"
            "// The network by which temporal_light judges cells: inputs, a hidden layer of max(x, 0), rejection.\n"
            "// Made by scripts/train_judge.py; do not edit.\n#pragma once\n\n"
            "#define JUDGE_INPUTS %d\n#define JUDGE_HIDDEN %d\n" % (INPUTS, HIDDEN) +
            macro("JUDGE_INPUT_WEIGHTS", rows) + macro("JUDGE_BIASES", [biases]) +
            macro("JUDGE_OUTPUT_WEIGHTS", [outputs]) + "#define JUDGE_OUTPUT_BIAS %.6ef\n" % bias)


def train(sets):
    torch.manual_seed(0)
    torch.set_num_threads(1)  # so that sums are in the same order everywhere
    judge = Judge(sets)
    optimizer = torch.optim.Adam(judge.parameters(), RATE)
    inputs, gains = (torch.from_numpy(np.concatenate(part)) for part in zip(*sets))
    sums = torch.where(gains < 0, -CAUTION * gains, gains).clamp(max=WEIGHT_MAX).double().cumsum(0)
    counts = torch.tensor([len(of_set[0]) for of_set in sets])
    ends = sums[counts.cumsum(0) - 1]
    firsts = torch.cat((torch.zeros(1, dtype=sums.dtype), ends[:-1]))
    weights = ((ends - firsts) / counts).float().repeat_interleave(BATCH)
    for step in range(STEPS):
        optimizer.param_groups[0]["lr"] = RATE * (1 - step / STEPS) + 1e-5
        # Cells are drawn as often as they matter.
        drawn = firsts[:, None] + torch.rand(len(sets), BATCH, dtype=sums.dtype) * (ends - firsts)[:, None]
        some = torch.searchsorted(sums, drawn.ravel()).clamp(max=len(sums) - 1)
        loss = torch.nn.functional.binary_cross_entropy_with_logits(
            judge(inputs[some]), (gains[some] > 0).float(), weight=weights)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
    return judge


def check(judge, named):
    """Prints how many cells are rejected, what that and the best there is does to the error, and its mistakes (%)."""
    for name, (inputs, gains) in named:
        with torch.no_grad():
            rejection = (LEVEL + RISE * judge(torch.from_numpy(inputs)).numpy()).clip(0, 1)
        print("%-28s rejected %5.2f   error %+6.2f  at best %+6.2f  by mistake %+6.2f  (%d cells)" % (
            name, 100 * rejection.mean(), 100 * -(gains * rejection).mean(), 100 * -gains.clip(0).mean(),
            100 * -(gains.clip(max=0) * rejection).mean(), len(gains)), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(ROOT, "build/release"))
    parser.add_argument("--work", default=os.path.join(ROOT, "build/judge"))
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--out", default=os.path.join(ROOT, HEADER))
    options = parser.parse_args()
    pool = concurrent.futures.ThreadPoolExecutor(2)
    folders = list(pool.map(lambda item: draw(options.build, options.work, item), SETS + PROOF))
    linker = constants.Programs(options.build, options.work)
    header = header_of(np.zeros((INPUTS, HIDDEN)), np.zeros(HIDDEN), np.zeros(HIDDEN), 0)
    for number in range(options.rounds):
        def link(count, rejection):
            return linker.make("round%d-%d-%d" % (number, count, rejection), lambda path, text: header if path.endswith(
                "judge_weights.h") else force(path, text, count, rejection))

        counts = sorted({count for _, count in RUNS + FLAT_RUNS})
        programs = {count: [link(count, rejection) for rejection in (0, 1)] for count in counts}
        sets = list(pool.map(lambda pair: gather(programs, pair[1], pair[0], options.work), zip(SETS + PROOF, folders)))
        judge = train(sets[:len(SETS)])
        check(judge, zip(map(name_of, SETS + PROOF), sets))
        header = header_of(*judge.weights())
    with open(options.out, "w", encoding="utf-8") as file:
        file.write(header)


if __name__ == "__main__":
    main()
