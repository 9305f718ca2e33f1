"""Weights between the centers of cells: interpolation of values at points."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._tiling.plane.topology import vertex_neighbor_vertices
from delone.errors import InputError
from delone.sphere.coordinates import directions_of, units_of
from delone.sphere.delaunay import Delaunay
from delone.sphere.interpolation import Linear, NaturalNeighbor
from delone.sphere.quadrilaterals import between_corners
from delone.sphere.voronoi import Voronoi

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Rows
    from delone.sphere.grid import Grid

__all__ = ["POINTWISE", "Entries", "pointwise", "refuse_neighbors"]

POINTWISE = (
    "nearest", "binned", "linear", "bilinear", "sibson", "laplace", "inverse_distance",
)  # fmt: skip


# Distances with a smaller relative difference count as equal.
_EQUAL = 1e-12


class Entries(NamedTuple):
    """Weights, one by one: target cells, source cells, and values."""

    rows: Rows
    columns: Rows
    values: Floats


class _Pair(NamedTuple):
    """Both grids, and which cells are used."""

    source: Grid
    target: Grid
    sources: Rows
    targets: Rows
    workers: int | None


def refuse_neighbors(neighbors: int | None, method: str) -> None:
    """Reject a number of neighbors for a method that takes none."""
    if neighbors is not None and method != "inverse_distance":
        raise InputError(f"neighbors is only for method 'inverse_distance', got {method!r:.60}")


def pointwise(
    source: Grid,
    target: Grid,
    method: str,
    used: tuple[Bools | None, Bools | None],
    *,
    extrapolate: str,
    power: float,
    neighbors: int | None,
    workers: int | None,
) -> Entries:
    """Return the weights of a method of `POINTWISE` between the cells that are used."""
    pair = _Pair(source, target, _places(source, used[0]), _places(target, used[1]), workers)
    if not len(pair.sources) or not len(pair.targets):
        return Entries(*(np.zeros(0, dtype=np.int64),) * 2, np.zeros(0))
    if method == "binned":
        return _binned(pair)
    if method == "bilinear":
        found = _bilinear(pair, used[0])
    elif method in {"nearest", "inverse_distance"}:
        # These methods give values everywhere.
        return _nearest(pair, None if method == "nearest" else power, neighbors)
    else:
        found = _triangles(pair, method)
    if extrapolate == "nearest":
        rest = np.setdiff1d(pair.targets, found.rows)
        if len(rest):
            near = _nearest(pair._replace(targets=rest), None)
            found = Entries(*(np.concatenate(both) for both in zip(found, near, strict=True)))
    return found


def _places(grid: Grid, used: Bools | None) -> Rows:
    """Return the cells that are used and have a center."""
    there = np.isfinite(grid.centers_lonlat).all(axis=1)
    return np.flatnonzero(there if used is None else there & used)


def _triangles(pair: _Pair, method: str) -> Entries:
    """Return the weights of an interpolator of the centers."""
    sites = pair.source.centers_lonlat[pair.sources]
    options: dict[str, Any] = {"duplicates": "first", "workers": pair.workers}
    made: Linear | NaturalNeighbor
    if method == "linear":
        made = Linear(sites, **options)
    else:
        made = NaturalNeighbor(sites, kind=method, **options)
    table = made.weights_at(pair.target.centers_lonlat[pair.targets])
    rows = np.repeat(pair.targets, np.diff(table.indptr))
    return Entries(rows, pair.sources[table.indices], table.weights)


def _binned(pair: _Pair) -> Entries:
    """Return the weights of means: each source cell belongs to the nearest center of a target."""
    cells = Voronoi(lonlat=pair.target.centers_lonlat[pair.targets], workers=pair.workers)
    rows = pair.targets[cells.nearest(pair.source.centers_lonlat[pair.sources])]
    number = np.bincount(rows, minlength=pair.target.ncells)
    return Entries(rows, pair.sources, 1.0 / number[rows])


def _nearest(pair: _Pair, power: float | None, most: int | None = None) -> Entries:
    """Return the nearest centers; with a power, also others, weighted by distance.

    The others are the neighbors in the Delaunay triangulation, or the `most` nearest centers and
    all others at the same distance as the last of them, so that ties are treated alike. A target at
    a center gets its value.
    """
    sites = pair.source.centers_lonlat[pair.sources]
    queries = pair.target.centers_lonlat[pair.targets]
    if power is None:
        near = Voronoi(lonlat=sites, workers=pair.workers).nearest(queries)
        return Entries(pair.targets, pair.sources[near], np.ones(len(near)))
    mesh = Delaunay(lonlat=sites, workers=pair.workers)
    near = mesh.nearest(queries).astype(np.int64)
    graph = vertex_neighbor_vertices(mesh.edges, mesh.npoints)
    places = units_of(_vectors(queries), None)
    row, every, angles = _several(mesh.points, graph, places, near, most)
    least = np.full(len(near), np.inf)
    np.minimum.at(least, row, angles)
    least = least[row]
    same = (least == 0) & (every == near[row])
    # Relative to the nearest one, so that no power overflows.
    with np.errstate(divide="ignore", invalid="ignore"):
        weights = np.where(least == 0, same, (least / angles) ** power)
    used = weights > 0
    sums = np.bincount(row, weights, len(near))
    return Entries(pair.targets[row[used]], pair.sources[every[used]], (weights / sums[row])[used])


def _several(
    sites: Floats, graph: tuple[Any, Any], places: Floats, near: Any, most: int | None
) -> tuple[Rows, Rows, Floats]:
    """Return the nearest site and others for each point: rows, sites and angles.

    The site after the j nearest ones is a neighbor of one of them in the Delaunay triangulation. So
    each step finds at least one more, and as many steps as wanted sites find all. This holds for
    points within 90 degrees of their sites.
    """
    starts, neighbors = graph
    count = len(sites)
    row, every = np.arange(len(near), dtype=np.int64), near.astype(np.int64)
    for _ in range(1 if most is None else most):
        numbers = np.diff(starts)[every].astype(np.int64)
        within = np.arange(numbers.sum()) - np.repeat(np.cumsum(numbers) - numbers, numbers)
        others = neighbors[np.repeat(starts[every].astype(np.int64), numbers) + within]
        pairs = np.concatenate((row * count + every, np.repeat(row, numbers) * count + others))
        found_row, found = np.divmod(np.unique(pairs), count)
        angles = _angles(sites[found], places[found_row])
        if most is not None:
            # The nearest sites of each point, with those as far as the last one up to rounding
            # errors.
            order = np.lexsort((angles, found_row))
            found_row, found, angles = found_row[order], found[order], angles[order]
            first = np.searchsorted(found_row, np.arange(len(near)))
            last = np.minimum(first + most, np.append(first[1:], len(found))) - 1
            kept = angles <= (angles[last] * (1 + _EQUAL))[found_row]
            found_row, found, angles = found_row[kept], found[kept], angles[kept]
        if len(found) == len(every) and np.array_equal(found, every):
            break
        row, every = found_row, found
    return row, every, angles


def _angles(one: Floats, other: Floats) -> Floats:
    chords = np.linalg.norm(one - other, axis=1)
    found: Floats = 2 * np.arcsin(np.minimum(chords / 2, 1.0))
    return found


def _vectors(lonlat: Floats) -> Floats:
    return directions_of(lonlat, None, degrees=True, workers=None, any_turns=True)


def _bilinear(pair: _Pair, used: Bools | None) -> Entries:
    """Return weights between centers in rows and columns; all four must be used.

    Between the outermost row and a pole that its cells reach, the pole has the mean of the row.
    Other cells are those around the corners that they have in common.
    """
    source = pair.source
    if source.bounds is None and source.edges == "parallel":
        raise InputError(
            "bilinear needs a source in rows and columns, or cells that have corners in common, "
            "which those of reduced grids have not: linear is for all grids"
        )
    if source.bounds is None:
        queries = pair.target.centers_lonlat[pair.targets]
        rows, cells, weights = between_corners(source, used, queries, pair.workers)
        return _unmasked(Entries(pair.targets[rows], cells, weights), used)
    shape = source.grid_shape
    at = np.arange(source.ncells).reshape(shape)
    lon, lat = (edges[:-1] + np.diff(edges) / 2 for edges in source.bounds)
    whole = abs(source.bounds[0][-1] - source.bounds[0][0]) == 360
    if len(lon) > 1 and lon[0] > lon[-1]:
        lon, at = lon[::-1], at[:, ::-1]
    if len(lat) > 1 and lat[0] > lat[-1]:
        lat, at = lat[::-1], at[::-1]
    if whole:
        # Repeat the first column one turn farther east.
        lon, at = np.append(lon, lon[0] + 360), np.column_stack((at, at[:, 0]))
    x, y = pair.target.centers_lonlat[pair.targets].T
    x = lon[0] + (x - lon[0]) % 360
    column = np.clip(np.searchsorted(lon, x, side="right") - 1, 0, max(len(lon) - 2, 0))
    row = np.searchsorted(lat, y, side="right") - 1
    inside = (x >= lon[0]) & (x <= lon[-1])
    found = []
    middle = inside & (row >= 0) & (y <= lat[-1])
    if len(lat) > 1 and len(lon) > 1:
        low = np.clip(row, 0, len(lat) - 2)
        s = (x - lon[column]) / (lon[column + 1] - lon[column])
        t = (y - lat[low]) / (lat[low + 1] - lat[low])
        for i, v in ((0, 1 - t), (1, t)):
            for j, u in ((0, 1 - s), (1, s)):
                found.append((middle, at[low + i, np.minimum(column + j, len(lon) - 1)], u * v))
    parts = [
        Entries(pair.targets[rows], cells[rows], weights[rows]) for rows, cells, weights in found
    ]
    if whole:
        for beyond, k, pole in ((row < 0, 0, -90.0), (y > lat[-1], len(lat) - 1, 90.0)):
            if abs(source.bounds[1][[0, -1]] - pole).min() == 0:
                parts += _to_pole(pair, beyond, (x, y, column), (lon, lat, at), k, pole)
    return _unmasked(Entries(*(np.concatenate(each) for each in zip(*parts, strict=True))), used)


def _unmasked(entries: Entries, used: Bools | None) -> Entries:
    """Return positive weights, without the targets that need an unused cell."""
    if used is not None:
        # A target that needs an unused cell has no value.
        lost = np.unique(entries.rows[~used[entries.columns] & (entries.values > 0)])
        kept = ~np.isin(entries.rows, lost)
        entries = _kept(entries, kept)
    return _kept(entries, entries.values > 0)


def _kept(entries: Entries, kept: Bools) -> Entries:
    return Entries(entries.rows[kept], entries.columns[kept], entries.values[kept])


def _to_pole(  # noqa: PLR0917
    pair: _Pair,
    beyond: Bools,
    places: tuple[Floats, Floats, Rows],
    nodes: tuple[Floats, Floats, Rows],
    k: int,
    pole: float,
) -> list[Entries]:
    """Return the weights of targets between a row and its pole."""
    x, y, column = (each[beyond] for each in places)
    lon, lat, at = nodes
    targets = pair.targets[beyond]
    t = (y - lat[k]) / (pole - lat[k])
    s = (x - lon[column]) / (lon[column + 1] - lon[column])
    parts = [Entries(targets, at[k, column + j], u * (1 - t)) for j, u in ((0, 1 - s), (1, s))]
    cells = at[k, :-1]
    share = np.repeat(t / len(cells), len(cells))
    parts.append(Entries(np.repeat(targets, len(cells)), np.tile(cells, len(targets)), share))
    return parts
