"""Runs the package ``triangle`` for `test_triangle`: pickled dictionaries in, pickled ones out."""

from __future__ import annotations

import os
import pickle
import sys

import numpy as np
import triangle

# What the program prints by itself goes elsewhere.
answers = os.fdopen(os.dup(1), "wb")
os.dup2(2, 1)
while True:
    try:
        tri, opts = pickle.load(sys.stdin.buffer)
    except EOFError:
        break
    out = triangle.triangulate(tri, opts)
    pickle.dump({key: np.array(value) for key, value in out.items()}, answers)
    answers.flush()
