"""Heights between lidar points: linear interpolation on the Delaunay triangles.

A regular raster over the lidar tile of the package; each raster point gets the height of the
triangle that holds it. Run it: ``python examples/heights.py``.
"""

import numpy as np

from delone import Delaunay
from delone.datasets import ahn3


def main() -> None:
    """Interpolate a raster of half a metre and say what it looks like."""
    survey = ahn3()
    mesh = Delaunay(survey.points)
    low, high = survey.points.min(axis=0), survey.points.max(axis=0)
    x, y = np.meshgrid(np.arange(low[0], high[0], 0.5), np.arange(low[1], high[1], 0.5))
    queries = np.column_stack([x.ravel(), y.ravel()])

    triangle = mesh.find_simplex(queries)
    inside = triangle >= 0
    affine = mesh.transform[triangle[inside]]
    first_two = np.einsum("kij,kj->ki", affine[:, :2], queries[inside] - affine[:, 2])
    weights = np.column_stack([first_two, 1.0 - first_two.sum(axis=1)])

    heights = np.full(len(queries), np.nan)
    corners = mesh.simplices[triangle[inside]]
    heights[inside] = (weights * survey.z[corners]).sum(axis=1)

    assert np.nanmin(heights) >= survey.z.min() - 1e-6
    assert np.nanmax(heights) <= survey.z.max() + 1e-6
    print(f"{len(queries):,} raster points, {np.count_nonzero(inside):,} inside the hull")
    print(f"mean height {np.nanmean(heights):.2f} m, highest {np.nanmax(heights):.2f} m")


if __name__ == "__main__":
    main()
