"""
Map coordinates: points that SciPy loses
========================================

Points in a square kilometer, in UTM coordinates rounded to millimeters, are triangulated by SciPy and by delone. The
coordinates are large compared with the distances between the points. SciPy silently drops some points; in delone's
result, every distinct point is a vertex. Both results are checked with exact predicates.

Install: ``pip install "delone[plot]" scipy``.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.spatial import Delaunay as SciPyDelaunay

from delone import Delaunay
from delone.datasets import utm_millimeters
from delone.testing import assert_delaunay

points = utm_millimeters(20_000, seed=1)
print(f"{points[0, 0]:.3f} m east, {points[0, 1]:.3f} m north: the first of {len(points):,} points")

# %%
# Both libraries get the same array. :func:`~delone.testing.assert_delaunay` raises an error if a point is missing
# or if a circumcircle contains a point; it decides with exact arithmetic.

lost = {}
for library in (SciPyDelaunay, Delaunay):
    mesh = library(points)
    name = library.__module__.partition(".")[0]
    used = np.zeros(len(points), dtype=bool)
    used[np.unique(mesh.simplices)] = True
    lost[name] = points[~used]
    try:
        assert_delaunay(points, mesh.simplices, canonical=False)
        verdict = "a Delaunay triangulation of all points"
    except AssertionError as error:
        verdict = str(error).splitlines()[0].rstrip(":")
    print(f"{name}: {np.count_nonzero(used):,} of {len(points):,} points are vertices; {verdict}")

assert len(lost["delone"]) == 0

# %%
# The lost points are everywhere. There is no warning, and a result of this size looks complete.

low = points.min(axis=0)
figure, ax = plt.subplots(figsize=(6, 5.4), layout="constrained")
ax.plot(*(points - low).T, ",", color="0.6")
ax.plot(*(lost["scipy"] - low).T, "o", color="tab:red", mfc="none", ms=10, label="lost by SciPy")
ax.set(
    title="Points that are not vertices", xlabel="east in m", ylabel="north in m", aspect="equal"
)
ax.legend(loc="upper right")
plt.show()
