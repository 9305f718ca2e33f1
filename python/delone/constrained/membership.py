"""Which triangles and regions are inside polygons whose sides are segments."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone.constrained import coverage

if TYPE_CHECKING:
    from delone._base.types import Bools, Indices, Rows
    from delone.constrained.segmented import Segmented

__all__ = ["containing", "inside"]


def containing(mesh: Segmented, polygons: Indices) -> Rows:
    """Return pairs of a region of `mesh.region` and a polygon that contains it, (k, 2), ascending.

    `polygons` contains the polygon of each row of segments, -1 for rows that are not sides of a
    polygon. The sides of each polygon must be closed rings; the even-odd rule applies. For meshes
    of the whole hull.
    """
    component = mesh._component
    region = np.empty(int(component.max()) + 1, dtype=np.int64)
    region[component] = mesh.region
    within, polygon = coverage.containing(mesh._made, polygons, component).T
    pairs = np.column_stack((region[within], polygon))
    return pairs[np.lexsort(pairs.T[::-1])]


def inside(mesh: Segmented, polygons: Indices) -> Bools:
    """Return which triangles of the hull are inside some polygon.

    `polygons` contains the polygon of each row of segments, -1 for rows that are not sides of a
    polygon. The sides of each polygon must be closed rings; the even-odd rule applies.
    """
    if not (polygons >= 0).any():
        return np.zeros(len(mesh._made.simplices), dtype=bool)
    component = mesh._component
    within = np.zeros(int(component.max()) + 1, dtype=bool)
    within[coverage.containing(mesh._made, polygons, component)[:, 0]] = True
    found: Bools = within[component]
    return found
