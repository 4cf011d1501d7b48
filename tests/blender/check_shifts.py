# SPDX-License-Identifier: MIT
"""In Blender: whether the add-on's shift moves what a camera sees by exactly the jitter, and small frames show all.

blender -b FILE.blend --python check_shifts.py -- FOLDER_OF_ADD_ON; prints the largest errors, in pixels of a frame.
"""
import itertools
import sys

import bpy

sys.path.append(sys.argv[sys.argv.index("--") + 1])
import quincunx_blender as addon  # noqa: E402

POINT = (0.3, -0.2, -3, 1)  # before the camera
JITTER = (0.4, -0.3)
CAMERA = bpy.context.scene.camera


def seen_at(size, aspect):
    """Where the camera has the point: parts of the picture, +x right, +y down."""
    bpy.context.view_layer.update()
    graph = bpy.context.evaluated_depsgraph_get()
    matrix = CAMERA.calc_matrix_camera(graph, x=size[0], y=size[1], scale_x=aspect[0], scale_y=aspect[1])
    x, y, _, w = (sum(a * b for a, b in zip(row, POINT)) for row in matrix)
    return (1 + x / w) / 2, (1 - y / w) / 2


def errors(full, aspect, fit, kind):
    """Of the jitter, and of the small picture."""
    data = CAMERA.data
    data.type, data.sensor_fit, data.sensor_height = kind, fit, 20
    data.shift_x, data.shift_y = 0.1, -0.2
    small = addon.small_size(full, 50)
    small_aspect = addon.small_aspect(small, full, aspect)
    at_full, before = seen_at(full, aspect), seen_at(small, small_aspect)
    shift = addon.shift_of(JITTER, small, small_aspect, fit)
    data.shift_x, data.shift_y = data.shift_x + shift[0], data.shift_y + shift[1]
    after = seen_at(small, small_aspect)
    return (max(abs((after[i] - before[i]) * small[i] + JITTER[i]) for i in (0, 1)),
            max(abs((before[i] - at_full[i]) * small[i]) for i in (0, 1)))


SHAPES = [((480, 270), (1, 1)), ((455, 255), (1, 1)), ((270, 480), (1, 1.3)), ((301, 299), (2, 1)), ((91, 91), (1, 1))]
found = [errors(*shape, fit, kind) for shape, fit, kind in
         itertools.product(SHAPES, ("AUTO", "HORIZONTAL", "VERTICAL"), ("PERSP", "ORTHO"))]
print("errors", *(max(values) for values in zip(*found)))
