# SPDX-License-Identifier: MIT
"""Quincunx from Python: resolves frames that are NumPy arrays, by the shared library's C interface.

    import quincunx
    resolver = quincunx.Resolver(output_extent=(1920, 1080), method="temporal", transparents=False)
    for frame in frames:
        picture = resolver.resolve(frame.colour, depth=frame.depth, velocity=frame.velocity, jitter=frame.jitter)

It needs NumPy and libquincunx.so.1, which is looked for where the system looks for libraries, or is the file that the
environment variable QUINCUNX_LIBRARY names. quincunx.h says what every setting and input means, docs/inputs.md has the
conventions. Errors are quincunx.Error with the library's sentence; its log goes to logging's
"quincunx". A Resolver belongs to one thread at a time.
"""
import atexit
import ctypes
import json
import logging
import os
import re
import subprocess
import textwrap
from ctypes import POINTER, Structure, byref, c_char_p, c_double, c_float, c_int32, c_int64, c_size_t, c_uint64, c_void_p

import numpy as np

API_VERSION, MAX_PASSES = 2, 72
HOST = 2  # images lie in host memory
# Channels and type of an array's pixels, and the number of their format.
FORMATS = {(1, "uint8"): 1, (1, "float32"): 2, (2, "float16"): 3, (2, "float32"): 4, (4, "uint8"): 5,
           (4, "float16"): 6, (4, "float32"): 7}
# Settings that are names here and numbers there: from 0 on, or as they are given.
CHOICES = {name: words if isinstance(words, dict) else {word: i for i, word in enumerate(words)} for name, words in {
    "two_frame_form": ("mean", "velocity", "reprojected"), "sampling": ("point", "bilinear"),
    "temporal_preset": ("fast", "balanced", "quality"),
    "temporal_view": ("picture", "confidence", "rejection", "phase", "layers", "coverage", "near", "far"),
    "history_format": {kind: FORMATS[4, kind] for kind in ("float16", "float32")},
    "colour": {kind: FORMATS[4, kind] for kind in ("uint8", "float16", "float32")},
    "storage": ("buffer", "image2d"), "targets": ("viewport", "placed"), "drawn_velocity": ("own", "dilated"),
    "sky_motion": ("as-drawn", "camera", "evidence"),
    "depth_convention": ("reversed-infinite", "reversed", "infinite", "forward", "linear"),
    "clip_space": ("direct3d", "opengl", "vulkan"), "velocity_unit": ("uv", "pixels", "ndc"), "origin": ("top", "bottom"),
    "tone_map": ("clamp", "reinhard", "aces"), "shading": ("full", "checkerboard"),
    "order": ("horizontal-first", "horizontal-only", "both-axes"), "cpu_bound": ("hold", "follow")}.items()}


class Error(RuntimeError):
    """What went wrong, in the library's words; `code` is that of quincunx.h."""

    def __init__(self, code, message):
        super().__init__(message)
        self.code = code


class Sized(Structure):
    """A struct that knows its size. Its fields are set by name, those of an extent or a vector as one pair."""

    UNNAMED = ("struct_size", "colour_format", "velocity_format", "linear_format",  # follow from what is given
               "kind", "calibration", "front", "methods", "method_count")
    WHOLE = {c_int32: "a whole number of 32 bits", c_uint64: "a whole number of 64 bits, from 0 on"}

    def __init__(self, **fields):
        super().__init__(ctypes.sizeof(self))
        self.set(**fields)

    def __repr__(self):
        values = {name: tuple(getattr(self, field) for field in fields) for name, fields in self.names().items()}
        return "%s(%s)" % (type(self).__name__, ", ".join(
            f"{name}={value if len(value) > 1 else value[0]!r}" for name, value in values.items()))

    @classmethod
    def names(cls):
        """The names here, each with its fields there: {"output_extent": ["output_width", "output_height"], ...}."""
        names = {}
        for field, _ in cls._fields_:
            if field not in cls.UNNAMED and "padding" not in field:
                names.setdefault(re.sub("_(width|height)$", "_extent", re.sub("_[xy]$", "", field)), []).append(field)
        return names

    def set(self, **values):
        """Sets fields by their names here. Raises TypeError for a name that is none and a value of another type."""
        names, kinds = self.names(), dict(self._fields_)
        for name, value in values.items():
            if name not in names:
                what = "setting" if "Settings" in type(self).__name__ else "field of " + type(self).__name__
                raise TypeError(f"'{name}' is no {what}; there are: {', '.join(names)}")
            for field, part in zip(names[name], (value,) if len(names[name]) == 1 else pair_of(name, value)):
                number, kind = number_of(field, part), self.WHOLE.get(kinds[field])
                try:
                    setattr(self, field, number)
                except TypeError:
                    raise TypeError(f"{field} is {part!r}; it must be {kind or 'a number'}") from None
                if kind and getattr(self, field) != number:
                    raise ValueError(f"{field} is {part!r}; it must be {kind}")


def sized(name, *fields):
    """A class for a struct of quincunx.h: its fields after struct_size, each given as (names, type)."""
    split = [(field, kind) for names, kind in fields for field in names.split()]
    return type(name, (Sized,), {"_fields_": [("struct_size", c_size_t), *split]})


Settings = sized(
    "Settings", (
        "moving_objects camera_motion transparents background method output_width output_height target_width "
        "target_height colour_format velocity_format linear_format storage targets shading present clear tone_map "
        "dither clamp_ringing noise_moves sky_motion two_frame_form sampling temporal_preset temporal_view "
        "history_format blur_samples", c_int32),
    ("shutter sharpness grain velocity_weight residual_weight", c_float), (
        "drawn_velocity depth_convention clip_space velocity_unit velocity_backward velocity_up velocity_jittered origin "
        "conventions_padding min_output_width min_output_height particle_target_width particle_target_height "
        "focus_width focus_height focus_target_width focus_target_height focus_mask measures_content fades",
        c_int32), ("temporal_noise", c_float), ("checks_motion checks_padding", c_int32))
Needs = sized("Needs", ("reads_depth reads_velocity reads_reactive reads_camera keeps_previous_frame "
                        "presented_storage accumulates padding", c_int32), ("frame_bytes", c_uint64))
Image = sized("Image", ("place format width height", c_int32), ("offset pitch", c_size_t), ("memory", c_void_p))
Particles = sized("Particles", ("colour depth reactive", POINTER(Image)), ("render_width render_height", c_int32))
Rectangle = type("Rectangle", (Structure,), {"_fields_": [(name, c_int32) for name in ("x", "y", "width", "height")]})
Focus = sized("Focus", ("frame", c_void_p), ("x y", c_int32), ("rectangles", POINTER(Rectangle)),
              ("rectangle_count", c_int32), ("feather", c_float), ("mask", POINTER(Image)))
Fade = sized("Fade", ("from", POINTER(Image)), ("weight", c_float), ("padding", c_int32))
Sync = sized("Sync", ("wait_for", POINTER(c_void_p)), ("wait_count padding", c_int32), ("done", POINTER(c_void_p)))
Inputs = sized("Inputs", ("colour depth velocity reactive", POINTER(Image)), ("render_width render_height", c_int32),
               ("jitter_x jitter_y velocity_scale_x velocity_scale_y", c_float),
               ("clip_to_previous_clip", c_float * 16), ("exposure", c_float), ("reset parity padding", c_int32),
               ("frame_index", c_uint64), ("near_plane far_plane", c_float), ("output_width output_height", c_int32),
               ("exposure_image", POINTER(Image)), ("particles", POINTER(Particles)), ("focus", POINTER(Focus)),
               ("fade", POINTER(Fade)), ("sync", POINTER(Sync)))
Outputs = sized("Outputs", ("linear presented", POINTER(Image)))
PassReport = type("PassReport", (Structure,), {
    "_fields_": [("kernel", c_char_p), ("ms", c_double), ("bytes", c_uint64)]})
Content = sized("Content", ("moving speed_px apart thin light zoom", c_double), ("cut judged", c_int32))
Report = sized("Report", ("passes", POINTER(PassReport)), ("pass_capacity pass_count", c_int32),
               ("frame_index", c_uint64), ("non_finite_pixels", c_int64), ("render_width render_height", c_int32),
               ("ratio_x ratio_y", c_float), ("used_previous padding output_width output_height focused content_known",
                                              c_int32), ("content", POINTER(Content)), ("in_focus", POINTER(c_int32)),
               ("motion", c_char_p), ("motion_margin_db", c_double))


NUMBERS = ("velocity_scale", "clip_to_previous_clip", "exposure", "reset", "parity", "frame_index", "near_plane",
           "far_plane")
TEXTS = ("quincunx_version", "quincunx_last_error", "quincunx_method_name", "quincunx_variant_name",
         "quincunx_plan_text", "quincunx_device_name", "quincunx_device_profile", "quincunx_device_pass_timer",
         "quincunx_controller_name", "quincunx_controller_text", "quincunx_costs_text", "quincunx_front_text",
         "quincunx_front_summary")


ControllerSettings = sized(
    "ControllerSettings", ("kind output_width output_height order step min_width min_height buffers", c_int32),
    ("min_scale max_scale target_ms rate spike_ratio factor margin", c_double), ("count cpu_bound", c_int32),
    ("fixed_part", c_double), ("calibration", c_void_p), ("blur_start_px blur_full_px blur_min_scale", c_double),
    ("blur_aware fade_frames", c_int32), ("front", c_void_p), ("methods", POINTER(c_char_p)),
    ("method_count padding", c_int32), ("hysteresis rest_seconds", c_double))
Timing = sized("Timing", ("frame next_frame", c_uint64), ("render_width render_height", c_int32),
               ("gpu_ms cpu_ms interval_ms", c_double), ("queued missed_vsyncs", c_int32),
               ("blur_px resolve_ms", c_double), ("content", POINTER(Content)))
Choice = sized("Choice", ("render_width render_height rung padding", c_int32), ("method fading_from", c_char_p),
               ("weight", c_double))
OutputSettings = sized("OutputSettings", ("display_width display_height steps rest_frames", c_int32),
                       ("min_scale max_filled hysteresis", c_double))
DetailSettings = sized("DetailSettings", ("levels rest_frames", c_int32), ("full_area min_area hysteresis", c_double))


def load():
    """The library, with its functions' types; raises OSError where it is not found."""
    library = ctypes.CDLL(os.environ.get("QUINCUNX_LIBRARY", "libquincunx.so.1"))
    if library.quincunx_api_version() < API_VERSION:
        raise Error(2, f"this library has version {library.quincunx_api_version()} of the interface; "
                       f"quincunx.py needs {API_VERSION} at least")
    for name in TEXTS:
        getattr(library, name).restype = c_char_p
    library.quincunx_jitter.argtypes = [c_uint64, c_int32, c_int32, c_int32, c_int32, POINTER(c_float)]
    library.quincunx_texture_lod_bias.restype = c_float
    for name in ("quincunx_controller_target_ms", "quincunx_costs_confidence"):
        getattr(library, name).restype = c_double
    library.quincunx_controller_set_target_ms.argtypes = [c_void_p, c_double]
    library.quincunx_costs_create.argtypes = [c_double, c_void_p]
    library.quincunx_costs_record.argtypes = [c_void_p, c_uint64, c_double, c_double]
    library.quincunx_costs_confidence.argtypes = [c_void_p, c_double]
    library.quincunx_costs_predict.argtypes = [c_void_p, c_double, c_double, c_void_p]
    library.quincunx_front_flip.argtypes = [c_void_p, c_void_p, c_char_p, c_double, c_void_p]
    library.quincunx_front_resolve_ms.argtypes = [c_void_p, c_char_p, c_double, c_double, c_void_p]
    library.quincunx_detail_follower_observe.argtypes = [c_void_p, c_double, c_void_p]
    return library


LIBRARY = load()
LEVELS = (logging.DEBUG, logging.INFO, logging.WARNING, logging.ERROR)
LOG = ctypes.CFUNCTYPE(None, c_int32, c_char_p, c_void_p)(
    lambda level, message, _: logging.getLogger("quincunx").log(LEVELS[level], "%s", message.decode()))
LIBRARY.quincunx_set_log(LOG, None)
atexit.register(LIBRARY.quincunx_set_log, None, None)  # the library may outlive Python


def call(name, *arguments):
    """Calls a function that can fail; NOT_READY is returned, and all other codes are raised."""
    code = getattr(LIBRARY, name)(*arguments)
    if code not in (0, 5):
        raise Error(code, LIBRARY.quincunx_last_error().decode())
    return code


def jitter(frame_index, render_extent, output_extent):
    """Where the samples of a frame lie, for the method "temporal": (x, y) in pixels of the frame, +x right, +y down.

    Several frames see more than one only if their samples lie elsewhere in each: move the camera's projection by it.
    """
    place = (c_float * 2)()
    LIBRARY.quincunx_jitter(frame_index, *render_extent, *output_extent, place)
    return place[0], place[1]


def jitter_phases(render_extent, output_extent):
    """After so many frames jitter() begins again."""
    return LIBRARY.quincunx_jitter_phases(*render_extent, *output_extent)


def texture_lod_bias(render_extent, output_extent):
    """What to add to the textures' level of detail where frames have that jitter."""
    return LIBRARY.quincunx_texture_lod_bias(*render_extent, *output_extent)


def image_of(array):
    """An array of shape (height, width, channels) as an Image over the same memory, which must outlive it."""
    height, width, channels = array.shape
    return Image(place=HOST, format=FORMATS[channels, array.dtype.name], width=width, height=height,
                 pitch=array.strides[0], memory=array.ctypes.data)


def pixels_of(name, array, channels, dtype):
    """As an array of (height, width, channels) whose rows are whole; copied only where it is not one already."""
    array = np.asarray(array, dtype=dtype)
    array = array[:, :, np.newaxis] if array.ndim == 2 else array
    if array.ndim == 3 and (channels, array.shape[2]) == (4, 3):  # colour without alpha covers all
        array = np.dstack([array, np.ones(array.shape[:2], dtype)])
    if array.ndim != 3 or array.shape[2] != channels or array.size == 0:
        raise ValueError(f"{name} has the shape {array.shape}; it must be (height, width, {channels})")
    rows_are_whole = array.strides[1:] == (channels * array.itemsize, array.itemsize)
    return array if rows_are_whole and array.strides[0] >= array[0].nbytes else np.ascontiguousarray(array)


def variants():
    """The names of methods with the settings that matter to them, by growing effort: "temporal:fast"."""
    names = []
    while (name := LIBRARY.quincunx_variant_name(len(names))) is not None:
        names.append(name.decode())
    return names


class Kept:
    """Arrays and structs that a call refers to."""

    def __init__(self):
        self.things = []

    def image(self, name, array, channels, dtype):
        """A pointer to an Image over the array, or None for None."""
        if array is None:
            return None
        pixels = pixels_of(name, array, channels, dtype)
        self.things.append(pixels)
        return self.pointer(image_of(pixels))

    def pointer(self, thing):
        self.things.append(thing)
        return ctypes.pointer(thing)


class Resolver:
    """Makes pictures of one size from frames of any size up to `target_extent`.

    output_extent  (width, height) of the pictures
    target_extent  (width, height) of the largest frame; None: that of the pictures
    device         OpenCL device: "", "cpu", "gpu", a number or a part of a name
    colour         type of the frames' colour: "float16" or "float32" (linear, premultiplied), or "uint8" (sRGB encoded)
    settings       as below, where choices take one of the words; extents are (width, height). method is a name of
                   variants(), or its part before the colon. transparents=False where frames have no reactive values,
                   moving_objects=False where only the camera moves.
    """

    def __init__(self, output_extent, target_extent=None, device="", colour="float32", **settings):
        self._device, self._plan, self._service = c_void_p(), c_void_p(), c_void_p()
        self.output_extent, self._colour = pair_of("output_extent", output_extent), colour
        plan = Settings()
        call("quincunx_settings_init", byref(plan))
        plan.colour_format, plan.velocity_format = number_of("colour", str(colour)), FORMATS[2, "float32"]
        if isinstance(settings.get("method"), str):
            call("quincunx_settings_set_method", byref(plan), settings.pop("method").encode())
        plan.set(output_extent=output_extent, target_extent=target_extent or output_extent, **settings)
        call("quincunx_plan_create", byref(plan), byref(self._plan))
        call("quincunx_device_open", str(device).encode(), byref(self._device))
        call("quincunx_service_create", self._device, self._plan, byref(self._service))
        self.needs = Needs()  # which inputs resolve() wants: reads_depth, reads_velocity, ...
        call("quincunx_plan_needs", self._plan, byref(self.needs))

    def __del__(self):
        for kind in ("service", "plan", "device"):
            getattr(LIBRARY, f"quincunx_{kind}_destroy")(getattr(self, f"_{kind}", None))

    def __str__(self):
        """The plan: passes, images, bytes, and why."""
        return LIBRARY.quincunx_plan_text(self._plan).decode()

    def device(self):
        """{"name", "profile": how work is cut for it, "pass_timer": what times its passes}."""
        return {name: getattr(LIBRARY, "quincunx_device_" + name)(self._device).decode()
                for name in ("name", "profile", "pass_timer")}

    def allow_timing_waits(self, allow=True):
        """Lets frames wait for each pass where the pass timer is "host clock", so that passes have times."""
        call("quincunx_allow_timing_waits", self._service, int(allow))

    def reads_history(self, render_extent, output_extent=(0, 0)):
        """Whether a frame of this size reads earlier ones where there are any."""
        return bool(LIBRARY.quincunx_plan_reads_history(self._plan, *render_extent, *output_extent))

    def focus_plan(self):
        """The plan of the focus's region, as text. Raises Error where there is none."""
        region = c_void_p()
        call("quincunx_plan_focus", self._plan, byref(region))
        text = LIBRARY.quincunx_plan_text(region).decode()
        LIBRARY.quincunx_plan_destroy(region)
        return text

    def resolve(self, colour, depth=None, velocity=None, reactive=None, jitter=(0, 0), presented=False,
                output_extent=None, particles=None, focus=None, fading_from=None, fade_weight=1, exposure_image=None,
                **inputs):
        """The picture of one frame, as an array of (height, width, 4).

        Arrays of the frame's size: colour (h, w, 3 or 4), depth (h, w), velocity (h, w, 2), reactive (h, w, uint8).
        jitter is in pixels of the frame. Gives linear float32, or with presented=True sRGB encoded uint8. `inputs`, as
        docs/inputs.md has them:

        reset                  True: a cut; nothing of the frames before may be used
        clip_to_previous_clip  (4, 4) or 16 numbers, column by column: of a matrix that multiplies columns (m @ v) m.T
        near_plane, far_plane  distances, where the depth_convention needs them
        velocity_scale         (x, y) that make velocity what the settings say
        exposure, parity, frame_index

        output_extent   (width, height) of this frame's picture, from the setting min_output_extent to the pictures'
                        size; it is then shown in theirs
        particles       where particle_target_extent is set: {"colour": (h, w, 4), "depth": (h, w), "reactive":
                        (h, w)}, drawn apart at a size of their own
        focus           where focus_extent is set: {"colour", "depth", ... and other inputs of the region's frame,
                        "x", "y": its upper left output pixel, "rectangles": [(x, y, width, height)], at most four,
                        "feather": output pixels, "mask": (height, width, uint8) of the region}
        fading_from     where fades is set: another method's linear picture of this frame, of which it
                        keeps 1 - fade_weight; fade_weight in [0, 1]
        exposure_image  (1, 1) float32: another factor of the exposure
        """
        kept = Kept()
        frame = self._frame(kept, colour, depth, velocity, reactive, jitter, inputs)
        frame.set(output_extent=output_extent or (0, 0))
        frame.exposure_image = kept.image("exposure_image", exposure_image, 1, "float32")
        if particles is not None:
            frame.particles = kept.pointer(self._particles(kept, **particles))
        if focus is not None:
            frame.focus = kept.pointer(self._focus(kept, **focus))
        if fading_from is not None:
            old = kept.image("fading_from", fading_from, 4, "float32")
            frame.fade = kept.pointer(Fade(**{"from": old}, weight=fade_weight))
        picture = np.empty((self.output_extent[1], self.output_extent[0], 4), "uint8" if presented else "float32")
        outputs = Outputs(**{"presented" if presented else "linear": ctypes.pointer(image_of(picture))})
        call("quincunx_dispatch", self._service, byref(frame), byref(outputs), None)
        return picture

    def _frame(self, kept, colour, depth, velocity, reactive, jitter, inputs):
        for name in inputs:
            if name not in NUMBERS:
                raise TypeError(f"'{name}' is no input; there are: {', '.join(NUMBERS)}")
        if "clip_to_previous_clip" in inputs:
            matrix = np.asarray(inputs["clip_to_previous_clip"], "float32")
            if matrix.shape not in ((4, 4), (16,)):
                raise ValueError(f"clip_to_previous_clip has the shape {matrix.shape}; it must be (4, 4) or (16,)")
            inputs = {**inputs, "clip_to_previous_clip": (c_float * 16)(*matrix.ravel())}
        image = kept.image("colour", colour, 4, self._colour)
        return Inputs(jitter=jitter, render_extent=(image.contents.width, image.contents.height), colour=image,
                      depth=kept.image("depth", depth, 1, "float32"),
                      velocity=kept.image("velocity", velocity, 2, "float32"),
                      reactive=kept.image("reactive", reactive, 1, "uint8"), **inputs)

    def _particles(self, kept, colour, depth, reactive=None):
        image = kept.image("particles' colour", colour, 4, self._colour)
        return Particles(colour=image, depth=kept.image("particles' depth", depth, 1, "float32"),
                         reactive=kept.image("particles' reactive", reactive, 1, "uint8"),
                         render_extent=(image.contents.width, image.contents.height))

    def _focus(self, kept, colour, depth=None, velocity=None, reactive=None, jitter=(0, 0), x=0, y=0, rectangles=(),
               feather=0, mask=None, **inputs):
        frame = kept.pointer(self._frame(kept, colour, depth, velocity, reactive, jitter, inputs))
        places = (Rectangle * len(rectangles))(*(Rectangle(*place) for place in rectangles))
        kept.things.append(places)
        return Focus(frame=ctypes.cast(frame, c_void_p), x=x, y=y, rectangles=places, rectangle_count=len(rectangles),
                     feather=feather, mask=kept.image("focus's mask", mask, 1, "uint8"))

    def reports(self):
        """Of the frames since the last call, each a dictionary:

        frame_index, render_extent, output_extent, used_previous, focused, non_finite_pixels, passes: [(name, ms,
        bytes)], where those of a focus begin with "focus: ", content: with the setting measures_content the shares
        of ContentStatistics by name, else None, and motion: with the setting checks_motion what the frames say of
        velocity, and by how many dB it is better, else None.
        """
        found, passes, in_focus = [], (PassReport * MAX_PASSES)(), (c_int32 * MAX_PASSES)()
        content = Content()
        report = Report(passes=passes, pass_capacity=MAX_PASSES, in_focus=in_focus, content=ctypes.pointer(content))
        while call("quincunx_next_report", self._service, byref(report)) == 0:
            known = {name: getattr(content, name) for name in Content.names()} if report.content_known else None
            motion = (report.motion.decode(), report.motion_margin_db) if report.motion else None
            found.append({"frame_index": report.frame_index,
                          "render_extent": (report.render_width, report.render_height),
                          "output_extent": (report.output_width, report.output_height),
                          "used_previous": bool(report.used_previous), "focused": bool(report.focused),
                          "non_finite_pixels": report.non_finite_pixels, "content": known, "motion": motion,
                          "passes": [("focus: " * bool(in_focus[i]) + passes[i].kernel.decode(), passes[i].ms,
                                      passes[i].bytes) for i in range(report.pass_count)]})
        return found


Resolver.__doc__ = (Resolver.__doc__ or "") + "\n" + textwrap.fill(", ".join(
    f"{name} ({' | '.join(CHOICES[name])})" if name in CHOICES else name for name in Settings.names()), 118,
    initial_indent="    ", subsequent_indent="    ", break_on_hyphens=False)


def resolve_sequence(pattern, out=None, *, program="quincunx-resolve", **options):
    """Resolves an EXR sequence by the program quincunx-resolve, as docs/sequences.md says, and returns its report.

        report = quincunx.resolve_sequence("shot/shot.%04d.exr", "up/up.%04d.exr", output=(3840, 2160), two_way=8)

    `pattern` and `out` name the files as the program wants them, or `pattern` a recording's folder. The program's
    options are keywords: numbers and text as they are, pairs as tuples, True for one without a value; None and False
    leave it out. two_way=8 looks eight frames ahead, 0 none. The report is that of --json, a dict: settings, frames,
    passes, scores (with truth), files and more; {} where nothing was left to do. Blocks; any thread may call it. Raises
    OSError where there is no program, and Error with the program's sentence: code 1 for wrong options, 4 for frames
    that cannot be read, written or resolved.
    """
    words = [program, pattern, "--json", "--quiet"] + (["--out", out] if out is not None else [])
    for name, value in options.items():
        if value is None or value is False:
            continue
        words.append("--" + name.replace("_", "-"))
        if isinstance(value, (tuple, list)):
            value = ("x" if name == "output" else ",").join(map(str, value))
        if value is not True:
            words.append(str(value))
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        raise Error(1 if done.returncode == 2 else 4, done.stderr.strip().removeprefix("error: "))
    return json.loads(done.stdout or "{}")


class Handle:
    """An object of the library's, which lives as long as this."""

    OBJECT, handle = None, None  # the name of its functions; what they take

    def __init__(self, how, *arguments):
        self.handle = c_void_p()
        call(f"quincunx_{self.OBJECT}_{how}", *arguments, byref(self.handle))

    def __del__(self):
        getattr(LIBRARY, f"quincunx_{self.OBJECT}_destroy")(self.handle)

    def _text(self, what):
        return getattr(LIBRARY, f"quincunx_{self.OBJECT}_{what}")(self.handle).decode()

    @classmethod
    def handle_of(cls, name, given):
        """What a setting of this class holds; None for None."""
        if given is not None and not isinstance(given, cls):
            raise TypeError(f"{name} is {given!r}; it must be of {cls.__name__}")
        return given.handle if given is not None else None


def settings_of(struct, init, fields):
    """A struct of settings: its defaults, and fields by name."""
    settings = struct()
    call(init, byref(settings))
    settings.set(**fields)
    return settings


class Controller(Handle):
    """Chooses each frame's size from the times of frames past; the base of those below.

    Every one takes output_extent=(width, height), each in [1, 32768], target_ms in (0, 60000], and the ladder of sizes:
    min_scale above 0, max_scale up to 2, order ("horizontal-first", "horizontal-only", "both-axes"), step (pixels),
    min_extent=(width, height). Settings outside their ranges raise Error. Pure: the same calls give the same sizes.

        controller = quincunx.PredictiveController(output_extent=(1920, 1080), target_ms=16.7)
        each frame: width, height = controller.next(); then controller.observe(number, (width, height), gpu_ms)
    """

    OBJECT, KIND = "controller", None

    def __init__(self, calibration=None, front=None, methods=(), **settings):
        made = settings_of(ControllerSettings, "quincunx_controller_settings_init", settings)
        made.kind = self.KIND
        names = (c_char_p * len(methods))(*(text_of("a name in methods", name) for name in methods))
        made.methods, made.method_count = names, len(methods)
        made.calibration = CostTable.handle_of("calibration", calibration)
        made.front = ErrorFront.handle_of("front", front)
        super().__init__("create", byref(made))

    @property
    def name(self):
        """ "predictive" """
        return self._text("name")

    @property
    def target_ms(self):
        """The time that a frame may take; may be set, in (0, 60000]."""
        return LIBRARY.quincunx_controller_target_ms(self.handle)

    @target_ms.setter
    def target_ms(self, value):
        call("quincunx_controller_set_target_ms", self.handle, value)

    def ladder(self):
        """The sizes to choose from, (width, height) in pixels, from the smallest."""
        extent, rungs = (c_int32 * 2)(), []
        for rung in range(LIBRARY.quincunx_controller_rung_count(self.handle)):
            call("quincunx_controller_rung", self.handle, rung, extent)
            rungs.append(tuple(extent))
        return rungs

    def observe(self, frame, render_extent, gpu_ms, content=None, **times):
        """Learns from one past frame, oldest first.

        frame          its number, which rises; gaps are allowed
        render_extent  (width, height) that it was drawn at
        gpu_ms         busy time of its critical path, resolve included, in (0, 60000]
        times          cpu_ms, interval_ms, blur_px, resolve_ms, queued, missed_vsyncs, next_frame; 0: not known
        content        of QualityController: shares as Resolver.reports() has them; None: as the frame before
        Raises Error for what cannot be; nothing has changed then.
        """
        timing = Timing(frame=frame, render_extent=render_extent, gpu_ms=gpu_ms, **times)
        if content is not None:
            timing.content = ctypes.pointer(Content(**content))
        call("quincunx_controller_observe", self.handle, byref(timing))

    def choice(self):
        """{"render_extent": (width, height), "rung", "method", "fading_from", "weight"}.

        method and fading_from are names of variants(), None where none is chosen. With fading_from, resolve with that
        as well and give its picture to resolve(fading_from=..., fade_weight=weight).
        """
        choice = Choice()
        call("quincunx_controller_choice", self.handle, byref(choice))
        return {"render_extent": (choice.render_width, choice.render_height), "rung": choice.rung,
                "method": choice.method and choice.method.decode(),
                "fading_from": choice.fading_from and choice.fading_from.decode(), "weight": choice.weight}

    def next(self):
        """(width, height) to draw the next frame at; at first the largest."""
        return self.choice()["render_extent"]


class ProportionalController(Controller):
    """Binks's controller. Besides: rate in (0, 1], spike_ratio at least 1."""

    KIND = 0


class MinimumOfNController(Controller):
    """The shortest of the last times decides. Besides: count in [1, 1000], factor and margin in (0, 1]."""

    KIND = 1


class PredictiveController(Controller):
    """Predicts the next frame's time and spends what the display's queue allows.

    Besides: buffers in [2, 8], fixed_part in [0, 0.9], cpu_bound ("hold", "follow"), calibration (a CostTable), and
    blur_aware=True with blur_start_px, blur_full_px, blur_min_scale.
    """

    KIND = 2


class QualityController(Controller):
    """Chooses method and size whose expected error is the least that fits.

    Besides those of PredictiveController: front (an ErrorFront), methods (names of variants()), hysteresis in [0, 1),
    rest_seconds and fade_frames in [0, 60].
    """

    KIND = 3

    def explain(self):
        """Why the last choice was made, in a few lines."""
        return self._text("text")


class CostTable(Handle):
    """Measured frame times by resolution, whose confidence halves in half_life_frames, in [1, 1e9].

    `json` is the str() of a table. Errors raise Error.
    """

    OBJECT = "costs"

    def __init__(self, half_life_frames=3600, json=None):
        if json is None:
            super().__init__("create", half_life_frames)
        else:
            super().__init__("parse", text_of("json", json))

    def __str__(self):
        return self._text("text")

    def record(self, frame, area_fraction, gpu_ms):
        """One frame of this part of the output's pixels, in (0, 4], took gpu_ms, in (0, 60000]."""
        call("quincunx_costs_record", self.handle, frame, area_fraction, gpu_ms)

    def confidence(self, area_fraction):
        """In [0, 1]; 0 where nothing was recorded."""
        return LIBRARY.quincunx_costs_confidence(self.handle, area_fraction)

    def predict(self, area_fraction, fixed_part=0.25):
        """The expected time in ms, if fixed_part of it does not scale; None where nothing is known."""
        return self._known("quincunx_costs_predict", area_fraction, fixed_part)

    def fixed_part(self):
        """The part of the cost that does not scale, by what was recorded; None where that is too little."""
        return self._known("quincunx_costs_fixed_part")

    def _known(self, name, *arguments):
        number = c_double()
        return number.value if call(name, self.handle, *arguments, byref(number)) == 0 else None


class ErrorFront(Handle):
    """How wrong each method's picture is at each scale, and what it costs.

    `json` is the str() of a front; None: the one that is built in. `resolver`: that of its device, for a scene's name.
    """

    OBJECT = "front"

    def __init__(self, json=None, resolver=None, scene=""):
        if resolver is None:
            super().__init__("parse", text_of("json", json))
        elif isinstance(resolver, Resolver):
            super().__init__("find", resolver._device, text_of("scene", scene))
        else:
            raise TypeError(f"resolver is {resolver!r}; it must be of Resolver")

    def __str__(self):
        return self._text("text")

    def summary(self):
        """Where its figures come from."""
        return self._text("summary")

    def flip(self, mix, method, scale):
        """The expected mean FLIP of a mix (as mix_of() gives it) at a scale per axis, above 0."""
        flip = c_double()
        call("quincunx_front_flip", self.handle, (c_double * 6)(*mix), method.encode(), scale, byref(flip))
        return flip.value

    def resolve_ms(self, method, scale, output_megapixels):
        """Milliseconds of the method's passes for an output of so many megapixels, above 0."""
        milliseconds = c_double()
        call("quincunx_front_resolve_ms", self.handle, method.encode(), scale, output_megapixels, byref(milliseconds))
        return milliseconds.value


def mix_of(**content):
    """Shares of (still, pan, objects, thin, light, zoom), 1 together, of content: moving=, speed_px=, apart=, ..."""
    share = (c_double * 6)()
    call("quincunx_mix_of", byref(Content(**content)), share)
    return tuple(share)


class OutputFollower(Handle):
    """An output that goes along with the size of frames, for resolve(output_extent=...).

    display_extent=(width, height), min_scale in (0, 1], steps at least 1, max_filled in (0, 1], hysteresis in [0, 1),
    rest_frames at least 0.
    """

    OBJECT = "output_follower"

    def __init__(self, **settings):
        made = settings_of(OutputSettings, "quincunx_output_settings_init", settings)
        super().__init__("create", byref(made))

    def observe(self, render_extent):
        """Called once per frame with the (width, height) it is drawn at. Returns the output's (width, height)."""
        output = (c_int32 * 2)()
        call("quincunx_output_follower_observe", self.handle, *render_extent, output)
        return tuple(output)

    def min_output(self):
        """The smallest there may be, for the setting min_output_extent."""
        output = (c_int32 * 2)()
        call("quincunx_output_follower_min_output", self.handle, output)
        return tuple(output)


class DetailFollower(Handle):
    """Levels of detail that go along with the resolution.

    levels in [2, 64], full_area, min_area in (0, full_area), hysteresis in [0, 1], rest_frames at least 0.
    """

    OBJECT = "detail_follower"

    def __init__(self, **settings):
        made = settings_of(DetailSettings, "quincunx_detail_settings_init", settings)
        super().__init__("create", byref(made))

    def observe(self, area_fraction):
        """Called once per frame with its pixels over the output's. Returns the level; 0 is the full detail."""
        level = c_int32()
        call("quincunx_detail_follower_observe", self.handle, area_fraction, byref(level))
        return level.value


def number_of(name, value):
    """The number of a setting whose value may be a name."""
    if not isinstance(value, str):
        return value
    if value not in CHOICES.get(name, ()):
        raise ValueError(f"{name} is '{value}'; it must be {'one of ' * (name in CHOICES)}"
                         f"{', '.join(CHOICES.get(name, ('a number',)))}")
    return CHOICES[name][value]


def pair_of(name, value):
    """Two numbers, in words where they are not."""
    try:
        first, second = value
    except (TypeError, ValueError):
        raise ValueError(f"{name} is {value!r}; it must be a pair of numbers") from None
    return first, second


def text_of(name, value):
    """Text as C has it; None for None."""
    if value is not None and not isinstance(value, str):
        raise TypeError(f"{name} is {value!r}; it must be text")
    return value if value is None else value.encode()
