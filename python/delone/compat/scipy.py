"""Drop-in replacements for ``scipy.spatial``'s Delaunay, Voronoi, ConvexHull and more.

>>> from delone.compat.scipy import Delaunay
>>> tri = Delaunay([(0, 0), (0, 1.1), (1, 0), (1, 1)])
>>> tri.simplices.shape, tri.simplices.dtype
((2, 3), dtype('int32'))
>>> sorted(map(sorted, tri.simplices.tolist()))
[[0, 1, 3], [0, 2, 3]]

Signatures, attributes, dtypes, errors and the mutability of arrays are those of SciPy. Differences:

* Every distinct point is a vertex, so `coplanar` lists only duplicates.
* Among the triangulations of cocircular points, the result is delone's canonical one, with
  triangles in delone's order.
* `find_simplex` is exact by default: a point outside by a rounding error is outside. In 2-D and
  3-D, `tol` is compared exactly; in more dimensions it has no effect.
* `vertex_to_simplex` of a duplicate is a triangle of its first occurrence.
* Triangles are counter-clockwise and tetrahedra positively oriented, including furthest-site ones.
* Furthest-site triangulations are only available in 2-D.
* Complex numbers, masked points, and integers that float64 cannot represent are rejected rather
  than rounded or unmasked. A masked query is treated as NaN, and is therefore in no simplex.
* Option ``Qu`` sets `furthest_site`; SciPy leaves it False.
* `add_points` of 2-D and 3-D triangulations inserts the points; the simplices are the same, but
  may be in a different order.

`Voronoi` and `voronoi_plot_2d` are exported here; `delone.compat.scipy_voronoi` documents their
differences. So are `ConvexHull` of `delone.compat.scipy_hull`, `HalfspaceIntersection` of
`delone.compat.scipy_halfspaces`, `SphericalVoronoi` of `delone.compat.scipy_sphere`,
`delaunay_plot_2d` and `convex_hull_plot_2d`, and the interpolators of ``scipy.interpolate``, whose
differences are in `delone.compat.interpolate`.
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
from delone.compat.scipy_halfspaces import HalfspaceIntersection
from delone.compat.scipy_hull import ConvexHull
from delone.compat.scipy_plot import convex_hull_plot_2d, delaunay_plot_2d
from delone.compat.scipy_sphere import SphericalVoronoi
from delone.compat.scipy_voronoi import Voronoi, voronoi_plot_2d

__all__ = [
    "CloughTocher2DInterpolator",
    "ConvexHull",
    "Delaunay",
    "DimensionError",
    "HalfspaceIntersection",
    "LinearNDInterpolator",
    "NearestNDInterpolator",
    "QhullError",
    "SphericalVoronoi",
    "Voronoi",
    "convex_hull_plot_2d",
    "delaunay_plot_2d",
    "estimate_gradients_2d_global",
    "griddata",
    "tsearch",
    "voronoi_plot_2d",
]
