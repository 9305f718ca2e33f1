"""What readers take and return: choices of the caller, and cells in the form that grids need."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Rows

__all__ = ["Cells", "Choices", "flags_of"]


class Choices(NamedTuple):
    """What the caller has chosen."""

    # Which of several grids: a topology, a grid of OASIS, or a variable of fields.
    name: str | None = None
    # The longitude and the latitude of centers.
    coords: tuple[str, str] | None = None
    # "parallel" or "arc"; None for what the convention has.
    edges: str | None = None
    # Whether angles without units are in degrees; None if nobody said so.
    degrees: bool | None = None
    infer: bool = False
    # "nodes" or "faces" of a mesh; None for what the convention has.
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
    # Within how many degrees meridians of boxes are one, and parallels.
    near: tuple[float, float] = (0.0, 0.0)
    # Places of corners, which of them each cell has (all in sequence without numbers), and where
    # the corners of each cell start.
    nodes: Floats | None = None
    corners: Rows | None = None
    starts: Rows | None = None
    # Which cells take part; None if the dataset does not say.
    mask: Bools | None = None
    # How many bounds moved to those of their neighbors.
    merged: int = 0
    # Whether cells share corners bit for bit, so that none need to be merged.
    shared: bool = False
    # The names of longitudes and latitudes of centers, if there are any.
    coords: tuple[Any, Any] | None = None
    # "node" if fields are at the nodes of a mesh, whose faces these cells are.
    location: str = "face"
    # Longitudes and latitudes of the centers in degrees, (n, 2), if they are known.
    centers: Floats | None = None


def flags_of(mask: Any, count: int, *, used: int = 1) -> Bools | None:
    """Return which cells take part; None if the variable has another size."""
    if mask is None or mask.size != count:
        return None
    found: Bools = np.asarray(mask.values).ravel() == used
    return found
