"""Exact assertions about triangulations, for the tests of this and other packages.

Nothing here uses the compiled core: coordinates become Python integers at one common power of two,
so that no arithmetic on them is rounded, and every check is a few lines of textbook geometry on
NumPy arrays of such integers. The checks are exact for the given doubles. `assert_delaunay` also
accepts 3-D points, and `same_tetrahedra` is for them; the rest is 2-D.
"""

from delone.testing.constrained import ConstrainedArrays, assert_constrained_delaunay
from delone.testing.delaunay import assert_delaunay
from delone.testing.meshes import assert_mesh
from delone.testing.regions import assert_regions
from delone.testing.sets import same_tetrahedra, same_triangles, triangle_set

__all__ = [
    "ConstrainedArrays",
    "assert_constrained_delaunay",
    "assert_delaunay",
    "assert_mesh",
    "assert_regions",
    "same_tetrahedra",
    "same_triangles",
    "triangle_set",
]
