"""Heights between lidar points: linear interpolation on the Delaunay triangles.

A regular raster over the lidar tile of the package; each raster point gets the height of the
triangle that contains it. Run it: ``python examples/heights.py``.
"""

import numpy as np

from delone import Delaunay
from delone.datasets import ahn3
from delone.interpolate import Linear


def main() -> None:
    """Interpolate a raster of half a meter and print a summary."""
    survey = ahn3()
    mesh = Delaunay(survey.points)
    low, high = survey.points.min(axis=0), survey.points.max(axis=0)
    x, y = np.meshgrid(np.arange(low[0], high[0], 0.5), np.arange(low[1], high[1], 0.5))
    queries = np.column_stack([x.ravel(), y.ravel()])

    heights = Linear(mesh, survey.z)(queries)
    inside = np.isfinite(heights)

    assert np.nanmin(heights) >= survey.z.min() - 1e-6
    assert np.nanmax(heights) <= survey.z.max() + 1e-6
    print(f"{len(queries):,} raster points, {np.count_nonzero(inside):,} inside the hull")
    print(f"mean height {np.nanmean(heights):.2f} m, highest {np.nanmax(heights):.2f} m")


if __name__ == "__main__":
    main()
