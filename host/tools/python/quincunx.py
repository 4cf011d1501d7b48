# SPDX-License-Identifier: MIT
"""Quincunx from Python: resolves frames that are NumPy arrays, by the shared library's C interface.

    import quincunx
    resolver = quincunx.Resolver(output_extent=(1920, 1080), method="temporal", transparents=False)
    for frame in frames:
        picture = resolver.resolve(frame.colour, depth=frame.depth, velocity=frame.velocity, jitter=frame.jitter)

It needs NumPy and libquincunx.so.1, which is looked for where the system looks for libraries, or is the file that the
environment variable QUINCUNX_LIBRARY names. quincunx.h says what every setting and input means, docs/inputs.md has the
conventions. Errors are quincunx.Error with the library's sentence. A Resolver belongs to one thread at a time.
"""
import ctypes
import os
from ctypes import POINTER, Structure, byref, c_char_p, c_double, c_float, c_int32, c_int64, c_size_t, c_uint64, c_void_p

import numpy as np

API_VERSION, MAX_PASSES = 1, 72
HOST = 2  # images lie in host memory
METHODS = {}  # name: number, as the library has them
CHOICES = {  # settings that are names here and numbers there
    "two_frame_form": ("mean", "velocity", "reprojected"), "sampling": ("point", "bilinear"),
    "temporal_preset": ("fast", "balanced", "quality"), "sky_motion": ("as-drawn", "camera", "evidence"),
    "drawn_velocity": ("own", "dilated"),
    "depth_convention": ("reversed-infinite", "reversed", "infinite", "forward", "linear"),
    "clip_space": ("direct3d", "opengl", "vulkan"), "velocity_unit": ("uv", "pixels", "ndc"), "origin": ("top", "bottom"),
    "tone_map": ("clamp", "reinhard", "aces"), "shading": ("full", "checkerboard")}
# Channels and type of an array's pixels, and the number of their format.
FORMATS = {(1, "uint8"): 1, (1, "float32"): 2, (2, "float16"): 3, (2, "float32"): 4, (4, "uint8"): 5,
           (4, "float16"): 6, (4, "float32"): 7}


class Error(RuntimeError):
    """What went wrong, in the library's words; `code` is that of quincunx.h."""

    def __init__(self, code, message):
        super().__init__(message)
        self.code = code


class Sized(Structure):
    """A struct that knows its size."""

    def __init__(self, **fields):
        super().__init__(ctypes.sizeof(self), **fields)


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
        "conventions_padding", c_int32))
Needs = sized("Needs", ("reads_depth reads_velocity reads_reactive reads_camera keeps_previous_frame "
                        "presented_storage accumulates padding", c_int32), ("frame_bytes", c_uint64))
Image = sized("Image", ("place format width height", c_int32), ("offset pitch", c_size_t), ("memory", c_void_p))
Inputs = sized("Inputs", ("colour depth velocity reactive", POINTER(Image)), ("render_width render_height", c_int32),
               ("jitter_x jitter_y velocity_scale_x velocity_scale_y", c_float),
               ("clip_to_previous_clip", c_float * 16), ("exposure", c_float), ("reset parity padding", c_int32),
               ("frame_index", c_uint64), ("near_plane far_plane", c_float))
Outputs = sized("Outputs", ("linear presented", POINTER(Image)))


PassReport = type("PassReport", (Structure,), {
    "_fields_": [("kernel", c_char_p), ("ms", c_double), ("bytes", c_uint64)]})
Report = sized("Report", ("passes", POINTER(PassReport)), ("pass_capacity pass_count", c_int32),
               ("frame_index", c_uint64), ("non_finite_pixels", c_int64), ("render_width render_height", c_int32),
               ("ratio_x ratio_y", c_float), ("used_previous padding", c_int32))


def load():
    """The library, with its functions' types; raises OSError where it is not found."""
    library = ctypes.CDLL(os.environ.get("QUINCUNX_LIBRARY", "libquincunx.so.1"))
    for name in ("quincunx_version", "quincunx_last_error", "quincunx_method_name", "quincunx_plan_text",
                 "quincunx_device_name"):
        getattr(library, name).restype = c_char_p
    for name in ("quincunx_plan_text", "quincunx_device_name", "quincunx_plan_destroy", "quincunx_device_destroy",
                 "quincunx_service_destroy"):
        getattr(library, name).argtypes = [c_void_p]
    library.quincunx_jitter.argtypes = [c_uint64, c_int32, c_int32, c_int32, c_int32, POINTER(c_float)]
    library.quincunx_texture_lod_bias.restype = c_float
    if library.quincunx_api_version() < API_VERSION:
        raise Error(2, f"this library has version {library.quincunx_api_version()} of the interface; "
                       f"quincunx.py needs {API_VERSION} at least")
    while (name := library.quincunx_method_name(len(METHODS))) is not None:
        METHODS[name.decode()] = len(METHODS)
    return library


LIBRARY = load()


def call(name, *arguments):
    """Calls a function that can fail; NOT_READY is returned, and all other codes are raised."""
    code = getattr(LIBRARY, name)(*arguments)
    if code not in (0, 5):
        raise Error(code, LIBRARY.quincunx_last_error().decode())
    return code


def jitter(frame_index, render, output):
    """Where the samples of a frame lie, for the method "temporal": (x, y) in pixels of the frame, +x right, +y down.

    Several frames see more than one only if their samples lie elsewhere in each: move the camera's projection by it.
    """
    place = (c_float * 2)()
    LIBRARY.quincunx_jitter(frame_index, *render, *output, place)
    return place[0], place[1]


def jitter_phases(render, output):
    """After so many frames jitter() begins again."""
    return LIBRARY.quincunx_jitter_phases(*render, *output)


def texture_lod_bias(render, output):
    """What to add to the textures' level of detail where frames have that jitter."""
    return LIBRARY.quincunx_texture_lod_bias(*render, *output)


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


class Resolver:
    """Makes pictures of one size from frames of any size up to `target_extent`.

    output_extent  (width, height) of the pictures
    target_extent  (width, height) of the largest frame; None: that of the pictures
    device         OpenCL device: "", "cpu", "gpu", a number or a part of a name
    colour         type of the frames' colour: "float16" or "float32" (linear, premultiplied), or "uint8" (sRGB encoded)
    settings       fields of quincunx_settings by name; methods and the keys of CHOICES take names. transparents=False
                   where frames have no reactive values, moving_objects=False where only the camera moves.
    """

    def __init__(self, output_extent, target_extent=None, device="", colour="float32", **settings):
        self._device, self._plan, self._service = c_void_p(), c_void_p(), c_void_p()
        self.output_extent, self._colour = tuple(output_extent), colour
        plan = Settings()
        call("quincunx_settings_init", byref(plan))
        plan.output_width, plan.output_height = output_extent
        plan.target_width, plan.target_height = target_extent or output_extent
        plan.colour_format, plan.velocity_format = FORMATS[4, colour], FORMATS[2, "float32"]
        for name, value in settings.items():
            if name not in dict(Settings._fields_):
                raise TypeError(f"'{name}' is no setting; there are: {', '.join(dict(Settings._fields_))}")
            setattr(plan, name, number_of(name, value))
        call("quincunx_plan_create", byref(plan), byref(self._plan))
        call("quincunx_device_open", device.encode(), byref(self._device))
        call("quincunx_service_create", self._device, self._plan, byref(self._service))
        self.needs = Needs()  # which inputs resolve() wants: reads_depth, reads_velocity, ...
        call("quincunx_plan_needs", self._plan, byref(self.needs))

    def __del__(self):
        for kind in ("service", "plan", "device"):
            getattr(LIBRARY, f"quincunx_{kind}_destroy")(getattr(self, f"_{kind}", None))

    def __str__(self):
        """The plan: passes, images, bytes, and why."""
        return LIBRARY.quincunx_plan_text(self._plan).decode()

    def resolve(self, colour, depth=None, velocity=None, reactive=None, jitter=(0, 0), presented=False, **inputs):
        """The picture of one frame, as an array of (height, width, 4).

        Arrays of the frame's size: colour (h, w, 3 or 4), depth (h, w), velocity (h, w, 2), reactive (h, w, uint8).
        jitter is in pixels of the frame; `inputs` are further fields of quincunx_inputs by name, for example reset or
        clip_to_previous_clip. Gives linear float32, or with presented=True sRGB encoded uint8.
        """
        kinds = {"colour": (colour, 4, self._colour), "depth": (depth, 1, "float32"),
                 "velocity": (velocity, 2, "float32"), "reactive": (reactive, 1, "uint8")}
        kept = {name: pixels_of(name, *kind) for name, kind in kinds.items() if kind[0] is not None}
        if "clip_to_previous_clip" in inputs:
            inputs["clip_to_previous_clip"] = (c_float * 16)(*np.ravel(inputs["clip_to_previous_clip"]))
        height, width = kept["colour"].shape[:2]
        frame = Inputs(jitter_x=jitter[0], jitter_y=jitter[1], render_width=width, render_height=height, **inputs)
        for name, array in kept.items():
            setattr(frame, name, ctypes.pointer(image_of(array)))
        picture = np.empty((self.output_extent[1], self.output_extent[0], 4), "uint8" if presented else "float32")
        outputs = Outputs(**{"presented" if presented else "linear": ctypes.pointer(image_of(picture))})
        call("quincunx_dispatch", self._service, byref(frame), byref(outputs), None)
        return picture

    def reports(self):
        """Of the frames since the last call: {"frame", "render", "used_previous", "passes": [(name, ms, bytes)]}."""
        found, passes = [], (PassReport * MAX_PASSES)()
        report = Report(passes=passes, pass_capacity=MAX_PASSES)
        while call("quincunx_next_report", self._service, byref(report)) == 0:
            found.append({"frame": report.frame_index, "render": (report.render_width, report.render_height),
                          "used_previous": bool(report.used_previous),
                          "passes": [(p.kernel.decode(), p.ms, p.bytes) for p in passes[:report.pass_count]]})
        return found


def number_of(name, value):
    """The number of a setting whose value may be a name."""
    choices = METHODS if name == "method" else {word: i for i, word in enumerate(CHOICES.get(name, ()))}
    if not isinstance(value, str):
        return value
    if value not in choices:
        raise ValueError(f"{name} is '{value}'; it must be one of {', '.join(choices) or 'numbers'}")
    return choices[value]
