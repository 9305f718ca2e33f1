"""How good tetrahedra are: dihedral angles, volumes, ratios of radii and of edges.

Measures are rounded, but right: what cancels in a sliver is computed again by `stages`, and what
exceeds the range of doubles is scaled. Angles come from `arctan2` of the volume and of the products
of the faces' vectors, so that those near 0 and 180 degrees are as exact as others.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._arrays import as_number
from delone.errors import InputError
from delone.plane.measures import Measures
from delone.space.stages import Exact, Measure, Vectors, cross, dot, staged

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["EDGES", "FACES", "TetQuality", "dihedral_angles", "measured"]

# Corners of the face opposite each corner, with that corner on the positive side.
FACES = ((1, 3, 2), (0, 2, 3), (0, 3, 1), (0, 1, 2))
# The edges of a tetrahedron as corners; the faces at each are those opposite the two others.
EDGES = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))
# These faces.
_BESIDE = tuple(tuple(c for c in range(4) if c not in edge) for edge in EDGES)
# Classes of a histogram in degrees: narrower ones are a mistake, and would fill the memory.
_NARROWEST = 0.001


@dataclass(frozen=True, eq=False, kw_only=True)
class TetQuality(Measures):
    """Measures of the tetrahedra of a mesh, one entry for each.

    Parameters
    ----------
    smallest_dihedral, largest_dihedral : ndarray of float64, shape (m,)
        Dihedral angles in degrees: those between two faces, at an edge. The smallest one of a
        tetrahedron is at most acos(1/3), about 70.53 degrees, that of the regular one; near 0 it
        is a sliver, or worse.
    volume : ndarray of float64, shape (m,)
        In the cube of the unit of the points.
    radius_ratio : ndarray of float64, shape (m,)
        Three times the radius of the inscribed sphere, as a share of that of the circumscribed one:
        1 for a regular tetrahedron, towards 0 for flat and thin ones.
    edge_ratio : ndarray of float64, shape (m,)
        The longest edge in lengths of the shortest: at least 1.

    Notes
    -----
    The relative error of each number is below 1e-13, also that of slivers and of needles, unless
    it is beyond the range of doubles (then inf, or rounded among the subnormal ones).

    Examples
    --------
    >>> import delone
    >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
    >>> quality = delone.improve(corner).quality()
    >>> print(quality)
    1 tetrahedron         least      1 %     10 %   median     90 %     99 %     most
    smallest dihedral      54.7     54.7     54.7     54.7     54.7     54.7     54.7
    largest dihedral         90       90       90       90       90       90       90
    volume                0.167    0.167    0.167    0.167    0.167    0.167    0.167
    radius ratio          0.732    0.732    0.732    0.732    0.732    0.732    0.732
    edge ratio             1.41     1.41     1.41     1.41     1.41     1.41     1.41
    """

    smallest_dihedral: Floats
    largest_dihedral: Floats
    volume: Floats
    radius_ratio: Floats
    edge_ratio: Floats

    _noun = "tetrahedron"

    def histogram(self, width: float = 5.0) -> tuple[NDArray[np.int64], Floats]:
        """Count tetrahedra by their smallest dihedral angle.

        Parameters
        ----------
        width : float, optional
            The width of a class in degrees, from 0.001 to 180.

        Returns
        -------
        counts : ndarray of int64, shape (k,)
            How many there are in each class.
        bounds : ndarray of float64, shape (k + 1,)
            The bounds of the classes, from 0 to above 70.53 degrees.

        Raises
        ------
        InputError
            `width` is no number, or not within these bounds.

        Examples
        --------
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> delone.improve(corner).quality().histogram(25)
        (array([0, 0, 1]), array([ 0., 25., 50., 75.]))
        """
        step = as_number(width, name="width")
        if not _NARROWEST <= step <= 180:
            raise InputError(f"width must be from {_NARROWEST} to 180 degrees, got {width!r}")
        most = np.degrees(np.arccos(1 / 3))
        bounds: Floats = step * np.arange(int(np.ceil(most / step)) + 1, dtype=np.float64)
        # That of the regular one may be rounded to above the last bound.
        counts, _ = np.histogram(np.minimum(self.smallest_dihedral, bounds[-1]), bounds)
        return counts.astype(np.int64), bounds

    def plot(self, ax: Any = None, *, bound: float | None = None) -> Any:
        """Draw the histogram of the smallest and the largest dihedral angles (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; by default on new axes.
        bound : float, optional
            An angle to be marked, in degrees.

        Returns
        -------
        matplotlib Axes
            What was drawn on.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.

        Examples
        --------
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> ax = delone.improve(corner).quality().plot(bound=20)
        >>> ax.get_ylabel()
        'tetrahedra'
        """
        from delone.plot import draw_angles

        ax = draw_angles(self.smallest_dihedral, self.largest_dihedral, ax=ax, bound=bound)
        ax.set_xlabel("dihedral angle in degrees")
        ax.set_ylabel("tetrahedra")
        return ax


def measured(points: Floats, simplices: Indices) -> TetQuality:
    """Measure tetrahedra.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    simplices : ndarray of int32, shape (m, 4)
        Tetrahedra, positively oriented.

    Returns
    -------
    TetQuality
        The measures.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.quality import measured
    >>> regular = np.array([(1.0, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)])
    >>> quality = measured(regular, np.array([(0, 2, 1, 3)]))
    >>> quality.radius_ratio.round(12), quality.smallest_dihedral.round(2)
    (array([1.]), array([70.53]))
    """
    found = staged(points, simplices, Measure(_numbers, _measures, _exact_measures, 5)).T
    return TetQuality(
        **{each.name: row for each, row in zip(fields(TetQuality), found.copy(), strict=True)}
    )


def dihedral_angles(points: Floats, simplices: Indices) -> Floats:
    """Return the dihedral angles of tetrahedra.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    simplices : ndarray of int32, shape (m, 4)
        Tetrahedra, positively oriented.

    Returns
    -------
    ndarray of float64, shape (m, 6)
        In degrees, at the edges between corners 01, 02, 03, 12, 13 and 23.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.quality import dihedral_angles
    >>> corner = np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
    >>> dihedral_angles(corner, np.array([(0, 1, 2, 3)])).round(2)
    array([[90.  , 90.  , 90.  , 54.74, 54.74, 54.74]])
    """
    return staged(points, simplices, Measure(_numbers, _angles, _exact_angles, 6))


def _numbers(v: Vectors) -> list[Any]:
    """The vectors of the faces, inwards; edges; the circumcentre times 2 D; and D."""
    a, b, c = v[:3]
    faces = [cross(c, b), cross(a, c), cross(b, a)]
    faces.append(tuple(-(x + y + z) for x, y, z in zip(*faces, strict=True)))
    edges = _edges(a, b, c)
    squares = [dot(p, p) for p in (a, b, c)]
    center = (dot(squares, [face[k] for face in faces[:3]]) for k in range(3))
    return [*(x for p in (*faces, *edges) for x in p), *center, dot(a, faces[0])]


def _edges(a: Any, b: Any, c: Any) -> list[Any]:
    """The edges in the order of EDGES, of the vectors from the last corner."""
    between = ((a, b), (a, c), (b, c))
    ab, ac, bc = ([x - y for x, y in zip(p, q, strict=True)] for p, q in between)
    return [ab, ac, a, bc, b, c]


def _radians(found: Floats) -> tuple[Floats, Floats, Floats]:
    """The dihedral angles, and the lengths of the vectors of faces and of edges."""
    faces, edges = found[:12].reshape(4, 3, -1), found[12:30].reshape(6, 3, -1)
    areas = np.sqrt((faces * faces).sum(axis=1))
    lengths = np.sqrt((edges * edges).sum(axis=1))
    cosines = np.stack([-(faces[k] * faces[m]).sum(axis=0) for k, m in _BESIDE])
    return np.arctan2(found[-1] * lengths, cosines), areas, lengths


def _angles(found: Floats, _: Vectors) -> Floats:
    return np.degrees(_radians(found)[0])


def _measures(found: Floats, v: Vectors) -> Floats:
    angles, areas, lengths = _radians(found)
    size, center = found[-1], found[30:33]
    # Radii D / sum of |N| and |center| / (2 D), for the determinant D.
    around = areas.sum(axis=0) * np.sqrt((center * center).sum(axis=0))
    return np.stack(
        (
            np.degrees(angles.min(axis=0)),
            np.degrees(angles.max(axis=0)),
            np.ldexp(size / 6, 3 * v.exponent),
            np.minimum(6 * size * size / around, 1),
            lengths.max(axis=0) / lengths.min(axis=0),
        )
    )


class _Integers(NamedTuple):
    """What is exact of a tetrahedron: integers in a unit, lengths times 2**64 and rounded down."""

    faces: list[Any]
    areas: list[int]
    lengths: list[int]
    center: int
    size: int
    unit: int


def _integers(vectors: tuple[Exact, Exact, Exact]) -> _Integers:
    # Denominators are powers of two, so the largest is a multiple of all.
    unit = max(x.denominator for p in vectors for x in p)
    a, b, c = ([x.numerator * (unit // x.denominator) for x in p] for p in vectors)
    faces: list[Any] = [cross(c, b), cross(a, c), cross(b, a)]
    faces.append([-sum(row) for row in zip(*faces, strict=True)])
    squares = [dot(p, p) for p in (a, b, c)]
    center = [dot(squares, [face[k] for face in faces[:3]]) for k in range(3)]
    return _Integers(
        faces=faces,
        areas=[_root(dot(p, p)) for p in faces],
        lengths=[_root(dot(p, p)) for p in _edges(a, b, c)],
        center=_root(dot(center, center)),
        size=dot(a, faces[0]),
        unit=unit,
    )


def _root(square: int) -> int:
    """The root times 2**64: with that many bits behind the point, at least."""
    return math.isqrt(square << 128)


def _exact_radians(of: _Integers) -> list[float]:
    found = []
    for length, (k, m) in zip(of.lengths, _BESIDE, strict=True):
        sine, cosine = of.size * length, -dot(of.faces[k], of.faces[m]) << 64
        # The quotient of integers is rounded once, whatever their size.
        if sine < abs(cosine):
            found.append(math.atan2(sine / abs(cosine), 1 if cosine > 0 else -1))
        else:
            found.append(math.atan2(1, cosine / sine))
    return found


def _exact_angles(vectors: tuple[Exact, Exact, Exact], _: Exact) -> list[float]:
    return [math.degrees(angle) for angle in _exact_radians(_integers(vectors))]


def _exact_measures(vectors: tuple[Exact, Exact, Exact], _: Exact) -> list[Any]:
    of = _integers(vectors)
    angles = _exact_radians(of)
    return [
        math.degrees(min(angles)),
        math.degrees(max(angles)),
        Fraction(of.size, 6 * of.unit**3),
        min((6 * of.size**2 << 128) / (sum(of.areas) * of.center), 1.0),
        Fraction(max(of.lengths), min(of.lengths)),
    ]
