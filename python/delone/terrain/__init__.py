"""Terrain: ground points, surfaces with breaklines, contours, profiles, volumes, detail.

>>> from delone.terrain import TIN
>>> tin = TIN.from_points([(0, 0, 1), (8, 0, 5), (8, 6, 9), (0, 6, 3)])
>>> tin
<TIN of 4 points: 2 triangles, heights 1 to 9>
"""

from __future__ import annotations

from delone.terrain.adjustments import Adjustments
from delone.terrain.agreement import Agreement
from delone.terrain.contouring import Bands, Contours
from delone.terrain.deviations import Deviations
from delone.terrain.differences import Difference, difference
from delone.terrain.filtering import Ground, ground
from delone.terrain.labeling import Labels
from delone.terrain.profiles import Profile, Sight
from delone.terrain.regions import Volumes
from delone.terrain.sections import CrossSections, Profiles
from delone.terrain.simplifying import Simplification
from delone.terrain.tin import TIN
from delone.terrain.volumes import Volume

__all__ = [
    "TIN",
    "Adjustments",
    "Agreement",
    "Bands",
    "Contours",
    "CrossSections",
    "Deviations",
    "Difference",
    "Ground",
    "Labels",
    "Profile",
    "Profiles",
    "Sight",
    "Simplification",
    "Volume",
    "Volumes",
    "difference",
    "ground",
]
