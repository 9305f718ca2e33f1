"""Exact geometric predicates over arrays of points.

Each function returns a sign that is correct for all finite doubles: wherever rounding could matter,
the decision is computed without rounding (J. R. Shewchuk, "Adaptive precision floating-point
arithmetic and fast robust geometric predicates", 1997, for the idea of stages). Arguments broadcast
against each other over their leading axes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from delone import _core
from delone._base.arrays import as_vectors, require_finite
from delone.errors import InputError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Signs = NDArray[np.int8]
    Ties = Literal["zero", "canonical"]

# The maximum number of axes that all releases of NumPy can broadcast.
_MOST_AXES = 32

__all__ = ["incircle", "insphere", "orient2d", "orient3d"]


def orient2d(a: ArrayLike, b: ArrayLike, c: ArrayLike) -> Signs:
    """Return the orientation of three points: the turn of the path a, b, c.

    Parameters
    ----------
    a, b, c : array_like, shape (..., 2)
        Finite points. Leading axes broadcast.

    Returns
    -------
    ndarray of int8, shape (...)
        1 if c lies to the left of the line from a to b (a, b, c are counter-clockwise), -1 if it
        lies to the right, 0 if the three are collinear. Zero-dimensional for single points.

    Raises
    ------
    NonFiniteError
        A coordinate is NaN or infinite.
    ShapeError, DtypeError
        An argument is not a real array of shape (..., 2), or the shapes do not broadcast.

    Notes
    -----
    Exact for all finite doubles. Time is linear in the number of results, with a few nanoseconds
    each if the points are in general position.

    Examples
    --------
    >>> from delone.predicates import orient2d
    >>> orient2d((0, 0), (1, 0), [(0, 1), (2, 0), (0, -1e-300)])
    array([ 1,  0, -1], dtype=int8)

    In plain arithmetic these three are collinear:

    >>> a, b, c = (0.1, 0.1), (0.2, 0.2), (0.3, 0.3)
    >>> (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    0.0
    >>> int(orient2d(a, b, (0.3, 0.30000000000000004)))
    1
    """
    (a, b, c), shape = _broadcast(2, a, b, c)
    return _core.orient2d(a, b, c).reshape(shape)


def incircle(
    a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike, *, ties: Ties = "zero"
) -> Signs:
    """Return whether d lies inside the circle through a, b and c.

    Parameters
    ----------
    a, b, c, d : array_like, shape (..., 2)
        Finite points. Leading axes broadcast.
    ties : {"zero", "canonical"}, optional
        The result for four cocircular points: 0, or the sign that delone's tie-breaking uses.

    Returns
    -------
    ndarray of int8, shape (...)
        For counter-clockwise a, b, c: 1 if d is inside, -1 if it is outside, 0 if it is on the
        circle. The sign is the opposite for clockwise a, b, c; if these are collinear, it is that
        of the lifted determinant. Zero-dimensional for single points.

    Raises
    ------
    NonFiniteError
        A coordinate is NaN or infinite.
    ShapeError, DtypeError
        An argument is not a real array of shape (..., 2), or the shapes do not broadcast.
    InputError
        `ties` is not one of its choices.

    Notes
    -----
    Exact for all finite doubles. With ``ties="canonical"`` the height x² + y² of each lifted point
    is lowered by an infinitesimal, which is larger for lexicographically smaller points (H.
    Edelsbrunner and E. P. Mücke, "Simulation of simplicity", 1990, with coordinates instead of
    indices). The result is never 0 for four distinct points that are not all collinear.

    Examples
    --------
    >>> from delone.predicates import incircle
    >>> incircle((0, 0), (1, 0), (1, 1), [(0.5, 0.5), (0, 1), (2, 2)])
    array([ 1,  0, -1], dtype=int8)
    >>> int(incircle((0, 0), (1, 0), (1, 1), (0, 1), ties="canonical"))
    -1
    """
    canonical = _is_canonical(ties)
    (a, b, c, d), shape = _broadcast(2, a, b, c, d)
    return _core.incircle(a, b, c, d, canonical).reshape(shape)


def orient3d(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike) -> Signs:
    """Return on which side of the plane through a, b and c the point d lies.

    Parameters
    ----------
    a, b, c, d : array_like, shape (..., 3)
        Finite points. Leading axes broadcast.

    Returns
    -------
    ndarray of int8, shape (...)
        1 if b - a, c - a, d - a form a right-handed frame (the tetrahedron is positively oriented;
        a, b, c turn left as seen from d), -1 if they are left-handed, 0 if the four points lie in
        one plane. Zero-dimensional for single points.

    Raises
    ------
    NonFiniteError
        A coordinate is NaN or infinite.
    ShapeError, DtypeError
        An argument is not a real array of shape (..., 3), or the shapes do not broadcast.

    Notes
    -----
    Exact for all finite doubles; time is linear in the number of results.

    Examples
    --------
    >>> from delone.predicates import orient3d
    >>> orient3d((0, 0, 0), (1, 0, 0), (0, 1, 0), [(0, 0, 1), (3, 3, 0), (0, 0, -1)])
    array([ 1,  0, -1], dtype=int8)
    """
    (a, b, c, d), shape = _broadcast(3, a, b, c, d)
    return _core.orient3d(a, b, c, d).reshape(shape)


def insphere(
    a: ArrayLike,
    b: ArrayLike,
    c: ArrayLike,
    d: ArrayLike,
    e: ArrayLike,
    *,
    ties: Ties = "zero",
) -> Signs:
    """Return whether e lies inside the sphere through a, b, c and d.

    Parameters
    ----------
    a, b, c, d, e : array_like, shape (..., 3)
        Finite points. Leading axes broadcast.
    ties : {"zero", "canonical"}, optional
        The result for five cospherical points: 0, or the sign that delone's tie-breaking uses.

    Returns
    -------
    ndarray of int8, shape (...)
        For positively oriented a, b, c, d (see `orient3d`): 1 if e is inside, -1 if it is outside,
        0 if it is on the sphere. The sign is the opposite for negatively oriented ones.
        Zero-dimensional for single points.

    Raises
    ------
    NonFiniteError
        A coordinate is NaN or infinite.
    ShapeError, DtypeError
        An argument is not a real array of shape (..., 3), or the shapes do not broadcast.
    InputError
        `ties` is not one of its choices.

    Notes
    -----
    Exact for all finite doubles. With ``ties="canonical"`` the heights x² + y² + z² are perturbed
    as in `incircle`; the result is never 0 for five distinct points that are not all in one plane.

    Examples
    --------
    >>> from delone.predicates import insphere
    >>> corners = (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)
    >>> insphere(*corners, [(0.5, 0.5, 0.5), (1, 1, 1), (2, 2, 2)])
    array([ 1,  0, -1], dtype=int8)
    """
    canonical = _is_canonical(ties)
    (a, b, c, d, e), shape = _broadcast(3, a, b, c, d, e)
    return _core.insphere(a, b, c, d, e, canonical).reshape(shape)


def _broadcast(ndim: int, *points: ArrayLike) -> tuple[list[NDArray[np.float64]], tuple[int, ...]]:
    """Return arguments as equally long rows of finite points, and the shape of the result."""
    arrays = []
    for name, values in zip("abcde", points, strict=False):
        array = as_vectors(values, ndim, name=name)
        if array.ndim > _MOST_AXES:
            raise ShapeError(f"{name} has {array.ndim} axes, more than {_MOST_AXES}; reshape it")
        require_finite(array.reshape(-1, ndim), name=name)
        arrays.append(array)
    try:
        shape = np.broadcast_shapes(*(array.shape for array in arrays))
    except ValueError:
        shapes = ", ".join(f"{n} {a.shape}" for n, a in zip("abcde", arrays, strict=False))
        raise ShapeError(f"arguments do not broadcast: {shapes}") from None
    rows = [np.broadcast_to(array, shape).reshape(-1, ndim) for array in arrays]
    return [np.ascontiguousarray(row) for row in rows], shape[:-1]


def _is_canonical(ties: str) -> bool:
    if ties not in ("zero", "canonical"):
        raise InputError(f'ties must be "zero" or "canonical", got {ties!r:.80}')
    return ties == "canonical"
