#!/usr/bin/python3
"""Trains the network of temporal_light, which judges history cell by cell: kernels/include/temporal/judge_weights.h.

  scripts/train_judge.py      draws scenes, trains from the present weights on: about half an hour on two cores

Needs a static build (--build), and Debian's python3-torch and python3-openimageio. Scenes are drawn once, with truth,
and kept in --work. In each round they are resolved by the weights so far, by a temporal_light that prints its inputs
(scripts/constants.py links it; the tree stays as it is), and the weights are trained anew, always from the same seed.

A cell's history is as wrong as the picture before, where the cell was, differs from truth now: both in tone space,
means of 3x3 pixels, at the cell's samples, divided by the mean of their brightest channels. What is wrong by less than
WRONG[0] is not to be rejected, from WRONG[1] on wholly. Cells beside a motion edge are left out.
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
INPUTS, HIDDEN, INPUT_MAX = 15, 16, 8.0
WRONG = (0.08, 0.28)
STEPS, BATCH, RATE = 4000, 1500, 4e-3  # BATCH: cells of each set
FRAMES, FIRST = 29, 6  # the first ones that history needs are not learnt from
# Scene, how it is drawn (output size, scale), options of quincunx-resolve. Drawn for 1280x720 textures are twice as
# sharp as fits: they alias as those of many engines do.
USUAL, SHARP, LARGE = ("640x360", 0.5), ("1280x720", 0.25), ("640x360", 0.667)
SETS = ([(scene, USUAL, ()) for scene in "shadows still pan chart zoom courtyard wheel particles".split()] +
        [(scene, SHARP, ()) for scene in "shadows still pan zoom courtyard wheel".split()] +
        [(scene, LARGE, ()) for scene in "shadows pan".split()] + [("particles", USUAL, ("--reactive", "none"))])
PROOF = [("runners", USUAL, ()), ("occluders", USUAL, ()), ("sparkles", USUAL, ())]  # not trained on


# Made here: textures that are not filtered at all, in motion: pixels a frame, growth a frame, and whether a hard shadow
# crosses them.
FLAT = {"flat-still": (0, 0, 1, False), "flat-slow": (0.37, 0.11, 1, False), "flat-drift": (-0.13, 0.26, 1, False),
        "flat-fast": (-3.3, 1.7, 1, False), "flat-zoom": (0, 0, 1.006, False), "flat-shadow": (0, 0, 1, True),
        "flat-slow-shadow": (0.37, 0.11, 1, True)}
SETS += [(name, USUAL, ()) for name in FLAT]
# In these no light changes, so no history is wrong: what differs from truth is aliased.
QUIET = ["still", "pan"] + [name for name in FLAT if not FLAT[name][3]]


def name_of(item):
    scene, (output, scale), options = item
    return "-".join([scene, output, str(scale)] + (["unmasked"] if options else []))


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


def draw_flat(folder, name):
    """Draws one of FLAT as the exchange format has it, with truth of 3x3 samples a pixel."""
    move_x, move_y, growth, has_shadow = FLAT[name]
    width, height = SIZE[0] // 2, SIZE[1] // 2
    generator = np.random.default_rng(1)

    def light(x, y, frame):
        grown = growth ** frame
        wall = flat_light((x - SIZE[0] / 2 - move_x * frame) / grown, (y - SIZE[1] / 2 - move_y * frame) / grown)
        if has_shadow:  # two bars, one upright
            dark = (np.abs((x - 5.1 * frame) % 220 - 60) < 30) | (np.abs((y + 0.4 * x - 1.3 * frame) % 190 - 60) < 9)
            wall = np.where(dark[..., None], 0.3 * wall, wall)
        return wall

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

    for frame in range(FRAMES):
        jitter = halton(frame % 32 + 1, 2) - 0.5, halton(frame % 32 + 1, 3) - 0.5
        x, y = np.meshgrid((np.arange(width) + 0.5 + jitter[0]) * 2, (np.arange(height) + 0.5 + jitter[1]) * 2)
        back_x = (x - SIZE[0] / 2 - move_x * frame) * (1 / growth - 1) - move_x
        back_y = (y - SIZE[1] / 2 - move_y * frame) * (1 / growth - 1) - move_y
        planes = [np.ones_like(x), np.full_like(x, 10), back_x / 2, -back_y / 2]
        write("%s/frame.%04d.exr" % (folder, frame), ("R", "G", "B", "A", "Z", "backward.u", "backward.v"),
              np.concatenate([light(x, y, frame)] + [plane[..., None] for plane in planes], -1),
              (("quincunx:jitter", oiio.TypeDesc(oiio.FLOAT, oiio.VEC2), jitter), ("quincunx:depthKind", "", "linear"),
               ("quincunx:near", "", 0.1), ("quincunx:version", "int", 1), ("quincunx:frameIndex", "int", frame)))
        x, y = np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1]))
        truth = sum(light(x + (i + generator.random(x.shape)) / 3, y + (j + generator.random(x.shape)) / 3, frame)
                    for i in range(3) for j in range(3)) / 9
        write("%s/truth.%04d.exr" % (folder, frame), ("R", "G", "B"), truth)


def draw(build, work, item):
    """Draws a sequence with truth, unless it is there. Returns its folder."""
    scene, (output, scale), _ = item
    name = "%s-%s-%s" % (scene, output, scale)
    if scene not in FLAT:
        return constants.draw(build, work, scene, output, scale, FRAMES, 2 if output == SHARP[0] else 4, name)
    folder = os.path.join(work, "sequences", name)
    if not os.path.exists(os.path.join(folder, "done")):
        os.makedirs(folder, exist_ok=True)
        draw_flat(folder, scene)
        open(os.path.join(folder, "done"), "w", encoding="utf-8").close()
    return folder


def read(path):
    """Returns (pixels, names of the channels, attributes) of an EXR."""
    file = oiio.ImageInput.open(path)
    spec = file.spec()
    pixels = np.asarray(file.read_image("float")).reshape(spec.height, spec.width, -1)
    file.close()
    return pixels, list(spec.channelnames), spec


def toned(path):
    """Its light in tone space, of SIZE, and blurred over 3x3 pixels."""
    light = np.nan_to_num(read(path)[0][..., :3])
    while light.shape[1] > SIZE[0]:
        light = (light[::2, ::2] + light[1::2, ::2] + light[::2, 1::2] + light[1::2, 1::2]) / 4
    padded = np.pad(light / (1 + np.maximum(light.max(-1, keepdims=True), 0)), ((1, 1), (1, 1), (0, 0)), mode="edge")
    return sum(padded[j:j + SIZE[1], i:i + SIZE[0]] for j in range(3) for i in range(3)) / 9


def at(picture, x, y):
    """Bilinear, at places in pixels."""
    x, y = np.clip(x - 0.5, 0, SIZE[0] - 1.001), np.clip(y - 0.5, 0, SIZE[1] - 1.001)
    i, j = x.astype(int), y.astype(int)
    fx, fy = (x - i)[..., None], (y - j)[..., None]
    above = picture[j, i] * (1 - fx) + picture[j, i + 1] * fx
    below = picture[j + 1, i] * (1 - fx) + picture[j + 1, i + 1] * fx
    return above * (1 - fy) + below * fy


def how_wrong(frame, before, truth):
    """Of each cell how wrong its history is; NaN where that is not known."""
    pixels, names, spec = read(frame)
    height, width = pixels.shape[:2]
    scale_x, scale_y = SIZE[0] / width, SIZE[1] / height
    jitter = spec.getattribute("quincunx:jitter")
    back_x = pixels[..., names.index("backward.u")] * scale_x
    back_y = -pixels[..., names.index("backward.v")] * scale_y
    x, y = np.meshgrid((np.arange(width) + 0.5 + jitter[0]) * scale_x, (np.arange(height) + 0.5 + jitter[1]) * scale_y)
    apart = np.max([np.abs(np.roll(v, by, axis) - v) for v in (back_x, back_y) for by in (-1, 1) for axis in (0, 1)], 0)
    from_x, from_y = x + back_x, y + back_y
    counts = (apart < 0.15) & (from_x > 0) & (from_x < SIZE[0]) & (from_y > 0) & (from_y < SIZE[1])
    was, is_now = at(toned(before), from_x, from_y), at(toned(truth), x, y)
    wrong = np.abs(was - is_now).max(-1) / ((was.max(-1) + is_now.max(-1)) / 2 + 0.02)
    columns, rows = SIZE[0] // CELL, SIZE[1] // CELL
    cell = np.clip((y // CELL).astype(int), 0, rows - 1) * columns + np.clip((x // CELL).astype(int), 0, columns - 1)
    number = np.bincount(cell[counts], minlength=rows * columns)
    sums = np.bincount(cell[counts], wrong[counts], rows * columns)
    return np.where(number > 0, sums / np.maximum(number, 1), np.nan)


def print_inputs(path, text):
    """An edit of kernels: temporal_light prints N for each frame, and of each judged cell its number and inputs."""
    if path != KERNEL:
        return text
    formats = " ".join(["%d"] + ["%.5g"] * INPUTS)
    values = ", ".join(["cell"] + ["inputs[%d]" % i for i in range(INPUTS)])
    for old, new in (
            ("static inline float judge(const float* inputs) {",
             'static inline float judge(const float* inputs, int cell) {\n  printf("%s\\n", %s);' % (formats, values)),
            ("return judge(inputs);", "return judge(inputs, cell);"),
            ("const TileEvidence* tile, const TileEvidence* tiles) {",
             "const TileEvidence* tile, const TileEvidence* tiles, int cell) {"),
            ("&own, &around.sum);", "&own, &around.sum, (2 * y + c / 2) * %d + 2 * x + c %% 2);" % (SIZE[0] // CELL)),
            ("if (y >= tiles_y) return;",
             'if (y >= tiles_y) return;\n  if (y == 0 && get_global_id(0) == 0) printf("N\\n");')):
        if text.count(old) != 1:
            raise SystemExit("%s: not there once: %s" % (path, old))
        text = text.replace(old, new)
    return text


def gather(program, folder, item, work):
    """Returns (inputs, how wrong) of the cells of all frames of a set."""
    out = os.path.join(work, "out", name_of(item))
    os.makedirs(out, exist_ok=True)
    # One thread, so that what is printed stays in order.
    environment = dict(os.environ, QUINCUNX_CACHE_DIR=os.path.join(work, "cache"), POCL_MAX_PTHREAD_COUNT="1")
    printed = subprocess.run([program, folder + "/frame.%04d.exr", "--out", out + "/out.%04d.exr", "--output",
                              "%dx%d" % SIZE, "--method", "temporal", "--two-way", "0", "--threads", "1", "-q",
                              *item[2]], check=True, text=True, capture_output=True, env=environment).stdout
    inputs, wrong = [], []
    for i, lines in list(enumerate(printed.split("N\n")[-FRAMES:]))[FIRST:]:
        found = np.array(lines.split(), dtype=np.float32).reshape(-1, 1 + INPUTS)
        of_cells = how_wrong("%s/frame.%04d.exr" % (folder, i), "%s/out.%04d.exr" % (out, i - 1),
                             "%s/truth.%04d.exr" % (folder, i))[found[:, 0].astype(int)]
        known = np.isfinite(of_cells)
        if item[0] in QUIET:
            of_cells *= 0
        inputs.append(found[known, 1:])
        wrong.append(of_cells[known])
    shutil.rmtree(out)
    return np.concatenate(inputs).clip(-INPUT_MAX, INPUT_MAX), np.concatenate(wrong).astype(np.float32)


class Judge(torch.nn.Module):
    def __init__(self, sets):
        super().__init__()
        every = np.concatenate([inputs[::7] for inputs, _ in sets])
        self.scale = torch.from_numpy(1 / (np.abs(every).mean(0) + 1e-3)).float()
        self.hidden, self.out = torch.nn.Linear(INPUTS, HIDDEN), torch.nn.Linear(HIDDEN, 1)

    def forward(self, inputs):
        """The logarithm of the odds that history is wrong."""
        return self.out(torch.relu(self.hidden(inputs * self.scale)))[:, 0]

    def weights(self):
        """Those of rejection: 0 at odds of 1 to 4.6, 1 at 12 to 1."""
        return ((self.hidden.weight * self.scale).detach().numpy().T, self.hidden.bias.detach().numpy(),
                0.25 * self.out.weight.detach().numpy()[0], 0.38 + 0.25 * float(self.out.bias.detach()))


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
    judge = Judge(sets)
    optimizer = torch.optim.Adam(judge.parameters(), RATE)
    low, high = WRONG
    tensors = [(torch.from_numpy(inputs), torch.from_numpy(((wrong - low) / (high - low)).clip(0, 1)))
               for inputs, wrong in sets]
    for step in range(STEPS):
        optimizer.param_groups[0]["lr"] = RATE * (1 - step / STEPS) + 1e-5
        loss = 0
        for inputs, rejected in tensors:
            some = torch.randint(len(inputs), (BATCH,))
            loss = loss + torch.nn.functional.binary_cross_entropy_with_logits(
                judge(inputs[some]), rejected[some], weight=1 + rejected[some])
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
    return judge


def check(judge, named):
    """Prints how much of what is right is rejected, and of what is wrong (%), by more than a half."""
    for name, (inputs, wrong) in named:
        with torch.no_grad():
            rejected = judge(torch.from_numpy(inputs)).numpy() > 0
        share = lambda cells: 100 * rejected[cells].mean() if cells.any() else float("nan")
        print("%-28s right %5.2f   wrong by .15 %5.1f   by .3 %5.1f   (%d cells, %.1f %% wrong by .15)" % (
            name, share(wrong < WRONG[0]), share(wrong > 0.15), share(wrong > 0.3), len(wrong),
            100 * (wrong > 0.15).mean()), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(ROOT, "build/release"))
    parser.add_argument("--work", default=os.path.join(ROOT, "build/judge"))
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--out", default=os.path.join(ROOT, HEADER))
    options = parser.parse_args()
    pool = concurrent.futures.ThreadPoolExecutor(2)
    folders = list(pool.map(lambda item: draw(options.build, options.work, item), SETS + PROOF))
    programs = constants.Programs(options.build, options.work)
    with open(options.out, encoding="utf-8") as file:
        header = file.read()
    for number in range(options.rounds):
        edit = lambda path, text: header if path.endswith("judge_weights.h") else print_inputs(path, text)
        program = programs.make("round%d" % number, edit)
        sets = list(pool.map(lambda pair: gather(program, pair[1], pair[0], options.work), zip(SETS + PROOF, folders)))
        judge = train(sets[:len(SETS)])
        check(judge, zip(map(name_of, SETS + PROOF), sets))
        header = header_of(*judge.weights())
    with open(options.out, "w", encoding="utf-8") as file:
        file.write(header)


if __name__ == "__main__":
    main()
