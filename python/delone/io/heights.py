"""Values that belong to points or triangles: coerced to float64, their number checked."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone._arrays import as_plain_array
from delone.errors import DtypeError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["as_values", "split_attributes", "with_heights"]


def as_values(
    values: ArrayLike | None, count: int, *, name: str = "z"
) -> NDArray[np.float64] | None:
    """Return one float64 value for each point.

    Parameters
    ----------
    values : array_like, shape (count,), or None
        Numbers.
    count : int
        How many there must be.
    name : str, optional
        What the argument is called in error messages.

    Returns
    -------
    ndarray of float64, shape (count,), or None
        None for None.

    Raises
    ------
    ShapeError
        Another number of values.
    DtypeError
        No real numbers.

    Examples
    --------
    >>> from delone.io.heights import as_values
    >>> as_values([1, 2], 2)
    array([1., 2.])
    """
    if values is None:
        return None
    if isinstance(values, np.ma.MaskedArray):
        raise DtypeError(f"{name} is a masked array; fill it: {name}.filled(numpy.nan)")
    array = as_plain_array(values, name)
    if array.dtype.kind not in "iufb":
        raise DtypeError(f"{name} must hold real numbers, got dtype {array.dtype}")
    if array.shape != (count,):
        raise ShapeError(f"{name} must have shape ({count},), got {array.shape}")
    return np.ascontiguousarray(array, dtype=np.float64)


def with_heights(points: NDArray[np.float64], z: NDArray[np.float64] | None) -> NDArray[np.float64]:
    """Return points with a third coordinate, zero where there are no heights.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Horizontal coordinates.
    z : ndarray of float64, shape (n,), or None
        Heights.

    Returns
    -------
    ndarray of float64, shape (n, 3)
        A copy.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.io.heights import with_heights
    >>> with_heights(np.array([[1.0, 2.0]]), None)
    array([[1., 2., 0.]])
    """
    space = np.zeros((len(points), 3))
    space[:, :2] = points
    if z is not None:
        space[:, 2] = z
    return space


def split_attributes(
    attributes: dict[str, NDArray[np.generic]], npoints: int, ncells: int
) -> tuple[dict[str, NDArray[np.generic]], dict[str, NDArray[np.generic]]]:
    """Tell values of points from values of cells by their number.

    Parameters
    ----------
    attributes : dict of str to ndarray
        Values.
    npoints, ncells : int
        Numbers of points and of triangles (or edges).

    Returns
    -------
    of_points, of_cells : dict of str to ndarray
        The same arrays.

    Raises
    ------
    ShapeError
        An array fits neither.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.io.heights import split_attributes
    >>> [list(part) for part in split_attributes({"class": np.zeros(5)}, 5, 4)]
    [['class'], []]
    """
    of_points, of_cells = {}, {}
    for name, values in attributes.items():
        if values.ndim == 1 and len(values) == npoints:
            of_points[name] = values
        elif values.ndim == 1 and len(values) == ncells:
            of_cells[name] = values
        else:
            raise ShapeError(
                f"attribute {name!r} of shape {values.shape} fits neither {npoints} points nor "
                f"{ncells} cells"
            )
    return of_points, of_cells
