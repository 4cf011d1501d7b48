# SPDX-License-Identifier: MIT
"""Shows the Blender add-on at work, for scripts/blender_pictures.sh: Blender runs this with a window.

blender FILE.blend --window-geometry 0 0 1600 900 --python scripts/blender_panel.py -- FOLDER_OF_ADD_ON FOLDER_OF_PICTURES

It presses the panel's button, takes pictures of the window before, while frames are resolved and afterwards, and ends
Blender with exit status 1 if a setting was not put back or no result was loaded.
"""
import os
import sys
import traceback

import bpy

ADD_ON, PICTURES = sys.argv[sys.argv.index("--") + 1:]
sys.path.append(ADD_ON)
import quincunx_blender as addon  # noqa: E402


def settings():
    scene = bpy.context.scene
    owners = [scene.render, scene.render.image_settings, scene.cycles, bpy.context.view_layer]
    return [str(getattr(owner, item.identifier)) for owner in owners for item in owner.bl_rna.properties
            if item.type in ("INT", "FLOAT", "BOOLEAN", "STRING", "ENUM")] + [scene.camera.data.name]


def take(name):
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.screen.screenshot(filepath=os.path.join(PICTURES, name))


def arrange():
    """The results where the scene is seen; the output properties, and nothing else, beside them."""
    areas = {area.type: area for area in bpy.context.window_manager.windows[0].screen.areas}
    areas["VIEW_3D"].type = "IMAGE_EDITOR"
    areas["PROPERTIES"].spaces.active.context = "OUTPUT"
    for name in dir(bpy.types):  # Blender's own panels of this tab, which would hide ours
        panel = getattr(bpy.types, name)
        if getattr(panel, "bl_context", "") == "output" and name not in ("RENDER_PT_format", "QUINCUNX_PT_output"):
            bpy.utils.unregister_class(panel)


def steps():
    """Yields how many seconds to wait."""
    addon.register()
    bpy.context.preferences.view.show_splash = False
    bpy.context.preferences.view.render_display_type = "NONE"
    arrange()
    yield 2
    take("panel.png")
    before = settings()
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.quincunx.render("INVOKE_DEFAULT")
    while addon.QUINCUNX_OT_render.job:
        yield 0.05
        job = addon.QUINCUNX_OT_render.job
        if job and 0.1 < job.progress()[0] < 1 and not os.path.exists(os.path.join(PICTURES, "resolving.png")):
            take("resolving.png")
    bpy.context.scene.frame_set(bpy.context.scene.frame_end)
    yield 2
    take("loaded.png")
    changed = [(old, new) for old, new in zip(before, settings()) if old != new]
    loaded = [image.source for image in bpy.data.images if image.filepath.endswith(".exr")]
    print("changed", changed, "loaded", loaded, flush=True)
    os._exit(0 if not changed and loaded == ["SEQUENCE"] else 1)  # Blender would ask whether to save


def next_step():
    try:
        return next(STEPS)
    except BaseException:  # else the window stays open
        traceback.print_exc()
        os._exit(1)


STEPS = steps()
bpy.app.timers.register(next_step, first_interval=2)
