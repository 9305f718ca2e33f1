"""The compiled core. All arrays are C-contiguous; inputs must have the dtypes given here.

Written by crates/bindings/stub.py from the source of the bindings; changes here are lost.
"""

from collections.abc import Callable, Sequence
from typing import Final, Protocol, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "CellGrid",
    "CellMeasures2",
    "CellMeasures3",
    "CellPieces2",
    "CheckedCells",
    "CheckedSurface",
    "ClippedCells2",
    "ClippedCells3",
    "ConstrainedTriangulation",
    "ContourBands",
    "ContourLines",
    "CornerWeights",
    "CutSurface",
    "DeepestPoints",
    "Diagram2",
    "Diagram3",
    "Distances3",
    "FacePairs",
    "Faults",
    "FlippedTriangulation",
    "Halfspaces",
    "Hull3",
    "HullN",
    "ImprovedMesh",
    "ImprovementCounts",
    "JudgedTriangles",
    "LazyN",
    "Live",
    "LiveArrays",
    "LiveSegments",
    "LiveState",
    "Location2",
    "Location3",
    "Locator2",
    "Locator3",
    "LocatorN",
    "NaturalWeights",
    "PeriodicFaults",
    "PeriodicTriangulation",
    "PlaneCells",
    "RecoveredFaces",
    "RecoveryCounts",
    "RefinedMesh",
    "RefinedTetrahedra",
    "Refinement2",
    "Refinement3",
    "RegularTriangulation",
    "SharedCells",
    "Simplified2",
    "SmoothedMesh",
    "SphereDual",
    "SphereLocator",
    "SphereTriangulation",
    "SphereWeights",
    "Triangulation",
    "WeightRows",
    "__version__",
    "alpha_counts",
    "alpha_edges",
    "alpha_faces",
    "alpha_flat",
    "alpha_labels",
    "alpha_rings2",
    "alpha_solid3",
    "alpha_torus2",
    "alpha_vertices",
    "antipodes",
    "areas2",
    "around",
    "below2",
    "check_surface3",
    "circumcenters",
    "closed_polygons",
    "coarsen3",
    "combine2",
    "components2",
    "components_beside2",
    "components_inside2",
    "condensed",
    "constrained2",
    "contour_bands2",
    "contour_lines2",
    "deepest2",
    "density",
    "dihedral_angles3",
    "disks2",
    "edges",
    "erode",
    "face_areas3",
    "face_normals3",
    "faces3",
    "facet_neighbors",
    "facet_rows",
    "fault",
    "find_simplex2",
    "gradients_global2",
    "gradients_local2",
    "gradients_local3",
    "graph_components",
    "halfspaces",
    "hull2",
    "hull3",
    "hull_in_flat",
    "hull_n",
    "imprint_surface3",
    "improve3",
    "incircle",
    "influence",
    "insphere",
    "judge2",
    "knn",
    "lawson2",
    "linkage",
    "measures2",
    "measures3",
    "methods2",
    "neighbors2",
    "not_longer",
    "numbered_components",
    "odd_pairs2",
    "of_triangles2",
    "orient2d",
    "orient3d",
    "orientations_n",
    "periodic2",
    "periodic_centers2",
    "pieces2",
    "polygon2",
    "proximity",
    "qualities",
    "recover_faces",
    "refine2",
    "regular",
    "resolve_touches3",
    "ring2",
    "simplify2",
    "sizes",
    "smallest_angle2",
    "smooth2",
    "smooth3",
    "spanning",
    "spanning_triangles2",
    "sphere_areas",
    "sphere_circumcenters",
    "sphere_constrained",
    "sphere_delaunay",
    "sphere_directions",
    "sphere_dual",
    "sphere_spans",
    "sphere_units",
    "touched2",
    "transforms",
    "triangulate2",
    "triangulate3",
    "triangulate_in_flat",
    "triangulate_n",
    "validate",
    "validate_in_flat",
    "validate_periodic2",
    "validate_regular",
    "volumes2",
    "voronoi2",
    "voronoi3",
    "voronoi_clip2",
    "voronoi_clip3",
    "within2",
]

__version__: Final[str]

class _Sheet(Protocol):
    """A triangulation and, if there are any, the heights of its points."""

    @property
    def points(self) -> NDArray[np.float64]: ...
    @property
    def simplices(self) -> NDArray[np.int32]: ...
    @property
    def neighbors(self) -> NDArray[np.int32]: ...
    @property
    def heights(self) -> NDArray[np.float64]: ...

@final
class CellGrid:
    """The cells of a grid on the sphere."""

    @staticmethod
    def polygons(
        vectors: NDArray[np.float64],
        rings: NDArray[np.int64],
        cells: NDArray[np.int64],
        holes: NDArray[np.bool_],
    ) -> CellGrid:
        """Cells with arcs of great circles as sides: corners, where their rings start, where
        the rings of cells start, and whether rings are holes.
        """
    @staticmethod
    def rows(
        tangents: NDArray[np.float64],
        starts: NDArray[np.int64],
        meridians: NDArray[np.float64],
        numbers: NDArray[np.int32],
        count: int,
    ) -> CellGrid:
        """Cells between meridians and parallels, by rows: tangents of latitudes, where the
        meridians of rows start, their directions, the number of the cell east of each or
        -1, and the number of cells.
        """
    def check(self, crossing: bool, workers: int) -> CheckedCells:
        """Areas and faults; sides that cross are only searched for if `crossing`."""
    def overlaps(self, other: CellGrid, workers: int) -> SharedCells:
        """What the cells share with those of another grid; cells with faults share nothing."""

@final
class CellMeasures2:
    """Measures of polygons."""

    @property
    def areas(self) -> NDArray[np.float64]:
        """Areas, (c,)."""
    @property
    def centroids(self) -> NDArray[np.float64]:
        """Centroids, (c, 2)."""
    @property
    def perimeters(self) -> NDArray[np.float64]:
        """Perimeters, (c,)."""

@final
class CellMeasures3:
    """Measures of cells, and of ridges."""

    @property
    def ridge_areas(self) -> NDArray[np.float64]:
        """The area of each ridge, (r,)."""
    @property
    def volumes(self) -> NDArray[np.float64]:
        """Volumes, (c,)."""
    @property
    def areas(self) -> NDArray[np.float64]:
        """Areas of surfaces, (c,)."""
    @property
    def centroids(self) -> NDArray[np.float64]:
        """Centroids, (c, 3)."""

@final
class CellPieces2:
    """Polygons clipped to an outline."""

    @property
    def left(self) -> NDArray[np.int8]:
        """For each polygon what is left: -1 (unknown), 0 (nothing), 1 (all) or 2 (parts), (k,)."""
    @property
    def cells(self) -> NDArray[np.int64]:
        """Start of the parts of each polygon, and the end, (k + 1,)."""
    @property
    def parts(self) -> NDArray[np.int64]:
        """Start of the rings of each part, and the end."""
    @property
    def rings(self) -> NDArray[np.int64]:
        """Start of the corners of each ring, and the end."""
    @property
    def points(self) -> NDArray[np.float64]:
        """The corners, (p, 2)."""
    @property
    def ridges(self) -> NDArray[np.int32]:
        """The ridge along the edge that starts at each corner, negative for none, (p,)."""
    @property
    def measures(self) -> CellMeasures2:
        """Measures of each clipped polygon."""

@final
class CheckedCells:
    """What is known about each cell of a grid."""

    @property
    def areas(self) -> NDArray[np.float64]:
        """Areas, on the sphere in steradians, 0 of cells that have none, (n,)."""
    @property
    def faults(self) -> NDArray[np.uint8]:
        """0, 1 for empty cells, 2 for opposite ends of a side, 3 for cells beyond a
        hemisphere, 4 for sides that cross, (n,).
        """
    @property
    def turned(self) -> NDArray[np.bool_]:
        """Whether outer rings were clockwise, (n,)."""
    @property
    def concave(self) -> NDArray[np.bool_]:
        """Whether cells are concave, or have several rings, (n,)."""
    @property
    def repeated(self) -> int:
        """How many corners repeat the one before."""

@final
class CheckedSurface:
    """What a surface is."""

    @property
    def duplicate_points(self) -> NDArray[np.int32]:
        """Rows of points with the first rows of the same coordinates, (k, 2)."""
    @property
    def repeats(self) -> NDArray[np.int32]:
        """Faces that use a vertex twice, (k,)."""
    @property
    def collinear(self) -> NDArray[np.int32]:
        """Other faces without area, (k,)."""
    @property
    def duplicate_faces(self) -> NDArray[np.int32]:
        """Rows of faces with the first rows of the same vertices, (k, 2)."""
    @property
    def pairs(self) -> FacePairs:
        """Pairs that cross or touch."""
    @property
    def nedges(self) -> int:
        """The number of edges."""
    @property
    def boundary(self) -> NDArray[np.int32]:
        """Edges of one face, (k, 2)."""
    @property
    def many(self) -> NDArray[np.int32]:
        """Edges of three faces or more, (k, 2)."""
    @property
    def unbalanced(self) -> NDArray[np.int32]:
        """Edges that are not passed equally often in both directions, (k, 2)."""
    @property
    def not_fans(self) -> NDArray[np.int32]:
        """Vertices whose faces do not form one fan, (k,)."""
    @property
    def component(self) -> NDArray[np.int32]:
        """The component of each face, -1 of degenerate ones, (m,)."""
    @property
    def ncomponents(self) -> int:
        """The number of components."""
    @property
    def nregions(self) -> int | None:
        """The number of regions that are separated from the outside; None if faces cross."""
    @property
    def dangling(self) -> NDArray[np.int32]:
        """Faces with the same region on both sides, (k,)."""
    @property
    def volume(self) -> float:
        """The signed volume."""
    @property
    def sign(self) -> int:
        """The exact sign of the volume."""

@final
class ClippedCells2:
    """Cells clipped to a box: convex polygons."""

    @property
    def starts(self) -> NDArray[np.int32]:
        """Start of the corners of each cell, and the end, (c + 1,)."""
    @property
    def corners(self) -> NDArray[np.float64]:
        """The corners, counter-clockwise, (p, 2)."""
    @property
    def ridges(self) -> NDArray[np.int32]:
        """The ridge along the edge that starts at each corner, -1 for the box, (p,)."""

@final
class ClippedCells3:
    """Cells clipped to a convex polyhedron."""

    @property
    def measures(self) -> CellMeasures3:
        """Measures of each clipped cell and ridge."""
    @property
    def cut(self) -> NDArray[np.int32]:
        """The cells that were clipped, (b,)."""
    @property
    def point_starts(self) -> NDArray[np.int32]:
        """Start of the corners of each of these, and the end, (b + 1,)."""
    @property
    def points(self) -> NDArray[np.float64]:
        """The corners, (p, 3)."""
    @property
    def face_starts(self) -> NDArray[np.int32]:
        """Start of the faces of each of these, and the end, (b + 1,)."""
    @property
    def corner_starts(self) -> NDArray[np.int32]:
        """Start of the corners of each face, and the end, (f + 1,)."""
    @property
    def corners(self) -> NDArray[np.int32]:
        """The corners of faces, as rows of `points`, counter-clockwise from outside."""
    @property
    def labels(self) -> NDArray[np.int32]:
        """The ridge of each face, negative for a face of the polyhedron, (f,)."""

@final
class ConstrainedTriangulation:
    """A constrained Delaunay triangulation of the whole hull."""

    @property
    def added(self) -> NDArray[np.float64]:
        """Added vertices, (a, 2)."""
    @property
    def simplices(self) -> NDArray[np.int32]:
        """Vertices of the triangles; added vertices follow the input, (m, 3)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The triangle opposite each vertex, -1 outside, (m, 3)."""
    @property
    def constrained(self) -> NDArray[np.bool_]:
        """Whether the edge opposite each vertex is a subsegment, (m, 3)."""
    @property
    def duplicates(self) -> NDArray[np.int32]:
        """Rows that repeat earlier rows, and the first of these, (k, 2)."""
    @property
    def segments(self) -> NDArray[np.int32]:
        """The subsegments, (q, 2)."""
    @property
    def source_start(self) -> NDArray[np.int64]:
        """Start of the rows that cover each subsegment in `source`, and the end, (q + 1,)."""
    @property
    def source(self) -> NDArray[np.int32]:
        """The rows of segments that cover subsegments, (c,)."""
    @property
    def forward(self) -> NDArray[np.bool_]:
        """Whether each of these has the direction of the subsegment, (c,)."""
    @property
    def zero(self) -> NDArray[np.int32]:
        """Rows of segments of zero length, (k,)."""
    @property
    def through(self) -> NDArray[np.int32]:
        """Rows of segments, and input vertices inside them, (k, 2)."""
    @property
    def crossings(self) -> NDArray[np.int32]:
        """Pairs of rows of segments that cross, and the vertex at the crossing, (k, 3)."""
    def __new__(
        cls,
        added: NDArray[np.float64],
        simplices: NDArray[np.int32],
        neighbors: NDArray[np.int32],
        constrained: NDArray[np.bool_],
        duplicates: NDArray[np.int32],
        segments: NDArray[np.int32],
        source_start: NDArray[np.int64],
        source: NDArray[np.int32],
        forward: NDArray[np.bool_],
        zero: NDArray[np.int32],
        through: NDArray[np.int32],
        crossings: NDArray[np.int32],
    ) -> ConstrainedTriangulation: ...
    def arrays(self) -> tuple[NDArray[np.generic], ...]:
        """All arrays, in the order of the arguments of the constructor."""
    def __getnewargs__(self) -> tuple[NDArray[np.generic], ...]:
        """The arguments for unpickling."""

@final
class ContourBands:
    """Bands between levels as polygons: runs of rings, which are runs of coordinates."""

    @property
    def points(self) -> NDArray[np.float64]:
        """Coordinates of all rings, (p, 2). Each ring ends with its first point."""
    @property
    def rings(self) -> NDArray[np.int64]:
        """The start of each ring in the points, and the end of the last, (r + 1,)."""
    @property
    def polygons(self) -> NDArray[np.int64]:
        """The start of each polygon in the rings, and the end of the last, (k + 1,)."""
    @property
    def bands(self) -> NDArray[np.int32]:
        """The band of each polygon, ascending, (k,)."""
    @property
    def tangled(self) -> NDArray[np.int32]:
        """Triangles in which bands would overlap; if there are any, there are no bands, (t,)."""

@final
class ContourLines:
    """Contour lines as runs of coordinates."""

    @property
    def points(self) -> NDArray[np.float64]:
        """Coordinates of all lines, (p, 2). A ring ends with its first point."""
    @property
    def starts(self) -> NDArray[np.int64]:
        """The start of each line, and the end of the last, (k + 1,)."""
    @property
    def levels(self) -> NDArray[np.int32]:
        """The number of the level of each line, ascending, (k,)."""
    @property
    def tangled(self) -> NDArray[np.int32]:
        """Triangles in which lines would cross; if there are any, there are no lines, (t,)."""

@final
class CornerWeights:
    """Weights of Clough-Tocher interpolation."""

    @property
    def simplex(self) -> NDArray[np.int32]:
        """The triangle that contains each query, -1 outside, (q,)."""
    @property
    def weights(self) -> NDArray[np.float64]:
        """Weights of values at its corners, (q, 3)."""
    @property
    def slopes(self) -> NDArray[np.float64]:
        """Weights of gradients at its corners, (q, 3, 2)."""

@final
class CutSurface:
    """A surface cut at itself."""

    @property
    def added(self) -> NDArray[np.float64]:
        """Vertices after those of the input, (k, 3)."""
    @property
    def faces(self) -> NDArray[np.int32]:
        """Triangles, (f, 3)."""
    @property
    def source(self) -> NDArray[np.int32]:
        """The face of the input that each is a part of, (f,)."""
    @property
    def merged(self) -> NDArray[np.int32]:
        """Rows of points with the rows that replace them, (k, 2)."""
    @property
    def distance(self) -> float:
        """The largest distance of a vertex from its source."""
    @property
    def tolerance(self) -> float:
        """The tolerance used."""
    @property
    def rounds(self) -> int:
        """The number of rounds."""
    @property
    def crossing(self) -> NDArray[np.int32]:
        """Rows of faces of which parts still cross, (k, 2)."""

@final
class DeepestPoints:
    """Points in conflict with triangles, those deepest in circles first."""

    @property
    def starts(self) -> NDArray[np.int64]:
        """Start of the points of each triangle, and the end, (m + 1,)."""
    @property
    def rows(self) -> NDArray[np.int32]:
        """Rows of points, (k,)."""
    @property
    def complete(self) -> NDArray[np.bool_]:
        """Whether these are all points in conflict with the triangle, (m,)."""

@final
class Diagram2:
    """A 2-D Voronoi or power diagram."""

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Vertices of cells, (k, 2)."""
    @property
    def simplex_vertex(self) -> NDArray[np.int32]:
        """The vertex of each triangle, -1 beyond the range of doubles, (m,)."""
    @property
    def sites(self) -> NDArray[np.int32]:
        """The two sites of each ridge, (r, 2)."""
    @property
    def ends(self) -> NDArray[np.int32]:
        """The two ends of each ridge: a vertex, or ~i for ray i, (r, 2)."""
    @property
    def rays(self) -> NDArray[np.float64]:
        """Directions of the rays, (q, 2)."""
    @property
    def beyond(self) -> NDArray[np.float64]:
        """The vertex beyond the range of doubles at the end of each ray, NaN if none, (q, 2)."""
    @property
    def region(self) -> NDArray[np.int32]:
        """The cell of each point, -1 for none, (n,)."""
    @property
    def site(self) -> NDArray[np.int32]:
        """The point of each cell, (c,)."""
    @property
    def region_starts(self) -> NDArray[np.int32]:
        """Start of the entries of each cell, and the end, (c + 1,)."""
    @property
    def region_vertices(self) -> NDArray[np.int32]:
        """Entries: vertices, counter-clockwise, -1 for an end at infinity, (e,)."""
    @property
    def region_ridges(self) -> NDArray[np.int32]:
        """Entries: the ridge that starts at each vertex, (e,)."""
    def __new__(
        cls,
        vertices: NDArray[np.float64],
        simplex_vertex: NDArray[np.int32],
        sites: NDArray[np.int32],
        ends: NDArray[np.int32],
        rays: NDArray[np.float64],
        beyond: NDArray[np.float64],
        region: NDArray[np.int32],
        site: NDArray[np.int32],
        region_starts: NDArray[np.int32],
        region_vertices: NDArray[np.int32],
        region_ridges: NDArray[np.int32],
    ) -> Diagram2: ...
    def arrays(self) -> tuple[NDArray[np.generic], ...]:
        """All arrays, in the order of the arguments of the constructor."""
    def __getnewargs__(self) -> tuple[NDArray[np.generic], ...]:
        """The arguments for unpickling."""

@final
class Diagram3:
    """A 3-D Voronoi or power diagram."""

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Vertices of cells, (k, 3)."""
    @property
    def simplex_vertex(self) -> NDArray[np.int32]:
        """The vertex of each tetrahedron, -1 beyond the range of doubles, (m,)."""
    @property
    def sites(self) -> NDArray[np.int32]:
        """The two sites of each ridge, (r, 2)."""
    @property
    def ridge_starts(self) -> NDArray[np.int32]:
        """Start of the entries of each ridge, and the end, (r + 1,)."""
    @property
    def ridge_entries(self) -> NDArray[np.int32]:
        """Entries: a vertex, or ~i for ray i, at both ends of an open ridge."""
    @property
    def rays(self) -> NDArray[np.float64]:
        """Directions of the rays, (q, 3)."""
    @property
    def region(self) -> NDArray[np.int32]:
        """The cell of each point, -1 for none, (n,)."""
    @property
    def site(self) -> NDArray[np.int32]:
        """The point of each cell, (c,)."""
    @property
    def region_starts(self) -> NDArray[np.int32]:
        """Start of the vertices of each cell, and the end, (c + 1,)."""
    @property
    def region_vertices(self) -> NDArray[np.int32]:
        """Vertices of cells, ascending, -1 first if a cell is unbounded."""
    @property
    def region_ridge_starts(self) -> NDArray[np.int32]:
        """Start of the ridges of each cell, and the end, (c + 1,)."""
    @property
    def region_ridges(self) -> NDArray[np.int32]:
        """Ridges of cells, ascending."""
    def __new__(
        cls,
        vertices: NDArray[np.float64],
        simplex_vertex: NDArray[np.int32],
        sites: NDArray[np.int32],
        ridge_starts: NDArray[np.int32],
        ridge_entries: NDArray[np.int32],
        rays: NDArray[np.float64],
        region: NDArray[np.int32],
        site: NDArray[np.int32],
        region_starts: NDArray[np.int32],
        region_vertices: NDArray[np.int32],
        region_ridge_starts: NDArray[np.int32],
        region_ridges: NDArray[np.int32],
    ) -> Diagram3: ...
    def arrays(self) -> tuple[NDArray[np.generic], ...]:
        """All arrays, in the order of the arguments of the constructor."""
    def __getnewargs__(self) -> tuple[NDArray[np.generic], ...]:
        """The arguments for unpickling."""

@final
class Distances3:
    """Triangles in 3-D, in a tree: distances from the nearest one."""

    def __new__(cls, points: NDArray[np.float64], triangles: NDArray[np.int32]) -> Distances3:
        """Of triangles, (m, 3); with repeated vertices they are segments and points."""
    def of(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.float64]:
        """The distance of each query from the nearest triangle, rounded."""

@final
class FacePairs:
    """Pairs of faces that cross or touch."""

    @property
    def faces(self) -> NDArray[np.int32]:
        """Rows of both faces, the smaller first, (p, 2)."""
    @property
    def kinds(self) -> NDArray[np.uint8]:
        """The kind of each pair, (p,)."""
    @property
    def crossing(self) -> NDArray[np.bool_]:
        """Whether they cross, (p,)."""
    @property
    def counts(self) -> NDArray[np.uint64]:
        """The number of all pairs of each kind, (6,)."""
    @property
    def ncrossing(self) -> int:
        """The number of all pairs that cross."""

@final
class Faults:
    """Faults of a triangulation with d coordinates; arrays are empty if there are none."""

    @property
    def orientation(self) -> NDArray[np.int32]:
        """Simplices that are not positively oriented, (k,)."""
    @property
    def edges(self) -> NDArray[np.int32]:
        """In 2-D, directed edges that more than one triangle uses, (k, 2)."""
    @property
    def facets(self) -> NDArray[np.int32]:
        """In 3-D, oriented faces that more than one tetrahedron has, (k, d)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """Simplices whose row of neighbors is wrong, (k,)."""
    @property
    def hull(self) -> NDArray[np.int32]:
        """Boundary facets that are not on the hull, (k, d)."""
    @property
    def missing(self) -> NDArray[np.int32]:
        """Rows of distinct points that no simplex uses; with weights, those outside all
        simplices, (k,).
        """
    @property
    def hidden(self) -> NDArray[np.int32]:
        """With weights, rows that should be vertices though simplices cover them, (k,)."""
    @property
    def repeats(self) -> NDArray[np.int32]:
        """Rows that are used although another row represents their coordinates, (k,)."""
    @property
    def delaunay(self) -> NDArray[np.int32]:
        """Pairs of simplices that are not locally Delaunay or regular, (k, 2)."""
    @property
    def ties(self) -> NDArray[np.int32]:
        """Pairs of simplices on a tie that are not canonical, (k, 2)."""
    @property
    def count(self) -> NDArray[np.int32]:
        """In 2-D, numbers of triangles expected and found, (2,), if they differ; otherwise (0,)."""
    @property
    def overlaps(self) -> NDArray[np.int32]:
        """In more than three dimensions, simplices that cover a point of simplex 0, (k,)."""

@final
class FlippedTriangulation:
    """A triangulation made canonical by flips."""

    @property
    def simplices(self) -> NDArray[np.int32]:
        """Vertices of the triangles, (m, 3)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The triangle opposite each vertex, -1 outside, (m, 3)."""
    @property
    def flips(self) -> int:
        """Number of flips."""
    @property
    def sequence(self) -> NDArray[np.int32] | None:
        """The vertices of each flip, (flips, 4); None if they were not recorded."""

@final
class Halfspaces:
    """The intersection of half-spaces around a point."""

    @property
    def dual_points(self) -> NDArray[np.float64]:
        """The dual point of each half-space, (n, d)."""
    @property
    def simplices(self) -> NDArray[np.int32]:
        """Half-spaces of the simplices of the dual hull, sorted, (m, d)."""
    @property
    def corner_of(self) -> NDArray[np.int32]:
        """The corner of each simplex, (m,)."""
    @property
    def facets(self) -> NDArray[np.int32]:
        """Half-spaces that meet at each corner, one corner after another, (k,)."""
    @property
    def starts(self) -> NDArray[np.int32]:
        """Start of the half-spaces of each corner, and the end, (c + 1,)."""
    @property
    def points(self) -> NDArray[np.float64]:
        """The corners, infinite where the intersection is unbounded, (c, d)."""
    @property
    def equations(self) -> NDArray[np.float64]:
        """Outer unit normals and offsets of the dual points of each corner, (c, d + 1)."""

@final
class Hull3:
    """The convex hull of 3-D points."""

    @property
    def simplices(self) -> NDArray[np.int32]:
        """Vertices of the triangles of facets, (m, 3)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The triangle opposite each vertex, (m, 3)."""
    @property
    def facet_of(self) -> NDArray[np.int32]:
        """The facet of each triangle, (m,)."""
    @property
    def polygons(self) -> NDArray[np.int32]:
        """Vertices of all facets, one facet after another, (k,)."""
    @property
    def starts(self) -> NDArray[np.int32]:
        """Start of the vertices of each facet, and the end, (f + 1,)."""
    @property
    def duplicates(self) -> NDArray[np.int32]:
        """Rows that repeat earlier rows, and the first of these, (d, 2)."""

@final
class HullN:
    """The convex hull of points with four to eight coordinates."""

    @property
    def simplices(self) -> NDArray[np.int32]:
        """Vertices of the facets, positively oriented behind a point inside, (m, d)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The facet opposite each vertex, (m, d)."""
    @property
    def facet_of(self) -> NDArray[np.int32]:
        """The plane of each facet, numbered, (m,)."""
    @property
    def inside(self) -> NDArray[np.int32]:
        """For each facet, the row of a point that is not on its plane, (m,)."""
    @property
    def duplicates(self) -> NDArray[np.int32]:
        """Rows that repeat earlier rows, and the first of these, (k, 2)."""

@final
class ImprovedMesh:
    """Improved tetrahedra."""

    @property
    def points(self) -> NDArray[np.float64]:
        """Coordinates, (n, 3)."""
    @property
    def simplices(self) -> NDArray[np.int32]:
        """Vertices of the tetrahedra, (m, 4)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The tetrahedron opposite each vertex, -1 outside, (m, 4)."""
    @property
    def weights(self) -> NDArray[np.float64]:
        """The weight of each point, 0 for most, (n,)."""
    @property
    def labels(self) -> NDArray[np.int32]:
        """The label of each tetrahedron, (m,)."""
    @property
    def distance(self) -> float:
        """An upper bound on the distance between the boundary and the original one."""
    @property
    def counts(self) -> ImprovementCounts:
        """Numbers of changes."""
    @property
    def exhausted(self) -> bool:
        """Whether the limit on passes was reached while passes still made progress."""

@final
class ImprovementCounts:
    """Numbers of changes to tetrahedra, by kind."""

    @property
    def edges(self) -> int:
        """Edges removed."""
    @property
    def boundary(self) -> int:
        """Edges of the boundary among these."""
    @property
    def faces(self) -> int:
        """Faces removed."""
    @property
    def moves(self) -> int:
        """Vertices moved."""
    @property
    def slides(self) -> int:
        """Vertices of the boundary or of regions among these."""
    @property
    def peeled(self) -> int:
        """Tetrahedra removed at the boundary."""
    @property
    def weights(self) -> int:
        """Weights assigned."""
    @property
    def added(self) -> int:
        """Vertices added."""
    @property
    def removed(self) -> int:
        """Vertices removed; no tetrahedron uses their rows."""
    @property
    def passes(self) -> int:
        """Passes."""
    @property
    def refused(self) -> int:
        """Changes rejected."""

@final
class JudgedTriangles:
    """Triangles with small, extreme or unknown angles."""

    @property
    def below(self) -> NDArray[np.int32]:
        """Those with an angle below the bound, (k,)."""
    @property
    def extremes(self) -> NDArray[np.int32]:
        """Those that include the smallest and the largest angle, (e,)."""
    @property
    def beyond(self) -> NDArray[np.int32]:
        """Those that are beyond the range of doubles, (b,)."""

@final
class LazyN:
    """Points with any number of coordinates, whose triangulation is not computed."""

    def __new__(cls, points: NDArray[np.float64]) -> LazyN: ...
    @property
    def duplicates(self) -> NDArray[np.int32]:
        """Rows that repeat earlier rows, and the first of these, (k, 2)."""
    def within(
        self, xi: NDArray[np.float64], workers: int
    ) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """For each query the rows of the corners of the simplex that contains it, -1 outside,
        and their weights.
        """

@final
class Live:
    """A Delaunay triangulation that is edited, in 2-D or in 3-D."""

    def __new__(
        cls,
        points: NDArray[np.float64],
        handles: NDArray[np.int64] | None,
        total: int,
        workers: int,
    ) -> Live:
        """The triangulation of points with these handles, ascending, before the handle `total`."""
    @property
    def ndim(self) -> int:
        """The number of coordinates, 2 or 3."""
    def counts(self) -> list[int]:
        """Numbers: points, vertices, simplices, and the next handle."""
    @property
    def edits(self) -> int:
        """How many edits are complete."""
    def insert(self, points: NDArray[np.float64], workers: int) -> NDArray[np.int64]:
        """Inserts points and returns their handles."""
    def remove(self, handles: NDArray[np.int64], workers: int) -> None:
        """Removes points."""
    def remove_with_segments(self, handles: NDArray[np.int64], workers: int) -> NDArray[np.int64]:
        """Removes points and the segments that end there, and returns the handles of these."""
    def relocate(
        self, handles: NDArray[np.int64], points: NDArray[np.float64], workers: int
    ) -> None:
        """Moves points."""
    def faults(self, handles: NDArray[np.int64]) -> list[NDArray[np.int64]]:
        """Which of these handles do not exist, or are named earlier."""
    def points(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """The handles, ascending, and their points."""
    def arrays(self) -> LiveArrays:
        """The current triangulation; no simplices if all points are in one line or plane."""
    def split_crossings(self, split: bool) -> None:
        """Chooses whether crossings of segments are split."""
    def constraints(self) -> list[bool]:
        """Whether there are segments, and whether crossings are split."""
    def insert_segments(self, ends: NDArray[np.int64], workers: int) -> NDArray[np.int64]:
        """Inserts segments between points and returns their handles."""
    def remove_segments(self, handles: NDArray[np.int64], workers: int) -> None:
        """Removes segments."""
    def adopt_segments(
        self,
        known: tuple[NDArray[np.int64], NDArray[np.int64]],
        total: int,
        crossings: tuple[NDArray[np.int64], NDArray[np.float64]],
        workers: int,
    ) -> None:
        """Inserts segments with known handles, ascending, before the handle `total`; crossings
        at known places get their handles again.
        """
    def segments(self) -> LiveSegments:
        """The segments and their crossings."""
    def segment_faults(self, handles: NDArray[np.int64]) -> list[NDArray[np.int64]]:
        """Which of these handles of segments do not exist, or are named earlier."""
    def held(self, handles: NDArray[np.int64]) -> NDArray[np.int64]:
        """Which of these handles of points are ends of segments, each with one, or crossings,
        with -1.
        """
    def weights(
        self, xi: NDArray[np.float64], known: int
    ) -> tuple[NDArray[np.int64], NDArray[np.float64], int, NDArray[np.int64] | None]:
        """The handles of the corners of a simplex that contains each query, -1 outside, and
        weights; the number of edits so far; and if that is not `known`, the handles of all
        points.
        """
    def corners(self, xi: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """The handles of the corners of a simplex that contains each query, -1 outside, and
        weights.
        """
    def nearest(self, xi: NDArray[np.float64]) -> NDArray[np.int64]:
        """The handle of the nearest point to each query, -1 if there is none."""
    def changes(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The simplices that were removed and added since the last call, as handles."""
    def state(self) -> LiveState:
        """The current state."""
    def restore(self, state: LiveState, known: int | None = None) -> bool:
        """Restores a state of the same dimension; not if `known` is given and is not the
        number of edits so far. Returns whether it was restored.
        """

@final
class LiveArrays:
    """The current triangulation."""

    @property
    def handles(self) -> NDArray[np.int64]:
        """The handles of the points, ascending, (n,)."""
    @property
    def points(self) -> NDArray[np.float64]:
        """The points, (n, d)."""
    @property
    def simplices(self) -> NDArray[np.int32]:
        """Simplices as rows of these, (m, d + 1)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The simplex opposite each vertex, -1 outside, (m, d + 1)."""
    @property
    def constrained(self) -> NDArray[np.bool_] | None:
        """Whether the edge opposite each vertex is part of a segment, (m, 3); None without
        segments.
        """
    @property
    def duplicates(self) -> NDArray[np.int32]:
        """Rows that repeat earlier rows, and the first of these, (k, 2)."""

@final
class LiveSegments:
    """The segments of a triangulation."""

    @property
    def handles(self) -> NDArray[np.int64]:
        """The handles of segments, ascending, (s,)."""
    @property
    def ends(self) -> NDArray[np.int64]:
        """The handles of their ends, (s, 2)."""
    @property
    def crossings(self) -> NDArray[np.int64]:
        """Two segments, and the handle of the vertex where they cross, (c, 3)."""
    @property
    def added(self) -> NDArray[np.int64]:
        """The handles of vertices that only crossings need, (v,)."""
    @property
    def total(self) -> int:
        """The next handle of a segment."""

@final
class LiveState:
    """A state of a `Live`, which never changes."""

    @property
    def ndim(self) -> int:
        """The number of coordinates, 2 or 3."""
    def open(self) -> Live:
        """A separate triangulation in this state."""
    def own_bytes(self, other: LiveState) -> int:
        """Bytes that are not shared with another state of the same dimension."""

@final
class Location2:
    """Locations of queries in triangles."""

    @property
    def simplex(self) -> NDArray[np.int32]:
        """The triangle that contains each query, -1 outside, (q,)."""
    @property
    def weights(self) -> NDArray[np.float64]:
        """Weights of its corners, NaN outside, (q, 3)."""
    @property
    def beside(self) -> NDArray[np.int32]:
        """Outside, the triangle at the nearest point of the boundary; else -1, (q,)."""
    @property
    def edge(self) -> NDArray[np.int32]:
        """Outside, the boundary edge with that point; else -1, (q, 2)."""
    @property
    def along(self) -> NDArray[np.float64]:
        """Outside, the position of the point along that edge, from 0 to 1; else NaN, (q,)."""

@final
class Location3:
    """Locations of queries in tetrahedra."""

    @property
    def simplex(self) -> NDArray[np.int32]:
        """The tetrahedron that contains each query, -1 outside, (q,)."""
    @property
    def weights(self) -> NDArray[np.float64]:
        """Weights of its corners, NaN outside, (q, 4)."""
    @property
    def beside(self) -> NDArray[np.int32]:
        """Outside, the tetrahedron at the nearest point of the boundary; else -1, (q,)."""
    @property
    def face(self) -> NDArray[np.int32]:
        """Outside, the boundary face with that point; else -1, (q, 3)."""
    @property
    def shares(self) -> NDArray[np.float64]:
        """Outside, the weights of its corners; else NaN, (q, 3)."""

@final
class Locator2:
    """A triangulation that is kept for many calls."""

    def __new__(
        cls, points: NDArray[np.float64], simplices: NDArray[np.int32], neighbors: NDArray[np.int32]
    ) -> Locator2: ...
    def find(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.int32]:
        """For each query, the first triangle that contains it, or -1."""
    def locate(self, xi: NDArray[np.float64], workers: int) -> Location2:
        """Triangles with barycentric coordinates, and outside the nearest boundary point."""
    def nearest(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.int32]:
        """The nearest vertex to each query, in a Delaunay triangulation."""
    def along(self, a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.int32]:
        """The triangles along the segment from `a` to `b`."""
    def linear(
        self, values: NDArray[np.float64], xi: NDArray[np.float64], order: int, workers: int
    ) -> NDArray[np.float64]:
        """Linear interpolation: values, or gradients."""
    def clough_tocher(
        self,
        values: NDArray[np.float64],
        gradients: NDArray[np.float64],
        xi: NDArray[np.float64],
        barrier: NDArray[np.bool_] | None,
        order: int,
        workers: int,
    ) -> NDArray[np.float64]:
        """Clough-Tocher interpolation: values, gradients or Hessians."""
    def clough_tocher_weights(
        self, xi: NDArray[np.float64], barrier: NDArray[np.bool_] | None, workers: int
    ) -> CornerWeights:
        """The weights of Clough-Tocher interpolation."""
    def natural(
        self, kind: str, xi: NDArray[np.float64], barrier: NDArray[np.bool_] | None, workers: int
    ) -> NaturalWeights:
        """The weights of natural neighbors."""
    def natural_values(
        self,
        kind: str,
        values: NDArray[np.float64],
        gradients: NDArray[np.float64] | None,
        xi: NDArray[np.float64],
        barrier: NDArray[np.bool_] | None,
        order: int,
        workers: int,
    ) -> NDArray[np.float64]:
        """Natural neighbor interpolation: values, gradients or Hessians."""
    def leave_one_out(self, kind: str, workers: int) -> WeightRows:
        """For each vertex, the weights of the others."""

@final
class Locator3:
    """A 3-D triangulation that is kept for many calls."""

    def __new__(
        cls, points: NDArray[np.float64], simplices: NDArray[np.int32], neighbors: NDArray[np.int32]
    ) -> Locator3: ...
    def find(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.int32]:
        """For each query, the first tetrahedron that contains it, or -1."""
    def within(
        self, xi: NDArray[np.float64], workers: int
    ) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """Tetrahedra with barycentric coordinates."""
    def locate(self, xi: NDArray[np.float64], workers: int) -> Location3:
        """Tetrahedra with barycentric coordinates, and outside the nearest boundary point."""
    def laplace(self, xi: NDArray[np.float64], workers: int) -> NaturalWeights:
        """Laplace weights of natural neighbors, as compressed rows, and the tetrahedra of
        queries.
        """
    def nearest(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.int32]:
        """The nearest vertex to each query, in a Delaunay triangulation."""

@final
class LocatorN:
    """A Delaunay triangulation in four to eight dimensions that is kept for many calls."""

    def __new__(
        cls, points: NDArray[np.float64], simplices: NDArray[np.int32], neighbors: NDArray[np.int32]
    ) -> LocatorN: ...
    def find(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.int32]:
        """For each query, the first simplex that contains it, or -1."""
    def within(
        self, xi: NDArray[np.float64], workers: int
    ) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """Simplices with barycentric coordinates."""
    def nearest(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.int32]:
        """The nearest vertex to each query."""

@final
class NaturalWeights:
    """Weights of natural neighbors as compressed rows."""

    @property
    def indptr(self) -> NDArray[np.int64]:
        """Start of the neighbors of each query, and the end, (q + 1,)."""
    @property
    def indices(self) -> NDArray[np.int32]:
        """The neighbors, (k,)."""
    @property
    def weights(self) -> NDArray[np.float64]:
        """Their weights, (k,)."""
    @property
    def slopes(self) -> NDArray[np.float64] | None:
        """Weights of their gradients, (k, 2); None if the kind has none."""
    @property
    def simplex(self) -> NDArray[np.int32]:
        """The simplex that contains each query, -1 outside, (q,)."""

@final
class PeriodicFaults:
    """Faults of a periodic triangulation; arrays are empty if there are none."""

    @property
    def offsets(self) -> NDArray[np.int32]:
        """Triangles with impossible offsets; if there are any, nothing else is checked, (k,)."""
    @property
    def faults(self) -> Faults:
        """Faults as without periods: `neighbors` has triangles whose neighbors or partners are
        wrong, and `hull` edges without a partner that are not on the boundary of the strip.
        """
    @property
    def layers(self) -> NDArray[np.int32]:
        """How often the triangles cover the plane, (1,), if not once; otherwise (0,)."""

@final
class PeriodicTriangulation:
    """A triangulation of periodic points: one triangle of each class of translates."""

    @property
    def simplices(self) -> NDArray[np.int32]:
        """Vertices of the triangles, (m, 3)."""
    @property
    def offsets(self) -> NDArray[np.int32]:
        """The number of periods by which each corner is shifted, x and y by turns, (m, 6)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The triangle opposite each vertex, -1 outside, (m, 3)."""
    @property
    def partners(self) -> NDArray[np.int32]:
        """The same with its corner, 3 t + k, (m, 3)."""
    @property
    def chain(self) -> NDArray[np.int32]:
        """Rows that are not hidden, in order along the line, if there is no triangle, (k,)."""

@final
class PlaneCells:
    """The cells of a grid in the plane."""

    def __new__(
        cls,
        points: NDArray[np.float64],
        rings: NDArray[np.int64],
        cells: NDArray[np.int64],
        holes: NDArray[np.bool_],
    ) -> PlaneCells:
        """Cells of corners, where their rings start, where the rings of cells start, and
        whether rings are holes.
        """
    def check(self, crossing: bool, workers: int) -> CheckedCells:
        """Areas and faults; sides that cross are only searched for if `crossing`."""
    def overlaps(self, other: PlaneCells, workers: int) -> SharedCells:
        """What the cells share with those of another grid; cells with faults share nothing."""

@final
class RecoveredFaces:
    """Tetrahedra that have given faces."""

    @property
    def points(self) -> NDArray[np.float64]:
        """The points given, followed by those that were added, (n + k, 3)."""
    @property
    def tetrahedra(self) -> NDArray[np.int32]:
        """Vertices of the tetrahedra, (t, 4)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The tetrahedron opposite each vertex, -1 if there is none, (t, 4)."""
    @property
    def walls(self) -> NDArray[np.int32]:
        """The row of the face opposite each vertex, -1 if there is none, (t, 4)."""
    @property
    def cells(self) -> NDArray[np.int32]:
        """The cell of each tetrahedron, from 0: faces separate cells, (t,)."""
    @property
    def nadded(self) -> int:
        """The number of points that were added."""
    @property
    def counts(self) -> RecoveryCounts:
        """What happened."""
    @property
    def crowded(self) -> NDArray[np.int32]:
        """Rows of faces near which no double is left for a point, (k,): then there are no
        tetrahedra.
        """

@final
class RecoveryCounts:
    """What happened during a recovery of faces."""

    @property
    def missing_edges(self) -> int:
        """Edges of faces that the Delaunay triangulation lacks."""
    @property
    def missing_faces(self) -> int:
        """Faces that it lacks."""
    @property
    def flips(self) -> int:
        """Changes by flips."""
    @property
    def flipped_edges(self) -> int:
        """Edges recovered by flips."""
    @property
    def flipped_faces(self) -> int:
        """Faces recovered by flips."""
    @property
    def segment_points(self) -> int:
        """Points that were temporarily put on edges."""
    @property
    def face_points(self) -> int:
        """Points that were temporarily put in faces."""
    @property
    def suppressed(self) -> int:
        """Sectors whose point on the boundary moved into the inside."""
    @property
    def joined(self) -> int:
        """Sectors that were joined to a vertex without a point."""
    @property
    def thinned(self) -> int:
        """Interior points that were removed again."""

@final
class RefinedMesh:
    """A refined triangulation of the hull."""

    @property
    def added(self) -> NDArray[np.float64]:
        """Added vertices; they follow the input vertices, (a, 2)."""
    @property
    def on(self) -> NDArray[np.int32]:
        """The line that each of these lies on, or -1, (a,)."""
    @property
    def simplices(self) -> NDArray[np.int32]:
        """Vertices of the triangles, (m, 3)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The triangle opposite each vertex, -1 outside, (m, 3)."""
    @property
    def sides(self) -> NDArray[np.int32]:
        """The line under the edge opposite each vertex, or -1, (m, 3)."""
    @property
    def labels(self) -> NDArray[np.int32]:
        """The label of each triangle, -1 outside the domain, (m,)."""
    @property
    def needles(self) -> NDArray[np.int32]:
        """The number of the unrefined needle that contains each triangle, or -1, (m,)."""
    @property
    def for_segments(self) -> int:
        """Number of vertices added on segments."""
    @property
    def for_angles(self) -> int:
        """Number of vertices added inside for angles."""
    @property
    def for_sizes(self) -> int:
        """Number of vertices added inside for sizes."""
    @property
    def exhausted(self) -> bool:
        """Whether the limit on vertices was reached."""

@final
class RefinedTetrahedra:
    """Refined tetrahedra."""

    @property
    def points(self) -> NDArray[np.float64]:
        """Coordinates: the input points, then the added ones, (n, 3)."""
    @property
    def simplices(self) -> NDArray[np.int32]:
        """Vertices of the tetrahedra, (m, 4)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The tetrahedron opposite each vertex, -1 outside, (m, 4)."""
    @property
    def labels(self) -> NDArray[np.int32]:
        """The label of each tetrahedron, (m,)."""
    @property
    def sizes(self) -> NDArray[np.float64]:
        """The size that was requested for each, infinite for none, (m,)."""
    @property
    def faces(self) -> NDArray[np.int32]:
        """The faces that stayed, oriented as given, (k, 3)."""
    @property
    def face_rows(self) -> NDArray[np.int32]:
        """The row of the given face that each of these is, or lies in the facet of, (k,)."""
    @property
    def on_segments(self) -> int:
        """Number of points added on segments."""
    @property
    def on_facets(self) -> int:
        """Number of points added on facets."""
    @property
    def for_shapes(self) -> int:
        """Number of points added inside for shapes."""
    @property
    def for_sizes(self) -> int:
        """Number of points added inside for sizes."""

@final
class Refinement2:
    """A refinement in rounds, between which areas are sampled."""

    def __new__(
        cls,
        domain: tuple[
            NDArray[np.float64],
            NDArray[np.int32],
            NDArray[np.int32],
            NDArray[np.int32],
            NDArray[np.int32],
            NDArray[np.bool_],
        ],
        lines: tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]],
        samples: tuple[NDArray[np.float64], NDArray[np.float64]],
        min_angle: float,
        circles: bool,
        sizes_yield: bool,
    ) -> Refinement2:
        """A domain `(points, simplices, neighbors, labels, segments, frozen)` with lines;
        `samples` are positions in it and the largest areas of triangles there.
        """
    def fresh(self, workers: int) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
        """The centers, (k, 2), and the labels, (k,), of triangles that are new since the last
        call.
        """
    def comply(self, wanted: NDArray[np.float64]) -> bool:
        """Sets the areas wanted at these centers; returns whether all triangles comply."""
    def refine(
        self, max_vertices: int, progress: Callable[[int, float], object] | None
    ) -> tuple[bool, int]:
        """One round; returns whether `max_vertices`, the number of vertices to add, was
        enough, and the number of vertices added in all rounds.
        """
    def export(self) -> RefinedMesh:
        """The triangulation, with the vertices of all rounds."""

@final
class Refinement3:
    """A refinement of tetrahedra in rounds, between which sizes are requested."""

    def __new__(
        cls,
        points: NDArray[np.float64],
        simplices: NDArray[np.int32],
        labels: NDArray[np.int32],
        faces: tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]],
        split: tuple[bool, float],
        radius_edge: float,
    ) -> Refinement3:
        """Tetrahedra with labels, and the faces `(faces, sources, markers)` that stay. `split`
        says whether points may be put on faces, and within which distance of a plane faces
        are one facet.
        """
    def fresh(self) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
        """The corners, (k, 12), and the labels, (k,), of tetrahedra whose sizes are not known."""
    def comply(self, sizes: NDArray[np.float64], gradual: bool) -> bool:
        """Sets the sizes of these; returns whether none is too large. With `gradual`, edges
        are at most halved in the next round.
        """
    def refine(self, max_points: int, progress: Callable[[int], object] | None) -> tuple[bool, int]:
        """One round; returns whether `max_points`, the number of points to add, was enough,
        and the number of points added in all rounds.
        """
    def export(self) -> RefinedTetrahedra:
        """The mesh, with the points of all rounds."""

@final
class RegularTriangulation:
    """The regular triangulation of weighted points, of either dimension d."""

    @property
    def simplices(self) -> NDArray[np.int32]:
        """Vertices of the simplices, (m, d + 1)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The simplex opposite each vertex, -1 outside, (m, d + 1)."""
    @property
    def chain(self) -> NDArray[np.int32]:
        """Rows that are not hidden, in order along the line, if all points are collinear, (k,)."""
    @property
    def stands_for(self) -> NDArray[np.int32]:
        """The row that represents each point, -1 for hidden points, (n,)."""

@final
class SharedCells:
    """The areas that cells of two grids share, as compressed rows."""

    @property
    def indptr(self) -> NDArray[np.int64]:
        """Where the entries of each cell of the first grid start, and their number, (n + 1,)."""
    @property
    def indices(self) -> NDArray[np.int32]:
        """Cells of the second grid, (k,)."""
    @property
    def areas(self) -> NDArray[np.float64]:
        """Areas, on the sphere in steradians, (k,)."""
    @property
    def first(self) -> NDArray[np.float64]:
        """Sums over the cells of the first grid, (n,)."""
    @property
    def second(self) -> NDArray[np.float64]:
        """Sums over the cells of the second grid, (m,)."""

@final
class Simplified2:
    """Points in the order in which they make a coarse surface finer."""

    @property
    def order(self) -> NDArray[np.int32]:
        """The points that are inserted, as rows, (k,)."""
    @property
    def errors(self) -> NDArray[np.float64]:
        """A bound on the vertical distance of all points before the first insertion and after
        each, (k + 1,).
        """
    @property
    def triangles(self) -> NDArray[np.int32]:
        """The number of triangles before the first insertion and after each, (k + 1,)."""

@final
class SmoothedMesh:
    """A mesh whose free vertices have moved."""

    @property
    def points(self) -> NDArray[np.float64]:
        """The coordinates, (n, 2)."""
    @property
    def simplices(self) -> NDArray[np.int32]:
        """Vertices of the triangles, each in the region that it was in before, (m, 3)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The triangle opposite each vertex, -1 outside, (m, 3)."""
    @property
    def sides(self) -> NDArray[np.int32]:
        """The line under the edge opposite each vertex, or -1, (m, 3)."""

@final
class SphereDual:
    """The Voronoi diagram of directions."""

    @property
    def simplices(self) -> NDArray[np.int32]:
        """Facets of the convex hull: the triangles, and those across a void, (f, 3)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The facet opposite each corner, (f, 3)."""
    @property
    def vertex(self) -> NDArray[np.int32]:
        """The vertex of each facet, (f,)."""
    @property
    def facet(self) -> NDArray[np.int32]:
        """The first facet of each vertex, (k,)."""
    @property
    def around(self) -> NDArray[np.int32]:
        """The edge of each ridge, and the corners to its left and right, (r, 4)."""
    @property
    def ends(self) -> NDArray[np.int32]:
        """The vertices of each ridge, to the left and right of its edge, (r, 2)."""
    @property
    def cell(self) -> NDArray[np.int32]:
        """The cell of each row, -1 if it is not a corner, (n,)."""
    @property
    def starts(self) -> NDArray[np.int32]:
        """Where the entries of each cell begin."""
    @property
    def vertices(self) -> NDArray[np.int32]:
        """The vertices of cells, counter-clockwise."""
    @property
    def ridges(self) -> NDArray[np.int32]:
        """The ridges that follow them."""

@final
class SphereLocator:
    """A triangulation of directions that is kept for many calls."""

    def __new__(
        cls,
        vectors: NDArray[np.float64],
        simplices: NDArray[np.int32],
        neighbors: NDArray[np.int32],
        workers: int,
    ) -> SphereLocator: ...
    def find(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.int32]:
        """For each vector, the first triangle that contains its direction, or -1."""
    def weights(
        self,
        kind: str,
        xi: NDArray[np.float64],
        simplex: NDArray[np.int32],
        sloped: bool,
        workers: int,
    ) -> SphereWeights:
        """The weights of vertices at vectors, each of which is in or at a triangle, or -1 for
        none; and if `sloped` their derivatives.
        """
    def nearest(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.int32]:
        """The vertex nearest to the direction of each vector."""

@final
class SphereTriangulation:
    """A Delaunay triangulation of directions."""

    @property
    def simplices(self) -> NDArray[np.int32]:
        """Vertices of the triangles, counter-clockwise seen from outside, (m, 3)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The triangle opposite each vertex, -1 beyond a hull, (m, 3)."""
    @property
    def duplicates(self) -> NDArray[np.int32]:
        """Rows that repeat the direction of earlier rows, and the first of these, (d, 2)."""

@final
class SphereWeights:
    """Weights of vertices at directions as compressed rows."""

    @property
    def indptr(self) -> NDArray[np.int64]:
        """Start of the entries of each query, and the end, (q + 1,)."""
    @property
    def indices(self) -> NDArray[np.int32]:
        """The vertices, (k,)."""
    @property
    def weights(self) -> NDArray[np.float64]:
        """Their weights, (k,)."""
    @property
    def slopes(self) -> NDArray[np.float64] | None:
        """Derivatives of the weights toward east and north, per radian, (k, 2); None if not
        wanted.
        """

@final
class Triangulation:
    """A Delaunay triangulation of either dimension d."""

    @property
    def simplices(self) -> NDArray[np.int32]:
        """Vertices of the simplices, (m, d + 1)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The simplex opposite each vertex, -1 outside, (m, d + 1)."""
    @property
    def duplicates(self) -> NDArray[np.int32]:
        """Rows that repeat earlier rows, and the first of these, (k, 2)."""
    @property
    def stages(self) -> tuple[tuple[str, float], ...]:
        """Pairs of stage name and seconds."""

@final
class WeightRows:
    """Weights as compressed rows."""

    @property
    def indptr(self) -> NDArray[np.int64]:
        """Start of the entries of each row, and the end, (n + 1,)."""
    @property
    def indices(self) -> NDArray[np.int32]:
        """Vertices, (k,)."""
    @property
    def weights(self) -> NDArray[np.float64]:
        """Their weights, (k,)."""

def alpha_counts(
    order: NDArray[np.int32], neighbors: NDArray[np.int32], outside: bool
) -> NDArray[np.int32]:
    """The numbers of components of the first simplices of an order."""

def alpha_edges(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    edges: NDArray[np.int32],
    workers: int,
) -> NDArray[np.float64]:
    """The values of edges without cofaces."""

def alpha_faces(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    simplices: NDArray[np.int32],
    workers: int,
) -> tuple[NDArray[np.float64], list[tuple[NDArray[np.int32], NDArray[np.float64]]]]:
    """The values of simplices in four to eight dimensions, and `(faces, values)` of each
    dimension below.
    """

def alpha_flat(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    workers: int,
) -> tuple[NDArray[np.float64], tuple[NDArray[np.int32], NDArray[np.float64]]]:
    """The values of triangles and their edges."""

def alpha_labels(kept: NDArray[np.bool_], neighbors: NDArray[np.int32]) -> NDArray[np.int32]:
    """The component of each simplex that is kept, -1 of others."""

def alpha_rings2(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    labels: NDArray[np.int32],
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32], NDArray[np.bool_]]:
    """`(vertices, starts, parts, outer)`: the rings of the components of triangles."""

def alpha_solid3(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    workers: int,
) -> tuple[
    NDArray[np.float64],
    tuple[NDArray[np.int32], NDArray[np.float64]],
    tuple[NDArray[np.int32], NDArray[np.float64]],
]:
    """The values of tetrahedra, their faces and their edges."""

def alpha_torus2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    periods: Sequence[float],
    simplices: NDArray[np.int32],
    offsets: NDArray[np.int32],
    partners: NDArray[np.int32],
    workers: int,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int32]]:
    """`(triangles, edges, conflicts)`: the values of periodic triangles, (m,), and of the
    edges opposite their corners, (m, 3), and whether (tail, head) of these are in
    conflict with the other, (3 m, 2).
    """

def alpha_vertices(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    edges: NDArray[np.int32],
    values: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The values of points, from those of edges."""

def antipodes(
    graph: tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]],
    simplices: NDArray[np.int32] | None,
    neighbors: NDArray[np.int32] | None,
    workers: int,
) -> NDArray[np.int32]:
    """The pairs with an empty open diametral ball that are not Delaunay edges."""

def areas2(
    made: ConstrainedTriangulation, segments: NDArray[np.int32], polygons: NDArray[np.int32]
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """The component of each triangle, and the first polygon whose rings contain each
    component, or -1. Triangles that share unconstrained edges are in one component.
    `polygons` has the polygon of each of the segments that were given, -1 for sides of
    none. A polygon with a missing side contains nothing; what is outside the triangles
    is in no polygon.
    """

def around(edges: NDArray[np.int32], npoints: int) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """The neighbors of each vertex along `edges`: `(indptr, indices)`."""

def below2(
    points: NDArray[np.float64], simplices: NDArray[np.int32], squared_cosine: float, workers: int
) -> NDArray[np.int32]:
    """1 for triangles with an angle below a bound, given by its squared cosine; else 0."""

def check_surface3(
    points: NDArray[np.float64], faces: NDArray[np.int32], limit: int, workers: int
) -> CheckedSurface:
    """Checks a surface; at most `limit` pairs are returned."""

def circumcenters(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]:
    """The centers of the circles or spheres through the corners of simplices."""

def closed_polygons(ends: NDArray[np.int32], polygons: NDArray[np.int32]) -> NDArray[np.int32]:
    """The polygon of each segment, or -1, without polygons of which an odd number of sides
    meet at some vertex.
    """

def coarsen3(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    labels: NDArray[np.int32],
    removable: NDArray[np.bool_],
    min_angle: float,
) -> ImprovedMesh:
    """Removes vertices, no two of which are neighbors, if no angle falls below the bound,
    and none that is already below it becomes smaller.
    """

def combine2(
    indptr: NDArray[np.int64],
    indices: NDArray[np.int32],
    weights: NDArray[np.float64],
    values: NDArray[np.float64],
    slopes: NDArray[np.float64] | None,
    gradients: NDArray[np.float64] | None,
    workers: int,
) -> NDArray[np.float64]:
    """Sums of weights times values, row by row."""

def components2(neighbors: NDArray[np.int32], constrained: NDArray[np.bool_]) -> NDArray[np.int32]:
    """Components of triangles that share unconstrained edges."""

def components_beside2(
    parts: tuple[
        NDArray[np.int32],
        NDArray[np.int32],
        NDArray[np.bool_],
        NDArray[np.int32],
        NDArray[np.int32],
    ],
) -> NDArray[np.int32]:
    """The components to the left and right of each subsegment, (q, 2)."""

def components_inside2(
    parts: tuple[
        NDArray[np.int32],
        NDArray[np.int32],
        NDArray[np.bool_],
        NDArray[np.int32],
        NDArray[np.int32],
    ],
    covers: tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int32]],
    first: int,
) -> NDArray[np.int32]:
    """Pairs of a component and a polygon whose rings contain it, ascending, (k, 2);
    `first` is in none.
    """

def condensed(
    points: NDArray[np.float64], k: int, least: int, number: float, workers: int
) -> tuple[
    NDArray[np.int32],
    NDArray[np.int32],
    NDArray[np.int32],
    NDArray[np.int32],
    NDArray[np.int32],
    NDArray[np.int32],
    NDArray[np.float64],
    NDArray[np.float64],
    tuple[int, int],
]:
    """The condensed tree by mutual reachability, and the levels below and up to a number;
    of at least two points, with `k` rows at most as many.
    """

def constrained2(
    points: NDArray[np.float64],
    segments: NDArray[np.int32],
    split: bool,
    conforming: bool,
    max_vertices: int,
    method: str,
    workers: int,
    polygons: NDArray[np.int32] | None = None,
) -> tuple[
    ConstrainedTriangulation,
    tuple[tuple[str, float], ...],
    tuple[NDArray[np.int32], NDArray[np.int32]] | None,
]:
    """The constrained triangulation of points and segments, as arrays that cannot be made
    writeable, the seconds of its stages, and, if the polygon of each segment is given,
    what `areas2` returns.
    """

def contour_bands2(
    surface: _Sheet,
    levels: NDArray[np.float64],
    limit: int,
    collapsed: NDArray[np.bool_],
    far: bool,
    workers: int,
) -> ContourBands:
    """The bands of a surface between levels, below the first and above the last; see
    `contour_lines2`.
    """

def contour_lines2(
    surface: _Sheet,
    levels: NDArray[np.float64],
    limit: int,
    collapsed: NDArray[np.bool_],
    far: bool,
    workers: int,
) -> ContourLines:
    """The contour lines of a surface, with higher ground to their left. Those in triangles
    of `collapsed`, which may be empty, pass through vertices; `far` allows points of
    lines that are far apart to be united.
    """

def deepest2(
    points: NDArray[np.float64], corners: NDArray[np.float64], most: int, workers: int
) -> DeepestPoints:
    """For each triangle (rows of six coordinates), up to `most` points in conflict, and
    whether these are all.
    """

def density(
    points: NDArray[np.float64], eps: float, k: int, workers: int
) -> tuple[NDArray[np.int32], NDArray[np.bool_]]:
    """For each row, the first row of its cluster or -1, and whether it is a core point."""

def dihedral_angles3(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]:
    """The dihedral angles of tetrahedra at the edges 01, 02, 03, 12, 13 and 23."""

def disks2(points: NDArray[np.float64], simplices: NDArray[np.int32]) -> NDArray[np.float64]:
    """Center and radius of disks that contain the closed circumdisks; an infinite radius
    means the whole plane.
    """

def edges(
    simplices: NDArray[np.int32], neighbors: NDArray[np.int32], npoints: int, workers: int
) -> NDArray[np.int32]:
    """Every edge of simplices once: the smaller vertex first, rows ascending."""

def erode(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    name: str,
    value: float,
    holes: bool,
) -> NDArray[np.bool_]:
    """Which simplices of a concave hull remain; `holes` is whether triangles may leave
    holes.
    """

def face_areas3(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]:
    """The areas of triangles in 3-D."""

def face_normals3(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]:
    """The unit normals of triangles in 3-D."""

def faces3(
    simplices: NDArray[np.int32], neighbors: NDArray[np.int32], npoints: int, workers: int
) -> NDArray[np.int32]:
    """Every face of tetrahedra once: vertices and rows ascending."""

def facet_neighbors(simplices: NDArray[np.int32], npoints: int) -> NDArray[np.int32]:
    """The simplex opposite each vertex, -1 if there is none: of triangles, of the same
    orientation, or of tetrahedra.
    """

def facet_rows(
    facets: NDArray[np.int32], wanted: NDArray[np.int32], npoints: int, directed: bool
) -> NDArray[np.int32]:
    """The first row of `facets`, (k, 2) or (k, 3), that is each of `wanted`, -1 where
    there is none; with the same order of vertices if they are `directed`.
    """

def fault(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    workers: int,
) -> tuple[str, int] | None:
    """The first fault of simplices: `("neighbors", row)` or `("orientation", row)`; None
    if there is none.
    """

def find_simplex2(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    xi: NDArray[np.float64],
    workers: int,
) -> NDArray[np.int32]:
    """For each query, the first triangle that contains it, or -1."""

def gradients_global2(
    points: NDArray[np.float64],
    indptr: NDArray[np.int32],
    indices: NDArray[np.int32],
    values: NDArray[np.float64],
    tol: float,
    maxiter: int,
    workers: int,
    floor: float | None = None,
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Gradients of minimal bending energy, and the number of sweeps for each column."""

def gradients_local2(
    points: NDArray[np.float64],
    indptr: NDArray[np.int32],
    indices: NDArray[np.int32],
    values: NDArray[np.float64],
    degree: int,
    workers: int,
) -> NDArray[np.float64]:
    """Gradients of polynomials fitted around each vertex."""

def gradients_local3(
    points: NDArray[np.float64],
    indptr: NDArray[np.int32],
    indices: NDArray[np.int32],
    values: NDArray[np.float64],
    vertices: NDArray[np.int32],
    workers: int,
) -> NDArray[np.float64]:
    """Gradients of linear functions fitted around some vertices of a 3-D triangulation."""

def graph_components(edges: NDArray[np.int32], npoints: int) -> NDArray[np.int32]:
    """The number of the connected component of each row."""

def halfspaces(
    rows: NDArray[np.float64], point: NDArray[np.float64]
) -> tuple[Halfspaces | None, str, NDArray[np.int32]]:
    """The intersection of half-spaces `a x + b <= 0` around a point, in two to eight
    dimensions. If it has no corners: "not inside" or "too close", with the row of a
    half-space, or "flat", with the rows that span all.
    """

def hull2(points: NDArray[np.float64]) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """The extreme points in 2-D, counter-clockwise, and the rows that repeat them."""

def hull3(points: NDArray[np.float64]) -> Hull3 | None:
    """The hull of 3-D points; None if they span no volume."""

def hull_in_flat(points: NDArray[np.float64], rest: NDArray[np.float64]) -> HullN:
    """The convex hull in a flat of points, given as to `triangulate_in_flat`."""

def hull_n(points: NDArray[np.float64]) -> HullN:
    """The convex hull of points with four to eight coordinates."""

def imprint_surface3(
    points: NDArray[np.float64], faces: NDArray[np.int32], tolerance: float, workers: int
) -> CutSurface:
    """Cuts a surface where its faces cross, overlap or touch."""

def improve3(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    labels: NDArray[np.int32],
    fixed: NDArray[np.bool_],
    removable: NDArray[np.bool_],
    min_angle: float,
    flips: bool,
    smooth: bool,
    exude: bool,
    turn: bool,
    tolerance: float,
    passes: int,
    most: int,
    progress: Callable[[int, int], object] | None = None,
) -> ImprovedMesh:
    """Improves tetrahedra. `progress` is called after each pass with its number and the
    number of tetrahedra below the bound.
    """

def incircle(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    c: NDArray[np.float64],
    d: NDArray[np.float64],
    canonical: bool,
) -> NDArray[np.int8]:
    """Signs of d relative to the circle through a, b, c."""

def influence(
    points: NDArray[np.float64], closed: bool, workers: int
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """The edges of the sphere of influence graph, and the duplicates."""

def insphere(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    c: NDArray[np.float64],
    d: NDArray[np.float64],
    e: NDArray[np.float64],
    canonical: bool,
) -> NDArray[np.int8]:
    """Signs of e relative to the sphere through a, b, c, d."""

def judge2(
    points: NDArray[np.float64], simplices: NDArray[np.int32], cos2: float
) -> JudgedTriangles:
    """The triangles with an angle below a bound, given by its squared cosine; those that
    include the smallest and the largest angle; and those beyond the range of doubles.
    """

def knn(
    points: NDArray[np.float64], k: int, directed: bool, workers: int
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """The edges to the k nearest neighbors, and the duplicates."""

def lawson2(
    points: NDArray[np.float64], simplices: NDArray[np.int32], record: bool
) -> FlippedTriangulation:
    """The canonical triangulation by flips, the number of flips, and their sequence if
    recorded.
    """

def linkage(
    points: NDArray[np.float64],
    edges: NDArray[np.int32],
    duplicates: NDArray[np.int32],
    workers: int,
) -> NDArray[np.float64]:
    """The merges of single linkage, from the edges of the spanning tree and duplicates."""

def measures2(
    starts: NDArray[np.int32], corners: NDArray[np.float64], workers: int
) -> CellMeasures2:
    """The measures of polygons."""

def measures3(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    diagram: Diagram3,
    workers: int,
) -> CellMeasures3:
    """The measures of the cells of a diagram and of its ridges."""

def methods2() -> list[str]:
    """Names of the methods of `triangulate2`."""

def neighbors2(simplices: NDArray[np.int32], npoints: int) -> NDArray[np.int32]:
    """The triangle across the edge opposite each corner, -1 outside."""

def not_longer(
    points: NDArray[np.float64], edges: NDArray[np.int32], ends: NDArray[np.float64], workers: int
) -> NDArray[np.int32]:
    """The edges that are not longer than the one between two points."""

def numbered_components(
    points: NDArray[np.float64], simplices: NDArray[np.int32], component: NDArray[np.int32]
) -> NDArray[np.int32]:
    """Components of triangles in 2-D or 3-D, numbered in the order of their smallest
    triangles, which depends on coordinates only.
    """

def odd_pairs2(
    covers: tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int32]],
) -> NDArray[np.int32]:
    """Pairs of a subsegment and a polygon of which an odd number of sides cover it,
    ascending, (k, 2).
    """

def of_triangles2(
    tiling: tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int32]],
    name: str,
    beta: float,
    closed: bool,
    workers: int,
) -> NDArray[np.int32]:
    """The edges of triangles that no opposite corner removes, by the name of a rule."""

def orient2d(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]
) -> NDArray[np.int8]:
    """Orientation signs of the triangles a, b, c."""

def orient3d(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64], d: NDArray[np.float64]
) -> NDArray[np.int8]:
    """Orientation signs of the tetrahedra a, b, c, d."""

def orientations_n(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.int32]:
    """The orientations of simplices in four to eight dimensions: 1, 0 or -1, exactly."""

def periodic2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    periods: Sequence[float],
    workers: int,
) -> PeriodicTriangulation:
    """The Delaunay triangulation (with weights the regular one) of points that repeat
    after `periods`, 0 for none; points must lie within one period.
    """

def periodic_centers2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    periods: Sequence[float],
    corners: NDArray[np.int32],
    apexes: NDArray[np.int32],
    workers: int,
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """`(centers, shared)`: the center of each triangle of copies, and whether the neighbor
    across each edge, with a given apex, has the same center; corners and apexes are
    rows and shifts, three per triangle.
    """

def pieces2(
    starts: NDArray[np.int32],
    corners: NDArray[np.float64],
    ridges: NDArray[np.int32],
    rows: NDArray[np.int32],
    inside: NDArray[np.bool_],
    rings: NDArray[np.int32],
    outline: NDArray[np.float64],
    workers: int,
) -> CellPieces2:
    """Clips the polygons `rows` to an outline: rings with their inside to the left.
    `inside` is whether the outline contains the first corner of each of these polygons.
    """

def polygon2(
    points: NDArray[np.float64], starts: NDArray[np.int32], nonzero: bool
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """The triangles inside rings, and the vertices added where they cross."""

def proximity(
    graph: tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]],
    name: str,
    beta: float,
    closed: bool,
    workers: int,
) -> NDArray[np.int32]:
    """The Delaunay edges whose region is empty."""

def qualities(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> list[NDArray[np.float64]]:
    """Smallest and largest angle (of tetrahedra, dihedral angle), size, ratio of radii and
    of edges.
    """

def recover_faces(
    points: NDArray[np.float64],
    faces: NDArray[np.int32],
    max_points: int,
    flips: bool,
    workers: int,
) -> RecoveredFaces:
    """Tetrahedra that have all faces, which may meet only in common vertices and edges.
    What can be reached from far outside without crossing a face is left out.
    """

def refine2(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    labels: NDArray[np.int32],
    areas: NDArray[np.float64],
    segments: NDArray[np.int32],
    frozen: NDArray[np.bool_],
    min_angle: float,
    max_vertices: int,
    lines: tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]] | None = None,
    circles: bool = False,
    sizes_yield: bool = False,
    progress: Callable[[int, float], object] | None = None,
) -> RefinedMesh:
    """Refines a triangulation. `progress` is called with the number of added vertices and
    the current smallest angle.
    """

def regular(
    points: NDArray[np.float64], weights: NDArray[np.float64], workers: int
) -> RegularTriangulation:
    """The regular triangulation of weighted points; in 2-D a chain of rows if all are
    collinear.
    """

def resolve_touches3(
    points: NDArray[np.float64], faces: NDArray[np.int32], limit: int, workers: int
) -> tuple[tuple[NDArray[np.int32], NDArray[np.int32]] | None, FacePairs]:
    """`(parts, pairs)`: the faces subdivided where they touch, None if some cross, and at
    most `limit` pairs.
    """

def ring2(points: object) -> tuple[NDArray[np.float64], NDArray[np.int32]] | None:
    """A read-only copy of the points and the triangles of one ring; None unless the ring
    is known to be simple and `points` is a contiguous array of doubles.  It holds the
    GIL: such rings are short, and releasing it would cost as much as triangulating.
    """

def simplify2(
    coarse: _Sheet,
    segments: NDArray[np.int32],
    present: int,
    points: NDArray[np.float64],
    z: NDArray[np.float64],
    max_error: float,
    max_triangles: int,
    workers: int,
) -> Simplified2:
    """Inserts points into a `coarse` surface, always the one that is farthest from it,
    until none is farther than `max_error` or there would be more than `max_triangles`.
    `segments` are edges that stay, `present` is the number of triangles, `points` and
    `z` are the other points.
    """

def sizes(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]:
    """The areas of triangles, or the volumes of simplices of more dimensions."""

def smallest_angle2(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> float:
    """The smallest angle of all triangles in degrees, 180 if there are none."""

def smooth2(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    sides: NDArray[np.int32],
    free: NDArray[np.bool_],
    cos2: float,
    target: str,
    rounds: int,
    workers: int,
) -> SmoothedMesh:
    """Moves free vertices of a mesh toward better positions; `cos2` is the squared cosine
    of the bound.
    """

def smooth3(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    labels: NDArray[np.int32],
    fixed: NDArray[np.bool_],
    min_angle: float,
    target: str,
    rounds: int,
) -> ImprovedMesh:
    """Moves vertices that are not fixed to the mean of the circumcenters of their
    tetrahedra ("odt") or of their neighbors ("laplace"), as far as the bound allows.
    """

def spanning(
    graph: tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]],
    workers: int,
) -> NDArray[np.int32]:
    """The edges of the minimum spanning tree."""

def spanning_triangles2(
    tiling: tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int32]], workers: int
) -> NDArray[np.int32]:
    """The edges of the minimum spanning tree of triangulated 2-D points."""

def sphere_areas(
    vectors: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]:
    """Returns the solid angles of triangles, (m,)."""

def sphere_circumcenters(
    vectors: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]:
    """Returns the unit vectors at the circumcenters of triangles, (m, 3)."""

def sphere_constrained(
    vectors: NDArray[np.float64], segments: NDArray[np.int32], workers: int
) -> ConstrainedTriangulation:
    """Returns the constrained triangulation of the directions of vectors and arcs between
    them.
    """

def sphere_delaunay(vectors: NDArray[np.float64], workers: int) -> SphereTriangulation:
    """Returns the triangulation of the directions of vectors."""

def sphere_directions(
    lonlat: NDArray[np.float64], degrees: bool, workers: int
) -> NDArray[np.float64]:
    """Returns vectors in the directions of longitudes and latitudes, (n, 3)."""

def sphere_dual(
    vectors: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    merged: bool,
    workers: int,
) -> SphereDual:
    """Returns the dual of a triangulation of at least four directions; facets of one
    circle share a vertex if `merged`.
    """

def sphere_spans(
    vectors: NDArray[np.float64], around: NDArray[np.int32], workers: int
) -> NDArray[np.float64]:
    """Returns the length of each ridge, and the area between it and either of its sites,
    (r, 2).
    """

def sphere_units(vectors: NDArray[np.float64], workers: int) -> NDArray[np.float64]:
    """Returns the unit vectors of vectors, rounded, (n, 3)."""

def touched2(
    starts: NDArray[np.int32],
    corners: NDArray[np.float64],
    ridges: NDArray[np.int32],
    segments: NDArray[np.float64],
) -> tuple[NDArray[np.int32], int]:
    """For each polygon its connected group of polygons that no segment comes near, or -1;
    and the number of groups.
    """

def transforms(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]:
    """The affine maps of simplices to barycentric coordinates."""

def triangulate2(points: NDArray[np.float64], method: str, workers: int) -> Triangulation:
    """The Delaunay triangulation of 2-D points."""

def triangulate3(points: NDArray[np.float64], workers: int) -> Triangulation:
    """The Delaunay triangulation of 3-D points."""

def triangulate_in_flat(points: NDArray[np.float64], rest: NDArray[np.float64]) -> Triangulation:
    """The Delaunay triangulation of points in a flat: `points` are their coordinates along
    its axes, and `rest` the others, padded with zeros to eight, (n, 8).
    """

def triangulate_n(points: NDArray[np.float64]) -> Triangulation:
    """The Delaunay triangulation of points with four to eight coordinates."""

def validate(
    points: NDArray[np.float64], simplices: NDArray[np.int32], neighbors: NDArray[np.int32]
) -> Faults:
    """Returns the faults of a triangulation with two to eight coordinates."""

def validate_in_flat(
    points: NDArray[np.float64],
    rest: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
) -> Faults:
    """The faults of a triangulation of points in a flat, given as to `triangulate_in_flat`."""

def validate_periodic2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    periods: Sequence[float],
    simplices: NDArray[np.int32],
    offsets: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    partners: NDArray[np.int32],
) -> PeriodicFaults:
    """Returns the faults of a periodic triangulation: periods of 0 mean none; `offsets`
    has those of the three corners of each triangle in one row.
    """

def validate_regular(
    points: NDArray[np.float64],
    weights: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
) -> tuple[Faults, NDArray[np.int32]]:
    """The same of a regular triangulation; also, for each row, the one that represents it."""

def volumes2(
    surface: _Sheet,
    other: _Sheet | None,
    plane: Sequence[float],
    region: _Sheet | None,
    workers: int,
) -> list[NDArray[np.float64]]:
    """For each triangle of a surface: the volumes below it and above it up to another
    surface or to the plane z = c + a x + b y, the areas of both, and the area of the
    overlap.
    """

def voronoi2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    workers: int,
) -> Diagram2:
    """The diagram of a triangulation; with weights, of the regular triangulation."""

def voronoi3(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    workers: int,
) -> Diagram3:
    """The diagram of a triangulation; with weights, of the regular triangulation."""

def voronoi_clip2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    diagram: Diagram2,
    bounds: Sequence[float],
    workers: int,
) -> ClippedCells2:
    """The cells of a diagram, clipped to a box."""

def voronoi_clip3(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    diagram: Diagram3,
    clip_points: NDArray[np.float64],
    clip_starts: NDArray[np.int32],
    clip_corners: NDArray[np.int32],
    clip_planes: NDArray[np.float64],
    workers: int,
) -> ClippedCells3:
    """The cells of a diagram, clipped to a convex polyhedron given by corners, faces
    (counter-clockwise from outside, as compressed rows) and the planes n . x <= c of
    the faces.
    """

def within2(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    own: int,
    bounds: Sequence[float],
    workers: int,
) -> NDArray[np.bool_]:
    """Which triangles have their corners among the first `own` points and their disks in a
    box.
    """
