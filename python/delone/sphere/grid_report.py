"""Reports on the cells of a grid: how corners changed, and which cells overlap."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from delone._base.counting import counted
from delone._base.immutable import ReadOnly
from delone._base.renames import renamed

if TYPE_CHECKING:
    from delone._base.types import Rows

__all__ = ["GridFaults", "GridReport"]


@renamed(turned="reversed")
@dataclass(frozen=True, repr=False, eq=False)
class GridReport(ReadOnly):
    """Which corners of a grid were changed, and which cells are special.

    Attributes
    ----------
    merged : int
        The number of corners that were moved to an earlier corner within `merge`, and of bounds
        that were moved to those of a neighbor; for meshes, of nodes.
    repeated : int
        Corners that repeat the one before in their cell, and are ignored.
    reversed : ndarray of int64
        Cells with clockwise corners, which are used in the opposite direction: they are on the
        smaller side of their corners, unless `winding` says otherwise.
    empty : ndarray of int64
        Cells with fewer than three distinct corners, or without area; they share nothing.
    concave : ndarray of int64
        Cells that are concave or have several rings, or have more than 64 corners.
    large : ndarray of int64
        Cells that no hemisphere contains: those that have several parts, and those that are divided
        into triangles, with `winding`.
    masked : ndarray of int64
        Cells that the dataset excludes.

    Examples
    --------
    >>> from delone import sphere
    >>> corners = [(1, 0, 0), (0, 0, 1), (0, 1, 0)]
    >>> sphere.Grid.from_mesh(corners, [0, 3]).report
    <GridReport: 1 cell reversed>
    """

    merged: int
    repeated: int
    reversed: Rows
    empty: Rows
    concave: Rows
    large: Rows
    masked: Rows

    def __repr__(self) -> str:
        parts = [f"{counted(self.merged, 'corner')} merged"] if self.merged else []
        if self.repeated:
            parts.append(f"{counted(self.repeated, 'repeated corner')} ignored")
        for name in ("reversed", "empty", "concave", "large", "masked"):
            if count := len(getattr(self, name)):
                what = "beyond a hemisphere" if name == "large" else name
                parts.append(f"{counted(count, 'cell')} {what}")
        return f"<GridReport: {', '.join(parts) or 'nothing special'}>"


@dataclass(frozen=True, repr=False, eq=False)
class GridFaults(ReadOnly):
    """What `Grid.validate` finds; truthy if no cells overlap.

    Attributes
    ----------
    overlapping : ndarray of int64, shape (k, 2)
        Pairs of cells that share more than 1e-12 of the smaller one.
    covered : float
        The fraction of the sphere that the cells cover, where overlaps count twice.
    holes : int or None
        The number of holes: connected parts of the sphere outside all cells. Those that meet at a
        corner are one. None if cells overlap, or if sides cross.
    rims : tuple of ndarray of int64
        For each closed ring of sides that have a cell on one side only, the cells along it,
        ascending. Cells that have no side in common, such as those of islands, have different
        rings, so a hole can have several. Parts of a cell count like cells of their own.
    slivers : int
        Gaps and overlaps of less than 1e-12 of the smallest cell along them, or narrower than 2e-15
        radians, such as those between cells whose corners are rounded: closed rings, and chains of
        sides that rounding puts beside each other. They are neither holes nor rims.

    Notes
    -----
    Rings follow from common corners, and from corners in sides of other cells. A corner is in a
    side if it is within 2e-15 radians of it, or if its triangle with the side is less than 1e-12 of
    the smallest cell beside them; corners that are this close to each other are one. Beyond these
    limits, exact signs decide. If sides of cells cross that share less than 1e-12 of the smaller
    one, the rings are not known: `holes` is None, and `rims` is empty.

    Examples
    --------
    >>> import numpy as np
    >>> from delone import sphere
    >>> grid = sphere.Grid.from_lonlat(np.arange(0, 361, 30), np.arange(0, 91, 30))
    >>> faults = grid.validate()
    >>> bool(faults), round(faults.covered, 12)
    (True, 0.5)

    The rest of the sphere is a hole, and the cells of the southern row are along it:

    >>> faults
    <GridFaults: no cells overlap, 50 % of the sphere, 1 hole>
    >>> faults.rims[0].tolist()
    [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]
    """

    overlapping: Rows
    covered: float
    holes: int | None
    rims: tuple[Rows, ...]
    slivers: int

    def __bool__(self) -> bool:
        return not len(self.overlapping)

    def __repr__(self) -> str:
        pairs = f"{counted(len(self.overlapping), 'pair')} of cells overlap"
        if not len(self.overlapping):
            pairs = "no cells overlap"
        more = "".join(
            f", {counted(count, what)}"
            for count, what in ((self.holes, "hole"), (self.slivers, "sliver"))
            if count
        )
        if self.holes is None and not len(self.overlapping):
            more = ", holes not counted because sides cross"
        return f"<GridFaults: {pairs}, {100 * self.covered:.6g} % of the sphere{more}>"
