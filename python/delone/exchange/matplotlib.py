"""Triangulations of matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone.exchange.parts import kind_of, parts_of
from delone.extras import require

if TYPE_CHECKING:
    from delone.exchange.parts import Given

__all__ = ["to_matplotlib"]


def to_matplotlib(mesh: Given) -> Any:
    """Return a triangulation of matplotlib.

    Parameters
    ----------
    mesh : Parts, mesh of delone, or pair of points and simplices
        Triangles in 2-D.

    Returns
    -------
    matplotlib.tri.Triangulation
        For ``tripcolor``, ``tricontour`` and other functions of matplotlib.

    Raises
    ------
    InputError
        The simplices are no triangles in 2-D.
    MissingExtraError
        matplotlib is not installed (extra ``plot``).

    Examples
    --------
    >>> from delone.exchange.matplotlib import to_matplotlib
    >>> to_matplotlib(([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)])).triangles.shape
    (1, 3)
    """
    tri = require("matplotlib.tri", extra="plot", what="to_matplotlib")
    parts = parts_of(mesh)
    kind_of(parts, what="a triangulation of matplotlib", kinds=("triangles",))
    return tri.Triangulation(*parts.points.T, triangles=parts.simplices)
