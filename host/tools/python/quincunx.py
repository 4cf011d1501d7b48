# SPDX-License-Identifier: MIT
"""Quincunx from Python: resolves frames that are NumPy arrays, by the shared library's C interface.

    import quincunx
    resolver = quincunx.Resolver(output_extent=(1920, 1080), method="temporal", transparents=False)
    for frame in frames:
        picture = resolver.resolve(frame.colour, depth=frame.depth, velocity=frame.velocity, jitter=frame.jitter)

It needs NumPy, cffi and libquincunx.so.1, which is looked for where the system looks for libraries, or is the file that
the environment variable QUINCUNX_LIBRARY names. quincunx.h says what every setting and input means, docs/inputs.md has
the conventions. Errors are quincunx.Error with the library's sentence; its log goes to logging's "quincunx". A Resolver
belongs to one thread at a time, and to the process that made it.

cffi reads the C headers, so structs, numbers and functions are declared there alone, and a setting or an image that is
new in them is known here. It loads the library at run time (its ABI mode): one module then serves every processor and
every library of the same SONAME, and needs no compiler.
"""
import atexit
import json
import logging
import operator
import os
import re
import subprocess
import textwrap
import weakref
from collections import namedtuple
from pathlib import Path

import cffi
import numpy as np


class Error(RuntimeError):
    """Says what went wrong, in the library's words; `code` is that of quincunx.h."""

    def __init__(self, code, message):
        super().__init__(message)
        self.code = code

    def __reduce__(self):
        return Error, (self.code, str(self))


def declarations():
    """Returns what the C headers declare. They lie beside this file where it is installed, else in the source tree."""
    here = Path(__file__).resolve().parent
    headers = (here if (here / "include").is_dir() else here.parents[1]) / "include" / "quincunx"
    text = "".join((headers / name).read_text("utf-8")
                   for name in ("c/settings.h", "c/frame.h", "quincunx.h", "c/control.h"))
    text = re.sub(r"#ifdef __cplusplus.*?#endif", "", text, flags=re.S)
    return re.sub(r"^#(?!define \w+ \d).*|\bQUINCUNX_API ", "", text, flags=re.M)


def load():
    """Returns the library. Raises OSError where it is not found, and Error where it is too old."""
    library = FFI.dlopen(os.environ.get("QUINCUNX_LIBRARY", "libquincunx.so.1"))
    if library.quincunx_api_version() < library.QUINCUNX_API_VERSION:
        raise Error(library.QUINCUNX_UNSUPPORTED, f"this library has version {library.quincunx_api_version()} of the "
                    f"interface; this module needs {library.QUINCUNX_API_VERSION} at least")
    return library


FFI, DECLARATIONS = cffi.FFI(), declarations()
FFI.cdef(DECLARATIONS)
LIBRARY = load()
# {function: (type of its result, [(parameter, length of an array, else 0)])}
FUNCTIONS = {name: (result, [(parameter, int(getattr(LIBRARY, length, length) or 0)) for parameter, length in
                             re.findall(r"(\w+)(?:\[(\w+)\])?[,)]", parameters.replace("(void)", ""))])
             for result, name, parameters in re.findall(r"^([\w ]+\*?) quincunx_(\w+)(\([^)]*\));", DECLARATIONS, re.M)}
# {struct: {field: the comment behind it}}
COMMENTS = {struct: {name: " ".join(text.split()) for name, text in re.findall(
    r"(\w+)(?:\[\w+\])?; */\*(.*?)\*/", body, re.S)} for struct, body in re.findall(
        r"typedef struct quincunx_(\w+) \{(.*?)\n\}", DECLARATIONS, re.S)}
# {struct: {image: number of its format}}: the first format that the comment names.
IMAGES = {struct: {name: getattr(LIBRARY, "QUINCUNX_" + re.match(r"\w+", comments[name]).group())
                   for name, field in FFI.typeof("quincunx_" + struct).fields
                   if field.type.cname == "quincunx_image *"} for struct, comments in COMMENTS.items()}
ENUMS = {enum: FFI.typeof("enum quincunx_" + enum).elements
         for enum in re.findall(r"enum quincunx_(\w+) \{", DECLARATIONS)}
# {number of a format: (channels, type)}
FORMATS = {number: (len(channels), {"8": "uint8", "16F": "float16", "32F": "float32"}[bits])
           for number, name in ENUMS["format"].items() for channels, bits in re.findall(r"_([RGBA]+)(\w+)", name)}
# Fields that follow from what is given, and one that arrays do not need.
UNNAMED = {"struct_size", "kind", "method_count", "rectangle_count", "linear_format", "sync",
           *(name + "_format" for name in IMAGES["inputs"])}
KEPT = weakref.WeakKeyDictionary()  # what the pointers of a struct point to
OPENED_BY = set()  # the process that has used a device


@FFI.callback("quincunx_log_function")
def log(level, message, _):
    """Passes on a line of the library's log."""
    logging.getLogger("quincunx").log(10 * (level + 1), "%s", FFI.string(message).decode(errors="replace"))


LIBRARY.quincunx_set_log(log, FFI.NULL)
atexit.register(LIBRARY.quincunx_set_log, FFI.NULL, FFI.NULL)  # the library may outlive Python


def types_of(struct):
    """Returns the types of a struct's fields by their names."""
    return {name: field.type for name, field in FFI.typeof("quincunx_" + struct).fields}


def struct_at(kind):
    """Returns the name of the struct that a pointer points to; None for other types."""
    return kind.item.cname.partition("quincunx_")[2] if kind.kind == "pointer" and kind.item.kind == "struct" else None


def names_of(struct):
    """Returns the names of fields here, each with those there: {"output_extent": ["output_width", ...], ...}."""
    names = {}
    for field in types_of(struct):
        if field not in UNNAMED and "padding" not in field:
            names.setdefault(re.sub("_(width|height)$", "_extent", re.sub("_[xy]$", "", field)), []).append(field)
    return names


def word_of(name):
    """Returns the word for a number's name: "as-drawn" for QUINCUNX_AS_DRAWN."""
    return re.sub("^QUINCUNX_(BY_|SAMPLE_|VIEW_|CONTROL_)?|_VELOCITY$", "", name).lower().replace("_", "-")


def words_of(enum):
    """Returns the words for an enum's numbers: {"as-drawn": 0, ...}."""
    return {word_of(name): number for number, name in sorted(ENUMS[enum].items())}


# Settings that are numbers there and words here: fields that an enum is named after, and types of pixels.
CHOICES = {name: words_of(name) for struct in ("settings", "controller_settings") for name in types_of(struct)
           if name in ENUMS and name != "method"}
CHOICES["storage"] = {word: number for word, number in words_of("place").items() if word != "host"}
CHOICES["handle"] = words_of("handle")
CHOICES["colour"] = {kind: number for number, (channels, kind) in sorted(FORMATS.items()) if channels == 4}
CHOICES["history_format"] = {kind: CHOICES["colour"][kind] for kind in ("float16", "float32")}


def described(struct):
    """Decorates a class or function that takes the fields of a struct: its text gets the header's comments on them."""
    def decorate(thing):
        for name, fields in names_of(struct).items():
            words = f" ({' | '.join(CHOICES[name])})" if name in CHOICES else ""
            comment = next((COMMENTS[struct][field] for field in fields if field in COMMENTS[struct]), "")
            comment = re.sub(r"QUINCUNX_\w+", lambda found: word_of(found.group()), comment)
            thing.__doc__ += "\n" + textwrap.fill(f"    {name}{words}{': ' * bool(comment)}{comment}", 118,
                                                  subsequent_indent=" " * 8, break_on_hyphens=False)
        return thing
    return decorate


def number_of(name, value, kind):
    """Returns a number of a C type, which a word may stand for. Raises TypeError or ValueError where it is none."""
    if isinstance(value, str):
        if value not in CHOICES.get(name, ()):
            raise ValueError(f"{name} is '{value}'; it must be {'one of ' * (name in CHOICES)}"
                             f"{', '.join(CHOICES.get(name, ('a number',)))}")
        value = CHOICES[name][value]
    is_real = kind.cname in ("float", "double")
    try:
        number = float(value) if is_real else int(value) if isinstance(value, np.bool_) else operator.index(value)
        FFI.new(kind.cname + "[]", [number])
    except (TypeError, ValueError, OverflowError) as error:
        whole = f"a whole number of {8 * FFI.sizeof(kind)} bits" + ", from 0 on" * kind.cname.startswith("u")
        raise (TypeError if isinstance(error, TypeError) else ValueError)(
            f"{name} is {value!r}; it must be {'a number' if is_real else whole}") from None
    return number


def pair_of(name, value):
    """Returns two numbers. Raises ValueError where they are not two."""
    try:
        first, second = value
    except (TypeError, ValueError):
        raise ValueError(f"{name} is {value!r}; it must be a pair of numbers") from None
    return first, second


def numbers_of(name, value, shapes):
    """Returns the numbers of an array of one of the shapes. Raises ValueError where it is none."""
    array = np.asarray(value)
    if array.shape not in shapes or array.dtype.kind not in "biuf":
        of = f" of {array.dtype}" * (array.dtype.kind not in "biuf")
        raise ValueError(f"{name} has the shape {array.shape}{of}; it must be {' or '.join(map(str, shapes))}")
    return array.astype(float).ravel().tolist()


def value_of(name, value, kind, length=0, settings=None):
    """Returns a value as a field or a parameter takes it. Raises TypeError or ValueError where it cannot be one."""
    if kind.kind == "primitive":
        return number_of(name, value, kind)
    if kind.kind == "array" or length:
        return numbers_of(name, value, ((length,),) if length else ((4, 4), (kind.length,)))
    if value is None or isinstance(value, FFI.CData):
        return FFI.NULL if value is None else value
    if kind.item.cname == "char":
        if isinstance(value, str) and "\0" not in value:
            return value.encode()
        raise TypeError(f"{name} is {value!r}; it must be text")
    struct = struct_at(kind)
    if isinstance(value, dict) and struct in IMAGES:
        return fill(struct, new(struct), value, settings, name + ".")
    if isinstance(value, Handle) and value.OBJECT == struct:
        return value.object
    owner = next((each.__name__ for each in Handle.__subclasses__() if each.OBJECT == struct), "dict")
    raise TypeError(f"{name} is {value!r}; it must be of {owner}")


def new(struct, **fields):
    """Returns a struct that knows its size. What its pointers point to lives as long."""
    made = FFI.new(f"quincunx_{struct} *", {"struct_size": FFI.sizeof("quincunx_" + struct), **fields})
    KEPT[made] = list(fields.values())
    return made


def fill(struct, made, values, settings=None, where=""):
    """Sets fields of a struct by their names here, and returns it. Raises TypeError or ValueError for what cannot be.

    A word may stand for a number, a pair for x and y or width and height. An array becomes an image of the format that
    the settings have for it, or else the header; a dictionary a struct; a list an array and its count.
    """
    names, types = names_of(struct), types_of(struct)
    for name, value in values.items():
        if name not in names:
            what = {"settings": "setting", "inputs": "input"}.get(struct.split("_")[-1], "field of " + struct.title())
            raise TypeError(f"'{name}' is no {what}; there are: {', '.join(names)}")
        for field, part in zip(names[name], (value,) if len(names[name]) == 1 else pair_of(name, value)):
            kind, count = types[field], field[:-1] + "_count"
            if field in IMAGES[struct] and part is not None and not isinstance(part, FFI.CData):
                number = getattr(settings, field + "_format", IMAGES[struct][field])
                part = image_over(pixels_of(where + field, part, *FORMATS[number]), number)
            elif count in types:
                of_texts, whole = kind.item.kind == "pointer", FFI.typeof("int32_t")
                items = [FFI.new("char[]", value_of(f"a name in {field}", item, kind.item)) if of_texts else
                         [number_of(where + field, number, whole) for number in item] for item in part]
                if not of_texts and any(len(item) != len(kind.item.fields) for item in items):
                    raise ValueError(f"{where}{field} is {part!r}; each must have {len(kind.item.fields)} numbers")
                KEPT[made].append(items)
                part = FFI.new(FFI.getctype(kind.item, "[]"), items)
                setattr(made, count, len(part))
            part = value_of(where + field, part, kind, settings=settings)
            setattr(made, field, part)
            KEPT[made].append(part)
    if "render_width" in types and IMAGES[struct] and made.colour and not made.render_width:
        made.render_width, made.render_height = made.colour.width, made.colour.height
    return made


def values_of(struct, made):
    """Returns the numbers and texts of a struct by their names here."""
    read = {name: [getattr(made, field) for field in fields] for name, fields in names_of(struct).items()}
    return {name: tuple(value) if len(value) > 1 else text_at(value[0]) for name, value in read.items()}


def text_at(value):
    """Returns the text that a pointer points to, None for none; other values as they are."""
    if not isinstance(value, FFI.CData) or FFI.typeof(value).item.cname != "char":
        return value
    return FFI.string(value).decode() if value else None


def call(name, *arguments):
    """Returns what a function returns, or writes to the parameter that is not given; None where that is not known yet.

    Raises Error where it fails, and where it needs a device in a process forked from one that has used one.
    """
    function, (result, parameters) = getattr(LIBRARY, "quincunx_" + name), FUNCTIONS[name]
    kinds = FFI.typeof(function).args
    if any(re.search("quincunx_(device|service|memory|semaphore)", kind.cname) for kind in kinds):
        OPENED_BY.add(os.getpid())
        if len(OPENED_BY) > 1:
            raise Error(LIBRARY.QUINCUNX_UNSUPPORTED, "OpenCL does not work in this process, which was forked from one "
                        "that had used a device; start it by multiprocessing's method 'spawn'")
    given = [value_of(parameter, value, kind, length)
             for (parameter, length), value, kind in zip(parameters, arguments, kinds)]
    rest = kinds[len(given):]
    room = [new(struct_at(kind)) if struct_at(kind) in IMAGES else FFI.new(
        FFI.getctype(kind.item, "[]"), parameters[-1][1] or 1) for kind in rest]
    value = function(*given, *room)
    if result == "quincunx_status" and value not in (LIBRARY.QUINCUNX_OK, LIBRARY.QUINCUNX_NOT_READY):
        raise Error(value, call("last_error"))
    if not room:
        return text_at(value)
    if value == LIBRARY.QUINCUNX_NOT_READY and result == "quincunx_status":
        return None
    if struct_at(rest[0]):
        return room[0]
    if rest[0].item.kind == "pointer":
        return owned(room[0][0])
    return tuple(room[0]) if parameters[-1][1] else room[0][0]


def owned(made):
    """Returns an object that is destroyed with the last reference, but never in a forked process."""
    destroy, process = getattr(LIBRARY, FFI.typeof(made).item.cname + "_destroy"), os.getpid()
    return FFI.gc(made, lambda last, getpid=os.getpid: destroy(last) if getpid() == process else None)


class Handle:
    """An object of the library's, which lives as long as this. It can be neither copied nor pickled."""

    OBJECT, object = None, None  # the name of its functions; what they take

    def __reduce_ex__(self, protocol):
        raise TypeError(f"a {type(self).__name__} can be neither copied nor pickled; make another where it is needed")

    def _call(self, what, *arguments):
        return call(f"{self.OBJECT}_{what}", self.object, *arguments)


Needs = namedtuple("Needs", names_of("needs"))


def jitter(frame_index, render_extent, output_extent):
    """Returns where the samples of a frame lie, for the method "temporal": (x, y) in pixels, +x right, +y down.

    Several frames see more than one only if their samples lie elsewhere in each: move the camera's projection by it.
    """
    return call("jitter", frame_index, *render_extent, *output_extent)


def jitter_phases(render_extent, output_extent):
    """Returns after how many frames jitter() begins again."""
    return call("jitter_phases", *render_extent, *output_extent)


def texture_lod_bias(render_extent, output_extent):
    """Returns what to add to the textures' level of detail where frames have that jitter."""
    return call("texture_lod_bias", *render_extent, *output_extent)


def variants():
    """Returns the names of methods with the settings that matter to them, by growing effort: "temporal:fast"."""
    names = []
    while (name := call("variant_name", len(names))) is not None:
        names.append(name)
    return names


def mix_of(**content):
    """Returns shares of (still, pan, objects, thin, light, zoom), 1 together, of content: moving=, speed_px=, ..."""
    return call("mix_of", content)


def converted(name, array, channels, kind):
    """Returns an array's values in a type in which they mean the same. Raises ValueError where they do not.

    True is the largest value. Floating point takes floating point, where too large becomes the largest half, and
    integers that are 0, or signed and 1: others may be codes or numbers. uint8 takes integers that are such codes, but
    none of a signed type that has only 0 and 1; and in one channel, floating point from 0 to 1.
    """
    own, are_codes = array.dtype.kind, kind == "uint8"
    if array.dtype == kind:
        return array
    if own == "b":
        return np.where(array, 255 if are_codes else 1, 0).astype(kind)
    if own == "f" and not are_codes:
        with np.errstate(over="ignore"):
            made = array.astype(kind)
        beyond = np.isinf(made) & np.isfinite(array)
        if kind == "float16" or not beyond.any():
            made[beyond] = np.copysign(np.finfo(kind).max, array[beyond])
            return made
    low, high = (array.min(), array.max()) if own in "iuf" else (0, 0)
    if own == "f" and channels == 1 and -0.5 < 255 * float(low) and 255 * float(high) < 255.5:
        return np.clip(np.rint(255 * array.astype(np.float64)), 0, 255).astype(kind)
    if own in "iu" and low >= 0 and (high == 0 or high <= 255 and (own == "u" or high > 1) if are_codes else
                                     high <= (own == "i")):
        return array.astype(kind)
    right = (f"{kind}, or floating point within its range" + ", linear; pictures of uint8 want a Resolver with "
             "colour='uint8'" * (channels == 4) if not are_codes else
             "uint8, sRGB encoded; linear light wants a Resolver with colour='float32'" if channels == 4 else
             "uint8, floating point from 0 to 1, or bool")
    raise ValueError(f"{name} is {array.dtype}{f' from {low} to {high}' * (own in 'iuf')}; it must be {right}")


def pixels_of(name, given, channels, kind):
    """Returns an array of (height, width, channels) whose rows are whole, in place where it is such."""
    if np.ma.is_masked(given):
        raise ValueError(f"{name} has masked pixels; it must have a value for each, as filled() gives them")
    array = np.asarray(given)
    array = np.asarray(array.tolist()) if array.dtype == object else array
    array = array[:, :, np.newaxis] if array.ndim == 2 else array
    no_alpha = array.ndim == 3 and (channels, array.shape[2]) == (4, 3)
    if array.ndim != 3 or array.shape[2] != channels - no_alpha or array.size == 0:
        raise ValueError(f"{name} has the shape {array.shape}; it must be (height, width, {channels})")
    array = converted(name, array, channels, kind)
    if no_alpha:  # colour without alpha covers all
        array = np.dstack([array, np.full(array.shape[:2], 255 if kind == "uint8" else 1, kind)])
    rows_are_whole = array.strides[1:] == (channels * array.itemsize, array.itemsize)
    return array if rows_are_whole and array.strides[0] >= array[0].nbytes else np.ascontiguousarray(array)


def image_over(pixels, number):
    """Returns an image over an array's memory."""
    made = new("image", place=LIBRARY.QUINCUNX_HOST, format=number, width=pixels.shape[1], height=pixels.shape[0],
               pitch=pixels.strides[0] if len(pixels) > 1 else 0,
               memory=FFI.cast("void *", pixels.__array_interface__["data"][0]))
    KEPT[made].append(pixels)
    return made


@described("settings")
class Resolver(Handle):
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
        self.output_extent, self._settings = pair_of("output_extent", output_extent), call("settings_init")
        self._settings.colour_format = number_of("colour", str(colour), FFI.typeof("int32_t"))
        self._settings.velocity_format = LIBRARY.QUINCUNX_RG32F
        if isinstance(settings.get("method"), str):
            call("settings_set_method", self._settings, settings.pop("method"))
        sizes = {"output_extent": output_extent, "target_extent": target_extent or output_extent}
        fill("settings", self._settings, {**sizes, **settings})
        self._plan = call("plan_create", self._settings)
        self._device = call("device_open", str(device))
        self._service = call("service_create", self._device, self._plan)
        # Which inputs resolve() wants: reads_depth, reads_velocity, ...
        self.needs = Needs(**values_of("needs", call("plan_needs", self._plan)))

    def __str__(self):
        """Returns the plan: passes, images, bytes, and why."""
        return call("plan_text", self._plan)

    def device(self):
        """Returns {"name", "profile": how work is cut for it, "pass_timer": what times its passes, "uuid": bytes}."""
        return {**{name: call("device_" + name, self._device) for name in ("name", "profile", "pass_timer")},
                "uuid": bytes(map(int, call("device_uuid", self._device)))}

    def finish(self):
        """Waits until all that was begun is done: pictures that went into an image of SharedMemory, too."""
        call("finish", self._service)

    def allow_timing_waits(self, allow=True):
        """Lets frames wait for each pass where the pass timer is "host clock", so that passes have times."""
        call("allow_timing_waits", self._service, bool(allow))

    def reads_history(self, render_extent, output_extent=(0, 0)):
        """Returns whether a frame of this size reads earlier ones where there are any."""
        return bool(call("plan_reads_history", self._plan, *render_extent, *output_extent))

    def focus_plan(self):
        """Returns the plan of the focus's region, as text. Raises Error where there is none."""
        return call("plan_text", call("plan_focus", self._plan))

    @described("inputs")
    def resolve(self, colour, depth=None, velocity=None, reactive=None, jitter=(0, 0), presented=False,
                output_extent=None, fading_from=None, fade_weight=1, out=None, **inputs):
        """Returns the picture of one frame, an array of (height, width, 4).

        It is linear float32, or with presented=True sRGB encoded uint8. Arrays of the frame's size are colour (h, w, 3
        or 4), depth (h, w), velocity (h, w, 2) and reactive (h, w), which is uint8, 0 to 1 or bool. converted() says
        how other types are taken, or refused. docs/inputs.md has the conventions. Images of SharedMemory stand for
        arrays; with one as `out` the picture goes there, which is returned at once: finish() waits for it.

        clip_to_previous_clip  (4, 4) or 16 numbers, column by column: of a matrix that multiplies columns (m @ v) m.T
        particles              {"colour": (h, w, 4), "depth": (h, w), "reactive": (h, w)}, of a size of their own
        focus                  {"colour", "depth", ... and other inputs of the region's frame, "x", "y": its upper left
                               output pixel, "rectangles": [(x, y, width, height)], at most four, "feather": output
                               pixels, "mask": (height, width) of the region, as reactive}
        fading_from            in place of fade: another method's linear picture of this frame, of which it keeps
                               1 - fade_weight
        """
        if fading_from is not None:
            inputs["fade"] = {"from": fading_from, "weight": fade_weight}
        if inputs.get("focus") is not None:
            parts = {"frame": {}}
            for name, value in inputs["focus"].items():
                (parts if name in names_of("focus") else parts["frame"])[name] = value
            inputs["focus"] = parts
        frame = fill("inputs", new("inputs"), {
            "colour": colour, "depth": depth, "velocity": velocity, "reactive": reactive, "jitter": jitter,
            "output_extent": output_extent or (0, 0), **inputs}, self._settings)
        name = "presented" if presented else "linear"
        number = getattr(self._settings, name + "_format", IMAGES["outputs"][name])
        picture = out
        if out is None:
            picture = np.empty((*self.output_extent[::-1], FORMATS[number][0]), FORMATS[number][1])
        image = image_over(picture, number) if out is None else out
        call("dispatch", self._service, frame, new("outputs", **{name: image}), None)
        return picture

    def reports(self):
        """Returns a dictionary for each frame since the last call:

        frame_index, render_extent, output_extent, used_previous, focused, non_finite_pixels
        passes   [(name, ms, bytes)]; names of a focus's begin with "focus: "
        content  with the setting measures_content: the shares of ContentStatistics by name; else None
        motion   with the setting checks_motion: what the frames say of velocity, and by how many dB it is better
        """
        found, room, content = [], LIBRARY.QUINCUNX_MAX_PASSES, new("content")
        passes, in_focus = FFI.new("quincunx_pass_report[]", room), FFI.new("int32_t[]", room)
        report = new("report", passes=passes, pass_capacity=room, in_focus=in_focus, content=content)
        while call("next_report", self._service, report) == LIBRARY.QUINCUNX_OK:
            values = values_of("report", report)
            found.append({
                **{name: values[name]
                   for name in ("frame_index", "render_extent", "output_extent", "non_finite_pixels")},
                "used_previous": bool(report.used_previous), "focused": bool(report.focused),
                "content": values_of("content", content) if report.content_known else None,
                "motion": (values["motion"], report.motion_margin_db) if report.motion else None,
                "passes": [("focus: " * bool(in_focus[i]) + text_at(passes[i].kernel), passes[i].ms, passes[i].bytes)
                           for i in range(report.pass_count)]})
        return found


@described("external_memory")
class SharedMemory(Handle):
    """Memory of Vulkan, OpenGL or another API of the same machine, of which frames are read and into which pictures go.

    resolver  the Resolver on whose device it is
    mapped    in place of fd: an array over memory that was mapped, for devices that are the processor
    device    bytes: the UUID of the device that it was allocated on, to be compared with resolver.device()["uuid"]

        memory.acquire()
        resolver.resolve(memory.image((h, w, 4), "float16"), ..., out=memory.image((height, width, 4), "float32", offset))
        memory.release()
    """

    OBJECT = "memory"

    def __init__(self, resolver, mapped=None, device=bytes(16), **external):
        if not isinstance(resolver, Resolver):
            raise TypeError(f"resolver is {resolver!r}; it must be of Resolver")
        if not isinstance(device, bytes) or len(device) != 16:
            raise ValueError(f"device is {device!r}; it must be the 16 bytes of a UUID")
        made = fill("external_memory", new("external_memory", fd=-1), external)
        made.device = device
        if mapped is not None:
            if not isinstance(mapped, np.ndarray) or not mapped.flags.c_contiguous:
                raise ValueError("mapped must be an array whose bytes follow one another")
            made.handle, made.bytes = LIBRARY.QUINCUNX_MAPPED, made.bytes or mapped.nbytes
            made.mapped = FFI.cast("void *", mapped.__array_interface__["data"][0])
        self.object, self._kept = call("memory_import", resolver._device, made), mapped

    def image(self, shape, kind, offset=0, pitch=0):
        """Returns an image in it, of (height, width[, channels]) and of a type, as "float16" or "uint8".

        `offset` bytes from the start, a multiple of 16; `pitch` bytes from one row to the next, 0: tightly packed.
        """
        height, width, channels = (*shape, 1)[:3]
        number = next((number for number, has in FORMATS.items() if has == (channels, str(np.dtype(kind)))), None)
        if number is None:
            raise ValueError(f"an image of {channels} channels of {kind} is none of {sorted(set(FORMATS.values()))}")
        made = new("image", place=LIBRARY.QUINCUNX_BUFFER, format=number, width=width, height=height, offset=offset,
                   pitch=pitch, memory=self._call("object"))
        KEPT[made].append(self)
        return made

    def acquire(self):
        """Takes it from the other API, which owns it first. Enqueued."""
        self._call("acquire")

    def release(self):
        """Gives it back to the other API. Enqueued: Resolver.finish() waits for it, or the other API for a Semaphore."""
        self._call("release", None)


class Semaphore(Handle):
    """A binary semaphore of Vulkan or OpenGL, on the device of `resolver`. `fd` is imported, and stays the caller's."""

    OBJECT = "semaphore"

    def __init__(self, resolver, fd):
        if not isinstance(resolver, Resolver):
            raise TypeError(f"resolver is {resolver!r}; it must be of Resolver")
        self.object = call("semaphore_import", resolver._device, fd)

    def wait(self):
        """Lets what is enqueued from now on wait until the other API has signalled it."""
        self._call("wait")

    def signal(self):
        """Signals it when all that was enqueued is done."""
        self._call("signal")


def resolve_sequence(pattern, out=None, *, program="quincunx-resolve", **options):
    """Resolves an EXR sequence by the program quincunx-resolve, as docs/sequences.md says, and returns its report.

        report = quincunx.resolve_sequence("shot/shot.%04d.exr", "up/up.%04d.exr", output=(3840, 2160), two_way=8)

    `pattern` and `out` name the files as the program wants them, or `pattern` a recording's folder. The program's
    options are keywords: numbers and text as they are, pairs as tuples, True for one without a value; None and False
    leave it out. two_way=8 looks eight frames ahead, 0 none. The report is that of --json, a dict: settings, frames,
    passes, scores (with truth), files and more; {} where nothing was left to do. Options that make the program print
    text, as explain=True does, return it, a str. Blocks; any thread may call it. Raises OSError where there is no
    program, and Error with the program's sentence: code 1 for wrong options, 4 for frames that cannot be read, written
    or resolved.
    """
    words = [program, pattern, "--json", "--quiet"] + (["--out", out] if out is not None else [])
    for name, value in options.items():
        if isinstance(value, (tuple, list, np.ndarray)):
            value = ("x" if name == "output" else ",").join(map(str, value))
        if value is not None and value is not False and name not in ("json", "quiet"):
            words.append("--" + name.replace("_", "-") + ("" if value is True else f"={value}"))
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        raise Error(LIBRARY.QUINCUNX_INVALID_ARGUMENT if done.returncode == 2 else LIBRARY.QUINCUNX_IO_FAILURE,
                    done.stderr.strip().removeprefix("error: "))
    try:
        return json.loads(done.stdout or "{}")
    except json.JSONDecodeError:
        return done.stdout


def settings_of(name, fields):
    """Returns a struct of settings: its defaults, and fields by name."""
    return fill(name + "_settings", call(name + "_settings_init"), fields)


@described("controller_settings")
class Controller(Handle):
    """Chooses each frame's size from the times of frames past; the base of those below.

    Pure: the same calls give the same sizes. Settings outside their ranges raise Error.

        controller = quincunx.PredictiveController(output_extent=(1920, 1080), target_ms=16.7)
        each frame: width, height = controller.next(); then controller.observe(number, (width, height), gpu_ms)
    """

    OBJECT, KIND = "controller", None

    def __init__(self, **settings):
        made = settings_of("controller", settings)
        made.kind = self.KIND
        self.object = call("controller_create", made)

    @property
    def name(self):
        """ "predictive" """
        return self._call("name")

    @property
    def target_ms(self):
        """The time that a frame may take; may be set, in (0, 60000]."""
        return self._call("target_ms")

    @target_ms.setter
    def target_ms(self, value):
        self._call("set_target_ms", value)

    def ladder(self):
        """Returns the sizes to choose from, (width, height) in pixels, from the smallest."""
        return [self._call("rung", rung) for rung in range(self._call("rung_count"))]

    @described("timing")
    def observe(self, frame, render_extent, gpu_ms, content=None, **times):
        """Learns from one past frame, oldest first. `content` is a dictionary, as Resolver.reports() has them.

        Raises Error for what cannot be; nothing has changed then.
        """
        timing = {"frame": frame, "render_extent": render_extent, "gpu_ms": gpu_ms, "content": content, **times}
        self._call("observe", timing)

    def choice(self):
        """Returns {"render_extent": (width, height), "rung", "method", "fading_from", "weight"}.

        method and fading_from are names of variants(), None where none is chosen. With fading_from, resolve with that
        as well and give its picture to resolve(fading_from=..., fade_weight=weight).
        """
        return values_of("choice", self._call("choice"))

    def next(self):
        """Returns the (width, height) to draw the next frame at; at first the largest."""
        return self.choice()["render_extent"]


class ProportionalController(Controller):
    """Binks's controller."""

    KIND = LIBRARY.QUINCUNX_CONTROL_PROPORTIONAL


class MinimumOfNController(Controller):
    """The shortest of the last times decides."""

    KIND = LIBRARY.QUINCUNX_CONTROL_MINIMUM_OF_N


class PredictiveController(Controller):
    """Predicts the next frame's time and spends what the display's queue allows. `calibration` is a CostTable."""

    KIND = LIBRARY.QUINCUNX_CONTROL_PREDICTIVE


class QualityController(Controller):
    """Chooses method and size whose expected error is the least that fits. `front` is an ErrorFront."""

    KIND = LIBRARY.QUINCUNX_CONTROL_QUALITY

    def explain(self):
        """Returns why the last choice was made, in a few lines."""
        return self._call("text")


class CostTable(Handle):
    """Measured frame times by resolution, whose confidence halves in half_life_frames, in [1, 1e9].

    `json` is the str() of a table. Errors raise Error.
    """

    OBJECT = "costs"

    def __init__(self, half_life_frames=3600, json=None):
        self.object = call("costs_create", half_life_frames) if json is None else call("costs_parse", json)

    def __str__(self):
        return self._call("text")

    def record(self, frame, area_fraction, gpu_ms):
        """Learns that a frame of this part of the output's pixels, in (0, 4], took gpu_ms, in (0, 60000]."""
        self._call("record", frame, area_fraction, gpu_ms)

    def confidence(self, area_fraction):
        """Returns a number in [0, 1]; 0 where nothing was recorded."""
        return self._call("confidence", area_fraction)

    def predict(self, area_fraction, fixed_part=0.25):
        """Returns the expected time in ms, if fixed_part of it does not scale; None where nothing is known."""
        return self._call("predict", area_fraction, fixed_part)

    def fixed_part(self):
        """Returns the part of the cost that does not scale; None where too little was recorded."""
        return self._call("fixed_part")


class ErrorFront(Handle):
    """How wrong each method's picture is at each scale, and what it costs.

    `json` is the str() of a front; None: the one that is built in. `resolver`: that of its device, for a scene's name.
    """

    OBJECT = "front"

    def __init__(self, json=None, resolver=None, scene=""):
        if resolver is not None and not isinstance(resolver, Resolver):
            raise TypeError(f"resolver is {resolver!r}; it must be of Resolver")
        self.object = call("front_parse", json) if resolver is None else call("front_find", resolver._device, scene)

    def __str__(self):
        return self._call("text")

    def summary(self):
        """Returns where its figures come from."""
        return self._call("summary")

    def flip(self, mix, method, scale):
        """Returns the expected mean FLIP of a mix (as mix_of() gives it) at a scale per axis, above 0."""
        return self._call("flip", mix, method, scale)

    def resolve_ms(self, method, scale, output_megapixels):
        """Returns the milliseconds of the method's passes for an output of so many megapixels, above 0."""
        return self._call("resolve_ms", method, scale, output_megapixels)


@described("output_settings")
class OutputFollower(Handle):
    """An output that goes along with the size of frames, for resolve(output_extent=...)."""

    OBJECT = "output_follower"

    def __init__(self, **settings):
        self.object = call("output_follower_create", settings_of("output", settings))

    def observe(self, render_extent):
        """Returns the output's (width, height). Called once per frame with the (width, height) that it is drawn at."""
        return self._call("observe", *render_extent)

    def min_output(self):
        """Returns the smallest output that there may be, for the setting min_output_extent."""
        return self._call("min_output")


@described("detail_settings")
class DetailFollower(Handle):
    """Levels of detail that go along with the resolution."""

    OBJECT = "detail_follower"

    def __init__(self, **settings):
        self.object = call("detail_follower_create", settings_of("detail", settings))

    def observe(self, area_fraction):
        """Returns the level; 0 is the full detail. Called once per frame with its pixels over the output's."""
        return self._call("observe", area_fraction)
