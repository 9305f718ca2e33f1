"""Values in files: heights as a third coordinate, point values and triangle values."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone.errors import ShapeError

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["split_attributes"]


def split_attributes(
    attributes: dict[str, NDArray[np.generic]], npoints: int, ncells: int, nnodes: int | None = None
) -> tuple[dict[str, NDArray[np.generic]], dict[str, NDArray[np.generic]]]:
    """Split values into point values and cell values, by their number."""
    of_points, of_cells = {}, {}
    for name, values in attributes.items():
        if values.ndim == 1 and len(values) == npoints:
            of_points[name] = values
        elif values.ndim == 1 and len(values) == ncells:
            of_cells[name] = values
        else:
            raise ShapeError(
                f"attribute {name!r:.40} of shape {values.shape} matches neither {npoints} points "
                f"nor {ncells} cells" + ("" if nnodes is None else f" nor {nnodes} nodes")
            )
    return of_points, of_cells
