"""Interpolators by name, for rasters, cross-validation, the command line and other libraries."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

from delone._base.arrays import as_choice
from delone.errors import DtypeError, InputError
from delone.interpolate.clough_tocher import CloughTocher
from delone.interpolate.linear import Linear
from delone.interpolate.natural import NaturalNeighbor
from delone.interpolate.nearest import Nearest

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from delone._tiling.triangulation import Triangulation
    from delone.interpolate.base import Interpolator
    from delone.periodic import PeriodicDelaunay

__all__ = ["METHODS", "interpolator", "require_options"]

METHODS: Mapping[str, tuple[type[Interpolator], dict[str, Any]]] = {
    "linear": (Linear, {}),
    "nearest": (Nearest, {}),
    "clough-tocher": (CloughTocher, {}),
    "sibson": (NaturalNeighbor, {"kind": "sibson"}),
    "laplace": (NaturalNeighbor, {"kind": "laplace"}),
    "sibson1": (NaturalNeighbor, {"kind": "sibson1"}),
    "farin": (NaturalNeighbor, {"kind": "farin"}),
}


def interpolator(
    points: ArrayLike | Triangulation | PeriodicDelaunay,
    values: ArrayLike | None = None,
    method: str = "linear",
    **options: Any,
) -> Interpolator:
    """Make an interpolator by name.

    Parameters
    ----------
    points : array_like, shape (n, 2), or a triangulation
        Sites.
    values : array_like, shape (n,) or (n, ...), optional
        Values at the sites.
    method : str, optional
        ``"linear"``, ``"nearest"``, ``"clough-tocher"``, ``"sibson"``, ``"laplace"``,
        ``"sibson1"`` or ``"farin"``.
    **options
        Options of the class.

    Returns
    -------
    Interpolator
        Of the class `Linear`, `Nearest`, `CloughTocher` or `NaturalNeighbor`.

    Raises
    ------
    InputError
        The method is unknown, or does not have one of the options; or the class raises it.

    Examples
    --------
    >>> from delone.interpolate import interpolator
    >>> interpolator([(0, 0), (1, 0), (0, 1)], [1, 2, 3], "nearest")((2, 0))
    array(2.)
    """
    if isinstance(points, str) or not isinstance(method, str):
        raise DtypeError(
            "the arguments are points, values and the method, as in interpolator(points, values, "
            f"'linear'); the method is an object of type {type(method).__name__}"
        )
    kind, fixed = METHODS[as_choice(method, tuple(METHODS), name="method")]
    require_options(method, options)
    return kind(points, values, **fixed, **options)


def require_options(method: str, options: Mapping[str, Any]) -> None:
    """Raise InputError for an option that a method does not have.

    Parameters
    ----------
    method : str
        A name in `METHODS`.
    options : mapping
        What will be passed to its class.

    Raises
    ------
    InputError
        An option is not one of the class, or the method determines it.
    """
    kind, fixed = METHODS[method]
    for name in options:
        known = [*inspect.signature(kind).parameters][2:]
        if name not in known or name in fixed:
            listed = ", ".join(each for each in known if each not in fixed)
            raise InputError(f"{name} is not an option of {method!r:.80}; its options are {listed}")
