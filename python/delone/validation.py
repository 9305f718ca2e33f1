"""Reports of exact validation, with the numbers of the simplices that are wrong.

The checks themselves run in the core; this module adds a name for each kind of fault and readable
messages. `validate` accepts triangles from any source.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from delone import _core
from delone._base.arrays import (
    as_mesh,
    as_neighbors,
    as_points,
    as_simplices,
    as_workers,
    require_finite,
)
from delone._base.immutable import ReadOnly
from delone._tiling.higher import topology as higher
from delone._tiling.higher.dimension import MOST
from delone._tiling.plane import topology
from delone._tiling.space import topology as space

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices

    Rows = NDArray[np.integer]
    # By kind of fault: the message for one element, and for several.
    Sentences = Mapping[str, tuple[str, str]]

__all__ = ["HigherReport", "SpaceReport", "ValidationReport", "validate"]

_SHOWN = 5


def fault(one: str = "", many: str = "", *, width: int | None = None) -> Any:
    """Return a field of faulty elements, by default none, with their messages.

    `width` is the number of columns, for elements that are several rows. Without messages, the
    report describes the fault differently.
    """
    shape = (0,) if width is None else (0, width)
    return field(
        default_factory=lambda: np.empty(shape, dtype=np.int64), metadata={"said": (one, many)}
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class ValidationReport(ReadOnly):
    """The result of ``validate()``: truthy if the triangulation is correct.

    Every field is an array of faulty elements, which is empty if there are none.

    Parameters
    ----------
    orientation : ndarray of int, shape (k,)
        Triangles that are not counter-clockwise: flat or clockwise.
    edges : ndarray of int, shape (k, 2)
        Directed edges that more than one triangle uses.
    neighbors : ndarray of int, shape (k,)
        Triangles whose row of neighbors is wrong.
    hull : ndarray of int, shape (k, 2)
        Boundary edges that are not part of the convex hull, or have a point outside.
    missing : ndarray of int, shape (k,)
        Rows of distinct points that no triangle uses.
    repeats : ndarray of int, shape (k,)
        Rows that triangles use although an earlier row has the same coordinates.
    delaunay : ndarray of int, shape (k, 2)
        Pairs of adjacent triangles, one of which has the other's opposite vertex inside its circle.
    ties : ndarray of int, shape (k, 2)
        Pairs of adjacent triangles that share one circle but are not fanned from the
        lexicographically smallest vertex.
    count : ndarray of int, shape (2,) or (0,)
        Number of triangles expected, 2n - h - 2, and found, if they differ.

    Attributes
    ----------
    ok : bool
        True if there are no faults.

    Examples
    --------
    >>> from delone.validation import ValidationReport
    >>> report = ValidationReport(missing=[7])
    >>> bool(report)
    False
    >>> print(report)
    not a canonical Delaunay triangulation:
      missing: 1 point is not a vertex: 7
    >>> print(ValidationReport())
    a canonical Delaunay triangulation
    """

    orientation: Rows = fault(
        "triangle is not counter-clockwise", "triangles are not counter-clockwise"
    )
    edges: Rows = fault(
        "directed edge is used more than once", "directed edges are used more than once", width=2
    )
    neighbors: Rows = fault("triangle has wrong neighbors", "triangles have wrong neighbors")
    hull: Rows = fault(
        "boundary edge is not on the hull", "boundary edges are not on the hull", width=2
    )
    missing: Rows = fault("point is not a vertex", "points are not vertices")
    repeats: Rows = fault(
        "vertex repeats an earlier row of points", "vertices repeat earlier rows of points"
    )
    delaunay: Rows = fault(
        "pair of triangles is not locally Delaunay",
        "pairs of triangles are not locally Delaunay",
        width=2,
    )
    ties: Rows = fault(
        "pair of cocircular triangles is not canonical",
        "pairs of cocircular triangles are not canonical",
        width=2,
    )
    count: Rows = fault()

    _SUBJECT: ClassVar[str] = "a canonical Delaunay triangulation"
    # Messages for fields of a base class that have a different meaning in this class.
    _SAID: ClassVar[Sentences] = {}

    @classmethod
    def _of(cls, faults: Any, **more: Any) -> Self:
        """Return a report of what the core found, by name, with additional or different fields."""
        names = {each.name for each in fields(cls)} - set(more)
        found = {name: getattr(faults, name) for name in names if hasattr(faults, name)}
        return cls(**found, **more)

    def __post_init__(self) -> None:
        for each in fields(self):
            array = np.array(getattr(self, each.name), dtype=np.int64)
            object.__setattr__(self, each.name, array)
        super().__post_init__()

    @property
    def ok(self) -> bool:
        """True if there are no faults."""
        return all(getattr(self, each.name).size == 0 for each in fields(self))

    def __bool__(self) -> bool:
        return self.ok

    def __str__(self) -> str:
        if self.ok:
            return self._SUBJECT
        lines = [f"not {self._SUBJECT}:"]
        said = {each.name: each.metadata["said"] for each in fields(self)}
        for kind in reversed(type(self).__mro__):
            said |= vars(kind).get("_SAID", {})
        for name, (one, many) in said.items():
            culprits = getattr(self, name)
            if len(culprits) and one:
                sentence = one if len(culprits) == 1 else many
                lines.append(f"  {name}: {len(culprits)} {sentence}: {_list(culprits)}")
        if self.count.size:
            lines.append(f"  count: {self.count[1]} triangles, {self.count[0]} expected")
        return "\n".join(lines)


def _of_cells(one: str, many: str, facet: str) -> Sentences:
    """Return the messages for cells of more than two dimensions."""
    return {
        "orientation": (f"{one} is not positively oriented", f"{many} are not positively oriented"),
        "neighbors": (f"{one} has wrong neighbors", f"{many} have wrong neighbors"),
        "hull": (f"boundary {facet} is not on the hull", f"boundary {facet}s are not on the hull"),
        "delaunay": (
            f"pair of {many} is not locally Delaunay",
            f"pairs of {many} are not locally Delaunay",
        ),
        "ties": (
            f"pair of cospherical {many} is not canonical",
            f"pairs of cospherical {many} are not canonical",
        ),
    }


@dataclass(frozen=True, eq=False, kw_only=True)
class SpaceReport(ValidationReport):
    """The result of ``validate()`` in 3-D: truthy if the triangulation is correct.

    The fields are those of `ValidationReport`, for tetrahedra instead of triangles, with faces of
    three vertices in `hull`; `edges` and `count` are always empty. There is one more:

    Parameters
    ----------
    facets : ndarray of int, shape (k, 3)
        Oriented faces that more than one tetrahedron uses.

    Examples
    --------
    >>> from delone.validation import validate
    >>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> print(validate(corners, [(0, 1, 2, 3)]))
    a canonical Delaunay triangulation
    >>> print(validate(corners, [(1, 0, 2, 3)]).orientation)
    [0]
    """

    facets: Rows = fault(
        "oriented face is used more than once", "oriented faces are used more than once", width=3
    )

    _SAID: ClassVar[Sentences] = _of_cells("tetrahedron", "tetrahedra", "face")


@dataclass(frozen=True, eq=False, kw_only=True)
class HigherReport(ValidationReport):
    """The result of ``validate()`` in more than three dimensions.

    The fields are those of `ValidationReport`, for simplices instead of triangles, with facets of d
    vertices in `hull`; `edges` and `count` are always empty. If a simplex is not positively
    oriented, or has wrong neighbors, the other faults of simplices are not checked. There is one
    more:

    Parameters
    ----------
    overlaps : ndarray of int, shape (k,)
        Simplices that cover the center of gravity of simplex 0.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.validation import validate
    >>> corners = np.vstack((np.zeros(4), np.eye(4)))
    >>> print(validate(corners, [(0, 1, 2, 3, 4)]))
    a canonical Delaunay triangulation
    >>> print(validate(corners, [(1, 0, 2, 3, 4)]).orientation)
    [0]
    """

    overlaps: Rows = fault("simplex overlaps simplex 0", "simplices overlap simplex 0")

    _SAID: ClassVar[Sentences] = _of_cells("simplex", "simplices", "facet")


def validate(
    points: ArrayLike, simplices: ArrayLike, *, neighbors: ArrayLike | None = None
) -> ValidationReport:
    """Prove that simplices are the canonical Delaunay triangulation, or name the faults.

    Parameters
    ----------
    points : array_like, shape (n, d)
        Finite coordinates, from two to eight for each point.
    simplices : array_like of int, shape (m, d + 1)
        Vertices of the simplices, as rows of `points`.
    neighbors : array_like of int, shape (m, d + 1), optional
        The simplex opposite each vertex, -1 outside. By default they follow from the simplices.

    Returns
    -------
    ValidationReport
        Truthy if everything is correct. If only `ties` is filled, the triangulation is Delaunay but
        has different diagonals; if only `repeats` is, a duplicate other than the first is a
        vertex. In 3-D it is a `SpaceReport`, in more dimensions a `HigherReport`.

    Raises
    ------
    ShapeError, DtypeError
        The arrays have the wrong shape or dtype.
    InputError
        An index is out of range.
    NonFiniteError
        A coordinate is NaN or infinite.

    Notes
    -----
    Exact. Linear time, or O(m log m) if neighbors must be computed.

    Examples
    --------
    >>> from delone.validation import validate
    >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    >>> bool(validate(square, [(0, 1, 2), (0, 2, 3)]))
    True
    >>> print(validate(square, [(0, 1, 3), (1, 2, 3)]))
    not a canonical Delaunay triangulation:
      ties: 1 pair of cocircular triangles is not canonical: 0-1
    """
    rows = as_points(points, most=MOST)
    require_finite(rows)
    d = rows.shape[1]
    if d > 2:
        cells = as_simplices(simplices, len(rows), d)
        if neighbors is None:
            beside = space.neighbors(cells) if d == 3 else higher.neighbors(cells)
        else:
            beside = as_neighbors(neighbors, len(cells), d)
        return judged(rows, cells, beside)
    triangles = as_simplices(simplices, len(rows), 2)
    if neighbors is None:
        beyond = topology.neighbors(triangles, len(rows))
    else:
        beyond = as_neighbors(neighbors, len(triangles), 2)
    return judged(rows, triangles, beyond)


def judged(points: Floats, simplices: Indices, neighbors: Indices) -> ValidationReport:
    """Check arrays that are known to fit together."""
    report = {2: ValidationReport, 3: SpaceReport}.get(points.shape[1], HigherReport)
    return report._of(_core.validate(points, simplices, neighbors))


def smallest_angle(points: Floats, simplices: Indices) -> float:
    """Return the smallest angle of counterclockwise triangles in degrees, 180 if there are none."""
    return _core.smallest_angle2(*as_mesh(points, simplices), as_workers(None))


def not_across(
    pairs: NDArray[np.integer], neighbors: NDArray[np.int32], constrained: NDArray[np.bool_]
) -> NDArray[np.integer]:
    """Leave out pairs of adjacent triangles, (k, 2), that a segment separates.

    `constrained`, (m, 3), says which edge opposite each vertex is part of a segment.
    """
    across = neighbors[pairs[:, 0]] == pairs[:, 1:]
    found: NDArray[np.integer] = pairs[~(across & constrained[pairs[:, 0]]).any(axis=1)]
    return found


def _list(culprits: NDArray[np.integer]) -> str:
    """List the first few faulty elements, pairs joined by a hyphen."""
    shown = [
        "-".join(map(str, culprit)) if isinstance(culprit, list) else str(culprit)
        for culprit in culprits[:_SHOWN].tolist()
    ]
    return ", ".join(shown) + (", ..." if len(culprits) > _SHOWN else "")
