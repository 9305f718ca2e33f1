"""Alpha complexes of points in 2-D to 8-D, and alpha shapes and concave hulls in 2-D and 3-D.

Values are squared radii: the doubles nearest to the exact ones. Which faces have their own value is
decided exactly.
"""

from delone.alpha.concave import concave_hull
from delone.alpha.filtration import AlphaComplex
from delone.alpha.shape import AlphaShape, ConcaveHull

__all__ = ["AlphaComplex", "AlphaShape", "ConcaveHull", "concave_hull"]
