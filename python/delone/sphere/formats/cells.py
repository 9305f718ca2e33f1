"""What readers take and return: the caller's options, and cells in the form that grids need."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Rows

__all__ = ["Cells", "Choices", "flags_of"]


class Choices(NamedTuple):
    """The options of the caller."""

    # Selects one of several grids: a topology, an OASIS grid, or a variable with values.
    name: str | None = None
    # The longitude and the latitude of centers.
    coords: tuple[str, str] | None = None
    # "parallel" or "arc"; None for the default of the convention.
    edges: str | None = None
    # Whether angles without units are in degrees; None if not given.
    degrees: bool | None = None
    infer: bool = False
    # "nodes" or "faces" of a mesh; None for the default of the convention.
    cells: str | None = None
    merge: float = 0.0
    workers: int | None = None


class Cells(NamedTuple):
    """The cells of a dataset: bounds of rows and columns, or corners of polygons."""

    format: str
    # The dimensions of fields; empty if fields are in other files.
    dims: tuple[Any, ...]
    shape: tuple[int, ...]
    # Edges between columns and between rows in degrees, for cells between meridians and parallels.
    columns: Floats | None = None
    rows: Floats | None = None
    # West, east, south and north of cells in one list, (n, 4), in degrees.
    boxes: Floats | None = None
    # Distances, in degrees, within which meridians and parallels of boxes are merged.
    near: tuple[float, float] = (0.0, 0.0)
    # Coordinates of corners, the corners of each cell (None if they are in sequence), and where
    # those of each cell start.
    nodes: Floats | None = None
    corners: Rows | None = None
    starts: Rows | None = None
    # The cells to use; None if the dataset does not say.
    mask: Bools | None = None
    # How many bounds were moved to those of their neighbors.
    merged: int = 0
    # Whether cells share corners bit for bit, so that none need to be merged.
    shared: bool = False
    # The names of longitudes and latitudes of centers, if there are any.
    coords: tuple[Any, Any] | None = None
    # "node" if fields are at the nodes of a mesh and these cells are its faces.
    location: str = "face"
    # Longitudes and latitudes of the centers in degrees, (n, 2), if known.
    centers: Floats | None = None


def flags_of(mask: Any, count: int, *, used: int = 1) -> Bools | None:
    """Return the cells to use; None if the variable has a different size."""
    if mask is None or mask.size != count:
        return None
    found: Bools = np.asarray(mask.values).ravel() == used
    return found
