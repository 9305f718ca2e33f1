"""Values in files: heights as a third coordinate, values of points and of triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone.errors import ShapeError

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["split_attributes", "with_heights"]


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
