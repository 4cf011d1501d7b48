# SPDX-License-Identifier: MIT
"""Quincunx for Blender: Cycles renders a shot small, and quincunx-resolve makes its frames of full size from it.

The buttons are in Properties > Output > Quincunx. Without a display:

    blender -b shot.blend --addons quincunx_blender --python-expr "import quincunx_blender; quincunx_blender.run()"

This file is the whole add-on. In an extension (Blender 4.2 and later) it is __init__.py, beside the program.

Both take the steps of a Job: check() finds what stands in the way, SmallRender changes the scene, Blender renders,
SmallRender puts every setting back, whether frames were rendered or not, and Resolving runs quincunx-resolve.
"""
import contextlib
import itertools
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import textwrap
import time

import bpy

bl_info = {
    "name": "Quincunx",
    "description": "Render small, resolve to full size",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Output > Quincunx",
    "category": "Render",
}

PROGRAM = "quincunx-resolve"
FILTER_WIDTH = 0.01  # pixels, the least that Cycles takes: samples then lie at one place, the jittered centre
JITTER_FILE = "jitter.txt"  # among the small frames
AHEAD = 8  # frames beyond the shot's last, which knows them as the others know later ones; --two-way of the program
PREVIEW_REACH = 8  # frames on each side of the one to be seen, which accumulates them
LONGEST_SHUTTER = 2  # frames, of --blur
SMALLEST_SIDE = 4  # pixels, of Blender
BAR_LETTERS = 10  # of progress, where the panel may be narrow
WRONG_USAGE = 2  # exit status of quincunx-resolve


REFUSALS = AttributeError, ReferenceError, RuntimeError, TypeError, ValueError  # of Blender, where a setting is set


class Failure(Exception):
    """One sentence for the user: what is wrong, and what would be right."""


# ---- The jitter. Pure.


def radical_inverse(index, base):
    result, weight = 0.0, 1 / base
    while index > 0:
        result += index % base * weight
        index, weight = index // base, weight / base
    return result


def jitter_of(frame, small, full):
    """Where the samples of a frame >= 0 lie: pixels of the small picture from the centre, (+x right, +y down).

    It is --jitter halton of quincunx-resolve: Halton (2, 3) about its mean, as many places as the scale needs.
    """
    places = min(-(-8 * full[0] * full[1] // (small[0] * small[1])), 512)
    mean = [sum(radical_inverse(i, base) / places for i in range(1, places + 1)) for base in (2, 3)]
    place = frame % places + 1
    return radical_inverse(place, 2) - mean[0], radical_inverse(place, 3) - mean[1]


def small_size(full, percent):
    return tuple(max(SMALLEST_SIDE, round(side * percent / 100)) for side in full)


def small_aspect(small, full, aspect):
    """Aspect of the small picture's pixels, with which it shows just what the full one does; none is below 1."""
    wide = [own * of_full / of_small for own, of_full, of_small in zip(aspect, full, small)]
    return tuple(side / min(wide) for side in wide)


def shift_of(jitter, size, aspect, fit):
    """What is added to Shift X and Y of a camera to have samples at `jitter`: parts of the side that the lens fits."""
    height = size[1] * aspect[1] / aspect[0]  # in units of a pixel's width
    fits_width = size[0] >= height if fit == "AUTO" else fit == "HORIZONTAL"
    side = size[0] if fits_width else height
    return jitter[0] / side, -jitter[1] * aspect[1] / aspect[0] / side


# ---- The shot.


class Shot:
    """What is rendered (frames), what is made of it (results), and where to. `choices`: QuincunxSettings.

    `preview`: of the current frame alone, from its neighbours too, with a name of its own.
    """

    def __init__(self, scene, layer, choices, preview=False):
        render = scene.render
        self.scene, self.layer, self.choices = scene, layer, choices
        self.full = tuple(
            int(side * render.resolution_percentage / 100) for side in (render.resolution_x, render.resolution_y))
        self.small = small_size(self.full, choices.percent)
        self.aspect = small_aspect(self.small, self.full, (render.pixel_aspect_x, render.pixel_aspect_y))
        self.results = range(scene.frame_start, scene.frame_end + 1)
        self.cuts = sorted({marker.frame for marker in scene.timeline_markers if marker.camera})
        self.frames = range(scene.frame_start, self.take(scene.frame_end)[1] + 1) if self.results else self.results
        path = bpy.path.abspath(render.filepath)
        self.folder = os.path.dirname(path) or os.getcwd()
        stem = re.sub(r"\.(exr|png|jpe?g|tiff?)$", "", os.path.basename(path), flags=re.IGNORECASE)
        self.stem = stem if "#" in stem else stem + "####"
        self.blur = render.motion_blur_shutter if render.use_motion_blur else 0
        if preview:
            now = scene.frame_current
            first, last = self.take(now) if now in self.results else (now, now - 1)
            self.frames = range(max(first, now - PREVIEW_REACH), min(last, now + PREVIEW_REACH) + 1)
            self.results = range(now, now + 1)
            self.stem = "preview_" + self.stem

    @property
    def small_folder(self):
        return os.path.join(self.folder, re.sub("#+", "", self.stem) + "small")

    def small_file(self, frame):
        return os.path.join(self.small_folder, f"frame.{frame:04}.exr")

    @property
    def drafts(self):
        """For each set of results, in the order in which they are made, whether it is the draft."""
        return (True, False) if self.choices.draft else (False,)

    def stem_of(self, draft):
        return "draft_" + self.stem if draft else self.stem

    def result(self, frame, draft=False):
        name = re.sub("#+", lambda mark: f"{frame:0{len(mark[0])}}", self.stem_of(draft))
        return os.path.join(self.folder, name + ".exr")

    def cameras(self):
        """Those through which the frames are seen, each once."""
        by_markers = [marker.camera for marker in self.scene.timeline_markers if marker.camera]
        return list(dict.fromkeys([self.scene.camera, *by_markers] if self.scene.camera else by_markers))

    def take(self, frame):
        """The first and the last frame about this one that are seen by one camera; some come after the shot's end."""
        said = re.search(r"--two-way[ =](\d+)", self.choices.options)
        end = self.scene.frame_end + (int(said[1]) if said else AHEAD)
        first = max([self.scene.frame_start, *(cut for cut in self.cuts if cut <= frame)])
        return first, min([end, *(cut - 1 for cut in self.cuts if cut > frame)])

    def shift(self, frame, fit):
        return shift_of(jitter_of(frame, self.small, self.full), self.small, self.aspect, fit)

    def command(self, program, draft=False):
        """The words that make the results, in the folder of the small frames. Raises Failure for an open quote."""
        name = self.layer.name
        number = re.sub("#+", lambda mark: f"%0{len(mark[0])}d", self.stem_of(draft))
        size = [(side + 1) // 2 for side in self.full] if draft else self.full
        words = [program, "frame.%04d.exr", "--out", os.path.join(os.pardir, number + ".exr"),
                 "--output", f"{size[0]}x{size[1]}", "--frames", f"{self.results[0]}-{self.results[-1]}",
                 "--method", self.choices.method,
                 "--jitter", JITTER_FILE if draft else "halton", "--sky-motion", "evidence",
                 "--colour", f"{name}.Combined", "--velocity", f"{name}.Vector.X,{name}.Vector.Y",
                 "--velocity-next", f"{name}.Vector.Z,{name}.Vector.W", "--velocity-convention", "blender",
                 "--depth", f"{name}.Depth.Z"]
        cuts = [str(cut) for cut in self.cuts if cut in self.frames]
        if cuts:
            words += ["--cuts", ",".join(cuts)]
        if self.blur > 0:
            words += ["--blur", f"{self.blur:g}"]
        try:
            chosen = shlex.split(self.choices.options)
        except ValueError as error:
            raise Failure(f"The options '{self.choices.options}' end in the middle: {error}.") from error
        if not self.scene.cycles.use_denoising and not any(word.startswith("--noise") for word in chosen):
            words += ["--noise", "auto"]
        return words + chosen


def program_named(choice):
    """The path of what was chosen, else of an extension's own program, else of that in PATH; None without any."""
    if choice:
        return shutil.which(bpy.path.abspath(choice))
    own = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", PROGRAM)
    if os.path.isfile(own) and not os.access(own, os.X_OK):  # Blender unpacks files without their modes
        with contextlib.suppress(OSError):  # another user's
            os.chmod(own, 0o755)
    return shutil.which(own) or shutil.which(PROGRAM)


def obstacles(shot):
    """(whether it stands in the way, the sentence for it) of all that a scene can have."""
    render, scene = shot.scene.render, shot.scene
    layers = [layer.name for layer in scene.view_layers if layer.use]
    cameras = shot.cameras()
    name = os.path.basename(shot.stem)
    return [
        (render.engine != "CYCLES", f"The render engine is {render.engine}; choose Cycles."),
        (not cameras, "The scene has no camera."),
        (any(camera.type != "CAMERA" for camera in cameras), "The scene's camera is no camera but another object."),
        (any(camera.type == "CAMERA" and camera.data.type == "PANO" for camera in cameras),
         "The camera is panoramic; only perspective and orthographic ones have a shift."),
        (any(camera.library for camera in cameras), "The camera is linked from another file; make a library override."),
        (scene.frame_end < scene.frame_start,
         f"The last frame, {scene.frame_end}, comes before the first, {scene.frame_start}."),
        (not shot.frames, f"The current frame, {scene.frame_current}, is not in the shot, which has frames "
                          f"{scene.frame_start} to {scene.frame_end}."),
        (scene.frame_step != 1, f"The frame step is {scene.frame_step}; motion is known for steps of 1 only."),
        (render.frame_map_old != render.frame_map_new, "Time is stretched; set Old and New of Time Stretching alike."),
        (render.use_border, "Render Region is on; turn it off."),
        (render.use_multiview, "Stereoscopy is on; turn it off."),
        (layers != [shot.layer.name], f"View layers on: {', '.join(layers) or 'none'}; keep just {shot.layer.name}."),
        (len(re.findall("#+", name)) > 1 or set("%@") & set(name),
         f"The output's name, '{name}', may have one run of # for the frame's number, and no % or @."),
        (shot.blur > LONGEST_SHUTTER, f"The shutter is open for {shot.blur:g} frames; {LONGEST_SHUTTER} are the most."),
    ]


def check(shot, program):
    """Raises Failure for the first thing that stands in the way. Changes nothing."""
    for stands, sentence in obstacles(shot):
        if stands:
            raise Failure(sentence)
    if not program_named(program):
        raise Failure(f"There is no program '{program or PROGRAM}'; install Quincunx, or set the add-on's Program.")
    shot.command(PROGRAM)  # where options end in the middle


# ---- What is changed for a while.


class SmallRender:
    """The scene while it renders small, jittered frames: try: change() ... finally: restore()."""

    def __init__(self, shot):
        self.shot = shot
        self.old = []  # owner, name and value of each setting
        self.cameras = []  # object, its own data, the jittered copy

    def settings(self):
        """(owner, name, value) of what this version of Blender has, in an order in which each may be set."""
        shot, layer, cycles = self.shot, self.shot.layer, self.shot.scene.cycles
        render, image = shot.scene.render, shot.scene.render.image_settings
        wanted = [
            (shot.scene, "frame_start", shot.frames[0]), (shot.scene, "frame_end", shot.frames[-1]),
            (render, "resolution_x", shot.small[0]), (render, "resolution_y", shot.small[1]),
            (render, "resolution_percentage", 100),
            (render, "pixel_aspect_x", shot.aspect[0]), (render, "pixel_aspect_y", shot.aspect[1]),
            (render, "filepath", os.path.join(shot.small_folder, "frame.####")),
            (render, "use_file_extension", True), (render, "use_overwrite", True), (render, "use_placeholder", False),
            (render, "use_motion_blur", False), (render, "use_compositing", False), (render, "use_sequencer", False),
            (render, "use_lock_interface", True),
            (image, "media_type", "MULTI_LAYER_IMAGE"),  # Blender 5
            (image, "file_format", "OPEN_EXR_MULTILAYER"),  # before those that depend on it
            (image, "color_mode", "RGBA"), (image, "color_depth", "32"), (image, "exr_codec", "ZIP"),
            (image, "color_management", "FOLLOW_SCENE"),
            (layer, "use_pass_combined", True), (layer, "use_pass_z", True), (layer, "use_pass_vector", True),
            (cycles, "pixel_filter_type", "BLACKMAN_HARRIS"), (cycles, "filter_width", FILTER_WIDTH),
            (cycles, "use_animated_seed", True),  # else all frames have the same noise
        ]
        if not cycles.use_denoising:
            wanted.append((layer.cycles, "denoising_store_passes", True))  # albedo, for --noise
        return [setting for setting in wanted if hasattr(setting[0], setting[1])]

    def change(self):
        """Raises Failure where Blender refuses a setting."""
        wanted = self.settings()
        own_shifts = self.own_shifts()  # while all is as it was
        self.old = [(owner, name, getattr(owner, name)) for owner, name, _ in wanted]
        for owner, name, value in wanted:
            try:
                setattr(owner, name, value)
            except REFUSALS as error:
                raise Failure(f"Blender refuses {value!r} for {name}: {error}") from error
        for camera, shifts in zip(self.shot.cameras(), own_shifts):
            self.jitter(camera, shifts)

    def jittered_frames(self):
        """Those of the shot and one on each side, which motion is measured against."""
        return range(self.shot.frames[0] - 1, self.shot.frames[-1] + 2)

    def own_shifts(self):
        """For each camera, its Shift X and Y by frame, without jitter."""
        cameras, scene, frames = self.shot.cameras(), self.shot.scene, self.jittered_frames()
        if not any(camera.data.animation_data for camera in cameras):
            return [dict.fromkeys(frames, (camera.data.shift_x, camera.data.shift_y)) for camera in cameras]
        shifts = [{} for _ in cameras]
        now, part = scene.frame_current, scene.frame_subframe
        for frame in frames:
            scene.frame_set(frame)
            graph = self.shot.layer.depsgraph
            for camera, of_camera in zip(cameras, shifts):
                data = camera.evaluated_get(graph).data
                of_camera[frame] = data.shift_x, data.shift_y
        scene.frame_set(now, subframe=part)
        return shifts

    def jitter(self, camera, shifts):
        """Gives the object a copy of its data, where drivers look keys up by the frame. They go before animation."""
        data, copy = camera.data, camera.data.copy()
        self.cameras.append((camera, data, copy))
        by_frame = {frame: self.shot.shift(max(frame, 0), data.sensor_fit) for frame in shifts}
        for axis, path in enumerate(("shift_x", "shift_y")):
            copy.driver_remove(path)
            curve = copy.driver_add(path)
            curve.driver.type, curve.driver.expression = "SCRIPTED", "frame"
            for modifier in list(curve.modifiers):
                curve.modifiers.remove(modifier)
            for frame, shift in shifts.items():
                curve.keyframe_points.insert(frame, shift[axis] + by_frame[frame][axis]).interpolation = "CONSTANT"
        camera.data = copy

    def restore(self):
        """Puts everything back. What cannot be put back keeps nothing else from it; then raises Failure."""
        stuck = []
        for camera, data, copy in self.cameras:
            camera.data = data
            bpy.data.cameras.remove(copy)
        for owner, name, value in self.old:
            try:
                setattr(owner, name, value)
            except REFUSALS:
                stuck.append(name)
        self.cameras, self.old = [], []
        if stuck:
            raise Failure(f"These settings could not be put back: {', '.join(stuck)}.")


class Outcome:
    """What Blender's handlers tell of a render: that it ended, and whether it was cancelled."""

    def __init__(self):
        self.ended = self.cancelled = False
        on = bpy.app.handlers
        self.handlers = [(on.render_complete, self.complete), (on.render_cancel, self.cancel)]
        for handlers, handler in self.handlers:
            handlers.append(handler)

    def complete(self, *_):
        self.ended = True

    def cancel(self, *_):
        self.ended = self.cancelled = True

    def forget(self):
        for handlers, handler in self.handlers:
            if handler in handlers:
                handlers.remove(handler)


# ---- quincunx-resolve.


def state_of(path):
    """Changes with a file."""
    with contextlib.suppress(OSError):
        state = os.stat(path)
        return state.st_mtime_ns, state.st_ino
    return None


def try_command(shot, program):
    """Raises Failure where quincunx-resolve refuses its options. It does so before it misses the frames."""
    words = [*shot.command(program_named(program)), "--dry-run"]
    try:
        with tempfile.TemporaryDirectory() as nothing:
            tried = subprocess.run(words, cwd=nothing, capture_output=True, text=True, check=False)
    except OSError as error:
        raise Failure(f"{PROGRAM} could not be started: {error}.") from error
    if tried.returncode == WRONG_USAGE:
        raise Failure(f"{PROGRAM} refuses its options: {tried.stderr.splitlines()[0]}")


class Resolving:
    """Runs of quincunx-resolve: that of the draft, if any, and that of the results."""

    def __init__(self, shot, program):
        self.shot = shot
        self.commands = [shot.command(program_named(program), draft) for draft in shot.drafts]
        paths = [shot.result(frame, draft) for draft in shot.drafts for frame in shot.results]
        self.before = {path: state_of(path) for path in paths}
        self.said = tempfile.TemporaryFile(mode="w+")
        self.process = None

    def step(self):
        """Starts what is next. True when all is done. Raises Failure with the program's own sentence."""
        if self.process and self.process.poll() is None:
            return False
        if self.process and self.process.returncode != 0:
            sentence = self.messages("error") or f"exit status {self.process.returncode}."
            raise Failure(f"{PROGRAM} failed: {sentence}")
        if not self.commands:
            return True
        self.process = subprocess.Popen(
            self.commands.pop(0), cwd=self.shot.small_folder, stdout=subprocess.DEVNULL, stderr=self.said)
        return False

    def done(self):
        """How many results are there."""
        return sum(state_of(path) != state for path, state in self.before.items())

    def messages(self, kind):
        """What it said of one kind, "error" or "warning"; most often nothing."""
        self.said.seek(0)
        return " ".join(line[len(kind) + 2:] for line in self.said.read().splitlines() if line.startswith(kind + ": "))

    def stop(self):
        """The end of it, after the frame at hand."""
        self.commands = []
        if self.process and self.process.poll() is None:
            self.process.terminate()
            self.process.wait()
        self.said.close()


# ---- From the shot to its results.


def clear(shot):
    """Makes the folder of the small frames, and removes what earlier runs left in it, but nothing else."""
    os.makedirs(shot.small_folder, exist_ok=True)
    for name in os.listdir(shot.small_folder):
        if name == JITTER_FILE or re.fullmatch(r"frame\.\d{4,}\.exr", name):
            os.remove(os.path.join(shot.small_folder, name))


def write_jitter(shot):
    """For the draft: quincunx-resolve would take another pattern for its size."""
    with open(os.path.join(shot.small_folder, JITTER_FILE), "w", encoding="ascii") as file:
        for frame in shot.frames:
            print(frame, *jitter_of(max(frame, 0), shot.small, shot.full), file=file)


def loaded(shot, draft):
    image = bpy.data.images.load(shot.result(shot.results[0], draft), check_existing=True)
    image.source = "SEQUENCE" if len(shot.results) > 1 else "FILE"
    image.reload()
    return image


def load(shot):
    """The results as images of Blender's; those image editors that are open show them and the draft in turn."""
    images = [loaded(shot, draft) for draft in reversed(shot.drafts)]
    areas = [area for window in bpy.context.window_manager.windows for area in window.screen.areas]
    spaces = [area.spaces.active for area in areas if area.type == "IMAGE_EDITOR"]
    for space, image in zip(spaces, itertools.cycle(images)):
        space.image = image
        space.image_user.frame_start, space.image_user.frame_duration = shot.results[0], len(shot.results)
        space.image_user.frame_offset, space.image_user.use_auto_refresh = shot.results[0] - 1, True


class Job:
    """begin(), a render of Blender's, step() until it is True; end() in any case. All raise Failure."""

    def __init__(self, context, program="", preview=False):
        self.shot = Shot(context.scene, context.view_layer, context.scene.quincunx, preview)
        self.program = program or chosen_program()
        self.changed = SmallRender(self.shot)
        self.outcome = self.resolving = None
        self.warnings = ""

    def begin(self):
        check(self.shot, self.program)
        try_command(self.shot, self.program)
        try:
            clear(self.shot)
            if self.shot.choices.draft:
                write_jitter(self.shot)
        except OSError as error:
            raise Failure(f"The small frames have no place: {error}.") from error
        self.changed.change()
        self.outcome = Outcome()

    def render(self, *how):
        """`how`: "INVOKE_DEFAULT" returns at once, and outcome.ended tells the rest."""
        try:
            result = bpy.ops.render.render(*how, animation=True, scene=self.shot.scene.name)
        except RuntimeError as error:
            raise Failure(f"The render failed: {str(error).strip()}") from error
        if "CANCELLED" in result and not self.outcome.cancelled:  # that is what Blender 4 says of both
            raise Failure("The render could not be started.")

    def step(self):
        """To be called now and then once the render has ended. True: the results are there."""
        if not self.resolving:
            self.changed.restore()
            if self.outcome.cancelled:
                raise Failure("The render was cancelled; nothing is resolved.")
            for frame in self.shot.frames:
                if not os.path.exists(self.shot.small_file(frame)):
                    raise Failure(f"Frame {frame} was not rendered: there is no '{self.shot.small_file(frame)}'.")
            self.resolving = Resolving(self.shot, self.program)
        if not self.resolving.step():
            return False
        self.warnings = self.resolving.messages("warning")
        load(self.shot)
        if not self.shot.choices.keep:
            clear(self.shot)
            with contextlib.suppress(OSError):  # something else lies there
                os.rmdir(self.shot.small_folder)
        return True

    def progress(self):
        """(part, text)"""
        if not self.resolving:  # Blender shows how far a render is, and draws no panel during it
            return 0, "rendering"
        done, count = self.resolving.done(), len(self.resolving.before)
        return done / count, f"resolved: {done} of {count}"

    def end(self):
        if self.outcome:
            self.outcome.forget()
        if self.resolving:
            self.resolving.stop()
        self.changed.restore()


def wait_for(job):
    """The whole job, on the terminal."""
    started = time.monotonic()
    try:
        job.begin()
        job.render()
        rendered, said = time.monotonic(), None
        while not job.step():
            if said != job.progress():
                said = job.progress()
                print(f"Quincunx: {said[1]}", flush=True)
            time.sleep(0.05)
    finally:
        job.end()
    if job.warnings:
        print(f"quincunx: {job.warnings}", file=sys.stderr)
    print("Quincunx: {} frames of {}x{} rendered in {:.1f} s, {} of {}x{} made of them in {:.1f} s".format(
        len(job.shot.frames), *job.shot.small, rendered - started,
        len(job.shot.results), *job.shot.full, time.monotonic() - rendered))


def choose(name, value):
    known = QuincunxSettings.__annotations__
    if name not in known:
        raise Failure(f"There is no choice '{name}', but {', '.join(known)}.")
    try:
        setattr(bpy.context.scene.quincunx, name, value)
    except REFUSALS as error:
        raise Failure(f"{value!r} cannot be chosen for {name}: {error}") from error


def run(program="", preview=False, **choices):
    """Renders and resolves the scene of the open file. `choices`: those of QuincunxSettings, kept in the scene.

    On a failure it ends Blender with one sentence on stderr and exit status 1.
    """
    if not hasattr(bpy.types.Scene, "quincunx"):
        register()
    try:
        for name, value in choices.items():
            choose(name, value)
        wait_for(Job(bpy.context, program, preview))
    except Failure as failure:
        sys.exit(f"quincunx: {failure}")


# ---- With a display.


def chosen_program():
    addon = bpy.context.preferences.addons.get(__name__)
    return addon.preferences.program if addon else ""


class QuincunxSettings(bpy.types.PropertyGroup):
    percent: bpy.props.IntProperty(
        name="Render at", default=50, min=25, max=100, subtype="PERCENTAGE",
        description="Sides of the frames that Cycles renders, as parts of the full ones")
    method: bpy.props.EnumProperty(
        name="Quality", default="temporal", description="How frames are accumulated",
        items=[("temporal:fast", "Fast", "Cheap"), ("temporal", "Balanced", "Recommended"),
               ("temporal:quality", "High", "A little better, and slower")])
    options: bpy.props.StringProperty(
        name="Options", description="More options of quincunx-resolve, as typed in a shell: --sharpen 0.3")
    draft: bpy.props.BoolProperty(
        name="Half-Size Draft", description="Make results of half the size, too, before the full ones")
    keep: bpy.props.BoolProperty(
        name="Keep Small Frames", description="Leave the rendered frames beside the results, to resolve them once more")


class QuincunxPreferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    program: bpy.props.StringProperty(
        name="Program", subtype="FILE_PATH", 
        description="Path of quincunx-resolve; empty: the extension's own, else that in PATH")

    def draw(self, _context):
        self.layout.prop(self, "program")


class QUINCUNX_OT_render(bpy.types.Operator):
    """Render the shot small with Cycles and make frames of full size from it"""

    bl_idname = "quincunx.render"
    bl_label = "Render small, resolve to full size"

    preview: bpy.props.BoolProperty(
        name="Preview", description="Only the current frame, and as many on each side as it accumulates")
    job = None  # that of the panel's buttons, while it runs

    @classmethod
    def poll(cls, _context):
        return not cls.job

    def execute(self, context):
        try:
            wait_for(Job(context, preview=self.preview))
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        return {"FINISHED"}

    def invoke(self, context, _event):
        if bpy.app.background:
            return self.execute(context)
        cls = type(self)
        cls.job = Job(context, preview=self.preview)
        self.timer = context.window_manager.event_timer_add(0.1, window=context.window)
        try:
            cls.job.begin()
            cls.job.render("INVOKE_DEFAULT")
        except Failure as failure:
            return self.end(context, str(failure))
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        job = type(self).job
        if event.type == "ESC" and job.resolving:
            return self.end(context, "Stopped; the frames that are there are whole.")
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        for area in context.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()
        try:
            return self.end(context) if job.outcome.ended and job.step() else {"PASS_THROUGH"}
        except Failure as failure:
            return self.end(context, str(failure))

    def end(self, context, sentence=None):
        context.window_manager.event_timer_remove(self.timer)
        job, type(self).job = type(self).job, None
        try:
            job.end()
        except Failure as failure:
            sentence = f"{sentence} {failure}" if sentence else str(failure)
        if sentence:
            self.report({"ERROR"}, sentence)
            return {"CANCELLED"}
        self.report({"WARNING"} if job.warnings else {"INFO"},
                    job.warnings or f"Frames of full size in {job.shot.folder}: {len(job.shot.results)}")
        return {"FINISHED"}


class QUINCUNX_PT_output(bpy.types.Panel):
    bl_label = "Quincunx"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "output"

    def draw(self, context):
        layout, choices = self.layout, context.scene.quincunx
        layout.use_property_split, layout.use_property_decorate = True, False
        for name in ("percent", "method", "options", "draft", "keep"):
            layout.prop(choices, name)
        job = QUINCUNX_OT_render.job
        shot = job.shot if job else Shot(context.scene, context.view_layer, choices)
        column = layout.column()
        self.write(context, column, "{} frames of {}×{}, from {} of {}×{}".format(
            len(shot.results), *shot.full, len(shot.frames), *shot.small))
        if job:
            self.draw_progress(column, *job.progress())
            return
        sentence = self.obstacle(shot)
        buttons = column.column()
        buttons.enabled, buttons.scale_y = not sentence, 1.4
        buttons.operator(QUINCUNX_OT_render.bl_idname, icon="RENDER_ANIMATION",
                         text=f"Render at {choices.percent} %, resolve to full size").preview = False
        buttons.operator(QUINCUNX_OT_render.bl_idname, icon="RENDER_STILL",
                         text=f"Preview frame {context.scene.frame_current}").preview = True
        if sentence:
            self.write(context, column, sentence, icon="ERROR")

    @staticmethod
    def write(context, layout, text, icon="NONE"):
        """Several lines where the panel is narrow, which labels do not have."""
        letters = context.region.width / context.preferences.system.ui_scale / 7 - 6
        lines = layout.column(align=True)
        for line in textwrap.wrap(text, max(round(letters), 16)):
            lines.label(text=line, icon=icon)
            icon = "BLANK1" if icon != "NONE" else icon

    @staticmethod
    def obstacle(shot):
        try:
            check(shot, chosen_program())
        except Failure as failure:
            return str(failure)
        return ""

    @staticmethod
    def draw_progress(layout, part, text):
        if hasattr(layout, "progress"):  # Blender 4
            layout.progress(factor=part, text=text)
        else:
            filled = round(part * BAR_LETTERS)
            layout.label(text=f"{'█' * filled}{'░' * (BAR_LETTERS - filled)} {text}")


CLASSES = QuincunxSettings, QuincunxPreferences, QUINCUNX_OT_render, QUINCUNX_PT_output


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.quincunx = bpy.props.PointerProperty(type=QuincunxSettings)


def unregister():
    del bpy.types.Scene.quincunx
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
