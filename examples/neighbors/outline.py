"""
Outline the roofs in a lidar cloud
==================================

The convex hull of a building covers its yard. An alpha shape has one part for each building, in the shape of its
roof.

Install: ``pip install "delone[plot,geo]"``.
"""

import matplotlib.pyplot as plt
import shapely

from delone import AlphaComplex, concave_hull
from delone.datasets import ahn3

# %%
# The points on roofs and walls, as classified in the survey (class 6), seen from above. Alpha is a squared radius:
# here the radius is 1 m.

survey = ahn3()
points = survey.points[survey.attributes["classification"] == 6]
complex = AlphaComplex(points)
shape = complex.shape(1.0**2)
polygons = [polygon for polygon in shape.polygons() if polygon.area > 10]
print(shape)
print(f"{len(polygons)} roofs: " + ", ".join(f"{polygon.area:.0f} m²" for polygon in polygons))
assert shapely.is_valid(polygons).all()

# %%
# The concave hull of the largest roof is one polygon that contains all of its points, carved through edges longer
# than 2 m. The convex hull is larger.

largest = max(polygons, key=lambda polygon: polygon.area)
own = points[shapely.covers(largest, shapely.points(points))]
concave = concave_hull(own, max_edge=2.0).polygon()
convex = concave_hull(own, ratio=1).polygon()
print(f"alpha {largest.area:.0f} m², concave {concave.area:.0f} m², convex {convex.area:.0f} m²")
assert largest.area < concave.area * 1.1 and concave.area < convex.area

# %%
# All roofs, and the two hulls of the largest one.

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4.4), layout="constrained")
left.plot(*points[::10].T, ",", color="0.7")
for polygon in polygons:
    for ring in (polygon.exterior, *polygon.interiors):
        left.plot(*ring.xy, color="C3", lw=1)
right.plot(*own[::5].T, ",", color="0.6")
right.plot(*convex.exterior.xy, color="C0", lw=1, label="convex")
right.plot(*concave.exterior.xy, color="C3", lw=1.2, label="concave")
right.legend(loc="lower right")
left.set(title="Alpha shape, circles of 1 m", aspect="equal", xticks=[], yticks=[])
right.set(title="The largest roof", aspect="equal", xticks=[], yticks=[])
plt.show()
