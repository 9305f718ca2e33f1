"""Reports of exact validation of regular and periodic triangulations.

The checks run in the core, like those of `validation`. This module names the faults.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from delone import _core
from delone._tiling.space.plane import repeated_rows
from delone.validation import HigherReport, SpaceReport, ValidationReport, fault

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices
    from delone.validation import Sentences

    Rows = NDArray[np.integer]

__all__ = ["PeriodicReport", "RegularHigherReport", "RegularReport", "RegularSpaceReport"]

_HIDDEN = "hidden point should be a vertex", "hidden points should be vertices"
_REPEATS = (
    "vertex is not the first of the heaviest rows with its coordinates",
    "vertices are not the first of the heaviest rows with their coordinates",
)


@dataclass(frozen=True, eq=False, kw_only=True)
class _Weighted:
    """What reports on regular triangulations contain in every dimension."""

    hidden: Rows = fault(*_HIDDEN)
    duplicates: Rows = fault("row has the wrong duplicate", "rows have the wrong duplicates")

    _SUBJECT: ClassVar[str] = "a canonical regular triangulation"
    _SAID: ClassVar[Sentences] = {
        "missing": ("point is outside all simplices", "points are outside all simplices"),
        "repeats": _REPEATS,
        "delaunay": (
            "pair of simplices is not locally regular",
            "pairs of simplices are not locally regular",
        ),
        "ties": (
            "pair of simplices on a tie is not canonical",
            "pairs of simplices on ties are not canonical",
        ),
    }


# The fields of the last base come first.
@dataclass(frozen=True, eq=False, kw_only=True)
class RegularReport(_Weighted, ValidationReport):
    """The result of ``RegularTriangulation.validate()``: truthy if the triangulation is correct.

    The fields are those of `ValidationReport`, with these changes: `missing` lists points outside
    all triangles, `repeats` lists vertices that are not the first of the heaviest rows with their
    coordinates, and `delaunay` and `ties` are about lifted points. There are two more:

    Parameters
    ----------
    hidden : ndarray of int, shape (k,)
        Rows that should be vertices, though triangles cover them. These and `missing` are checked
        only if there are no other faults.
    duplicates : ndarray of int, shape (k,)
        Rows that should be listed as duplicates and are not, or the reverse.

    Examples
    --------
    >>> from delone import RegularTriangulation
    >>> mesh = RegularTriangulation([(0, 0), (4, 0), (0, 4), (1, 1)], [0, 0, 0, -9])
    >>> print(mesh.validate())
    a canonical regular triangulation
    """


@dataclass(frozen=True, eq=False, kw_only=True)
class RegularSpaceReport(_Weighted, SpaceReport):
    """The result of ``RegularTriangulation.validate()`` in 3-D.

    The fields are those of `SpaceReport`, with the changes of `RegularReport`. There are two more:

    Parameters
    ----------
    hidden : ndarray of int, shape (k,)
        Rows that should be vertices, though tetrahedra cover them.
    duplicates : ndarray of int, shape (k,)
        Rows that should be listed as duplicates and are not, or the reverse.

    Examples
    --------
    >>> from delone import RegularTriangulation
    >>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> RegularTriangulation(corners, [0, 0, 0, 1]).validate().ok
    True
    """


@dataclass(frozen=True, eq=False, kw_only=True)
class RegularHigherReport(_Weighted, HigherReport):
    """The result of ``RegularTriangulation.validate()`` in more than three dimensions.

    The fields are those of `HigherReport`, with the changes of `RegularReport`. There are two more:

    Parameters
    ----------
    hidden : ndarray of int, shape (k,)
        Rows that should be vertices, though simplices cover them.
    duplicates : ndarray of int, shape (k,)
        Rows that should be listed as duplicates and are not, or the reverse.

    Examples
    --------
    >>> import numpy as np
    >>> from delone import RegularTriangulation
    >>> corners = np.vstack((np.zeros(4), np.eye(4)))
    >>> RegularTriangulation(corners, [0, 0, 0, 0, 1]).validate().ok
    True
    """


@dataclass(frozen=True, eq=False, kw_only=True)
class PeriodicReport(ValidationReport):
    """The result of ``PeriodicDelaunay.validate()``: truthy if the triangulation is correct.

    The fields are those of `ValidationReport`, with these changes: `neighbors` lists triangles
    whose `neighbors` or `partners` are wrong, `hull` lists edges without a partner that are not on
    the boundary of the strip, and `edges` is always empty. With v vertices and h edges without a
    partner, `count` expects 2v - h triangles. With weights, `delaunay` and `ties` are about lifted
    points, and `missing` is always empty. There are three more:

    Parameters
    ----------
    offsets : ndarray of int, shape (k,)
        Triangles with impossible offsets: the first corner is moved, another one is moved by more
        than one period, or in a direction without a period. If there are any, nothing else is
        checked.
    hidden : ndarray of int, shape (k,)
        Rows that should be vertices, though triangles cover them; checked only if there are
        no other faults.
    layers : ndarray of int, shape (1,) or (0,)
        How many times the triangles cover the plane, if not exactly once. Checked only if
        orientations, neighbors and boundary are correct.

    Examples
    --------
    >>> from delone import PeriodicDelaunay
    >>> print(PeriodicDelaunay([(0.25, 0.5)], (1, 1)).validate())
    a canonical periodic triangulation
    """

    offsets: Rows = fault("triangle has impossible offsets", "triangles have impossible offsets")
    hidden: Rows = fault(*_HIDDEN)
    layers: Rows = fault()

    _SUBJECT: ClassVar[str] = "a canonical periodic triangulation"
    _SAID: ClassVar[Sentences] = {
        "neighbors": (
            "triangle has wrong neighbors or partners",
            "triangles have wrong neighbors or partners",
        ),
        "hull": (
            "boundary edge is not on the boundary of the strip",
            "boundary edges are not on the boundary of the strip",
        ),
        "delaunay": (
            "pair of triangles is not locally Delaunay or regular",
            "pairs of triangles are not locally Delaunay or regular",
        ),
        "ties": (
            "pair of triangles on a tie is not canonical",
            "pairs of triangles on ties are not canonical",
        ),
        "repeats": _REPEATS,
    }

    def __str__(self) -> str:
        text = super().__str__()
        if self.layers.size:
            text += f"\n  layers: triangles cover the plane {self.layers[0]} times, 1 expected"
        return text


def validate_regular(
    points: Floats, weights: Floats, simplices: Indices, neighbors: Indices, duplicates: Indices
) -> RegularReport | RegularSpaceReport | RegularHigherReport:
    """Check a regular triangulation; duplicates are rows, and those that they repeat."""
    reports: Any = {2: RegularReport, 3: RegularSpaceReport}
    report = reports.get(points.shape[1], RegularHigherReport)
    faults, stands_for = _core.validate_regular(points, weights, simplices, neighbors)
    made: RegularReport | RegularSpaceReport | RegularHigherReport = report._of(
        faults, duplicates=_differing(duplicates, repeated_rows(stands_for, weights))
    )
    return made


def _differing(found: Indices, expected: Indices) -> NDArray[np.int64]:
    """Return the rows of pairs that are in only one array; all rows if the order differs."""
    if np.array_equal(found, expected):
        return np.empty(0, dtype=np.int64)
    pairs, count = np.unique(np.concatenate((found, expected)), axis=0, return_counts=True)
    single = pairs[count != 2] if (count != 2).any() else pairs
    return np.unique(single[:, 0]).astype(np.int64)


def validate_periodic(
    points: Floats,
    weights: Floats | None,
    periods: tuple[float | None, float | None],
    topology: tuple[Indices, Indices, Indices, Indices],
) -> PeriodicReport:
    """Check a periodic triangulation; `topology` is simplices, offsets, neighbors and partners."""
    simplices, offsets, neighbors, partners = topology
    found = _core.validate_periodic2(
        points,
        weights,
        (periods[0] or 0.0, periods[1] or 0.0),
        simplices,
        offsets.reshape(-1, 6),
        neighbors,
        partners,
    )
    return PeriodicReport._of(found.faults, offsets=found.offsets, layers=found.layers)
