#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""quincunx.py: its structs are those of the headers, its pictures those of a reference, its errors sentences."""
import copy
import os
import pickle
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import numpy as np

import quincunx

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
HEADERS = os.path.join(ROOT, "host", "include", "quincunx")


def read(*path):
    with open(os.path.join(*path), encoding="utf-8") as text:
        return text.read()


def waves(u, v):
    """A picture without an edge: three waves that a frame of 64x36 resolves barely."""
    return 0.5 + 0.15 * (np.sin(2 * np.pi * 27 * u) + np.sin(2 * np.pi * 13 * v) + np.sin(2 * np.pi * (19 * u + 9 * v)))


def sampled(width, height, jitter=(0, 0)):
    x, y = np.meshgrid(np.arange(width), np.arange(height))
    grey = waves((x + 0.5 + jitter[0]) / width, (y + 0.5 + jitter[1]) / height)
    return np.dstack([grey] * 3 + [np.ones_like(grey)]).astype(np.float32)


def bilinear(frame, width, height):
    """In double precision, clamped to the edge."""
    def taps(size, to):
        at = np.clip((np.arange(to) + 0.5) * size / to - 0.5, 0, size - 1)
        low = np.minimum(at.astype(int), max(size - 2, 0))
        return low, np.minimum(low + 1, size - 1), at - low

    frame = frame.astype(np.float64)
    x0, x1, fx = taps(frame.shape[1], width)
    y0, y1, fy = taps(frame.shape[0], height)
    fx, fy = fx[:, np.newaxis], fy[:, np.newaxis, np.newaxis]
    rows = [frame[y][:, x0] * (1 - fx) + frame[y][:, x1] * fx for y in (y0, y1)]
    return rows[0] * (1 - fy) + rows[1] * fy


def rms(a, b):
    return float(np.sqrt(np.mean((a.astype(np.float64) - b) ** 2)))


# Weights of both axes and their product are rounded to float, and so are three sums: 8 roundings of values up to 1.
FLOAT_BOUND = 8 * 2.0 ** -24


class Header(unittest.TestCase):
    """All that the module knows of C comes from the headers."""

    def test_nothing_of_c_is_written_twice(self):
        source = read(quincunx.__file__)
        declared = set(quincunx.FUNCTIONS)
        self.assertEqual(set(re.findall(r"\bcall\(\"(\w+)\"[,)]", source)) - declared, set())
        for kind in quincunx.Handle.__subclasses__():
            self.assertTrue(kind.OBJECT is None or kind.OBJECT + "_destroy" in declared, kind)
        symbols = read(ROOT, "tests", "install", "c_symbols.txt")
        self.assertEqual(declared, set(re.findall(r"^quincunx_(\w+)", symbols, re.M)))

    def test_every_image_has_a_format(self):
        images = {(struct, name) for struct in quincunx.IMAGES for name, kind in quincunx.types_of(struct).items()
                  if kind.cname == "quincunx_image *"}
        self.assertEqual(images, {(struct, name) for struct, formats in quincunx.IMAGES.items() for name in formats})
        self.assertIn(("inputs", "exposure_image"), images)
        names = {number: "%d %s" % layout for number, layout in quincunx.FORMATS.items()}
        self.assertEqual({name: names[number] for name, number in quincunx.IMAGES["inputs"].items()
                          if name != "colour"}, {"depth": "1 float32", "velocity": "2 float16", "reactive": "1 uint8",
                                                 "exposure_image": "1 float32"})

    def test_what_is_new_in_the_headers_is_known(self):
        with tempfile.TemporaryDirectory() as folder:  # the module as it is installed
            include = os.path.join(folder, "fresh", "include", "quincunx")
            shutil.copytree(os.path.join(HEADERS, "c"), os.path.join(include, "c"))
            shutil.copy(os.path.join(HEADERS, "quincunx.h"), include)
            shutil.copy(quincunx.__file__, os.path.join(folder, "fresh", "__init__.py"))
            header = read(include, "c", "frame.h")
            with open(os.path.join(include, "c", "frame.h"), "w", encoding="utf-8") as text:
                text.write(header.replace("\n} quincunx_inputs;", """
  const quincunx_image* light; /* RG32F: of both */
  float dusk_x, dusk_y; /* a pair */
} quincunx_inputs;"""))
            code = """import fresh, numpy
resolver = fresh.Resolver((8, 6), method='point', present=0)
assert 'light: RG32F: of both' in resolver.resolve.__doc__
for light in numpy.ones((6, 8, 2)), numpy.ones((6, 8, 1)):
    try:
        resolver.resolve(numpy.ones((6, 8, 4)), light=light, dusk=(1, 2))
    except Exception as error:
        print(error)"""
            run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                                 env={**os.environ, "PYTHONPATH": folder})
        self.assertRegex(run.stdout, r"^inputs\.struct_size is \d+, and a field beyond .* this.*\n"
                         r"light has the shape \(6, 8, 1\); it must be \(height, width, 2\)\n$")

    def test_words_stand_for_numbers(self):
        text = read(HEADERS, "c", "settings.h") + read(HEADERS, "c", "control.h")
        for name, (field, word) in {"QUINCUNX_REPROJECTED": ("two_frame_form", "reprojected"),
                                    "QUINCUNX_BY_EVIDENCE": ("sky_motion", "evidence"),
                                    "QUINCUNX_DILATED_VELOCITY": ("drawn_velocity", "dilated"),
                                    "QUINCUNX_SAMPLE_POINT": ("sampling", "point"),
                                    "QUINCUNX_VIEW_FAR": ("temporal_view", "far"),
                                    "QUINCUNX_RGBA32F": ("history_format", "float32"),
                                    "QUINCUNX_RGBA8": ("colour", "uint8"),
                                    "QUINCUNX_IMAGE2D": ("storage", "image2d"),
                                    "QUINCUNX_PLACED": ("targets", "placed"),
                                    "QUINCUNX_LINEAR": ("depth_convention", "linear"),
                                    "QUINCUNX_BOTTOM": ("origin", "bottom"),
                                    "QUINCUNX_QUALITY": ("temporal_preset", "quality"),
                                    "QUINCUNX_BOTH_AXES": ("order", "both-axes"),
                                    "QUINCUNX_FOLLOW": ("cpu_bound", "follow"),
                                    "QUINCUNX_ACES": ("tone_map", "aces")}.items():
            self.assertRegex(text, r"\b%s = %d\b" % (name, quincunx.CHOICES[field][word]))
        for enum in ("depth_convention", "clip_space", "velocity_unit", "shading", "targets", "origin"):
            self.assertEqual(sorted(quincunx.CHOICES[enum].values()), list(range(len(quincunx.CHOICES[enum]))), enum)


class Pictures(unittest.TestCase):
    def test_bilinear_is_the_reference(self):
        resolver = quincunx.Resolver((129, 71), method="bilinear", present=0)
        random = np.random.default_rng(1)
        for width, height in ((64, 36), (57, 33), (129, 71), (5, 9)):
            frame = random.random((height, width, 4), dtype=np.float32)
            picture = resolver.resolve(frame)
            self.assertEqual((picture.shape, picture.dtype.name), ((71, 129, 4), "float32"))
            self.assertLessEqual(np.abs(picture - bilinear(frame, 129, 71)).max(), FLOAT_BOUND)

    def test_any_layout_of_an_array_gives_the_same(self):
        resolver = quincunx.Resolver((80, 60), method="catmull-rom", present=0)
        large = np.random.default_rng(2).random((50, 90, 4), dtype=np.float32)
        large[:, :, 3] = 1
        part = large[7:37, 20:60]
        expected = resolver.resolve(part.copy())
        for name, same in {"rows apart": part, "upside down": part[::-1].copy()[::-1], "double": part.astype(float),
                           "no alpha": part[:, :, :3], "columns first": np.asfortranarray(part)}.items():
            before = same.copy()
            np.testing.assert_array_equal(resolver.resolve(same), expected, name)
            np.testing.assert_array_equal(same, before, name)

    def test_half_and_presented(self):
        resolver = quincunx.Resolver((40, 30), method="point", colour="float16", tone_map="clamp", dither=0)
        picture = resolver.resolve(np.full((20, 20, 4), [1, 0, 0.5, 1], np.float16), presented=True)
        self.assertEqual(picture.dtype.name, "uint8")
        np.testing.assert_array_equal(picture, np.broadcast_to([255, 0, 188, 255], (30, 40, 4)))

    def test_reports_tell_each_frame_once(self):
        resolver = quincunx.Resolver((40, 30), method="bilinear", present=0)
        for index in range(3):
            resolver.resolve(np.zeros((20, 30, 4)), frame_index=index)
        reports = resolver.reports()
        self.assertEqual([(r["frame_index"], r["render_extent"]) for r in reports], [(i, (30, 20)) for i in range(3)])
        self.assertEqual([p[0] for p in reports[0]["passes"]], ["scale_bilinear"])
        self.assertEqual(resolver.reports(), [])


class Extras(unittest.TestCase):
    """Inputs besides a frame's own: each shows where it should and nowhere else."""

    def frame(self, value, size=(20, 30)):
        return {"colour": np.full((*size, 4), [value, value, value, 1], np.float32), "depth": np.full(size, 0.5),
                "velocity": np.zeros((*size, 2)), "reactive": np.zeros(size, np.uint8)}

    def test_particles_lie_over_the_frame(self):
        resolver = quincunx.Resolver((40, 30), method="bilinear", present=0, particle_target_extent=(16, 12))
        dust = {"colour": np.zeros((12, 16, 4)), "depth": np.full((12, 16), 0.5)}
        dust["colour"][:, 8:] = [0, 1, 0, 1]
        picture = resolver.resolve(**self.frame(0.25, (30, 40)), particles={**dust, "reactive": np.zeros((12, 16))})
        np.testing.assert_allclose(picture[:, :15], np.broadcast_to([0.25, 0.25, 0.25, 1], (30, 15, 4)), atol=1e-6)
        np.testing.assert_allclose(picture[:, 25:], np.broadcast_to([0, 1, 0, 1], (30, 15, 4)), atol=1e-6)

    def test_a_focus_shows_in_its_rectangle(self):
        resolver = quincunx.Resolver((40, 30), method="bilinear", present=0, focus_extent=(20, 16))
        self.assertIn("20x16", resolver.focus_plan())
        focus = {**self.frame(1, (16, 20)), "x": 10, "y": 4, "rectangles": [(12, 6, 16, 12)], "feather": 1}
        picture = resolver.resolve(**self.frame(0, (30, 40)), focus=focus)
        inside = np.zeros((30, 40), bool)
        inside[6:18, 12:28] = True
        self.assertEqual(picture[~inside][:, :3].max(), 0)
        self.assertEqual(picture[8:16, 14:26, :3].min(), 1)
        report, = resolver.reports()
        self.assertTrue(report["focused"])
        self.assertEqual({name.startswith("focus: ") for name, _, _ in report["passes"]}, {True, False})

    def test_a_fade_mixes_both_pictures(self):
        resolver = quincunx.Resolver((40, 30), method="bilinear", present=0, fades=1)
        old = np.full((30, 40, 4), [1, 0, 0, 1], np.float32)
        picture = resolver.resolve(**self.frame(0.5), fading_from=old, fade_weight=0.25)
        np.testing.assert_allclose(picture, np.broadcast_to([0.875, 0.125, 0.125, 1], (30, 40, 4)), atol=1e-6)

    def test_a_smaller_output_is_shown_in_the_pictures_size(self):
        resolver = quincunx.Resolver((40, 30), method="bilinear", present=0, min_output_extent=(20, 15))
        picture = resolver.resolve(**self.frame(0.5), output_extent=(24, 18))
        np.testing.assert_allclose(picture[:, :, 0], 0.5, atol=1e-6)
        self.assertEqual(resolver.reports()[0]["output_extent"], (24, 18))

    def test_exposure_of_an_image_counts_as_the_number_does(self):
        def shown(**exposure):
            resolver = quincunx.Resolver((40, 30), method="bilinear", tone_map="clamp", dither=0)
            return resolver.resolve(**self.frame(0.125), presented=True, **exposure)

        np.testing.assert_array_equal(shown(exposure_image=np.full((1, 1), 4.0)), shown(exposure=4))
        self.assertGreater(shown(exposure=4)[0, 0, 0], shown()[0, 0, 0])

    def test_content_is_measured(self):
        resolver = quincunx.Resolver((64, 64), (64, 64), measures_content=1)
        self.assertEqual(set(resolver.device()), {"name", "profile", "pass_timer", "uuid"})
        moving = self.frame(0.5, (64, 64))
        moving["velocity"][:, :, 0] = 4 / 64
        for _ in range(3):
            resolver.resolve(**moving)
        content = resolver.reports()[-1]["content"]
        self.assertGreater(content["moving"], 0.9)
        self.assertAlmostEqual(content["speed_px"], 4, 1)

    def test_variants_are_methods(self):
        names = quincunx.variants()
        self.assertIn("temporal:fast", names)
        self.assertIn("fast", str(quincunx.Resolver((40, 30), method="temporal:fast")).lower())
        with self.assertRaisesRegex(quincunx.Error, "temporal:quality"):
            quincunx.Resolver((40, 30), method="temporal:best")


class Controllers(unittest.TestCase):
    KINDS = (quincunx.ProportionalController, quincunx.MinimumOfNController, quincunx.PredictiveController,
             quincunx.QualityController)

    def test_each_holds_its_target(self):
        for kind in self.KINDS:
            controller = kind(output_extent=(1920, 1080), target_ms=16, min_scale=0.4, order="both-axes")
            self.assertEqual(controller.next(), (1920, 1080))
            for number in range(1, 400):
                width, height = controller.next()
                gpu_ms = 2 + 22 * width * height / (1920 * 1080)
                controller.observe(number, (width, height), gpu_ms, interval_ms=max(gpu_ms, 16), resolve_ms=1)
            self.assertLess(gpu_ms, 17, controller.name)
            self.assertGreater(gpu_ms, 11, controller.name)
            self.assertIn(controller.next(), controller.ladder())
            controller.target_ms = 40
            self.assertEqual(controller.target_ms, 40)

    def test_quality_chooses_a_method_and_says_why(self):
        controller = quincunx.QualityController(output_extent=(1280, 720), target_ms=20,
                                                methods=["bilinear", "temporal:fast"])
        controller.observe(1, (1280, 720), 25, resolve_ms=2, content={"moving": 1, "speed_px": 3})
        choice = controller.choice()
        self.assertIn(choice["method"], ("bilinear", "temporal:fast"))
        self.assertEqual(choice["weight"], 1)
        self.assertIn("ms", controller.explain())

    def test_costs_and_fronts_go_through_text(self):
        costs = quincunx.CostTable()
        self.assertIsNone(costs.predict(0.5))
        for number in range(20):
            costs.record(number, 0.3 + 0.03 * number, 4 + 10 * (0.3 + 0.03 * number))
        self.assertAlmostEqual(quincunx.CostTable(json=str(costs)).predict(0.6), 10, 1)
        self.assertAlmostEqual(costs.fixed_part(), 4 / 14, 2)
        self.assertGreater(costs.confidence(0.87), 0.9)
        front, mix = quincunx.ErrorFront(), quincunx.mix_of(moving=0.5)
        self.assertEqual(mix, (0.5, 0.5, 0, 0, 0, 0))
        again = quincunx.ErrorFront(str(front))
        self.assertEqual(front.flip(mix, "temporal", 0.5), again.flip(mix, "temporal", 0.5))
        self.assertLess(front.flip(mix, "temporal", 0.5), front.flip(mix, "bilinear", 0.5))
        self.assertGreater(front.resolve_ms("temporal", 0.5, 2), front.resolve_ms("bilinear", 0.5, 2))
        self.assertEqual(front.summary(), quincunx.ErrorFront(resolver=quincunx.Resolver((8, 8))).summary())
        controller = quincunx.QualityController(output_extent=(640, 360), front=again, calibration=costs)
        self.assertEqual(controller.name, "quality")

    def test_followers_follow(self):
        outputs = quincunx.OutputFollower(display_extent=(1920, 1080))
        details = quincunx.DetailFollower(levels=3, rest_frames=0)
        self.assertEqual(outputs.observe((1920, 1080)), (1920, 1080))
        for _ in range(100):
            output = outputs.observe((640, 360))
        self.assertEqual(output, outputs.min_output())
        self.assertLess(output[0], 1920)
        self.assertEqual([details.observe(area) for area in (1, 0.1, 0.1, 0.1)], [0, 1, 2, 2])

    def test_what_cannot_be_is_refused_in_words(self):
        with self.assertRaisesRegex(quincunx.Error, "buffers is 1"):
            quincunx.PredictiveController(output_extent=(64, 64), buffers=1)
        with self.assertRaisesRegex(TypeError, "'bufers' is no setting; there are: output_extent, .*buffers"):
            quincunx.PredictiveController(output_extent=(64, 64), bufers=3)
        with self.assertRaisesRegex(ValueError, "order is 'sideways'; it must be one of horizontal-first"):
            quincunx.PredictiveController(output_extent=(64, 64), order="sideways")
        with self.assertRaisesRegex(quincunx.Error, "gpu_ms"):
            quincunx.ProportionalController(output_extent=(64, 64)).observe(1, (64, 64), float("nan"))
        with self.assertRaisesRegex(quincunx.Error, r"settings.methods\[0\].*temporal:fast"):
            quincunx.QualityController(output_extent=(64, 64), methods=["best"])
        with self.assertRaisesRegex(TypeError, "'jiter_x' is no input; there are: .* velocity_scale, clip"):
            quincunx.Resolver((8, 8)).resolve(np.zeros((8, 8, 4)), jiter_x=1)


class Arrays(unittest.TestCase):
    """Types of arrays: the same meaning in another type, or a sentence."""

    FLOATS, CODES = (1, "float32"), (1, "uint8")

    def test_values_keep_their_meaning(self):
        for given, layout, expected in (
                (np.array([[True, False]]), self.CODES, [255, 0]), (np.array([[True, False]]), self.FLOATS, [1, 0]),
                (np.array([[0, 0.5, 1]]), self.CODES, [0, 128, 255]), ([[0.2, 0.4]], self.CODES, [51, 102]),
                (np.array([[1.001, -0.001]], np.float16), self.CODES, [255, 0]),
                (np.array([[0, 1, 255]], np.uint16), self.CODES, [0, 1, 255]), ([[0, 3, 255]], self.CODES, [0, 3, 255]),
                ([[0, 0]], self.CODES, [0, 0]), ([[0, 1]], self.FLOATS, [0, 1]),
                (np.zeros((1, 2), "u1"), self.FLOATS, [0, 0]), (np.array([[0.5, 2]], ">f8"), self.FLOATS, [0.5, 2]),
                (np.array([[0.5, 2]], object), self.FLOATS, [0.5, 2]),
                (np.array([[1e300, -np.inf, -7e4]]), (1, "float16"), [65504, -np.inf, -65504]),
                (np.array([[np.inf, 1e38]]), self.FLOATS, [np.inf, np.float32(1e38)]),
                (np.ma.array([[0.5, 2]], mask=False), self.FLOATS, [0.5, 2])):
            with self.subTest(given=given, layout=layout):
                pixels = quincunx.pixels_of("it", given, *layout)
                self.assertEqual((pixels.dtype.name, pixels.ravel().tolist()), (layout[1], expected))

    def test_what_may_mean_something_else_is_refused(self):
        codes = "; it must be uint8, floating point from 0 to 1, or bool"
        floats = "; it must be float32, or floating point within its range"
        for given, layout, sentence in (
                (np.array([[0, 1]]), self.CODES, "it is int64 from 0 to 1" + codes),
                (np.array([[0, 300]]), self.CODES, "it is int64 from 0 to 300" + codes),
                (np.array([[-1, 3]], "i2"), self.CODES, "it is int16 from -1 to 3" + codes),
                (np.array([[0, 255.0]]), self.CODES, "it is float64 from 0.0 to 255.0" + codes),
                (np.array([[0, np.nan]]), self.CODES, "it is float64 from nan to nan" + codes),
                (np.array([[0, 1]], "u1"), self.FLOATS, "it is uint8 from 0 to 1" + floats),
                (np.array([[0, 40000]], "i4"), self.FLOATS, "it is int32 from 0 to 40000" + floats),
                (np.array([[1e300, 1]]), self.FLOATS, r"it is float64 from 1\.0 to 1e\+300" + floats),
                (np.array([[1j]]), self.FLOATS, "it is complex128" + floats),
                (np.array([["0.5"]]), self.FLOATS, "it is <U3" + floats),
                (np.array([[None]]), self.FLOATS, "it is object" + floats),
                (np.zeros((1, 2), "M8[s]"), self.CODES, r"it is datetime64\[s\]" + codes),
                (np.ma.array([[0.5, 2]], mask=[[0, 1]]), self.FLOATS, "it has masked pixels; it must have a value"),
                (np.ones((2, 2, 4)), (4, "uint8"), "it is float64 from 1.0 to 1.0; it must be uint8, sRGB encoded; "
                 "linear light wants a Resolver with colour='float32'"),
                (np.ones((2, 2, 4), "u1"), (4, "float16"), "it is uint8 from 1 to 1; it must be float16, or .*, "
                 "linear; pictures of uint8 want a Resolver with colour='uint8'")):
            with self.subTest(given=given, layout=layout), self.assertRaisesRegex(ValueError, sentence):
                quincunx.pixels_of("it", given, *layout)

    def test_a_mask_counts_whatever_its_type(self):
        colour = np.random.default_rng(3).random((15, 20, 3))

        def last(mask):
            resolver = quincunx.Resolver((40, 30), present=0)
            for frame in range(6):
                picture = resolver.resolve(np.roll(colour, frame, 1), depth=np.full((15, 20), 0.5),
                                           velocity=np.zeros((15, 20, 2)), reactive=np.full((15, 20), mask),
                                           jitter=quincunx.jitter(frame, (20, 15), (40, 30)))
            return picture

        for mask in (True, 1.0, np.float16(1)):
            np.testing.assert_array_equal(last(mask), last(np.uint8(255)))
        self.assertGreater(np.abs(last(True) - last(np.uint8(0))).max(), 0.01)

    def test_colour_of_bytes_without_alpha_covers_all(self):
        resolver = quincunx.Resolver((40, 30), method="point", colour="uint8", present=0)
        self.assertEqual(resolver.resolve(np.full((20, 30, 3), 255, np.uint8)).min(), 1)


class Shared(unittest.TestCase):
    """Memory that another API could have mapped: an array at the start of a page."""

    def setUp(self):
        self.resolver = quincunx.Resolver((16, 12), (8, 6), device="cpu", method="bilinear", present=False)
        room = np.zeros(2 * 4096, np.uint8)
        self.page = room[-room.__array_interface__["data"][0] % 4096:][:4096]
        self.frame = sampled(8, 6).astype(np.float32)

    def test_frames_lie_and_pictures_come_in_it(self):
        memory = quincunx.SharedMemory(self.resolver, mapped=self.page, device=self.resolver.device()["uuid"])
        colour, out = memory.image((6, 8, 4), "float32"), memory.image((12, 16, 4), "float32", offset=1024)
        self.page[:768] = self.frame.ravel().view(np.uint8)
        expected = self.resolver.resolve(self.frame)
        for _ in range(2):
            self.page[1024:] = 255
            memory.acquire()
            self.assertIs(self.resolver.resolve(colour, out=out), out)
            memory.release()
            self.resolver.finish()
            made = self.page[1024:].view(np.float32)[:expected.size].reshape(expected.shape)
            np.testing.assert_array_equal(made, expected)
        memory.acquire()
        np.testing.assert_array_equal(self.resolver.resolve(colour), expected)
        del memory
        np.testing.assert_array_equal(self.resolver.resolve(colour), expected)  # the image keeps it

    def test_what_cannot_be_shared_is_refused(self):
        memory = quincunx.SharedMemory(self.resolver, mapped=self.page)
        half = memory.image((6, 8, 4), "float16")
        for kind, sentence, refused in (
                (quincunx.Error, "colour.format", lambda: self.resolver.resolve(half)),
                (quincunx.Error, "colour.memory has 4096 bytes",
                 lambda: self.resolver.resolve(memory.image((6, 8, 4), "float32", 4000))),
                (ValueError, "an image of 3 channels of uint8 is none of", lambda: memory.image((6, 8, 3), "uint8")),
                (ValueError, "mapped must be an array whose bytes", lambda: quincunx.SharedMemory(
                    self.resolver, mapped=self.page[::2])),
                (ValueError, "the 16 bytes of a UUID", lambda: quincunx.SharedMemory(self.resolver, device=b"1")),
                (ValueError, "handle is 'win32'; it must be one of opaque-fd, dma-buf, mapped",
                 lambda: quincunx.SharedMemory(self.resolver, handle="win32")),
                (TypeError, "resolver is None", lambda: quincunx.SharedMemory(None, fd=0)),
                (quincunx.Error, "cl_khr_external_memory_opaque_fd",
                 lambda: quincunx.SharedMemory(self.resolver, fd=0, bytes=64)),
                (quincunx.Error, "semaphore", lambda: quincunx.Semaphore(self.resolver, 0))):
            with self.subTest(sentence), self.assertRaisesRegex(kind, sentence):
                refused()


class Ownership(unittest.TestCase):
    def test_nothing_that_the_library_owns_is_copied(self):
        table = quincunx.CostTable()
        resolver = quincunx.Resolver((8, 6), method="point", present=0)
        for handle in (resolver, table, quincunx.ErrorFront(), quincunx.OutputFollower(display_extent=(64, 64)),
                       quincunx.DetailFollower(), *(kind(output_extent=(64, 64)) for kind in Controllers.KINDS)):
            for copied in (copy.copy, copy.deepcopy, pickle.dumps, lambda each: copy.deepcopy({"in": [each]})):
                with self.assertRaisesRegex(TypeError, f"a {type(handle).__name__} can be neither copied nor pickled"):
                    copied(handle)
        self.assertEqual(resolver.resolve(np.ones((4, 4, 4))).min(), 1)
        for value in (resolver.needs, quincunx.Error(3, "a sentence"), resolver.reports()):
            self.assertEqual(repr(pickle.loads(pickle.dumps(value))), repr(value))
        self.assertEqual(pickle.loads(pickle.dumps(quincunx.Error(3, "a sentence"))).code, 3)

    def forked(self, before, inside):
        """Runs Python that forks after `before`, `inside` in the child, which must end as Python does."""
        code = ("import os, signal, sys, numpy, quincunx\n"
                "frame, table = numpy.ones((6, 8, 4)), quincunx.CostTable()\n"
                "def made(): return quincunx.Resolver((8, 6), method='point', present=0)\n"
                f"{before}\nif child := os.fork():\n    assert os.waitpid(child, 0)[1] == 0\n    {before}\n"
                f"else:\n    signal.alarm(60)\n    {inside}\n    sys.exit(0)\n")
        run = subprocess.run([sys.executable, "-W", "ignore::DeprecationWarning", "-c", code], capture_output=True,
                             text=True, check=False, timeout=120)  # Python 3.12 warns of threads and fork()
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        return run.stdout

    def test_a_forked_process_ends_and_leaves_the_device_alone(self):
        use = "resolver = made(); assert resolver.resolve(frame).min() == 1"
        self.forked(use, "del resolver; table.record(1, 0.5, 4); assert table.predict(0.5) == 4")
        told = self.forked(use, """
    for use in (lambda: resolver.resolve(frame), resolver.reports, resolver.device, made,
                lambda: quincunx.ErrorFront(resolver=resolver), resolver.allow_timing_waits):
        try:
            print(use())
        except quincunx.Error as error:
            print(error)""")
        self.assertEqual(told.splitlines(), [
            "OpenCL does not work in this process, which was forked from one that had used a device; start it by "
            "multiprocessing's method 'spawn'"] * 6)
        self.forked("pass", use)  # before the first device


class Log(unittest.TestCase):
    def test_lines_go_to_logging(self):
        no_cache = {**os.environ, "QUINCUNX_CACHE_DIR": ""}  # so that the device's clock is measured, which is told
        code = ("import logging, sys, quincunx\n"
                "logging.basicConfig(stream=sys.stdout, level='DEBUG', format='%(levelname)s %(name)s %(message)s')\n"
                "quincunx.Resolver((8, 8), method='point')")
        run = subprocess.run([sys.executable, "-c", code], env=no_cache, capture_output=True, text=True, check=True)
        self.assertRegex(run.stdout, r"(?m)^(DEBUG|INFO) quincunx pass times of '.+': ")
        self.assertEqual(run.stderr, "")


class Example(unittest.TestCase):
    """docs/examples/sequence.py, with smaller pictures."""

    def test_it_resolves_a_sequence(self):
        code = read(ROOT, "docs", "examples", "sequence.py")
        self.assertIn("(1280, 720)", code)
        size, count = (128, 72), 24
        with tempfile.TemporaryDirectory() as folder:
            names = [os.path.join(folder, "%04d.npz" % i) for i in range(count)]
            for i, name in enumerate(names):
                jitter = quincunx.jitter(i, (64, 36), size)
                np.savez(name, colour=sampled(64, 36, jitter), depth=np.full((36, 64), 0.5),
                         velocity=np.zeros((36, 64, 2)), jitter=jitter)
            with unittest.mock.patch("sys.argv", ["sequence.py", folder, *names]):
                exec(code.replace("(1280, 720)", str(size)), {})  # pylint: disable=exec-used
            pictures = [np.load(os.path.join(folder, "picture.%04d.npy" % i)) for i in range(count)]
        truth = sampled(*size)
        self.assertLess(rms(pictures[-1], truth), rms(bilinear(sampled(64, 36), *size), truth) / 4)
        self.assertLess(rms(pictures[-1], truth), rms(pictures[0], truth) / 2)


def write_exr(path, channels, attributes=()):
    """A plain OpenEXR file of float32: {name: plane}, and attributes as (name, type, bytes)."""
    def text(*words):
        return b"".join(word.encode() + b"\0" for word in words)

    height, width = next(iter(channels.values())).shape
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    names = b"".join(text(name) + struct.pack("<4i", 2, 0, 1, 1) for name in sorted(channels)) + b"\0"
    header = b"".join(text(name, kind) + struct.pack("<i", len(value)) + value for name, kind, value in (
        ("channels", "chlist", names), ("compression", "compression", b"\0"), ("dataWindow", "box2i", box),
        ("displayWindow", "box2i", box), ("lineOrder", "lineOrder", b"\0"),
        ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", bytes(8)),
        ("screenWindowWidth", "float", struct.pack("<f", 1)), *attributes)) + b"\0"
    planes = np.stack([channels[name] for name in sorted(channels)], axis=1).astype("<f4")  # a row's, side by side
    start, size = 8 + len(header) + 8 * height, planes[0].nbytes
    with open(path, "wb") as file:
        file.write(struct.pack("<2i", 20000630, 2) + header)
        file.write(struct.pack(f"<{height}Q", *(start + y * (size + 8) for y in range(height))))
        for y in range(height):
            file.write(struct.pack("<2i", y, size) + planes[y].tobytes())


@unittest.skipUnless(os.environ.get("QUINCUNX_RESOLVE"), "it was built without the programs")
class Sequence(unittest.TestCase):
    """resolve_sequence(): nine still frames, with their truth, one way and both."""

    SIZE, FRAME, COUNT = (128, 72), (64, 36), 9

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.pattern = lambda name: os.path.join(folder.name, name + ".%04d.exr")
        zeros = np.zeros(self.FRAME[::-1])
        still = {"Z": zeros + 4, **{name: zeros for name in ("backward.u", "backward.v", "forward.u", "forward.v")}}
        truth = dict(zip("RGB", np.moveaxis(sampled(*self.SIZE), 2, 0)))
        for number in range(self.COUNT):
            jitter = quincunx.jitter(number, self.FRAME, self.SIZE)
            colour = dict(zip("RGB", np.moveaxis(sampled(*self.FRAME, jitter), 2, 0)))
            write_exr(self.pattern("f") % number, {**colour, **still},
                      [("quincunx:jitter", "v2f", struct.pack("<2f", *jitter))])
            write_exr(self.pattern("truth") % number, truth)

    def resolve(self, *out, **options):
        return quincunx.resolve_sequence(self.pattern("f"), *out, program=os.environ["QUINCUNX_RESOLVE"],
                                         **{"output": self.SIZE, **options})

    def test_both_ways_are_better_than_one(self):
        def first_score(report):
            self.assertEqual(len(report["frames"]), self.COUNT)
            return report["scores"]["frames"][0]["psnr_tone_mapped"]

        one, two = (self.resolve(truth=self.pattern("truth"), two_way=two_way) for two_way in (0, 8))
        self.assertGreater(first_score(two), first_score(one) + 2)
        written = self.resolve(self.pattern("u"), two_way=8, frames="2-4", resume=True, sharpen=None)
        self.assertEqual([row["index"] for row in written["frames"]], [2, 3, 4])
        self.assertTrue(os.path.exists(self.pattern("u") % 4))
        self.assertEqual(self.resolve(self.pattern("u"), two_way=8, frames="2-4", resume=True), {})

    def test_errors_are_the_programs_sentences(self):
        with self.assertRaisesRegex(quincunx.Error, "--two-way") as refused:
            self.resolve(self.pattern("u"), two_way=65)
        self.assertEqual(refused.exception.code, 1)
        os.remove(self.pattern("f") % 3)
        with self.assertRaisesRegex(quincunx.Error, "^frame 3 is missing: ") as failed:
            self.resolve(self.pattern("u"))
        self.assertEqual(failed.exception.code, 4)
        with self.assertRaises(OSError):
            quincunx.resolve_sequence("f.%04d.exr", program="no-such-program")

    def test_what_the_program_prints_is_given_as_it_is(self):
        for option, words in (("explain", "resolve_temporal"), ("help", "--output"), ("list_devices", "\n")):
            text = self.resolve(**{option: True})
            self.assertIsInstance(text, str)
            self.assertIn(words, text)
        report = self.resolve(self.pattern("u"), json=True, quiet=True, method="bilinear", velocity_scale=(-1, 1),
                              output=np.array(self.SIZE))
        self.assertEqual(len(report["frames"]), self.COUNT)


class Errors(unittest.TestCase):
    def test_what_the_library_refuses_is_its_sentence(self):
        resolver = quincunx.Resolver((40, 30), method="bilinear", present=0)
        with self.assertRaisesRegex(quincunx.Error, "render_width x render_height is 50x20; it must lie within 1x1 and the target's 40x30"):
            resolver.resolve(np.zeros((20, 50, 4)))
        with self.assertRaisesRegex(quincunx.Error, "velocity is missing; the plan needs it as RG32F"):
            quincunx.Resolver((40, 30), transparents=False).resolve(np.zeros((20, 30, 4)))
        with self.assertRaises(quincunx.Error) as refused:
            quincunx.Resolver((0, 30))
        self.assertEqual(refused.exception.code, 1)
        with self.assertRaisesRegex(quincunx.Error, "no OpenCL device matches 'none such'"):
            quincunx.Resolver((40, 30), device="none such")

    def test_what_python_refuses_says_what_would_be_right(self):
        def made(**settings):
            return quincunx.Resolver((40, 30), **{"method": "point", **settings})

        frame = np.zeros((20, 30, 4))
        controller = quincunx.PredictiveController(output_extent=(64, 64))
        for kind, sentence, refused in (
                (quincunx.Error, "no method 'best'; there are point, .*temporal:fast", lambda: made(method="best")),
                (TypeError, "'sharp' is no setting; there are: .*sharpness", lambda: made(sharp=1)),
                (TypeError, "'min_output_width' is no setting; .* min_output_extent", lambda: made(min_output_width=9)),
                (TypeError, "dither is None; it must be a whole number", lambda: made(dither=None)),
                (TypeError, r"blur_samples is 8\.5; it must be a whole number", lambda: made(blur_samples=8.5)),
                (ValueError, "target_width is 4294967300; it must be a whole number of 32 bits",
                 lambda: made(target_extent=(2 ** 32 + 4, 30))),
                (ValueError, "shutter is 'long'; it must be a number", lambda: made(shutter="long")),
                (ValueError, "focus_extent is 8; it must be a pair of numbers", lambda: made(focus_extent=8)),
                (ValueError, "output_extent is 8; it must be a pair of numbers", lambda: quincunx.Resolver(8)),
                (ValueError, "colour is 'float64'; it must be one of uint8, float16, float32",
                 lambda: made(colour="float64")),
                (ValueError, "temporal_view is 'all'; it must be one of picture, conf",
                 lambda: made(temporal_view="all")),
                (ValueError, "history_format is 'int'; it must be one of float16", lambda: made(history_format="int")),
                (ValueError, r"colour has the shape \(20, 30, 2\); it must be \(height, width, 4\)",
                 lambda: made().resolve(frame[:, :, :2])),
                (ValueError, r"clip_to_previous_clip has the shape \(3, 4\); it must be \(4, 4\) or \(16,\)",
                 lambda: made().resolve(frame, clip_to_previous_clip=np.zeros((3, 4)))),
                (ValueError, r"focus\.rectangles is \[\(1, 2\)\]; each must have 4 numbers",
                 lambda: made().resolve(frame, focus={"colour": frame, "rectangles": [(1, 2)]})),
                (TypeError, r"focus\.rectangles is 0\.5; it must be a whole number",
                 lambda: made().resolve(frame, focus={"colour": frame, "rectangles": [(1, 2, 3, 0.5)]})),
                (ValueError, r"particles\.depth is uint8 from 1 to 1; it must be float32", lambda: made().resolve(
                    frame, particles={"colour": frame, "depth": np.ones((20, 30), np.uint8)})),
                (TypeError, "particles is 1; it must be of dict", lambda: made().resolve(frame, particles=1)),
                (TypeError, "'width' is no field of Particles", lambda: made().resolve(frame, particles={"width": 1})),
                (TypeError, "frame_index is 1.5; it must be a whole", lambda: quincunx.jitter(1.5, (8, 8), (8, 8))),
                (TypeError, "gpu_ms is None; it must be a number", lambda: quincunx.CostTable().record(1, 0.5, None)),
                (ValueError, r"share has the shape \(2,\); it must be \(6,\)",
                 lambda: quincunx.ErrorFront().flip((1, 2), "temporal", 0.5)),
                (ValueError, "velocity_scale is 2; it must be a pair", lambda: made().resolve(frame, velocity_scale=2)),
                (TypeError, r"frame_index is \[\]; it must be a whole number",
                 lambda: made().resolve(frame, frame_index=[])),
                (ValueError, "frame_index is -1; it must be a whole number of 64 bits, from 0 on",
                 lambda: made().resolve(frame, frame_index=-1)),
                (TypeError, "'cpu' is no field of Timing; there are: .* cpu_ms",
                 lambda: controller.observe(1, (8, 8), 9, cpu=1)),
                (TypeError, "'speed' is no field of Content; there are: moving, speed_px, .* judged$",
                 lambda: quincunx.mix_of(speed=1)),
                (TypeError, "calibration is '{}'; it must be of CostTable",
                 lambda: quincunx.PredictiveController(calibration="{}", output_extent=(8, 8))),
                (TypeError, "front is 1; it must be of ErrorFront",
                 lambda: quincunx.QualityController(front=1, output_extent=(8, 8))),
                (TypeError, "json is {}; it must be text", lambda: quincunx.CostTable(json={})),
                (TypeError, "a name in methods is 1; it must be text",
                 lambda: quincunx.QualityController(methods=[1], output_extent=(8, 8))),
                (TypeError, "resolver is 'gpu'; it must be of Resolver", lambda: quincunx.ErrorFront(resolver="gpu")),
                (quincunx.Error, "cost table: it must be the JSON that a table gave",
                 lambda: quincunx.CostTable(json="x")),
                (quincunx.Error, "error front: it must be the JSON that a front gave",
                 lambda: quincunx.ErrorFront(json="x"))):
            with self.subTest(sentence), self.assertRaisesRegex(kind, sentence):
                refused()

    def test_names_stand_for_numbers_and_pairs(self):
        names = quincunx.names_of("settings")
        self.assertEqual(names["min_output_extent"], ["min_output_width", "min_output_height"])
        self.assertEqual([name for name in names if "padding" in name or name in ("struct_size", "kind")], [])
        for name in names:
            self.assertIn(name, quincunx.Resolver.__doc__)
        self.assertIn("history_format (float16 | float32)", quincunx.Resolver.__doc__)
        resolver = quincunx.Resolver((8, 6), device=0, history_format="float32", temporal_view="confidence",
                                     storage="image2d", transparents=False)
        self.assertIn("image storage", str(resolver))
        self.assertRegex(repr(resolver.needs), r"^Needs\(reads_depth=1, reads_velocity=1, .*frame_bytes=\d+\)$")

    def test_a_pair_of_velocity_scales_counts_for_its_axes(self):
        def second(velocity, **inputs):
            resolver = quincunx.Resolver((40, 30), method="quincunx", present=0, transparents=False)
            for value in (0, 1):
                picture = resolver.resolve(np.full((30, 40, 4), value), depth=np.full((30, 40), 0.5),
                                           velocity=velocity, **inputs)
            return picture

        velocity = np.full((30, 40, 2), [4 / 40, 2 / 30], np.float32)
        np.testing.assert_array_equal(second(velocity / [2, 4], velocity_scale=(2, 4)), second(velocity))
        self.assertGreater(np.abs(second(velocity / [2, 4], velocity_scale=(4, 2)) - second(velocity)).max(), 0.01)


if __name__ == "__main__":
    unittest.main()
