"""Exact assertions about triangulations, for the tests of this package and of others.

Nothing here uses the compiled core: coordinates become Python integers at one common power of two,
which no arithmetic on them can round, and every test is a few lines of textbook geometry over NumPy
arrays of such integers. What passes is the Delaunay triangulation of the real numbers that the
doubles denote. `assert_delaunay` takes points in space, too, and `same_tetrahedra` is for them; the
rest is of the plane.
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
