# SPDX-License-Identifier: MIT
"""Resolves frames that are NumPy archives (colour, depth, velocity, jitter): sequence.py PICTURES FRAME.npz..."""
import os
import sys

import numpy as np
import quincunx

folder, *names = sys.argv[1:]
resolver = quincunx.Resolver(output_extent=(1280, 720), transparents=False)
for number, name in enumerate(names):
    frame = np.load(name)
    picture = resolver.resolve(frame["colour"], depth=frame["depth"], velocity=frame["velocity"],
                               jitter=frame["jitter"])
    np.save(os.path.join(folder, f"picture.{number:04d}.npy"), picture)
