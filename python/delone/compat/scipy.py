"""The place of ``scipy.spatial``'s Delaunay, Voronoi and ConvexHull taken by delone, and more.

>>> from delone.compat.scipy import Delaunay
>>> tri = Delaunay([(0, 0), (0, 1.1), (1, 0), (1, 1)])
>>> tri.simplices.shape, tri.simplices.dtype
((2, 3), dtype('int32'))
>>> sorted(map(sorted, tri.simplices.tolist()))
[[0, 1, 3], [0, 2, 3]]

The signature, attributes, dtypes, errors and the mutability of arrays are SciPy's. What differs:

* Every distinct point is a vertex, so `coplanar` lists duplicates alone.
* Among the triangulations of cocircular points it is delone's canonical one, and triangles come in
  delone's order.
* `find_simplex` is exact: `tol` has no effect, and a point outside by a rounding error is outside.
* `vertex_to_simplex` of a duplicate is a triangle of its first occurrence.
* Triangles are counter-clockwise and tetrahedra positively oriented, furthest-site ones, too.
* Furthest-site triangulations are of the plane.
* Complex numbers, masked queries, and integers which float64 does not hold, are refused rather than
  rounded or unmasked.
* `add_points` triangulates anew, which takes the time of a triangulation, not of an insertion.

`Voronoi` and `voronoi_plot_2d` are here by name; `delone.compat.scipy_voronoi` has them and what
differs. So is `ConvexHull`, of `delone.compat.scipy_hull`. The interpolators of
``scipy.interpolate`` are here by name; `delone.compat.interpolate` has them and what differs.
"""

from __future__ import annotations

from delone.compat.interpolate import (
    CloughTocher2DInterpolator,
    LinearNDInterpolator,
    NearestNDInterpolator,
    estimate_gradients_2d_global,
    griddata,
)
from delone.compat.qhull import DimensionError, QhullError
from delone.compat.scipy_delaunay import Delaunay, tsearch
from delone.compat.scipy_hull import ConvexHull
from delone.compat.scipy_voronoi import Voronoi, voronoi_plot_2d

__all__ = [
    "CloughTocher2DInterpolator",
    "ConvexHull",
    "Delaunay",
    "DimensionError",
    "LinearNDInterpolator",
    "NearestNDInterpolator",
    "QhullError",
    "Voronoi",
    "estimate_gradients_2d_global",
    "griddata",
    "tsearch",
    "voronoi_plot_2d",
]
