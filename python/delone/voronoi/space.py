"""The class SpaceVoronoi: the diagram of points in space as immutable arrays.

`delone.Voronoi` makes one where points have three coordinates. The core makes the arrays of the
whole diagram; what follows from them, and what a clip leaves of the cells (`bodies`), is computed
on first use and kept.

The arrays of the core: ridge r has the sites ``sites[r]`` and the entries
``ridge_entries[ridge_starts[r]:ridge_starts[r + 1]]``, counter-clockwise as seen from the second: a
vertex, or ``~i`` for ray i with direction ``rays[i]``, with which an open ridge begins and ends.
Cell c has the site ``site[c]``, its vertices as rows of ``region_starts`` and ``region_vertices``
(ascending, -1 first where it is open), and its ridges as rows of ``region_ridge_starts`` and
``region_ridges``.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._arrays import as_flag, as_workers
from delone.counting import counted
from delone.errors import InputError
from delone.georeference import warn_of_degrees
from delone.immutable import kept, own_copy, sealed
from delone.regular import as_weights
from delone.voronoi import sites, thin
from delone.voronoi.bodies import Bodies, SpaceCell, SpaceNeighbors
from delone.voronoi.cells import Rays, as_site
from delone.voronoi.diagram import Voronoi
from delone.voronoi.lists import compressed, ridge_lists
from delone.voronoi.polyhedra import Polyhedron, as_polyhedron

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import ArrayLike, NDArray

    from delone._core import Diagram3

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["SpaceVoronoi"]

# Where a surface has less area, the volume may be below the range of doubles.
_SMALL = 2.0**-600


class SpaceVoronoi(Voronoi):
    """The Voronoi diagram of points in space, whole or clipped.

    ``delone.Voronoi(points)`` makes it where `points` has three columns.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        The sites, finite, in any unit. They are copied and taken as the exact numbers which they
        denote.
    clip : "box" or array_like, optional
        What to cut the cells to: the box of the sites; a box ``((xmin, ymin, zmin), (xmax, ymax,
        zmax))`` of shape (2, 3); half-spaces of shape (k, 4), each ``(a, b, c, d)`` for ``a x + b y
        + c z + d <= 0``, bounded together; or points of shape (k, 3), or an object with points and
        simplices as a convex hull has them, for the convex hull of these. Sites may lie outside.
    fix : bool, optional
        Accepted as in the plane; a convex polyhedron is never invalid.
    weights : array_like, shape (n,), optional
        Weights of the sites: then this is the power diagram.
    periods : None
        Periods are for the plane.
    workers : int, optional
        How many threads may work; by default one for each core. The answer is the same.

    Attributes
    ----------
    points : ndarray of float64, shape (n, 3)
        The sites.
    weights : ndarray of float64, shape (n,), or None
        Their weights.
    vertices : ndarray of float64, shape (k, 3)
        The vertices of the whole diagram.
    ridge_points : ndarray of int32, shape (r, 2)
        The two sites between which each ridge (a face of cells) lies.
    ridge_vertices : list of list of int
        The vertices of each ridge, counter-clockwise as seen from its second site; -1, which comes
        first, where it goes on for ever.
    regions : list of list of int
        For each cell its vertices, ascending, with -1 in front where it is open.
    point_region : ndarray of int32, shape (n,)
        The cell of each point, as an index of `regions`; -1 for a hidden site.

    Raises
    ------
    DegenerateInputError
        All points lie in one plane, or there are fewer than four; the error is that of
        `delone.Delaunay`, or of `delone.RegularTriangulation` where there are weights:
        ``error.plane`` has the triangulation of the plane, and its ``circumcenters`` are the
        vertices of the diagram there.
    NonFiniteError
        A coordinate is NaN or infinite; ``error.rows`` tells where.
    ShapeError, DtypeError
        `points` is no array of real points in space, or there are not as many weights.
    InputError
        `clip` has no volume or no end, judged exactly; or there are periods.

    Notes
    -----
    The diagram is the dual of the exact Delaunay triangulation (with weights, of the regular one),
    and all that is combinatorial in it is exact: sites on one sphere share one vertex, whatever
    their number, and no ridge is without area. The coordinates of vertices are rounded, each to
    within 4 units in the last place of the true one. A vertex beyond the range of doubles is not
    listed, and ridges that lead to it have a -1 in its place.

    In a `clip`, volumes, areas, centroids, neighbours and cells are those of what is left; the
    attributes listed above remain those of the whole diagram. Cells whose vertices all lie inside
    stay as they are; the others are the polyhedron, cut by the planes of their neighbours one after
    the other. An area or a volume beyond the range of doubles is infinite; below it, the smallest
    double. Corners in a clip are right to about 1e-13 of the largest coordinate, beside sites close
    together, too, as exact arithmetic finds them where planes meet at a flat angle. Which corners
    there are is decided on rounded numbers: that may lose or add faces as small as roundings, and
    beside sites that differ by a few units in the last place, wrong ones. A cell has the same
    corner twice where its surface would not be closed otherwise.

    Half-spaces are judged exactly, whatever their exponents, and the corners of what they have in
    common are rounded once: O(k^2) expected time for k of them, about half a second for 300.

    See Also
    --------
    delone.Delaunay : The dual.

    Examples
    --------
    >>> from delone import Voronoi
    >>> corners = [(x, y, z) for x in (0, 4) for y in (0, 4) for z in (0, 4)]
    >>> diagram = Voronoi([*corners, (2, 2, 2)], clip=((-1, -1, -1), (5, 5, 5)))
    >>> diagram
    <Voronoi diagram of 9 points in space: 6 vertices, 20 ridges, clipped to a box>
    >>> diagram.cell_volumes[8].round(9), diagram.cell_volumes.sum().round(9)
    (np.float64(36.0), np.float64(216.0))
    >>> cell = diagram.cell(8)
    >>> len(cell.vertices), [len(face) for face in cell.faces]
    (6, [3, 3, 3, 3, 3, 3, 3, 3])
    """

    __slots__ = ()

    _dual: Diagram3  # type: ignore[assignment]

    def __init__(
        self,
        points: ArrayLike,
        *,
        clip: Any = None,
        fix: bool = False,
        weights: ArrayLike | None = None,
        periods: None = None,
        workers: int | None = None,
        planar: bool = False,
    ) -> None:
        if hasattr(self, "_points"):
            raise AttributeError("a Voronoi never changes: make another one")
        if periods is not None:
            raise InputError("periods are only available in 2-D")
        threads = as_workers(workers)
        as_flag(fix, name="fix")
        own = own_copy(points, ndim=3)
        warn_of_degrees(points, own, planar=planar)
        heavy = None if weights is None else as_weights(weights, len(own))
        mesh, arrays = sites.in_space(own, heavy, threads)
        where = as_polyhedron(clip, own)
        self._fill(
            points=own,
            weights=heavy,
            mesh=mesh,
            dual=arrays,
            clip=where,
            periods=None,
            workers=threads,
        )

    @property
    def ndim(self) -> int:
        """Number of coordinates, 3."""
        return 3

    @property
    def clip(self) -> Polyhedron | None:
        """The polyhedron at which cells end; None without."""
        found: Any = self._clip
        return found if isinstance(found, Polyhedron) else None

    @property
    @kept
    def ridge_offsets(self) -> Indices:
        """Zeros, (r, 3): no site is moved by a period."""
        return sealed(np.zeros((len(self.ridge_points), 3), dtype=np.int32))

    @property
    @kept
    def ridge_vertices(self) -> list[list[int]]:  # type: ignore[override]
        """The vertices of each ridge in their order around it; -1, which comes first, if open."""
        return ridge_lists(self._dual)

    @property
    @kept
    def ridge_dict(self) -> dict[tuple[int, int], list[int]]:
        """The vertices of each ridge by the pair of its sites."""
        pairs = map(tuple, self.ridge_points.tolist())
        return dict(zip(pairs, self.ridge_vertices, strict=True))

    @property
    @kept
    def regions(self) -> list[list[int]]:
        """For each cell its vertices, ascending, with -1 in front where it is open."""
        indptr, indices = (array.tolist() for array in self.region_vertices)
        return [indices[a:b] for a, b in itertools.pairwise(indptr)]

    @property
    def region_vertices(self) -> tuple[Indices, Indices]:
        """`regions` as compressed rows (indptr, indices)."""
        return self._dual.region_starts, self._dual.region_vertices

    @property
    def triangle_vertices(self) -> Indices:
        """The vertex of each tetrahedron of `triangulation`, (m,); -1 beyond the range."""
        return self._dual.simplex_vertex

    @property
    @kept
    def rays(self) -> Rays:
        """The ridges that go on for ever, with origins and directions, two rows for each.

        In the row that comes first the boundary of the ridge comes in from infinity, in the other
        one it goes out; directions lead away.
        """
        starts, entries = self._dual.ridge_starts.astype(np.int64), self._dual.ridge_entries
        first, last = starts[:-1], starts[1:] - 1
        ridge = np.flatnonzero(entries[first] < 0)
        at = np.stack((first[ridge], last[ridge]), axis=1)
        beside = at + np.array([1, -1])
        there = (entries[at] < 0) & (entries[beside] >= 0)
        rows = np.broadcast_to(ridge[:, None], at.shape)[there].astype(np.int32)
        origin = self.vertices[entries[beside[there]]]
        direction = self._dual.rays[~entries[at[there]]]
        return Rays(sealed(rows), sealed(origin), sealed(direction))

    @property
    @kept
    def _bodies(self) -> Bodies:
        """What is left of the cells."""
        where: Any = self._clip
        found = Bodies(self._points, self._weights, self._dual, where, self._workers)
        thin.tell(self._rows_of(self._thin_bodies(found)), "volumes")
        return found

    def _thin_bodies(self, bodies: Bodies) -> NDArray[np.bool_]:
        """Which cells are too thin for their volumes to be known."""
        where: Any = self._clip
        # A cell without weights has its site, and something of what is around it.
        lost = np.flatnonzero((bodies.volumes == 0) & ~self._is_below(bodies.areas))
        if self._weights is not None:
            lost = lost[:0]
        elif where is not None and len(lost):
            lost = lost[where.holds(self._points[self._dual.site[lost]])]
        found = np.zeros(len(bodies.volumes), dtype=bool)
        found[lost] = True
        return found

    @staticmethod
    def _is_below(areas: Floats) -> NDArray[np.bool_]:
        """Whether volumes may be 0 as they are below the range of doubles."""
        return (areas > 0) & (areas < _SMALL)

    @property
    @kept
    def thin_cells(self) -> Indices:
        """The rows whose cells have lost their volumes to rounding, (k,).

        Such cells are only a few units in the last place wide. A `ThinCellWarning` names the rows
        when volumes or faces are asked for. Of cells that have weights, and nothing left within
        the clip, it is not known whether rounding has taken it.
        """
        return sealed(self._rows_of(self._thin_bodies(self._bodies)))

    @property
    @kept
    def cell_volumes(self) -> Floats:
        """Volumes of the cells within the clip, (n,), in the cube of the unit of the points.

        Infinite for an unbounded cell, 0 for one of which nothing is left and for hidden sites.
        Rows with the same coordinates share one cell and have the same volume each.
        """
        return sealed(np.append(self._bodies.volumes, 0.0)[self.point_region])

    @property
    @kept
    def cell_areas(self) -> Floats:
        """Areas of the surfaces of the cells within the clip, (n,), in the square of the unit.

        Infinite for an unbounded cell, 0 for one of which nothing is left and for hidden sites.
        """
        return sealed(np.append(self._bodies.areas, 0.0)[self.point_region])

    @property
    def cell_perimeters(self) -> Floats:
        """There is none in space: `cell_areas` has the surfaces."""
        raise InputError("cells in space have no perimeter; cell_areas are their surfaces")

    @property
    @kept
    def cell_centroids(self) -> Floats:
        """Centroids of the cells within the clip, (n, 3); NaN for unbounded and empty ones."""
        nowhere = [[np.nan] * 3]
        return sealed(np.concatenate((self._bodies.centroids, nowhere))[self.point_region])

    @property
    @kept
    def ridge_areas(self) -> Floats:
        """Areas of what is left of the ridges, (r,); infinite for open ones without a clip."""
        return sealed(self._bodies.ridge_areas)

    @property
    @kept
    def neighbors(self) -> SpaceNeighbors:  # type: ignore[override]
        """Sites whose cells have a face in common, with its area, as compressed rows.

        In a clip only what is left of a face counts. A duplicate has no neighbours of its own:
        those of its cell are with the first row.
        """
        areas = self._bodies.ridge_areas
        rows = np.flatnonzero(areas > 0) if self._bodies.clipped else np.arange(len(areas))
        pairs = self.ridge_points[rows].astype(np.int64)
        indptr, indices, beside = compressed(pairs, areas[rows], self.npoints)
        return SpaceNeighbors(sealed(indptr), sealed(indices), sealed(beside))

    def cell(self, i: int) -> SpaceCell:  # type: ignore[override]
        """Return the cell of a site.

        Parameters
        ----------
        i : int
            Row of the site.

        Returns
        -------
        SpaceCell
            What is left of it within the clip, neighbours and measures.

        Raises
        ------
        IndexError
            There is no such row.

        Examples
        --------
        >>> from delone import Voronoi
        >>> sites = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4)]
        >>> cell = Voronoi(sites, clip=((0, 0, 0), (2, 2, 2))).cell(0)
        >>> cell.volume, cell.bounded, len(cell.faces)
        (8.0, False, 6)
        """
        row = as_site(i)
        region, site = int(self.point_region[row]), int(self.duplicate_of[row])
        corners, ridges = np.empty((0, 3)), np.empty(0, dtype=np.int32)
        faces: tuple[Indices, ...] = ()
        bounded = True
        if region >= 0:
            corners, faces, ridges = self._bodies.shape(region)
            start = self._dual.region_starts[region]
            bounded = bool(self._dual.region_vertices[start] >= 0)
        pairs = self.ridge_points[np.maximum(ridges, 0)].reshape(-1, 2)
        beyond = np.where(ridges >= 0, np.where(pairs[:, 0] == site, *pairs[:, ::-1].T), -1)
        indptr, indices, areas = self.neighbors
        beside = slice(indptr[site], indptr[site + 1])
        return SpaceCell(
            site=site,
            bounded=bounded,
            vertices=corners,
            faces=faces,
            beyond=beyond.astype(np.int32),
            neighbors=indices[beside],
            areas=areas[beside],
            volume=float(self.cell_volumes[row]),
            area=float(self.cell_areas[row]),
            centroid=self.cell_centroids[row],
        )

    def _cells_with_an_end(self) -> Iterator[SpaceCell]:
        for site in np.setdiff1d(self.duplicate_of, self.hidden).tolist():
            cell = self.cell(site)
            if cell.faces:
                yield cell

    def to_pyvista(self) -> Any:
        """Return the cells as polyhedra of pyvista (extra ``pyvista``).

        Returns
        -------
        UnstructuredGrid
            A polyhedron for each cell that has an end, with the row of its site as cell data
            ``"site"`` and its ``"volume"``.

        Raises
        ------
        MissingExtraError
            pyvista is not installed.

        Examples
        --------
        >>> from delone import Voronoi
        >>> grid = [(x, y, z) for x in range(3) for y in range(3) for z in range(3)]
        >>> Voronoi(grid).to_pyvista().n_cells
        1
        """
        from delone.exchange.polyhedra import polyhedra_to_pyvista

        cells = list(self._cells_with_an_end())
        grid = polyhedra_to_pyvista(cells)
        rows = np.array([cell.site for cell in cells], dtype=np.int32)
        grid.cell_data["site"] = rows
        grid.cell_data["volume"] = self.cell_volumes[rows]
        return grid

    def plot(self, ax: Any = None, *, off_screen: bool | None = None, **options: Any) -> Any:
        """Draw the cells that have an end with pyvista (extra ``pyvista``).

        Parameters
        ----------
        ax : pyvista.Plotter, optional
            Where to draw; by default a new one.
        off_screen : bool, optional
            Whether a new plotter draws without a window. Not together with `ax`.
        **options
            As ``Plotter.add_mesh`` takes them.

        Returns
        -------
        pyvista.Plotter
            What was drawn on; its method ``show`` shows it.

        Raises
        ------
        InputError
            Both `ax` and `off_screen` are given.
        MissingExtraError
            pyvista is not installed.

        Examples
        --------
        >>> from delone import Voronoi
        >>> corners = [(x, y, z) for x in (0, 4) for y in (0, 4) for z in (0, 4)]
        >>> Voronoi(corners, clip="box").plot().show()  # doctest: +SKIP
        """
        from delone.plot import plot

        return plot(self, ax, off_screen=off_screen, **options)

    def polygons(self) -> NDArray[Any]:
        """Cells in space are no polygons: `cell` has their faces, `to_pyvista` the polyhedra."""
        raise InputError("cells in space are no polygons; see cell and to_pyvista")

    def to_geopandas(self, data: Any = None, *, crs: Any = None) -> Any:
        """Cells in space are no polygons: `cell` has their faces, `to_pyvista` the polyhedra."""
        return self.polygons()

    def __repr__(self) -> str:
        if not hasattr(self, "_clip"):  # the constructor failed, or has not run
            return "<Voronoi diagram of nothing yet>"
        where = "" if self.clip is None else f", clipped to {self.clip.name}"
        return (
            f"<Voronoi diagram of {counted(self.npoints, 'point')} in space: "
            f"{counted(len(self.vertices), 'vertex')}, "
            f"{counted(len(self.ridge_points), 'ridge')}{where}>"
        )
