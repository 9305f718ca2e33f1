"""The base of grids of cells on the sphere: properties of cells, files and pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._base.counting import counted
from delone._base.georeference import as_known_crs
from delone._base.immutable import kept, sealed
from delone._tiling.complex import Stored
from delone.errors import DtypeError, ShapeError
from delone.sphere import rings as rings_of
from delone.sphere.coordinates import as_step, lonlat_of, units_of
from delone.sphere.faults import EMPTY, FAULTS, LARGE, fault_error
from delone.sphere.grid_report import GridFaults, GridReport
from delone.sphere.holes import Holes, holes_between_arcs, holes_between_rows
from delone.sphere.large import Parts, overlaps_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Floats, Rows

__all__ = ["GridCells", "require_grid"]

# Cells overlap if they share more of the smaller one than this; less is a rounding error.
_SHARED = 1e-12
_NONE = np.zeros(0, dtype=np.int64)
# Names of arrays in files: for rows of cells, and for polygons.
_ROWS = "places", "starts", "meridians", "numbers"
_RINGS = "places", "rings", "cells", "holes"


def require_grid(grid: Any, name: str) -> None:
    """Reject anything but a grid."""
    if not isinstance(grid, GridCells):
        raise DtypeError(f"{name} must be a sphere.Grid, got {type(grid).__name__}")


class GridCells(Stored):
    """Cells on the sphere of any origin; see `Grid`."""

    __slots__ = (
        "_arrays", "_bounds", "_centers", "_checked", "_edges", "_made", "_mask", "_merged",
        "_shape",
    )  # fmt: skip

    _arrays: tuple[Any, ...]
    _bounds: tuple[Floats, Floats] | None
    _centers: Floats | None
    _checked: Any
    _edges: str
    # The cells of the core, or `Parts` of them.
    _made: Any
    _mask: Bools | None
    _merged: int
    _shape: tuple[int, ...]

    @classmethod
    def _of(
        cls,
        edges: str,
        arrays: tuple[Any, ...],
        shape: tuple[int, ...],
        merged: int,
        workers: int | None,
        *,
        bounds: tuple[Floats, Floats] | None = None,
        mask: Bools | None = None,
        centers: Floats | None = None,
    ) -> Self:
        """Return a grid from arrays for the core; `centers` are where fields are, in degrees."""
        threads = as_workers(workers)
        made = cls.__new__(cls)
        arrays = tuple(sealed(a) if isinstance(a, np.ndarray) else a for a in arrays)
        build = _core.CellGrid.rows if edges == "parallel" else _core.CellGrid.polygons
        cells: Any = build(*arrays)
        checked: Any = cells.check(True, threads)
        if (checked.faults == LARGE).any():
            cells = Parts(arrays, checked.faults)
            checked = cells.check(True, threads)
        made._hold(
            arrays=arrays,
            checked=checked,
            bounds=None if bounds is None else (sealed(bounds[0]), sealed(bounds[1])),
            centers=None if centers is None else sealed(centers),
            edges=edges,
            made=cells,
            mask=None if mask is None else sealed(mask),
            merged=merged,
            shape=shape,
            workers=workers,
        )
        made._refuse_faults()
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        parts = self._edges, self._arrays, self._shape, self._merged, self._workers
        return self._again, (parts, self._bounds, self._mask, self._centers)

    @classmethod
    def _again(
        cls,
        parts: tuple[Any, ...],
        bounds: tuple[Floats, Floats] | None,
        mask: Bools | None,
        centers: Floats | None = None,
    ) -> Self:
        """Restore a pickled grid."""
        edges, arrays, *rest = parts
        if len(arrays) != 4 + (edges == "parallel"):
            raise ShapeError("a pickled Grid is incomplete")
        return cls._of(edges, arrays, *rest, bounds=bounds, mask=mask, centers=centers)

    @classmethod
    def _stored_as(cls) -> str:
        return "sphere.Grid"

    def _saved(self) -> dict[str, NDArray[Any]]:
        names = _ROWS if self._edges == "parallel" else _RINGS
        found: dict[str, NDArray[Any]] = dict(zip(names, self._arrays[:4], strict=True))
        columns, rows = self._bounds or (np.zeros(0), np.zeros(0))
        mask = np.zeros(0, dtype=np.bool_) if self._mask is None else self._mask
        centers = np.zeros((0, 2)) if self._centers is None else self._centers
        found |= {"columns": columns, "rows": rows, "mask": mask, "centers": centers}
        found["shape"] = np.array(self._shape, dtype=np.int64)
        found["merged"] = np.array([self._merged], dtype=np.int64)
        return found

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        parallel = "meridians" in arrays
        given: tuple[Any, ...] = tuple(arrays[name] for name in (_ROWS if parallel else _RINGS))
        shape = tuple(arrays["shape"].tolist())
        if parallel:
            given = (*given, int(np.prod(shape)))
        bounds = (arrays["columns"], arrays["rows"]) if len(arrays["rows"]) else None
        mask = arrays["mask"] if len(arrays["mask"]) else None
        centers = arrays["centers"]
        return cls._of(
            "parallel" if parallel else "arc",
            given,
            shape,
            int(arrays["merged"][0]),
            None,
            bounds=bounds,
            mask=mask,
            centers=centers if len(centers) else None,
        )

    def __repr__(self) -> str:
        size = f" ({' x '.join(map(str, self._shape))})" if len(self._shape) > 1 else ""
        sides = "parallels" if self._edges == "parallel" else "arcs of great circles"
        return f"<Grid of {counted(self.ncells, 'cell')}{size}, {sides}>"

    def __len__(self) -> int:
        return self.ncells

    def _refuse_faults(self) -> None:
        """Raise an error for cells that cannot be used."""
        faults = self._checked.faults
        for fault in FAULTS:
            rows = np.flatnonzero(faults == fault)
            if len(rows):
                raise fault_error(fault, rows)

    @property
    def ncells(self) -> int:
        """Number of cells."""
        return int(np.prod(self._shape))

    @property
    def grid_shape(self) -> tuple[int, ...]:
        """The shape of fields on the grid."""
        return self._shape

    @property
    def edges(self) -> str:
        """The kind of sides: "parallel" for meridians and parallels, "arc" for great circles."""
        return self._edges

    @property
    def mask(self) -> Bools | None:
        """The cells to use, (ncells,), if a dataset specifies them; otherwise None."""
        return self._mask

    @property
    def bounds(self) -> tuple[Floats, Floats] | None:
        """Edges between columns and between rows, in degrees; None for other cells."""
        return self._bounds

    @property
    @kept
    def areas(self) -> Floats:
        """Areas in steradians, (ncells,); 0 for empty cells."""
        return sealed(self._checked.areas)

    @property
    @kept
    def report(self) -> GridReport:
        """Which corners were changed, and which cells are special."""
        known = self._checked
        return GridReport(
            merged=self._merged,
            repeated=known.repeated,
            reversed=np.flatnonzero(known.turned),
            empty=np.flatnonzero(known.faults == EMPTY),
            concave=np.flatnonzero(known.concave),
            large=np.flatnonzero(self._made.large) if isinstance(self._made, Parts) else _NONE,
            masked=np.flatnonzero(~self._mask) if self._mask is not None else _NONE,
        )

    @property
    @kept
    def rings(self) -> tuple[Floats, Rows, Rows]:
        """The rings of all cells: unit vectors of corners, starts of rings, starts of cells.

        Cells between meridians and parallels have their four corners. Cells on the larger side of
        their rings have the corners of the triangles that they are divided into.
        """
        if self._edges == "arc":
            vectors, starts, cells, _ = self._arrays
        else:
            vectors, starts, cells = rings_of.corners(self._arrays)
        return sealed(units_of(vectors, self._workers)), sealed(starts), sealed(cells)

    @property
    @kept
    def centers_lonlat(self) -> Floats:
        """Longitude and latitude of a point in the middle of each cell, (ncells, 2), in degrees.

        The centers in the dataset, or the nodes if cells are built around nodes. Otherwise the
        middle between the bounds of rows and columns, or the mean direction of the corners; NaN for
        cells without corners.
        """
        if self._centers is not None:
            return self._centers
        if self._bounds is not None:
            lon, lat = (edges[:-1] + np.diff(edges) / 2 for edges in self._bounds)
            x, y = np.meshgrid(np.where(lon > 180, lon - 360, lon), lat)
            return sealed(np.column_stack((x.ravel(), y.ravel())))
        vectors, starts, cells = self.rings
        total = np.concatenate((np.zeros((1, 3)), np.cumsum(vectors, axis=0)))
        sums = np.diff(total[starts[cells]], axis=0)
        none = ~sums.any(axis=1)
        sums[none] = 1.0
        found = lonlat_of(sums)
        found[none] = np.nan
        return sealed(found)

    def validate(self) -> GridFaults:
        """Find cells that overlap, and holes between cells.

        Returns
        -------
        GridFaults
            Truthy if no two cells share more than 1e-12 of the smaller one. It has the pairs that
            do, the number of `holes`, the cells along each ring of sides with a cell on one side
            only (`rims`), and the number of gaps from rounding errors (`slivers`).

        Notes
        -----
        This computes the overlaps of the grid with itself. Holes are not faults: a regional grid
        has one, the rest of the sphere. Corners closer to a side than rounding errors count as on
        it, within the limits of `GridFaults`. `holes` is None if cells overlap, or if sides cross.

        Examples
        --------
        >>> from delone import sphere
        >>> square = [(0, 0), (10, 0), (10, 10), (0, 10)]
        >>> moved = [(5, 0), (15, 0), (15, 10), (5, 10)]
        >>> sphere.Grid.from_mesh(lonlat=[square, moved]).validate()
        <GridFaults: 1 pair of cells overlap, 0.483547 % of the sphere>
        """
        found = overlaps_of(self._made, self._made, as_workers(self._workers))
        first = np.repeat(np.arange(self.ncells), np.diff(found.indptr))
        pairs = np.column_stack((first, found.indices.astype(np.int64)))
        small = self.areas[pairs].min(axis=1)
        wrong = (pairs[:, 0] < pairs[:, 1]) & (found.areas > _SHARED * small)
        holes = Holes(None, (), 0) if wrong.any() else self._holes()
        return GridFaults(
            overlapping=pairs[wrong],
            covered=float(self.areas.sum() / (4 * np.pi)),
            holes=holes.number,
            rims=holes.rims,
            slivers=holes.slivers,
        )

    def _holes(self) -> Holes:
        """Return the holes between cells that do not overlap."""
        if self._edges == "parallel":
            return holes_between_rows(self._arrays, self.areas)
        if isinstance(self._made, Parts):
            return holes_between_arcs(
                self._made.arrays, self._made.owner, self.areas, self._workers
            )
        return holes_between_arcs(self._arrays, np.arange(self.ncells), self.areas, self._workers)

    def to_geopandas(self, data: Any = None, *, crs: Any = None, step: float = 1.0) -> Any:
        """Convert the cells to a GeoDataFrame (extra ``geo``).

        Parameters
        ----------
        data : DataFrame or mapping, optional
            Columns to include, with one row for each cell.
        crs : any, optional
            Coordinate reference system of longitudes and latitudes, by default EPSG:4326.
        step : float, optional
            Maximum distance, in degrees, between the corners that represent arcs of great circles.

        Returns
        -------
        GeoDataFrame
            Polygons and multipolygons in degrees, cut at 180 degrees and completed along the edge
            of the map if they contain a pole. Empty cells are empty polygons.

        Raises
        ------
        MissingExtraError
            geopandas is not installed.
        InputError
            `data` does not have one row for each cell, or `step` is not positive.

        Examples
        --------
        >>> from delone import sphere
        >>> table = sphere.Grid.from_lonlat([170, 190], [0, 10, 20]).to_geopandas()
        >>> table.geom_type.tolist(), table.total_bounds.tolist()
        (['MultiPolygon', 'MultiPolygon'], [-180.0, 0.0, 180.0, 20.0])
        """
        from delone.exchange.geopandas import beside

        width = as_step(step)
        if self._edges == "parallel":
            shapes = rings_of.boxes(self._arrays)
        else:
            shapes = rings_of.shapes(self._arrays, self.areas, width)
        return beside(shapes, data, as_known_crs(crs) or "EPSG:4326", of="cells")

    def plot(
        self,
        ax: Any = None,
        *,
        values: ArrayLike | None = None,
        bounds: Sequence[float] | None = None,
        resolution: float | None = None,
        sides: bool | None = None,
        coast: Any = None,
        cmap: Any = "viridis",
        colorbar: bool = True,
        title: str | None = None,
    ) -> Any:
        """Draw the cells on a map of longitudes and latitudes with matplotlib (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; by default on a new one.
        values : array_like, optional
            A value for each cell, in the shape of the grid or (ncells,), shown as colors. Each
            pixel has the mean of the cells in it, weighted by shared area.
        bounds : sequence of float, optional
            Left, bottom, right and top of the map in degrees; by default those of the cells. The
            left one may exceed the right one, across the date line.
        resolution : float, optional
            Degrees per pixel; by default, the map is 600 pixels wide.
        sides : bool, optional
            Whether to draw the sides of cells. By default, they are drawn if there are no values or
            at most 5,000 cells.
        coast : dict, optional
            A GeoJSON MultiPolygon, drawn as lines, such as `delone.datasets.land()`.
        cmap, colorbar, title
            As usual in matplotlib.

        Returns
        -------
        matplotlib Axes
            Where it is drawn.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.
        InputError, ShapeError, DtypeError
            `values` are not numbers in the shape of the grid, or an option is invalid.

        Examples
        --------
        >>> from delone import sphere
        >>> ax = sphere.Grid.from_healpix(2).plot()
        >>> ax.get_xlabel(), ax.get_aspect()
        ('longitude', 1.0)
        """
        from delone.sphere.chart import plot_grid

        return plot_grid(
            self, ax, values, bounds=bounds, resolution=resolution, sides=sides, coast=coast,
            cmap=cmap, colorbar=colorbar, title=title,
        )  # fmt: skip
