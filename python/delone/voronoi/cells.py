"""What the cells of both dimensions have in common: the sites, the whole diagram and the clip.

`delone.Voronoi` stores the cells of one dimension, `plane` or `space`, which have the same methods.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_workers
from delone._base.immutable import sealed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats
    from delone.delaunay import Delaunay
    from delone.periodic import PeriodicDelaunay
    from delone.regular import RegularTriangulation

    Periods = tuple[float | None, float | None]

__all__ = ["Cells"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Cells:
    """The cells of d-dimensional sites: arrays that never change, and what follows from them."""

    points: Floats
    weights: Floats | None
    mesh: Delaunay | RegularTriangulation | PeriodicDelaunay | None
    dual: Any
    clip: Any
    periods: Periods | None = None
    workers: int | None

    def __post_init__(self) -> None:
        self._put("points", sealed(self.points))
        if self.weights is not None:
            self._put("weights", sealed(self.weights))
        self._put("dual", type(self.dual)(*map(sealed, self.dual.arrays())))

    def _put(self, name: str, value: object) -> None:
        object.__setattr__(self, name, value)

    def __reduce__(self) -> tuple[Any, ...]:
        # What has been computed from the fields is left out; arrays are protected again.
        return _made, (type(self), {each.name: getattr(self, each.name) for each in fields(self)})

    @property
    def _threads(self) -> int:
        return as_workers(self.workers)

    def _lost(self, empty: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return which empty cells rounding has emptied: those whose site is inside the clip.

        A cell without weights contains its site and a neighborhood of it. With weights, this is not
        known.
        """
        found = np.zeros(len(empty), dtype=bool)
        rows = np.flatnonzero(empty)
        if self.weights is not None or not len(rows):
            return found
        if self.clip is not None:
            rows = rows[self.clip.holds(self.points[self.dual.site[rows]])]
        found[rows] = True
        return found


def _made(kind: type[Cells], parts: dict[str, Any]) -> Cells:
    return kind(**parts)
