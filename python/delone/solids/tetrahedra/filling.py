"""The function `tetrahedralize`: checks the surface, calls the core, and decides what is inside.

The core recovers the faces (its module comment describes the method and why it terminates).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import LARGEST_LIMIT, as_callback, as_choice, as_flag, as_workers
from delone._base.counting import counted, listed
from delone._tiling.space.locking import Sides, cells, directions
from delone.errors import (
    BudgetExceededError,
    CrowdedFacesError,
    DanglingFacesError,
    DeloneError,
    InputError,
    InternalError,
    ShapeError,
)
from delone.solids.surface import imprint_surface
from delone.solids.surface.check import checked
from delone.solids.tetmesh.refinement import as_bounds, refined
from delone.solids.tetmesh.tetmesh import TetMesh
from delone.solids.tetrahedra import arguments, seeds
from delone.solids.tetrahedra.covering import counts_of, of_imprint, parts_of, reported
from delone.solids.tetrahedra.curtains import Curtains, free_faces
from delone.solids.tetrahedra.inside import RULES, inner_cells
from delone.solids.tetrahedra.recutting import recut, uncut
from delone.solids.tetrahedra.seeds import Tiling

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone._core import RecoveredFaces, RecoveryCounts
    from delone.solids.surface import ImprintedSurface, SurfaceCheck
    from delone.solids.tetmesh.refinement import Bounds
    from delone.solids.tetrahedra.arguments import Task
    from delone.solids.tetrahedra.covering import Parts
    from delone.solids.tetrahedra.recutting import Recut

__all__ = ["tetrahedralize"]

_BOUNDARIES = ("faces", "surface")
# Pairs of faces that are listed at first; if no faces cross, all that touch are.
_LISTED = 100_000


def tetrahedralize(
    points: Any,
    faces: ArrayLike | None = None,
    *,
    boundary: str = "faces",
    imprint: bool = False,
    tolerance: float | None = None,
    inside: str | None = None,
    holes: ArrayLike | None = None,
    regions: ArrayLike | None = None,
    face_markers: ArrayLike | None = None,
    extra_points: ArrayLike | None = None,
    size: Any = None,
    max_volume: Any = None,
    radius_edge: float | None = None,
    min_angle: float | None = None,
    max_points: int | None = None,
    progress: Callable[[str, float], object] | None = None,
    workers: int | None = None,
) -> TetMesh:
    """Fill a closed surface with tetrahedra; by default, its triangles are kept exactly.

    No point of the input moves. Points are added strictly between the faces; with
    ``boundary="surface"`` and sizes or bounds on shapes, also on them.

    Parameters
    ----------
    points : array_like of float, shape (n, 3), or path or mesh
        Coordinates. Rows with equal coordinates are one vertex; rows that no face uses are not
        vertices. Without `faces`: a file that `delone.io.read_mesh` reads, such as STL, OBJ, PLY,
        OFF or TetGen's .smesh and .poly; or a surface as a trimesh, PyVista, meshio or delone
        object, such as a 3-D `ConvexHull`.
    faces : array_like of int, shape (m, 3)
        The vertices of each triangle, rows of `points`.
    boundary : {"faces", "surface"}, optional
        What is kept: all triangles, or only the surface. In the second case, exactly coplanar
        triangles are retriangulated with the same vertices, which takes fewer points and less time
        for models with flat sides; see Notes.
    imprint : bool, optional
        Whether faces that cross, overlap or touch are first cut where they meet, by
        `imprint_surface`: for assemblies, whose bodies are in contact or overlap. Cut faces can
        leave the surface by rounding; see `report`. By default, faces that cross are an error.
    tolerance : float, optional
        How far the mesh may be from the surface. With ``imprint=True``, vertices, edges and faces
        within this distance are joined, as by `imprint_surface`. With ``boundary="surface"`` and
        sizes or bounds on shapes, triangles within this distance of one plane are one planar part,
        as for ``TetMesh.refine``: coordinates of STL files are rounded, so that triangles of a
        plane side are in slightly different planes.
    inside : {"winding", "parity", "enclosed"}, optional
        What is filled: regions with a nonzero winding number; regions that an odd number of faces
        separates from the outside, whatever their orientation; or everything enclosed. By default
        ``"winding"``, and ``"enclosed"`` for TetGen's files, in which faces may have any
        orientation. For walls between regions and sheets inside them, see Notes.
    holes : array_like of float, shape (k, 3), optional
        Seeds: the region around each is left empty.
    regions : array_like, shape (k, 3) or (k, 4), optional
        Seeds of regions: the tetrahedra of the region around each seed get its label in `region`.
        The label is the fourth column (an integer of at least 0), or the row of the seed; it is -1
        for regions without a seed. Without seeds, regions are numbered from 0.
    face_markers : array_like of int, shape (m,), optional
        A number for each face, inherited by the `face_markers` of the mesh. By default, the markers
        in a file (see `delone.io.MeshFile`), or the cell data named ``marker`` or ``gmsh:physical``
        of a PyVista or meshio object.
    extra_points : array_like of float, shape (k, 3), optional
        Further vertices strictly inside regions; in the mesh their rows follow `points`.
    size, max_volume : float, mapping, callable or tuple, optional
        Target edge length, and largest volume of a tetrahedron, as for ``TetMesh.refine``: by
        number, by region, by position, or by another mesh. With ``boundary="surface"``, faces are
        divided where sizes and bounds on shapes require it.
    radius_edge, min_angle : float, optional
        Bounds on shapes, as for ``TetMesh.refine``. If one of these four arguments is given, the
        mesh is refined, with 2.0 and 20 degrees by default; otherwise points are added only where
        faces need them. With ``boundary="surface"`` and a ratio, thin parts get tetrahedra about as
        large as they are thick; ``radius_edge=np.inf`` leaves shapes alone.
    max_points : int, optional
        Maximum number of points that may exist at any time besides those of the input; by default a
        million, or ten per face if that is more. For sizes and shapes, the maximum number of
        points that are added for them; by default 2,000,000. Sizes that need far more are an error
        before the work; for shapes, the work ends at the limit, and the report says so.
    progress : callable, optional
        Called before each stage with its name and the fraction of stages done, and again from time
        to time while points are added for sizes and shapes.
    workers : int, optional
        Number of threads; by default one per core. The result does not depend on it.

    Returns
    -------
    TetMesh
        The mesh, immutable. Its `report` says what was added, and which input faces are unions of
        faces of the mesh, or not in it.

    Raises
    ------
    CrossingFacesError
        Faces cross; the error contains the pairs and their kinds. See `imprint`.
    OpenSurfaceError
        The surface encloses nothing; the error contains its boundary edges.
    DegenerateInputError
        All faces are in one plane.
    CrowdedFacesError
        Between some faces there is no double where a point is needed; the error contains these
        faces.
    DanglingFacesError
        Beside faces that end inside a region, no double is left for a point that they need; the
        error contains these faces.
    BudgetExceededError
        More than `max_points` points are needed for the faces or, by an estimate, for the sizes.
    InputError
        Nothing is inside by the rule `inside`, or the rule contradicts itself; seeds or extra
        points are outside or on a face; faces that `tolerance` moves would cross others; or an
        argument is invalid.
    NonFiniteError, ShapeError, DtypeError, FileFormatError, MissingExtraError
        The input is not such arrays, or not such a file or object.
    KeyboardInterrupt
        Ctrl-C was pressed.

    See Also
    --------
    check_surface : Check the surface alone.
    imprint_surface : Cut faces where they cross, overlap or touch.
    TetMesh.refine : Add points for sizes and shapes later.
    improve : Remove slivers from the mesh.

    Notes
    -----
    Faces may touch. Where corners lie on other faces (T-junctions), and where faces repeat others
    or overlap in one plane, they are subdivided at existing vertices, as by `resolve_touches`, and
    the report lists them. Edges may have any number of faces: sheets inside, several shells, and
    walls between regions all become faces of the mesh.

    With ``imprint=True``, the mesh is that of the surface returned by `imprint_surface`: its points
    follow those of the input in `points`, `face_source` names its faces, and
    ``report.imprinted[mesh.face_source]`` is the input face of each. Volumes enclosed by two bodies
    are separate regions.

    Faces may end inside a region, such as cracks. If the edges of no other face need points, each
    face with such an edge gets an added point close to it.

    With ``boundary="surface"``, the edge between two triangles is flipped if the triangles are
    exactly coplanar and have the same orientation and marker, until each flat part has its
    constrained Delaunay triangulation. Edges of other faces and all vertices are kept, and no point
    is placed on the surface, so the surface is exactly the same set. In `face_source`, the faces of
    such a part have the first input face that it contains; `recut` and `recut_source` of the report
    contain the triangles that they replace, and `validate` proves that both cover the same area.

    Winding numbers and parities are counted from the outside: a region gets its number from
    adjacent regions that are separated from the outside by fewer faces. Walls between regions that
    are separated from it by the same number of faces need not be consistent: they may be given
    once, in any orientation.

    The Delaunay triangulation of the vertices lacks some of the edges and faces. Flips recover most
    of them; for the others, points are temporarily placed on them and then moved off them. All
    decisions are exact, and the order of points and faces does not matter. The mesh is not Delaunay
    in general. For a valid surface, there are only two causes of failure: the limit on points, and
    places so narrow that no double lies in them.

    In practice, the time is O(n log n). The number of points on faces can be quadratic, since some
    polyhedra need as many [1]_.

    References
    ----------
    .. [1] B. Chazelle, "Convex partitions of polyhedra: a lower bound and worst-case optimal
       algorithm", SIAM Journal on Computing 13 (1984), 488-507.

    Examples
    --------
    A cube:

    >>> import delone
    >>> points = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> cube = delone.ConvexHull(points)
    >>> mesh = delone.tetrahedralize(cube.points, cube.simplices)
    >>> mesh.nsimplex, mesh.nadded, len(mesh.input_faces), bool(mesh.validate())
    (6, 0, 12, True)

    For a simulation, with edges of about 0.2:

    >>> mesh = delone.tetrahedralize(cube.points, cube.simplices, boundary="surface", size=0.2)
    >>> 1500 < mesh.nsimplex < 2500, bool(mesh.report)
    (True, True)
    """
    as_choice(boundary, _BOUNDARIES, name="boundary")
    if inside is not None:
        as_choice(inside, RULES, name="inside")
    as_callback(progress, name="progress")
    bounds = None
    if not all(bound is None for bound in (size, max_volume, radius_edge, min_angle)):
        bounds = as_bounds(
            ratio=1.0,
            radius_edge=2.0 if radius_edge is None else radius_edge,
            size=size,
            max_volume=max_volume,
            min_angle=min_angle,
            boundary=boundary,
            tolerance=0.0 if tolerance is None or boundary == "faces" else tolerance,
            max_points=max_points,
            progress=None,
        )
    surface = arguments.given(points, faces, face_markers, holes, regions)
    task = arguments.task(surface, extra_points, max_points, workers)
    cut = None
    if as_flag(imprint, name="imprint"):
        cut = imprint_surface(task.points, task.faces, tolerance=tolerance, workers=workers)
        task = task.imprinted(cut)
    elif tolerance is not None and (bounds is None or boundary == "faces"):
        raise InputError(
            'tolerance is for imprint=True, or for boundary="surface" with sizes or bounds on '
            "shapes: otherwise nothing is rounded or joined"
        )
    stages = _Stages(task, cut, boundary, inside or surface.rule, progress, bounds)
    return stages.filled()


class _Everything(NamedTuple):
    """All tetrahedra that faces enclose."""

    tiling: Tiling
    # (m, 4): the row of the face opposite each corner, or -1.
    walls: Indices
    # (m,): the cell between faces that each tetrahedron is in.
    cell: Indices
    nadded: int
    counts: RecoveryCounts


class _Solid(NamedTuple):
    """The faces of these tetrahedra, and their cells."""

    sides: Sides
    cell: Indices

    @classmethod
    def of(cls, found: _Everything) -> _Solid:
        tiling, walls = found.tiling, found.walls
        turned = directions(tiling.simplices, tiling.faces, walls)
        return cls(Sides(walls, turned), found.cell)


class _Stages(NamedTuple):
    """The stages of one call."""

    task: Task
    # The surface cut at itself, if it is.
    cut: ImprintedSurface | None
    boundary: str
    rule: str
    progress: Callable[[str, float], object] | None
    # What the mesh is refined for, if it is.
    bounds: Bounds | None

    def _tell(self, stage: str, done: float) -> None:
        if self.progress is not None:
            self.progress(stage, done)

    def filled(self) -> TetMesh:
        """Return the mesh."""
        points, workers = self.task.points, self.task.workers
        self._tell("check", 0.0)
        check = _checked(points, self.task.faces, workers)
        self._tell("recover", 0.25)
        cut = uncut(parts_of(points, self.task.faces, check, workers))
        if self.boundary == "surface":
            cut = recut(points, cut.parts, self.task.markers)
        parts = cut.parts
        found = self._with_extra(parts)
        self._tell("select", 0.75)
        solid = _Solid.of(found)
        kept = self._inside(found.tiling, solid, parts)
        self._require_kept(found.tiling, kept)
        made = self._mesh(found, solid, kept, cut, check)
        if self.bounds is not None:
            self._tell("refine", 0.8)
            tell = None if self.progress is None else lambda _: self._tell("refine", 0.8)
            made = refined(made, None, self.bounds._replace(progress=tell))
        self._tell("done", 1.0)
        return made

    def _with_extra(self, parts: Parts) -> _Everything:
        """Return all tetrahedra, with the extra points, which must be enclosed and not on a face.

        The core proves that each face is whole, so no point is on one, and returns no tetrahedra
        outside. Only to say what is wrong, the faces are recovered without the points.
        """
        extra = self.task.extra
        if not len(extra):
            return self._recovered(parts, extra)
        failure = None
        corners = self.task.points[parts.faces.ravel()]
        # Points far away would make the core slow.
        if ((extra > corners.min(axis=0)) & (extra < corners.max(axis=0))).all():
            try:
                found = self._recovered(parts, extra)
                if not len(self._unused(found.tiling.simplices)):
                    return found
            except DeloneError as error:
                failure = error
        alone = self._recovered(parts, np.empty((0, 3)))
        _require_inside(alone.tiling, extra, self.task.workers)
        raise failure or InternalError("an extra point inside is not a vertex")

    def _unused(self, simplices: Indices) -> NDArray[np.int64]:
        """Return the extra points that are not vertices of these."""
        used = np.zeros(len(self.task.extra), dtype=bool)
        rows = simplices[simplices >= len(self.task.points)] - len(self.task.points)
        used[rows[rows < len(used)]] = True
        return np.flatnonzero(~used)

    def _recovered(self, parts: Parts, extra: Floats) -> _Everything:
        """Return all tetrahedra that the faces enclose, in rows of the result."""
        points, count = self.task.points, len(parts.faces)
        used = np.unique(parts.faces)
        faces = np.searchsorted(used, parts.faces).astype(np.int32)
        places = np.concatenate((points[used], extra))
        curtains = None
        try:
            made = self._by_core(places, faces)
        except ShapeError as error:
            curtains = self._curtains(places, parts, faces, error)
            places = np.concatenate((places, curtains.apexes))
            everything = np.concatenate((faces, curtains.faces))
            made = self._by_core(places, everything, len(curtains.apexes))
        if len(made.crowded):
            crowded = made.crowded if curtains is None else curtains.given(made.crowded, count)
            raise _crowded(parts.source[crowded], self._advice())
        further = made.points[len(used) :]
        rows = np.concatenate((used, len(points) + np.arange(len(further)))).astype(np.int32)
        everywhere = np.concatenate((points, further))
        simplices, neighbors, walls = made.tetrahedra, made.neighbors, made.walls
        cell, nadded = made.cells, made.nadded
        if curtains is not None:
            simplices, neighbors, walls = curtains.removed(made, count)
            cell = cells(neighbors, walls >= 0)
            nadded += len(curtains.apexes)
        tiling = Tiling(everywhere, rows[simplices], neighbors, parts.faces)
        return _Everything(tiling, walls, cell, nadded, made.counts)

    def _by_core(self, points: Floats, faces: Indices, apexes: int = 0) -> RecoveredFaces:
        """Recover the faces; the limit includes apexes, the last points."""
        limit = self.task.limit - apexes
        try:
            return _core.recover_faces(points, faces, limit, True, as_workers(self.task.workers))
        except BudgetExceededError as error:
            if apexes:
                raise self._beyond(error.found + apexes, apexes) from error
            error.args = (f"{error}{self._advice()}", *error.args[1:])
            raise

    def _beyond(self, found: int, apexes: int) -> BudgetExceededError:
        """Return the error that apexes and other added points are too many."""
        limit = self.task.limit
        # No option changes the number of apexes.
        advice = self._advice() if found > apexes else ""
        return BudgetExceededError(
            f"at least {counted(found, 'point')} would be added, {apexes:,} of them at faces that "
            f"end inside, more than max_points={limit:,}{advice}",
            limit=limit,
            found=found,
        )

    def _curtains(
        self, places: Floats, parts: Parts, faces: Indices, error: ShapeError
    ) -> Curtains:
        """Return temporary faces at free edges, since points cannot be moved off these."""
        free = free_faces(faces)
        if not len(free):
            raise error
        if len(free) > self.task.limit:
            raise self._beyond(len(free), len(free))
        curtains = Curtains.on(places, faces, free, self.task.workers)
        if curtains is None:
            raise _dangling(np.unique(parts.source[free])) from error
        return curtains

    def _advice(self) -> str:
        """Suggest the option that adds fewer points, unless it was chosen."""
        if self.boundary == "surface":
            return ""
        return (
            '; boundary="surface" cuts triangles in one plane again, which needs fewer points, '
            "often none"
        )

    def _inside(self, tiling: Tiling, solid: _Solid, parts: Parts) -> Bools:
        """Return which tetrahedra remain."""
        inner = inner_cells(self.rule, solid.cell, tiling.neighbors, solid.sides, parts)
        hole = seeds.located(tiling, self.task.holes, "holes", self.task.workers)
        inner[solid.cell[hole]] = False
        if not inner.any():
            raise InputError(
                "nothing is left inside: every region is a hole, or not inside by the rule "
                f"inside={self.rule!r:.80}"
            )
        kept: Bools = inner[solid.cell]
        return kept

    def _require_kept(self, tiling: Tiling, kept: Bools) -> None:
        """Require that no extra point is in a region that is left empty."""
        lost = self._unused(tiling.simplices[kept])
        if len(lost):
            raise InputError(
                f"extra_points: {counted(len(lost), 'point')} in a region that is left empty, "
                f"row {listed(lost, 10)}: leave them out, or fill that region"
            )

    def _mesh(
        self, found: _Everything, solid: _Solid, kept: Bools, cut: Recut, check: SurfaceCheck
    ) -> TetMesh:
        """Return the tetrahedra that remain, with their regions and faces."""
        tiling, parts = found.tiling, cut.parts
        number = np.cumsum(kept, dtype=np.int32) - np.int32(1)
        number[~kept] = -1
        across, face = tiling.neighbors[kept], solid.sides.face[kept]
        there = np.zeros(len(parts.faces), dtype=bool)
        there[face[face >= 0]] = True
        points, simplices, nadded = _without_unused(
            tiling.points, tiling.simplices[kept], found.nadded
        )
        source = parts.source[there]
        arrays: dict[str, NDArray[Any]] = {
            "points": points,
            "simplices": simplices,
            "neighbors": np.where(across < 0, np.int32(-1), number[across]),
            "region": self._regions(tiling, solid, kept),
            "input_faces": parts.faces[there],
            "face_source": source,
            "face_markers": self.task.markers[source],
            "holes": seeds.of_voids(
                tiling,
                seeds.Cells(solid.cell, solid.sides.face),
                kept,
                there,
                self.task.workers,
            ),
        }
        entries = counts_of(found.counts, nadded) | cut.reported(there) | of_imprint(self.cut)
        report = reported(entries, self.task.faces, cut.before, there, check)
        return TetMesh._of(arrays, report, nadded, self.task.workers)

    def _regions(self, tiling: Tiling, solid: _Solid, kept: Bools) -> Indices:
        """Return the region of each tetrahedron that remains."""
        if not len(self.task.regions):
            return np.unique(solid.cell[kept], return_inverse=True)[1].astype(np.int32)
        found = seeds.located(tiling, self.task.regions, "regions", self.task.workers)
        lost = np.flatnonzero(~kept[found])
        if len(lost):
            raise InputError(
                f"regions: {counted(len(lost), 'seed')} in a region that is left empty: "
                f"{listed(lost, 10)}"
            )
        label = np.full(int(solid.cell.max()) + 1, -1, dtype=np.int32)
        for row, (cell, own) in enumerate(
            zip(solid.cell[found].tolist(), self.task.labels.tolist(), strict=True)
        ):
            if label[cell] not in (-1, own):
                raise InputError(
                    f"regions: the seed in row {row} has the label {own}, but another one in its "
                    f"region has {label[cell]}"
                )
            label[cell] = own
        return label[solid.cell[kept]]


def _checked(points: Floats, faces: Indices, workers: int | None) -> SurfaceCheck:
    """Return the check of a surface that can be filled, with all pairs that touch."""
    check = checked(points, faces, _LISTED, workers)
    check.raise_if_bad()
    if len(check.pairs) < check.npairs:
        check = checked(points, faces, LARGEST_LIMIT, workers)
    return check


def _require_inside(tiling: Tiling, extra: Floats, workers: int | None) -> None:
    """Require that extra points are different, enclosed, and not on a face."""
    seeds.located(tiling, extra, "extra_points", workers, kind="point")
    _, first = np.unique(extra, axis=0, return_index=True)
    if len(first) < len(extra):
        again = np.setdiff1d(np.arange(len(extra)), first)
        raise InputError(f"extra_points: rows repeat others: {listed(again, 10)}")


def _without_unused(points: Floats, simplices: Indices, nadded: int) -> tuple[Floats, Indices, int]:
    """Leave out added points, the last rows, that no tetrahedron has."""
    given = len(points) - nadded
    used = np.zeros(len(points), dtype=bool)
    used[simplices] = True
    used[:given] = True
    if used.all():
        return points, simplices, nadded
    number = np.cumsum(used, dtype=np.int32) - np.int32(1)
    return points[used], number[simplices], int(used.sum()) - given


def _crowded(faces: Indices, advice: str) -> CrowdedFacesError:
    rows = np.unique(faces)
    return CrowdedFacesError(
        f"between {counted(len(rows), 'face')} no double is left for a point that is needed there: "
        f"{listed(rows, 10)}; `error.faces` lists them: move them apart, or subdivide them"
        + advice,
        faces=rows,
    )


def _dangling(rows: Indices) -> DanglingFacesError:
    """Return the error that names these faces."""
    return DanglingFacesError(
        f"beside {counted(len(rows), 'face')} with an edge of no other face, no double is left for "
        f"a point that is needed there: {listed(rows, 10)}; extend them to other faces, or remove "
        "points and faces near them",
        faces=rows,
    )
