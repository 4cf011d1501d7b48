# SPDX-License-Identifier: MIT
"""The Blender add-on without Blender: what it changes for a render, and that it puts everything back, come what may."""
import contextlib
import filecmp
import io
import os
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, "fake"), os.path.join(HERE, "../../host/tools/blender")]

import bpy  # noqa: E402
import quincunx_blender as addon  # noqa: E402

EXTENSION = os.environ.get("QUINCUNX_EXTENSION")  # the zip

# In place of quincunx-resolve: makes the results, or fails as it does. It says what it was called with.
PROGRAM = """#!/bin/sh
case "$*" in
  *wrong*) echo "--wrong: no such option" >&2; exit 2;;
  *--dry-run) exit 1;;
  *bad*) echo "error: frame 1 is damaged" >&2; exit 1;;
  *silent*) exit 3;;
esac
echo "$*" >> ../called
echo "warning: the sky stands still" >&2
while [ $# -gt 0 ]; do
  case "$1" in --out) out=$2;; --frames) frames=$2;; --jitter) [ ! -f "$2" ] || cp "$2" ../jitter;; esac
  shift
done
for frame in $(seq "${frames%-*}" "${frames#*-}"); do echo made > "$(printf "$out" "$frame")"; done
"""


class AddOn(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.program = os.path.join(self.folder, "resolve")
        with open(self.program, "w", encoding="ascii") as file:
            file.write(PROGRAM)
        os.chmod(self.program, 0o755)
        bpy.reset(self.folder)
        self.scene = bpy.context.scene

    def shot(self):
        return addon.Shot(self.scene, bpy.context.view_layer, self.scene.quincunx)

    def run_addon(self, **choices):
        """The exit's sentence, or None; stdout and stderr."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                addon.run(**{"program": self.program, **choices})
            except SystemExit as end:
                return end.code, out.getvalue(), err.getvalue()
        return None, out.getvalue(), err.getvalue()

    def expect_failure(self, part, options="", **arguments):
        """One sentence; the scene, its cameras and Blender's handlers are as they were."""
        self.scene.quincunx.options = options
        before = self.state()
        sentence, out, _ = self.run_addon(**arguments)
        self.assertIsNotNone(sentence, out)
        self.assertIn(part, sentence)
        self.assertNotIn("\n", sentence)
        self.assertEqual(self.state(), before)

    def state(self):
        handlers = bpy.app.handlers
        return bpy.describe([self.scene, bpy.data.cameras]), handlers.render_complete[:], handlers.render_cancel[:]

    def when_rendering(self, act):
        """`act` takes the place of Blender's render."""
        bpy.ops.render.render = act

    def entries(self):
        return sorted(os.listdir(self.folder))


class Rendering(AddOn):
    def test_all_is_set_for_the_render_and_put_back(self):
        before, seen = self.state(), {}

        def render(**how):
            seen.update(how=how, **bpy.describe(self.scene))
            return bpy.render_files()

        self.when_rendering(render)
        sentence, out, err = self.run_addon()
        self.assertIsNone(sentence, out)
        self.assertEqual(self.state(), before)
        self.assertEqual(seen["how"], {"animation": True, "scene": "Scene"})
        render, image = seen["render"], seen["render"]["image_settings"]
        self.assertEqual((render["resolution_x"], render["resolution_y"]), (32, 18))
        self.assertEqual(render["filepath"], os.path.join(self.folder, "shot_small/frame.####"))
        for name in ("use_motion_blur", "use_compositing", "use_sequencer", "use_placeholder"):
            self.assertFalse(render[name], name)
        for name in ("use_file_extension", "use_overwrite", "use_lock_interface"):
            self.assertTrue(render[name], name)
        self.assertEqual([image[name] for name in ("file_format", "color_mode", "color_depth", "exr_codec")],
                         ["OPEN_EXR_MULTILAYER", "RGBA", "32", "ZIP"])
        layer, cycles = seen["view_layers"][0], seen["cycles"]
        self.assertTrue(layer["use_pass_combined"] and layer["use_pass_z"] and layer["use_pass_vector"])
        self.assertTrue(layer["cycles"]["denoising_store_passes"])
        self.assertEqual((cycles["filter_width"], cycles["pixel_filter_type"]), (0.01, "BLACKMAN_HARRIS"))
        self.assertTrue(cycles["use_animated_seed"])
        self.assertEqual(err, "quincunx: the sky stands still\n")
        self.assertEqual((seen["frame_start"], seen["frame_end"]), (1, 11), "8 beyond the last of 3")
        self.assertIn("11 frames of 32x18 rendered", out)
        self.assertIn("3 of 64x36 made of them", out)

    def test_results_are_loaded_and_small_frames_removed(self):
        self.run_addon()
        self.assertEqual(self.entries(), ["called", "resolve", "shot_0001.exr", "shot_0002.exr", "shot_0003.exr"])
        image = bpy.data.images.loaded[0]
        self.assertEqual((image.path, image.source), (os.path.join(self.folder, "shot_0001.exr"), "SEQUENCE"))

    def test_small_frames_are_kept_when_asked_for_and_older_ones_removed(self):
        os.mkdir(os.path.join(self.folder, "shot_small"))
        for name in ("frame.0099.exr", "mine.exr"):
            with open(os.path.join(self.folder, "shot_small", name), "w", encoding="ascii"):
                pass
        self.run_addon(keep=True)
        self.assertEqual(sorted(os.listdir(os.path.join(self.folder, "shot_small"))),
                         [*(f"frame.{frame:04}.exr" for frame in range(1, 12)), "mine.exr"])

    def test_cameras_are_jittered_about_their_own_shift(self):
        bpy.reset(self.folder)
        self.scene = bpy.context.scene
        moving, still = bpy.Camera(moves=True), bpy.Camera(data=bpy.CameraData(shift_x=0.25, shift_y=-0.5))
        self.scene.camera = moving
        self.scene.timeline_markers.append(bpy.Owner(frame=3, camera=still))
        before, seen = self.state(), {}

        def render(**_):
            for name, camera in (("moving", moving), ("still", still)):
                seen[name] = {path: curve.keys for path, curve in camera.data.curves.items()}
                for curve in camera.data.curves.values():
                    self.assertEqual((curve.driver.expression, curve.modifiers), ("frame", []))
            return bpy.render_files()

        self.when_rendering(render)
        self.assertIsNone(self.run_addon()[0])
        self.assertEqual(self.state(), before)
        for frame in range(0, 13):
            x, y = addon.jitter_of(frame, (32, 18), (64, 36))
            self.assertAlmostEqual(seen["moving"]["shift_x"][frame], frame / 100 + x / 32)
            self.assertAlmostEqual(seen["moving"]["shift_y"][frame], -y / 32)
            self.assertAlmostEqual(seen["still"]["shift_x"][frame], 0.25 + x / 32)
            self.assertAlmostEqual(seen["still"]["shift_y"][frame], -0.5 - y / 32)
        with open(os.path.join(self.folder, "called"), encoding="ascii") as file:
            self.assertRegex(file.read(), "--frames 1-3 .*--cuts 3 ")

    def test_frames_beyond_the_shot_are_those_that_two_way_looks_at(self):
        for options, last in (("", 11), ("--two-way 0", 3), ("--sharpen 0.3 --two-way=4", 7)):
            self.scene.quincunx.options = options
            self.assertEqual((self.shot().frames, self.shot().results), (range(1, last + 1), range(1, 4)), options)
        self.scene.quincunx.options = ""
        for cut in (6, 9):
            self.scene.timeline_markers.append(bpy.Owner(frame=cut, camera=bpy.Camera()))
        self.assertEqual(self.shot().frames, range(1, 6), "what another camera sees comes not into it")
        self.assertNotIn("--cuts", self.shot().command("p"))
        self.scene.frame_end = 0
        self.assertEqual(list(self.shot().frames), [])

    def test_what_a_version_lacks_is_left_alone_and_what_another_has_is_set(self):
        del self.scene.render.image_settings.__dict__["color_management"]
        self.scene.render.image_settings.__dict__["media_type"] = "IMAGE"
        before, seen = self.state(), []

        def render(**_):
            seen.append(self.scene.render.image_settings.media_type)
            return bpy.render_files()

        self.when_rendering(render)
        self.assertIsNone(self.run_addon()[0])
        self.assertEqual(seen, ["MULTI_LAYER_IMAGE"])
        self.assertEqual(self.state(), before)


    def test_a_preview_is_one_frame_of_its_neighbours(self):
        self.scene.frame_end, self.scene.frame_current = 20, 3
        self.scene.timeline_markers.append(bpy.Owner(frame=2, camera=bpy.Camera()))
        before, seen = self.state(), []

        def render(**_):
            seen.append((self.scene.frame_start, self.scene.frame_end))
            return bpy.render_files()

        self.when_rendering(render)
        sentence, out, _ = self.run_addon(preview=True)
        self.assertIsNone(sentence, out)
        self.assertEqual(self.state(), before)
        self.assertEqual(seen, [(2, 11)], "8 frames on each side, but none from before a change of camera")
        seen.clear()
        self.scene.frame_current = 17
        self.assertIsNone(self.run_addon(preview=True)[0])
        self.assertEqual(seen, [(9, 25)], "it sees beyond the shot's end as the shot does")
        self.scene.frame_current = 3
        self.assertEqual(self.entries(), ["called", "preview_shot_0003.exr", "preview_shot_0017.exr", "resolve"])
        with open(os.path.join(self.folder, "called"), encoding="ascii") as file:
            self.assertIn("--frames 3-3 ", file.read())
        self.assertEqual(bpy.data.images.loaded[0].source, "FILE")
        self.scene.frame_current = 21
        self.expect_failure("The current frame, 21, is not in the shot, which has frames 1 to 20.", preview=True)

    def test_a_draft_comes_first_with_the_jitter_of_the_small_frames(self):
        editors = [bpy.Owner(type="IMAGE_EDITOR", spaces=bpy.Owner(active=bpy.Owner(image=None, image_user=bpy.Owner(
            frame_start=0, frame_duration=0, frame_offset=0, use_auto_refresh=False)))) for _ in range(2)]
        bpy.context.window_manager.windows.append(bpy.Owner(screen=bpy.Owner(areas=editors)))
        self.assertIsNone(self.run_addon(draft=True)[0])
        names = [f"{kind}shot_000{frame}.exr" for kind in ("draft_", "") for frame in (1, 2, 3)]
        self.assertEqual(self.entries(), ["called", *names[:3], "jitter", "resolve", *names[3:]])
        with open(os.path.join(self.folder, "called"), encoding="ascii") as file:
            draft, full = file.read().splitlines()
        self.assertIn("--output 32x18 ", draft)
        self.assertIn("--output 64x36 ", full)
        with open(os.path.join(self.folder, "jitter"), encoding="ascii") as file:
            found = [[float(word) for word in line.split()] for line in file]
        self.assertEqual(found, [[frame, *addon.jitter_of(frame, (32, 18), (64, 36))] for frame in range(1, 12)])
        shown = [os.path.basename(area.spaces.active.image.path) for area in editors]
        self.assertEqual(shown, ["shot_0001.exr", "draft_shot_0001.exr"])


@unittest.skipIf(EXTENSION is None, "shared libraries make no extension")
class Extension(AddOn):
    """The zip, unpacked as Blender does: without the files' modes."""

    def setUp(self):
        super().setUp()
        with zipfile.ZipFile(EXTENSION) as packed:
            packed.extractall(self.folder)
        self.old, addon.__file__ = addon.__file__, os.path.join(self.folder, "__init__.py")

    def tearDown(self):
        addon.__file__ = self.old

    def test_it_has_what_its_manifest_says(self):
        self.assertTrue(filecmp.cmp(self.old, addon.__file__, shallow=False))
        with open(os.path.join(self.folder, "blender_manifest.toml"), "rb") as file:
            manifest = tomllib.load(file)
        self.assertEqual((manifest["id"], manifest["type"], manifest["blender_version_min"]),
                         ("quincunx", "add-on", "4.2.0"))
        self.assertEqual(manifest["version"], ".".join(map(str, addon.bl_info["version"])))
        with contextlib.suppress(FileNotFoundError):  # where Blender is not installed
            about = subprocess.run(["blender", "--version"], capture_output=True, text=True, check=True).stdout
            if tuple(map(int, re.search(r"(\d+)\.(\d+)", about).groups())) >= (4, 2):
                subprocess.run(["blender", "--command", "extension", "validate", EXTENSION], check=True)

    def test_its_program_runs_by_itself(self):
        own = addon.program_named("")
        self.assertEqual(own, os.path.join(self.folder, "bin", addon.PROGRAM))
        self.assertEqual(addon.program_named(self.program), self.program, "what the user chose comes first")
        version = subprocess.run([own, "--version"], capture_output=True, text=True, check=True, env={}).stdout
        self.assertIn(".".join(map(str, addon.bl_info["version"])), version)
        loaded = subprocess.run([own], capture_output=True, text=True, check=True,
                                env={"LD_TRACE_LOADED_OBJECTS": "1"}).stdout
        for name, path in re.findall(r"(\S+) => (\S+)", loaded):
            with self.subTest(name):
                self.assertEqual(os.path.dirname(os.path.realpath(path)) != os.path.join(self.folder, "lib"),
                                 bool(re.match(r"lib(c|m|z|gcc_s|stdc\+\+|asan|ubsan)\.so", name)))


class Failing(AddOn):
    def test_an_abort_ends_the_program_and_leaves_what_is_whole(self):
        with open(self.program, "w", encoding="ascii") as file:
            file.write("""#!/bin/sh
case "$*" in *--dry-run) exit 1;; esac
echo made > ../shot_0001.exr
exec sleep 60
""")
        job = addon.Job(bpy.context, self.program)
        before = self.state()
        try:
            job.begin()
            job.render()
            while not job.step() and job.progress()[0] == 0:
                pass
        finally:
            job.end()
        self.assertIsNotNone(job.resolving.process.returncode, "it has ended")
        self.assertEqual(self.state(), before)
        self.assertEqual(self.entries(), ["resolve", "shot_0001.exr", "shot_small"])

    def test_a_render_that_fails(self):
        def render(**_):
            raise RuntimeError("Error: out of memory\n")

        self.when_rendering(render)
        self.expect_failure("The render failed: Error: out of memory")

    def test_a_render_that_is_cancelled(self):
        for said in ("FINISHED", "CANCELLED"):  # by Blender 3 and 4
            def render(said=said, **_):
                for handler in list(bpy.app.handlers.render_cancel):
                    handler(self.scene)
                return {said}

            self.when_rendering(render)
            self.expect_failure("The render was cancelled")
        self.when_rendering(lambda **_: {"CANCELLED"})
        self.expect_failure("could not be started")

    def test_a_render_without_all_frames(self):
        def render(**_):
            bpy.render_files()
            os.remove(os.path.join(self.folder, "shot_small/frame.0002.exr"))
            return {"FINISHED"}

        self.when_rendering(render)
        self.expect_failure("Frame 2 was not rendered")

    def test_an_interrupt(self):
        def render(**_):
            raise KeyboardInterrupt

        self.when_rendering(render)
        before = self.state()
        with self.assertRaises(KeyboardInterrupt):
            self.run_addon()
        self.assertEqual(self.state(), before)

    def test_a_setting_that_blender_refuses_halfway(self):
        class Stubborn(bpy.Owner):
            def __setattr__(self, name, value):
                if value == 0.01:
                    raise TypeError("out of range")
                super().__setattr__(name, value)

        self.scene.__dict__["cycles"] = Stubborn(**self.scene.cycles.__dict__)
        self.when_rendering(lambda **_: self.fail("rendered"))
        self.expect_failure("Blender refuses 0.01 for filter_width: out of range")

    def test_a_setting_that_cannot_be_put_back_keeps_no_other_from_it(self):
        class Sticky(bpy.Owner):
            def __setattr__(self, name, value):
                if value == 1.5:
                    raise TypeError("out of range")
                super().__setattr__(name, value)

        self.scene.__dict__["cycles"] = Sticky(**self.scene.cycles.__dict__)
        before = self.state()
        self.assertEqual(self.run_addon()[0], "quincunx: These settings could not be put back: filter_width.")
        self.scene.cycles.__dict__["filter_width"] = 1.5
        self.assertEqual(self.state(), before)

    def test_the_program_is_missing_or_fails(self):
        self.expect_failure("There is no program '/nonesuch'", program="/nonesuch")
        self.assertNotIn("shot_small", self.entries())
        self.expect_failure("quincunx-resolve failed: frame 1 is damaged", options="--bad")
        self.assertIn("shot_small", self.entries(), "what was rendered is not lost")
        self.expect_failure("quincunx-resolve failed: exit status 3.", options="--silent")
        self.assertEqual(bpy.data.images.loaded, [])

    def test_options_are_refused_before_the_render(self):
        self.when_rendering(lambda **_: self.fail("rendered"))
        self.expect_failure("quincunx-resolve refuses its options: --wrong: no such option", options="--wrong")
        self.expect_failure("end in the middle", options='--device "gpu')
        self.assertEqual(self.entries(), ["resolve"], "no folder, and frames of an earlier run would still be there")

    def test_a_folder_that_cannot_be_made(self):
        self.scene.render.filepath = os.path.join(self.program, "shot_")
        self.expect_failure("The small frames have no place")

    def test_choices(self):
        before = self.state()
        self.assertIn("There is no choice 'colour'", self.run_addon(colour=1)[0])
        self.assertIn("percent", self.run_addon(percent="half")[0])
        self.assertEqual(self.state(), before)

    def test_what_stands_in_the_way(self):
        second = bpy.Owner(name="Second", use=True)
        for part, owner, name, value in [
                ("engine is BLENDER_EEVEE", self.scene.render, "engine", "BLENDER_EEVEE"),
                ("no camera", self.scene, "camera", None),
                ("another object", self.scene.camera, "type", "EMPTY"),
                ("panoramic", self.scene.camera.data, "type", "PANO"),
                ("linked", self.scene.camera, "library", "other.blend"),
                ("last frame, 0", self.scene, "frame_end", 0),
                ("frame step is 2", self.scene, "frame_step", 2),
                ("Time is stretched", self.scene.render, "frame_map_new", 200),
                ("Render Region", self.scene.render, "use_border", True),
                ("Stereoscopy", self.scene.render, "use_multiview", True),
                ("View layers on: ViewLayer, Second;", self.scene, "view_layers", [bpy.context.view_layer, second]),
                ("one run of #", self.scene.render, "filepath", "/tmp/a#b#"),
                ("no % or @", self.scene.render, "filepath", "/tmp/50%_"),
                ("open for 3 frames", self.scene.render, "motion_blur_shutter", 3.0)]:
            with self.subTest(part):
                old = owner.__dict__[name]
                owner.__dict__[name] = value
                self.expect_failure(part)
                owner.__dict__[name] = old
        self.assertEqual(self.entries(), ["resolve"])


class Arithmetic(AddOn):
    def test_the_jitter_has_as_many_places_as_the_scale_needs_about_their_mean(self):
        for percent, places in ((50, 32), (100, 8), (25, 128)):
            small = addon.small_size((64, 36), percent)
            all_places = [addon.jitter_of(frame, small, (64, 36)) for frame in range(places)]
            self.assertEqual(len(set(all_places)), places)
            self.assertEqual(addon.jitter_of(places, small, (64, 36)), all_places[0])
            for axis in (0, 1):
                self.assertAlmostEqual(sum(place[axis] for place in all_places), 0)

    def test_a_shift_is_a_part_of_the_side_that_the_lens_fits(self):
        self.assertEqual(addon.shift_of((0.5, 0.25), (32, 18), (1, 1), "AUTO"), (0.5 / 32, -0.25 / 32))
        self.assertEqual(addon.shift_of((0.5, 0.25), (18, 32), (1, 1), "AUTO"), (0.5 / 32, -0.25 / 32))
        self.assertEqual(addon.shift_of((0.5, 0.25), (32, 18), (1, 1), "VERTICAL"), (0.5 / 18, -0.25 / 18))
        self.assertEqual(addon.shift_of((0.5, 0.25), (18, 32), (1, 1), "HORIZONTAL"), (0.5 / 18, -0.25 / 18))
        # Pixels twice as high as wide: 32 of them are 64 units, of which one pixel's height is 2.
        self.assertEqual(addon.shift_of((0.5, 0.25), (50, 32), (1, 2), "AUTO"), (0.5 / 64, -0.5 / 64))

    def test_small_frames_show_what_full_ones_do(self):
        for full, aspect in (((455, 255), (1, 1)), ((160, 91), (1, 1.5)), ((7, 1000), (2, 1))):
            small = addon.small_size(full, 50)
            made = addon.small_aspect(small, full, aspect)
            self.assertAlmostEqual(small[0] * made[0] / (small[1] * made[1]),
                                   full[0] * aspect[0] / (full[1] * aspect[1]))
            self.assertAlmostEqual(min(made), 1)

    def test_results_have_the_name_that_blender_gives(self):
        for path, name in (("shot_", "shot_0007.exr"), ("a.##.v2", "a.07.v2.exr"), ("b.PNG", "b0007.exr"),
                           ("", "0007.exr")):
            self.scene.render.filepath = os.path.join(self.folder, path)
            self.assertEqual(self.shot().result(7), os.path.join(self.folder, name))

    def test_the_percentage_of_the_resolution_counts_and_blur_is_made_afterwards(self):
        self.scene.render.resolution_percentage = 50
        self.assertEqual((self.shot().full, self.shot().small), ((32, 18), (16, 9)))
        words = self.shot().command("p")
        self.assertEqual(words[words.index("--blur") + 1], "0.5")
        self.assertEqual(words[words.index("--output") + 1], "32x18")
        self.scene.render.use_motion_blur = False
        self.assertNotIn("--blur", self.shot().command("p"))

    def test_noise_is_taken_out_once(self):
        words = self.shot().command("p")
        self.assertEqual(words[words.index("--noise") + 1], "auto")
        self.scene.quincunx.options = "--noise 3"
        self.assertEqual(self.shot().command("p").count("--noise"), 1)
        self.scene.quincunx.options = ""
        self.scene.cycles.use_denoising = True
        self.assertNotIn("--noise", self.shot().command("p"))


if __name__ == "__main__":
    unittest.main()
