"""Reference implementations of Delaunay triangulation: short, slow and exact.

Everything here uses Python's arbitrary-precision integers and `fractions.Fraction`, so that no
result depends on rounding, and follows the textbook literally where the fast core does not. It is
the oracle of the package's tests, and meant to be read; no other module of the package uses it.
`bowyer_watson` also triangulates in 3-D, with the predicates of `space`, and `natural_weights`
supports Laplace weights in 3-D; the rest is 2-D.

The five points found in every textbook, a rectangle and one point inside:

>>> from delone.reference import bowyer_watson, circumcircle
>>> points = [(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)]
>>> triangles = bowyer_watson(points)
>>> triangles
[(0, 1, 4), (0, 4, 3), (1, 2, 4), (2, 3, 4)]
>>> a, b, c = (points[vertex] for vertex in triangles[0])
>>> circle = circumcircle(a, b, c)
>>> circle.center
(Fraction(2, 1), Fraction(-3, 2))
>>> float(circle.squared_radius) ** 0.5
2.5
"""

from delone.reference.constrained import ConstrainedTriangulation, constrained_delaunay
from delone.reference.cubic import clough_tocher
from delone.reference.exact import (
    Circle,
    circumcircle,
    exact_point,
    incircle,
    incircle_canonical,
    orient,
)
from delone.reference.flips import lawson
from delone.reference.insertion import bowyer_watson
from delone.reference.natural import natural_weights
from delone.reference.space import insphere, insphere_canonical, orient3d

__all__ = [
    "Circle",
    "ConstrainedTriangulation",
    "bowyer_watson",
    "circumcircle",
    "clough_tocher",
    "constrained_delaunay",
    "exact_point",
    "incircle",
    "incircle_canonical",
    "insphere",
    "insphere_canonical",
    "lawson",
    "natural_weights",
    "orient",
    "orient3d",
]
