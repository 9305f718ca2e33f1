"""Why exactness matters: a survey in map coordinates, triangulated by SciPy and by delone.

A square kilometer in UTM coordinates, rounded to millimeters. Needs SciPy. Run it:
``python examples/far_from_home.py``.
"""

import time

import numpy as np
from scipy.spatial import Delaunay as SciPyDelaunay

from delone import Delaunay
from delone.datasets import utm_millimeters
from delone.testing import assert_delaunay

POINTS = 20_000


def main() -> None:
    """Triangulate the same points twice and count which of them are vertices."""
    points = utm_millimeters(POINTS, seed=1)
    distinct = len(np.unique(points, axis=0))
    for library in (SciPyDelaunay, Delaunay):
        start = time.perf_counter()
        mesh = library(points)
        seconds = time.perf_counter() - start
        used = len(np.unique(points[np.unique(mesh.simplices)], axis=0))
        try:
            assert_delaunay(points, mesh.simplices, canonical=False)
            verdict = "a Delaunay triangulation of all points"
        except AssertionError as error:
            verdict = str(error).splitlines()[0]
        name = library.__module__.partition(".")[0]
        print(f"{name}: {used:,} of {distinct:,} points, {seconds:.3f} s: {verdict}")


if __name__ == "__main__":
    main()
