"""Variables of datasets: units, coordinates of corners, and node numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.counting import agreed, counted
from delone._base.values import require_real
from delone.errors import DirectionError, DtypeError, InputError, NonFiniteError, ShapeError
from delone.interpolate.places import unit_of
from delone.sphere.coordinates import BEYOND, directions_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Rows
    from delone.sphere.formats.cells import Choices

__all__ = [
    "attribute",
    "connected",
    "in_degrees",
    "numbers",
    "padded",
    "places",
    "ragged",
    "refuse_projected",
    "required",
    "variables_of",
]


def variables_of(given: Any) -> dict[str, Any]:
    """Return the variables of a dataset, or the coordinates of an array, by name."""
    if hasattr(given, "data_vars"):
        return {str(name): part for name, part in given.variables.items()}
    if hasattr(given, "coords") and hasattr(given, "dims"):
        return {str(name): part.variable for name, part in given.coords.items()}
    raise DtypeError(
        "the dataset must be an xarray.Dataset, such as xarray.open_dataset(path), a DataArray, or "
        f"a grid of uxarray; got {type(given).__name__}"
    )


def attribute(variable: Any, name: str) -> Any:
    """Return an attribute, which xarray may have moved to the encoding; None if there is none."""
    return variable.attrs.get(name, variable.encoding.get(name))


def in_degrees(
    variable: Any, axis: int, name: str, choices: Choices, *, fixed: bool | None = None
) -> bool:
    """Return whether a longitude (axis 0) or latitude (1) is in degrees rather than radians.

    The units decide; if there are none, the caller's option, then the convention.
    """
    said = unit_of(variable, axis)
    if said in {"degrees", "radians"}:
        if choices.degrees not in {None, said == "degrees"}:
            raise InputError(
                f"{name} has the units {variable.attrs['units']!r:.40}, which degrees="
                f"{choices.degrees} contradicts"
            )
        return said == "degrees"
    if said is not None:
        raise InputError(
            f"{name} has the units {said!r:.40}, not degrees or radians: transform it to "
            "longitudes and latitudes"
        )
    if choices.degrees is not None:
        return choices.degrees
    if fixed is None:
        raise InputError(f"{name} has no attribute units: give degrees=True or degrees=False")
    return fixed


def numbers(variable: Any, name: str) -> NDArray[Any]:
    """Return the real numbers of a variable."""
    values = np.asarray(variable.values)
    require_real(values, name)
    return values


def _require_same_shape(lon: NDArray[Any], lat: NDArray[Any], names: tuple[str, str]) -> None:
    if lon.shape != lat.shape:
        raise ShapeError(f"{names[0]} has shape {lon.shape}, and {names[1]} {lat.shape}")


def refuse_projected(variables: dict[str, Any]) -> None:
    """Reject variables that are coordinates of a projection or of a turned pole."""
    for name, part in variables.items():
        known = str(part.attrs.get("standard_name", ""))
        if known.startswith("projection_") or known in {"grid_longitude", "grid_latitude"}:
            raise InputError(
                f"{name} is a {known}, not a longitude or latitude: transform the corners of "
                "cells, for example with pyproj, and use Grid.from_curvilinear or Grid.from_mesh"
            )


def required(variables: dict[str, Any], name: str) -> Any:
    """Return a variable of a dataset."""
    if name not in variables:
        raise InputError(f"the dataset has no variable {name!r:.60}")
    return variables[name]


def places(
    lon: NDArray[Any],
    lat: NDArray[Any],
    degrees: tuple[bool, bool],
    names: tuple[str, str],
    choices: Choices,
) -> Floats:
    """Return the vectors of longitudes and latitudes, (n, 3)."""
    _require_same_shape(lon, lat, names)
    one, two = lon.ravel(), lat.ravel()
    if degrees[0] != degrees[1]:
        one, two = (
            values if known else np.degrees(values)
            for values, known in zip((one, two), degrees, strict=True)
        )
    both = np.column_stack((one, two))
    for name, column in zip(names, both.T, strict=True):
        _refuse(~np.isfinite(column), name, "not finite", error=NonFiniteError)
    pole = 90.0 if any(degrees) else np.pi / 2
    far = np.abs(both[:, 1])
    hint = "beyond a pole: are these the right units?"
    _refuse(far > pole * BEYOND, names[1], hint, error=DirectionError)
    beyond = far > pole
    both[beyond, 1] = np.copysign(pole, both[beyond, 1])
    if not len(both):
        return np.zeros((0, 3))
    return directions_of(both, None, degrees=any(degrees), workers=choices.workers, any_turns=True)


def _refuse(wrong: Bools, name: str, what: str, *, error: type[Any]) -> None:
    """Raise an error that lists the wrong rows of a variable, if there are any."""
    rows = np.flatnonzero(wrong)
    if len(rows):
        count = len(rows)
        entries = agreed(count, "entry is", "entries are")
        raise error(
            f"{name}: {count} {entries} {what}; first {rows[0]}", rows=rows[:10], count=count
        )


def padded(lon: NDArray[Any], lat: NDArray[Any], names: tuple[str, str]) -> tuple[Bools, Rows]:
    """Return which of (n, k) corners exist, and where those of each cell start.

    NaN after the last corner of a cell is padding.
    """
    _require_same_shape(lon, lat, names)
    absent = np.isnan(lon) & np.isnan(lat)
    return _trailing(absent, names[0])


def _trailing(absent: Bools, name: str) -> tuple[Bools, Rows]:
    """Return which entries of a table with padded rows exist, and where rows start."""
    holes = (absent[:, :-1] & ~absent[:, 1:]).any(axis=1)
    if holes.any():
        row = int(np.flatnonzero(holes)[0])
        raise InputError(f"{name}: cell {row} has a missing corner before others")
    there = ~absent
    starts = np.concatenate(([0], np.cumsum(there.sum(axis=1)))).astype(np.int64)
    return there, starts


def connected(
    variable: Any,
    name: str,
    nodes: int,
    *,
    start: int,
    counts: NDArray[Any] | None = None,
    transposed: bool = False,
) -> tuple[Rows, Rows]:
    """Return the nodes of all cells in sequence, and where those of each cell start.

    Rows are padded with the declared fill value, NaN or negative numbers, unless the numbers of
    their corners are given.
    """
    table = numbers(variable, name)
    table = table.T if transposed else table
    if table.ndim != 2:
        raise ShapeError(f"{name} must have two axes, got shape {table.shape}")
    filled = _filled(variable, table)
    if counts is None:
        there, starts = _trailing(filled, name)
    else:
        sizes = np.asarray(counts).astype(np.int64)
        if sizes.shape != table.shape[:1] or (sizes < 0).any() or (
            sizes > table.shape[1]
        ).any():  # fmt: skip
            raise ShapeError(f"the numbers of corners do not fit {name} of shape {table.shape}")
        there = np.arange(table.shape[1]) < sizes[:, None]
        starts = np.concatenate(([0], np.cumsum(sizes))).astype(np.int64)
    return _nodes(table[there], name, nodes, start, starts), starts


def _filled(variable: Any, table: NDArray[Any]) -> Bools:
    """Return which entries are padding."""
    found: Bools
    if table.dtype.kind == "f":
        found = np.isnan(table) | (table < 0)
        return found
    found = table == np.iinfo(table.dtype).max
    if table.dtype.kind == "i":
        found |= table < 0
    for name in ("_FillValue", "missing_value"):
        fill = attribute(variable, name)
        if fill is not None and np.ndim(fill) == 0:
            found |= table == fill
    return found


def ragged(
    variable: Any, name: str, nodes: int, *, start: int, counts: NDArray[Any]
) -> tuple[Rows, Rows]:
    """Return the nodes of all cells and their starts, from a flat list."""
    flat = numbers(variable, name)
    starts = np.concatenate(([0], np.cumsum(np.asarray(counts).astype(np.int64))))
    if flat.ndim != 1 or (np.diff(starts) < 0).any() or starts[-1] != len(flat):
        raise ShapeError(f"the numbers of corners do not add up to the {flat.size} of {name}")
    return _nodes(flat, name, nodes, start, starts), starts


def _nodes(entries: NDArray[Any], name: str, nodes: int, start: int, starts: Rows) -> Rows:
    """Return numbers that start at 0, or raise an error that names a cell with one out of range."""
    with np.errstate(invalid="ignore"):
        found = np.asarray(entries).astype(np.int64)
        wrong = (found < start) | (found >= nodes + start) | (found != entries)
    if wrong.any():
        at = int(np.flatnonzero(wrong)[0])
        cell = int(np.searchsorted(starts, at, side="right")) - 1
        rows = np.unique(np.searchsorted(starts, np.flatnonzero(wrong), side="right") - 1)
        count = counted(len(rows), "cell")
        hint = ""
        if start == 0 and found.min() == 1 and found.max() == nodes and (found == entries).all():
            hint = ": if nodes are counted from 1, set its attribute start_index to 1"
        raise InputError(
            f"{name}: {count} {agreed(len(rows), 'has', 'have')} a node out of range {start} to "
            f"{nodes - 1 + start}; first cell {cell}, node {entries[at]}{hint}"
        )
    return found - start
