# SPDX-License-Identifier: MIT
"""Stands in for Blender's module: as much of it as quincunx_blender touches, and as strict as Blender is there.

An Owner refuses attributes that it does not have, and values that Blender would refuse.
"""
import os
import types as python_types

DEPTHS = {"JPEG": ("8",), "PNG": ("8", "16"), "OPEN_EXR": ("16", "32"), "OPEN_EXR_MULTILAYER": ("16", "32")}


class Owner:
    """Attributes with values, as a scene has them."""

    def __init__(self, **values):
        self.__dict__.update(values)

    def __setattr__(self, name, value):
        if name not in self.__dict__:
            raise AttributeError(name)
        if isinstance(self.__dict__[name], (int, float)) != isinstance(value, (int, float)):
            raise TypeError(f"{name}: {value!r}")
        self.__dict__[name] = value


class ImageSettings(Owner):
    """As in Blender, the depths depend on the format, and a new format may change the depth."""

    def __setattr__(self, name, value):
        if name == "color_depth" and value not in DEPTHS[self.file_format]:
            raise TypeError(f"enum {value!r} not found in {DEPTHS[self.file_format]}")
        super().__setattr__(name, value)
        if name == "file_format" and self.color_depth not in DEPTHS[value]:
            self.__dict__["color_depth"] = DEPTHS[value][0]


class Point:
    interpolation = "BEZIER"


class Curve:
    def __init__(self):
        self.driver = Owner(type="SCRIPTED", expression="")
        self.modifiers = ["generator"]
        self.keys = {}
        self.keyframe_points = self

    def insert(self, frame, value):
        self.keys[frame] = value
        return Point()


class CameraData(Owner):
    def __init__(self, **values):
        super().__init__(**{"type": "PERSP", "sensor_fit": "AUTO", "shift_x": 0.0, "shift_y": 0.0,
                            "animation_data": None, "curves": {}, **values})

    def copy(self):
        made = CameraData(**{**self.__dict__, "curves": dict(self.curves)})
        data.cameras.append(made)
        return made

    def driver_add(self, path):
        self.curves[path] = Curve()
        return self.curves[path]

    def driver_remove(self, path):
        self.curves.pop(path, None)


class Camera(Owner):
    """`moves`: its data's Shift X is a hundredth of the frame."""

    def __init__(self, moves=False, **values):
        super().__init__(**{"type": "CAMERA", "library": None, "data": CameraData(), "moves": moves, **values})
        data.cameras.append(self.data)
        if moves:
            self.data.animation_data = "an action"

    def evaluated_get(self, _graph):
        shift_x = context.scene.frame_current / 100 if self.moves else self.data.shift_x
        return Owner(data=CameraData(shift_x=shift_x, shift_y=self.data.shift_y))


class Scene(Owner):
    def frame_set(self, frame, subframe=0.0):
        self.frame_current, self.frame_subframe = frame, subframe


class Handlers:
    def __init__(self):
        self.render_complete, self.render_cancel = [], []


def reset(folder):
    """A new file in `folder`: 64x36 pixels, frames 1 to 3, a JPEG for output, motion blur on."""
    global app, data, context, ops
    app = Owner(background=True, handlers=Handlers())
    data = Owner(cameras=[], images=Owner(loaded=[]))
    data.images.__dict__["load"] = load
    image = ImageSettings(file_format="JPEG", color_mode="RGB", color_depth="8", exr_codec="DWAA",
                          color_management="OVERRIDE")
    render = Owner(
        engine="CYCLES", resolution_x=64, resolution_y=36, resolution_percentage=100, pixel_aspect_x=1.0,
        pixel_aspect_y=1.0, filepath=os.path.join(folder, "shot_"), use_file_extension=False, use_overwrite=False,
        use_placeholder=True, use_motion_blur=True, motion_blur_shutter=0.5, use_compositing=True, use_sequencer=True,
        use_lock_interface=False, use_border=False, use_multiview=False, frame_map_old=100, frame_map_new=100,
        image_settings=image)
    layer = Owner(name="ViewLayer", use=True, use_pass_combined=False, use_pass_z=False, use_pass_vector=False,
                  depsgraph=None, cycles=Owner(denoising_store_passes=False))
    cycles = Owner(pixel_filter_type="BOX", filter_width=1.5, use_animated_seed=False, use_denoising=False)
    choices = Owner(percent=50, method="temporal", options="", draft=False, keep=False)
    scene = Scene(name="Scene", render=render, cycles=cycles, view_layers=[layer], timeline_markers=[], frame_start=1,
                  frame_end=3, frame_step=1, frame_current=7, frame_subframe=0.5, camera=Camera(), quincunx=choices)
    context = Owner(scene=scene, view_layer=layer, preferences=Owner(addons={}), window_manager=Owner(windows=[]))
    ops = Owner(render=Owner(render=render_files))


def load(path, check_existing):
    del check_existing
    image = Owner(path=path, source="FILE", reload=lambda: None)
    data.images.loaded.append(image)
    return image


def render_files(**_):
    """What bpy.ops.render.render does when all goes well."""
    for frame in range(context.scene.frame_start, context.scene.frame_end + 1):
        with open(context.scene.render.filepath.replace("####", f"{frame:04}") + ".exr", "w", encoding="ascii"):
            pass
    for handler in list(app.handlers.render_complete):
        handler(context.scene)
    return {"FINISHED"}


def describe(owner):
    """Everything below an owner that a user could have set, to be compared with what it is later."""
    if isinstance(owner, (list, tuple)):
        return [describe(item) for item in owner]
    if isinstance(owner, Owner):
        return {"id": id(owner), **{name: describe(value) for name, value in owner.__dict__.items()}}
    return owner


types = python_types.SimpleNamespace(PropertyGroup=object, AddonPreferences=object, Operator=object, Panel=object,
                                     Scene=python_types.SimpleNamespace(quincunx=None))
props = python_types.SimpleNamespace(**{
    name: lambda **_: None for name in ("IntProperty", "EnumProperty", "BoolProperty", "StringProperty")})
path = python_types.SimpleNamespace(abspath=lambda text: text)
utils = python_types.SimpleNamespace(register_class=None, unregister_class=None)
app = data = context = ops = None
