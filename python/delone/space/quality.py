"""How good tetrahedra are: dihedral angles, volumes, ratios of radii and of edges.

Measures are rounded, with each tetrahedron scaled to its own size so that nothing exceeds the range
of doubles. Angles come from `arctan2` of the volume and of the products of the faces' vectors, so
that those near 0 and 180 degrees are as exact as others.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["EDGES", "FACES", "TetQuality", "counted_tetrahedra", "dihedral_angles", "measured"]

# Corners of the face opposite each corner, with that corner on the positive side.
FACES = ((1, 3, 2), (0, 2, 3), (0, 3, 1), (0, 1, 2))
# The edges of a tetrahedron as corners; the faces at each are those opposite the two others.
EDGES = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))
# Tetrahedra worked on at once, so that temporary arrays stay small.
_BLOCK = 1 << 15
# Differences of larger coordinates may exceed the range of doubles.
_LARGE = 1e300
_PERCENTILES = (1, 10, 50, 90, 99)


@dataclass(frozen=True, eq=False, kw_only=True)
class TetQuality:
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

    def __post_init__(self) -> None:
        for each in fields(self):
            getattr(self, each.name).flags.writeable = False

    def summary(self) -> dict[str, dict[str, float]]:
        """Return least, greatest and mean values and percentiles.

        Returns
        -------
        dict
            For each measure ``min``, ``max``, ``mean`` and the percentiles ``p1``, ``p10``,
            ``p50``, ``p90`` and ``p99``.

        Examples
        --------
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> delone.improve(corner).quality().summary()["largest_dihedral"]["mean"]
        90.0
        """
        found = {}
        for each in fields(self):
            values = getattr(self, each.name)
            at = np.percentile(values, _PERCENTILES).tolist()
            named = {f"p{p}": value for p, value in zip(_PERCENTILES, at, strict=True)}
            ends = {"min": float(values.min()), "max": float(values.max())}
            found[each.name] = ends | {"mean": float(values.mean())} | named
        return found

    def histogram(self, width: float = 5.0) -> tuple[NDArray[np.int64], Floats]:
        """Count tetrahedra by their smallest dihedral angle.

        Parameters
        ----------
        width : float, optional
            The width of a class in degrees, above 0.

        Returns
        -------
        counts : ndarray of int64, shape (k,)
            How many there are in each class.
        bounds : ndarray of float64, shape (k + 1,)
            The bounds of the classes, from 0 to above 70.53 degrees.

        Examples
        --------
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> delone.improve(corner).quality().histogram(25)
        (array([0, 0, 1]), array([ 0., 25., 50., 75.]))
        """
        most = np.degrees(np.arccos(1 / 3))
        bounds: Floats = float(width) * np.arange(int(np.ceil(most / width)) + 1, dtype=np.float64)
        counts, _ = np.histogram(self.smallest_dihedral, bounds)
        return counts.astype(np.int64), bounds

    def __str__(self) -> str:
        names = ("min", "p1", "p10", "p50", "p90", "p99", "max")
        head = ("least", "1 %", "10 %", "median", "90 %", "99 %", "most")
        lines: list[tuple[str, ...]] = [(counted_tetrahedra(len(self.volume)), *head)]
        for measure, values in self.summary().items():
            lines.append((measure.replace("_", " "), *(f"{values[name]:.3g}" for name in names)))
        rows = (f"{line[0]:<18}" + "".join(f"{cell:>9}" for cell in line[1:]) for line in lines)
        return "\n".join(rows)

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


def counted_tetrahedra(count: int) -> str:
    """Return a number of tetrahedra in words.

    Parameters
    ----------
    count : int
        How many there are.

    Returns
    -------
    str
        The number and the noun.

    Examples
    --------
    >>> from delone.space.quality import counted_tetrahedra
    >>> counted_tetrahedra(1), counted_tetrahedra(2)
    ('1 tetrahedron', '2 tetrahedra')
    """
    return f"{count} {'tetrahedron' if count == 1 else 'tetrahedra'}"


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
    found = np.empty((5, len(simplices)))
    for block, edges, unit in _blocks(points, simplices):
        angles, determinant, sizes = _angles(edges)
        lengths = np.sqrt((edges * edges).sum(axis=-1))
        found[0, block] = angles.min(axis=0)
        found[1, block] = angles.max(axis=0)
        with np.errstate(over="ignore", under="ignore"):
            found[2, block] = np.ldexp(determinant / 6, 3 * unit)
        u, v, w = edges[:3]
        square = lengths[:3] ** 2
        center = (
            square[0][:, None] * np.cross(v, w)
            + square[1][:, None] * np.cross(w, u)
            + square[2][:, None] * np.cross(u, v)
        )
        around = sizes.sum(axis=0) * np.sqrt((center * center).sum(axis=-1))
        # Radii D / sum of |N| and |center| / (2 D), for the determinant D.
        ratio = 6 * determinant**2 / np.where(around > 0, around, np.inf)
        found[3, block] = np.clip(ratio, 0, 1)
        found[4, block] = _edge_ratio(edges)
    return TetQuality(
        smallest_dihedral=found[0],
        largest_dihedral=found[1],
        volume=found[2],
        radius_ratio=found[3],
        edge_ratio=found[4],
    )


def _edge_ratio(edges: Floats) -> Floats:
    """The longest edge over the shortest, infinite beyond the range of doubles."""
    largest = np.abs(edges).max(axis=-1)
    # Each in a unit of its own: the square of a short one may underflow in that of all.
    with np.errstate(all="ignore"):
        scaled = edges / largest[..., None]
        lengths = largest * np.sqrt((scaled * scaled).sum(axis=-1))
        ratio: Floats = lengths.max(axis=0) / lengths.min(axis=0)
    return np.where(np.isnan(ratio), np.inf, ratio)


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
    found = np.empty((len(simplices), 6))
    for block, edges, _ in _blocks(points, simplices):
        found[block] = _angles(edges)[0].T
    return found


def _blocks(points: Floats, simplices: Indices) -> Iterator[tuple[slice, Floats, Indices]]:
    """Edges as vectors, (6, k, 3), in a unit of each tetrahedron, and its exponent."""
    for start in range(0, len(simplices), _BLOCK):
        block = slice(start, start + _BLOCK)
        corners = points[simplices[block]]
        large = bool(np.abs(corners).max(initial=0) > _LARGE)
        if large:
            corners *= 0.5
        edges = np.stack([corners[:, j] - corners[:, i] for i, j in EDGES])
        unit = np.frexp(np.abs(edges).max(axis=(0, 2)))[1]
        edges = np.ldexp(edges, -unit[None, :, None])
        yield block, edges, unit + int(large)


def _angles(edges: Floats) -> tuple[Floats, Floats, Floats]:
    """Dihedral angles at the six edges, the determinant, and the lengths of the faces' vectors."""
    ab, ac, ad, bc, bd, _ = edges
    # The vectors of the faces opposite each corner, inwards.
    faces = np.stack((np.cross(bd, bc), np.cross(ac, ad), np.cross(ad, ab), np.cross(ab, ac)))
    determinant = (faces[3] * ad).sum(axis=-1)
    lengths = np.sqrt((edges * edges).sum(axis=-1))
    angles = np.empty(lengths.shape)
    for e, (i, j) in enumerate(EDGES):
        k, m = (c for c in range(4) if c not in (i, j))
        cosine = -(faces[k] * faces[m]).sum(axis=-1)
        angles[e] = np.degrees(np.arctan2(determinant * lengths[e], cosine))
    sizes: Floats = np.sqrt((faces * faces).sum(axis=-1))
    return np.maximum(angles, 0.0), np.maximum(determinant, 0.0), sizes
