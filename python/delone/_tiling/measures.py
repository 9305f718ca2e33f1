"""Measures of triangles and tetrahedra, and what their reports have in common.

The core computes them in stages: values that suffer cancellation in thin simplices are computed
again with more digits. Points must be finite, and simplices exactly positively oriented.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from delone import _core
from delone._base.arrays import as_mesh, as_workers
from delone._base.counting import counted
from delone._base.immutable import ReadOnly

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["Measures", "circumcenters", "edges", "sizes", "transform"]

_PERCENTILES = (1, 10, 50, 90, 99)
# The columns of a table: keys of a summary, and their labels.
_COLUMNS = {
    "min": "least",
    "p1": "1 %",
    "p10": "10 %",
    "p50": "median",
    "p90": "90 %",
    "p99": "99 %",
    "max": "most",
}


@dataclass(frozen=True, eq=False, kw_only=True)
class Measures(ReadOnly):
    """Measures of simplices: each field is an array with one entry for each, read-only."""

    _noun: ClassVar[str]

    def summary(self) -> dict[str, dict[str, float]]:
        """Return smallest, largest and mean values and percentiles.

        Returns
        -------
        dict
            For each measure ``min``, ``max``, ``mean`` and the percentiles ``p1``, ``p10``,
            ``p50``, ``p90`` and ``p99``. All are NaN if there is no simplex.

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> delone.mesh(square).quality().summary()["area"]["mean"]
        0.5
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> delone.improve(corner).quality().summary()["largest_dihedral"]["mean"]
        90.0
        """
        found = {}
        for each in fields(self):
            values = getattr(self, each.name)
            if not len(values):
                keys = ("min", "max", "mean", *(f"p{p}" for p in _PERCENTILES))
                found[each.name] = dict.fromkeys(keys, np.nan)
                continue
            at = _percentiles(values).tolist()
            named = {f"p{p}": value for p, value in zip(_PERCENTILES, at, strict=True)}
            ends = {"min": float(values.min()), "max": float(values.max())}
            # A sum beyond the range of doubles is infinite.
            with np.errstate(over="ignore"):
                mean = float(values.mean())
            found[each.name] = ends | {"mean": mean} | named
        return found

    def __str__(self) -> str:
        count = len(getattr(self, fields(self)[0].name))
        lines: list[tuple[str, ...]] = [(counted(count, self._noun), *_COLUMNS.values())]
        for measure, values in self.summary().items():
            lines.append((measure.replace("_", " "), *(f"{values[key]:.3g}" for key in _COLUMNS)))
        rows = (f"{line[0]:<18}" + "".join(f"{cell:>9}" for cell in line[1:]) for line in lines)
        return "\n".join(rows)


def _percentiles(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return percentiles, linear between two values, the larger of which may be infinite."""
    with np.errstate(invalid="ignore"):
        found = np.percentile(values, _PERCENTILES)
    # Between infinity and another value, NumPy returns NaN.
    return np.where(np.isnan(found), np.percentile(values, _PERCENTILES, method="higher"), found)


def edges(
    simplices: Indices, neighbors: Indices, npoints: int, workers: int | None = None
) -> Indices:
    """Return every edge once, (k, 2): the smaller vertex first, rows ascending. O(m)."""
    return _core.edges(simplices, neighbors, npoints, as_workers(workers))


def sizes(points: Floats, simplices: Indices, workers: int | None = None) -> Floats:
    """Return areas or volumes; the relative error is below 1e-13 within the range of doubles."""
    return _core.sizes(*as_mesh(points, simplices), as_workers(workers))


def transform(points: Floats, simplices: Indices, workers: int | None = None) -> Floats:
    """Return affine maps to barycentric coordinates, (m, d + 1, d).

    The inverse of the matrix whose columns are the vectors from the last corner to the others, and
    below it the last corner. Within the range of doubles, each row has an error below 1e-13 of its
    length; in 2-D, each entry has an error below 1e-13 of itself.
    """
    return _core.transforms(*as_mesh(points, simplices), as_workers(workers))


def circumcenters(points: Floats, simplices: Indices, workers: int | None = None) -> Floats:
    """Return circumcenters, within 4 units in the last place; infinite beyond doubles."""
    return _core.circumcenters(*as_mesh(points, simplices), as_workers(workers))
