#!/usr/bin/env python3
"""Checks that scripts which edit kernels still meet their text: check_edits.py ROOT"""
import os
import sys
import unittest.mock

root = sys.argv[1]
sys.path.insert(0, os.path.join(root, "scripts"))
for module in ("numpy", "OpenImageIO", "torch"):  # no edit needs them
    sys.modules[module] = unittest.mock.MagicMock()
import constants  # noqa: E402
import train_judge  # noqa: E402


def kernel(path):
    with open(os.path.join(root, "kernels", path), encoding="utf-8") as file:
        return file.read()


missed = ["constants.py: %s: %s" % (name, old) for name, edits in constants.RULES.items() for file, old, new in edits
          if constants.replaced(kernel(file), old, new) is None]
try:
    train_judge.force(train_judge.KERNEL, kernel(train_judge.KERNEL), 7, 1.0)
except SystemExit as error:
    missed.append("train_judge.py: %s" % error)
for line in missed:
    print("not there once: " + line)
print("%d edits missed of %d rules and of train_judge.py" % (len(missed), len(constants.RULES)))
sys.exit(1 if missed else 0)
