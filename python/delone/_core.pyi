"""The compiled core. All arrays are C-contiguous; inputs must have the dtypes given here."""

from collections.abc import Callable
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
    "DeepestPoints",
    "Diagram2",
    "Diagram3",
    "FacePairs",
    "Faults2",
    "Faults3",
    "FlippedTriangulation",
    "Hull3",
    "ImprovedMesh",
    "ImprovementCounts",
    "JudgedTriangles",
    "Live2",
    "Live3",
    "LiveArrays2",
    "LiveArrays3",
    "LiveSegments2",
    "LiveState2",
    "LiveState3",
    "Location2",
    "Location3",
    "Locator2",
    "Locator3",
    "NaturalWeights",
    "PeriodicFaults",
    "PeriodicTriangulation",
    "RecoveredFaces",
    "RecoveryCounts",
    "RefinedMesh",
    "Refinement2",
    "RegularFaults2",
    "RegularFaults3",
    "RegularTriangulation",
    "SharedCells",
    "SmoothedMesh",
    "SphereDual",
    "SphereLocator",
    "SphereTriangulation",
    "SphereWeights",
    "Triangulation",
    "WeightRows",
    "__version__",
    "alpha_counts2",
    "alpha_counts3",
    "alpha_edges2",
    "alpha_edges3",
    "alpha_flat2",
    "alpha_flat3",
    "alpha_labels2",
    "alpha_labels3",
    "alpha_rings2",
    "alpha_solid3",
    "alpha_torus2",
    "alpha_vertices2",
    "alpha_vertices3",
    "antipodes2",
    "antipodes3",
    "areas2",
    "around",
    "below2",
    "check_surface3",
    "circumcenters2",
    "circumcenters3",
    "combine2",
    "components2",
    "components_beside2",
    "components_inside2",
    "condensed2",
    "condensed3",
    "constrained2",
    "contour_bands2",
    "contour_lines2",
    "deepest2",
    "density2",
    "density3",
    "dig2",
    "dig3",
    "dihedral_angles3",
    "disks2",
    "edges2",
    "edges3",
    "face_areas3",
    "face_normals3",
    "faces3",
    "facet_neighbors",
    "facet_rows",
    "fault2",
    "fault3",
    "find_simplex2",
    "gradients_global2",
    "gradients_local2",
    "gradients_local3",
    "graph_components",
    "hull2",
    "hull3",
    "improve3",
    "incircle",
    "influence2",
    "influence3",
    "insphere",
    "judge2",
    "knn2",
    "knn3",
    "lawson2",
    "linkage2",
    "linkage3",
    "measures2",
    "measures3",
    "methods2",
    "neighbors2",
    "not_longer2",
    "not_longer3",
    "numbered_components",
    "odd_pairs2",
    "of_triangles2",
    "orient2d",
    "orient3d",
    "periodic2",
    "periodic_centers2",
    "pieces2",
    "polygon2",
    "proximity2",
    "proximity3",
    "qualities2",
    "qualities3",
    "recover_faces",
    "refine2",
    "regular2",
    "regular3",
    "resolve_touches3",
    "ring2",
    "smooth2",
    "spanning2",
    "spanning3",
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
    "transforms2",
    "transforms3",
    "triangulate2",
    "triangulate3",
    "validate2",
    "validate3",
    "validate_periodic2",
    "validate_regular2",
    "validate_regular3",
    "volumes2",
    "volumes3",
    "voronoi2",
    "voronoi3",
    "voronoi_clip2",
    "voronoi_clip3",
    "within2",
]

__version__: Final[str]

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
class Faults2:
    """Faults of a 2-D triangulation; arrays are empty if there are none."""

    @property
    def orientation(self) -> NDArray[np.int32]:
        """Triangles that are not counter-clockwise, (k,)."""
    @property
    def edges(self) -> NDArray[np.int32]:
        """Directed edges that more than one triangle uses, (k, 2)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """Triangles whose row of neighbors is wrong, (k,)."""
    @property
    def hull(self) -> NDArray[np.int32]:
        """Boundary edges that are not on the hull, (k, 2)."""
    @property
    def missing(self) -> NDArray[np.int32]:
        """Rows of distinct points that no triangle uses, (k,)."""
    @property
    def repeats(self) -> NDArray[np.int32]:
        """Rows that are used although an earlier row has the same coordinates, (k,)."""
    @property
    def delaunay(self) -> NDArray[np.int32]:
        """Pairs of triangles that are not locally Delaunay, (k, 2)."""
    @property
    def ties(self) -> NDArray[np.int32]:
        """Pairs of cocircular triangles that are not canonical, (k, 2)."""
    @property
    def count(self) -> NDArray[np.int32]:
        """Numbers of triangles expected and found, (2,), if they differ; otherwise (0,)."""

@final
class Faults3:
    """Faults of a 3-D triangulation; arrays are empty if there are none."""

    @property
    def orientation(self) -> NDArray[np.int32]:
        """Tetrahedra that are not positively oriented, (k,)."""
    @property
    def facets(self) -> NDArray[np.int32]:
        """Oriented faces that more than one tetrahedron has, (k, 3)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """Tetrahedra whose row of neighbors is wrong, (k,)."""
    @property
    def hull(self) -> NDArray[np.int32]:
        """Boundary faces that are not on the hull, (k, 3)."""
    @property
    def missing(self) -> NDArray[np.int32]:
        """Rows of distinct points that no tetrahedron uses, (k,)."""
    @property
    def repeats(self) -> NDArray[np.int32]:
        """Rows that are used although an earlier row has the same coordinates, (k,)."""
    @property
    def delaunay(self) -> NDArray[np.int32]:
        """Pairs of tetrahedra that are not locally Delaunay, (k, 2)."""
    @property
    def ties(self) -> NDArray[np.int32]:
        """Pairs of cospherical tetrahedra that are not canonical, (k, 2)."""

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
class RegularFaults2:
    """What is wrong with a 2-D regular triangulation."""

    @property
    def faults(self) -> Faults2:
        """Faults as without weights; `missing` has points outside all triangles."""
    @property
    def hidden(self) -> NDArray[np.int32]:
        """Rows that should be vertices though triangles cover them, (k,)."""
    @property
    def stands_for(self) -> NDArray[np.int32]:
        """The row that stands for each point, (n,)."""

@final
class RegularFaults3:
    """What is wrong with a 3-D regular triangulation."""

    @property
    def faults(self) -> Faults3:
        """Faults as without weights; `missing` has points outside all tetrahedra."""
    @property
    def hidden(self) -> NDArray[np.int32]:
        """Rows that should be vertices though tetrahedra cover them, (k,)."""
    @property
    def stands_for(self) -> NDArray[np.int32]:
        """The row that stands for each point, (n,)."""

@final
class PeriodicFaults:
    """What is wrong with a periodic triangulation; arrays are empty where nothing is."""

    @property
    def offsets(self) -> NDArray[np.int32]:
        """Triangles with impossible offsets; if any, nothing else is checked, (k,)."""
    @property
    def orientation(self) -> NDArray[np.int32]:
        """Triangles that are not counter-clockwise, (k,)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """Triangles whose neighbors or partners are wrong, (k,)."""
    @property
    def hull(self) -> NDArray[np.int32]:
        """Edges without a partner that are not on the boundary of the strip, (k, 2)."""
    @property
    def missing(self) -> NDArray[np.int32]:
        """Rows of distinct points that no triangle uses, (k,)."""
    @property
    def repeats(self) -> NDArray[np.int32]:
        """Rows that are used although another row stands for them, (k,)."""
    @property
    def hidden(self) -> NDArray[np.int32]:
        """Rows that should be vertices though triangles cover them, (k,)."""
    @property
    def delaunay(self) -> NDArray[np.int32]:
        """Pairs of triangles that are not locally Delaunay or regular, (k, 2)."""
    @property
    def ties(self) -> NDArray[np.int32]:
        """Pairs of triangles on a tie that are not canonical, (k, 2)."""
    @property
    def count(self) -> NDArray[np.int32]:
        """Numbers of triangles expected and found, (2,), where they differ; else (0,)."""
    @property
    def layers(self) -> NDArray[np.int32]:
        """How often the triangles cover the plane, (1,), if not once; else (0,)."""

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
        """Vertices of all facets, one facet after the other, (k,)."""
    @property
    def starts(self) -> NDArray[np.int32]:
        """Start of the vertices of each facet, and the end, (f + 1,)."""
    @property
    def duplicates(self) -> NDArray[np.int32]:
        """Rows that repeat earlier rows, and the first of these, (d, 2)."""

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
        """Start of the rows of each subsegment in `source`, and the end, (q + 1,)."""
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
    ) -> ConstrainedTriangulation:
        """Check the shapes of the arrays."""
    def arrays(self) -> tuple[NDArray[np.generic], ...]:
        """All arrays, in the order of the arguments of the constructor."""
    def __getnewargs__(self) -> tuple[NDArray[np.generic], ...]:
        """The arguments for unpickling."""

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
        """The label of each triangle, -1 outside of the domain, (m,)."""
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
        """A domain (points, simplices, neighbors, labels, segments, frozen), lines, and samples."""
    def fresh(self, workers: int) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
        """The centers, (k, 2), and labels, (k,), of triangles that are new since the last call."""
    def comply(self, wanted: NDArray[np.float64]) -> bool:
        """Set the areas wanted at these centers; return whether all triangles comply."""
    def refine(
        self, max_vertices: int, progress: Callable[[int, float], object] | None
    ) -> tuple[bool, int]:
        """One round; return whether the limit was enough, and the vertices added in all rounds."""
    def export(self) -> RefinedMesh:
        """The triangulation, with the vertices of all rounds."""

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
    def weights(self) -> int:
        """Weights assigned."""
    @property
    def passes(self) -> int:
        """Passes."""
    @property
    def refused(self) -> int:
        """Changes rejected."""

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
    def counts(self) -> ImprovementCounts:
        """Numbers of changes."""
    @property
    def exhausted(self) -> bool:
        """Whether the limit on passes was reached while passes still made progress."""

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
    ) -> Diagram2:
        """Check the shapes of the arrays."""
    def arrays(self) -> tuple[NDArray[np.generic], ...]:
        """All arrays, in the order of the arguments of the constructor."""
    def __getnewargs__(self) -> tuple[NDArray[np.generic], ...]:
        """The arguments for unpickling."""

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
        """The ridge along the edge that starts at each corner, or -1, (p,)."""

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
        """A vertex, or ~i for ray i, at both ends of an open ridge."""
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
    ) -> Diagram3:
        """Check the shapes of the arrays."""
    def arrays(self) -> tuple[NDArray[np.generic], ...]:
        """All arrays, in the order of the arguments of the constructor."""
    def __getnewargs__(self) -> tuple[NDArray[np.generic], ...]:
        """The arguments for unpickling."""

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
        """Corners of faces, as rows of `points`, counter-clockwise from outside."""
    @property
    def labels(self) -> NDArray[np.int32]:
        """The ridge of each face, negative for a face of the polyhedron, (f,)."""

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
        """Outside, the tetrahedron at the nearest boundary point; else -1, (q,)."""
    @property
    def face(self) -> NDArray[np.int32]:
        """Outside, the boundary face with that point; else -1, (q, 3)."""
    @property
    def shares(self) -> NDArray[np.float64]:
        """Outside, the weights of its corners; else NaN, (q, 3)."""

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

class _Sheet(Protocol):
    """A triangulation and the heights of its points."""

    @property
    def points(self) -> NDArray[np.float64]: ...
    @property
    def simplices(self) -> NDArray[np.int32]: ...
    @property
    def neighbors(self) -> NDArray[np.int32]: ...
    @property
    def heights(self) -> NDArray[np.float64]: ...

def contour_lines2(
    surface: _Sheet,
    levels: NDArray[np.float64],
    limit: int,
    collapsed: NDArray[np.bool_],
    far: bool,
) -> ContourLines: ...
def contour_bands2(
    surface: _Sheet,
    levels: NDArray[np.float64],
    limit: int,
    collapsed: NDArray[np.bool_],
    far: bool,
) -> ContourBands: ...
def volumes2(
    surface: _Sheet,
    other: _Sheet | None,
    plane: list[float],
    region: _Sheet | None,
    workers: int,
) -> tuple[
    NDArray[np.float64],
    NDArray[np.float64],
    NDArray[np.float64],
    NDArray[np.float64],
    NDArray[np.float64],
]: ...
def methods2() -> list[str]: ...
def triangulate2(points: NDArray[np.float64], method: str, workers: int) -> Triangulation: ...
def validate2(
    points: NDArray[np.float64], simplices: NDArray[np.int32], neighbors: NDArray[np.int32]
) -> Faults2: ...
def triangulate3(points: NDArray[np.float64], workers: int) -> Triangulation: ...
def validate3(
    points: NDArray[np.float64], simplices: NDArray[np.int32], neighbors: NDArray[np.int32]
) -> Faults3: ...
def validate_regular2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
) -> RegularFaults2: ...
def validate_regular3(
    points: NDArray[np.float64],
    weights: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
) -> RegularFaults3: ...
def validate_periodic2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    periods: tuple[float, float],
    simplices: NDArray[np.int32],
    offsets: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    partners: NDArray[np.int32],
) -> PeriodicFaults: ...
def fault2(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    workers: int,
) -> tuple[str, int] | None: ...
def fault3(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    workers: int,
) -> tuple[str, int] | None: ...

_Tiling = tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int32]]
_Adjacency = tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]

def graph_components(edges: NDArray[np.int32], npoints: int) -> NDArray[np.int32]: ...
def proximity2(
    graph: _Adjacency, name: str, beta: float, closed: bool, workers: int
) -> NDArray[np.int32]: ...
def antipodes2(
    graph: _Adjacency,
    simplices: NDArray[np.int32] | None,
    neighbors: NDArray[np.int32] | None,
    workers: int,
) -> NDArray[np.int32]: ...
def spanning2(graph: _Adjacency, workers: int) -> NDArray[np.int32]: ...
def knn2(
    points: NDArray[np.float64], k: int, directed: bool, workers: int
) -> tuple[NDArray[np.int32], NDArray[np.int32]]: ...
def influence2(
    points: NDArray[np.float64], closed: bool, workers: int
) -> tuple[NDArray[np.int32], NDArray[np.int32]]: ...
def not_longer2(
    points: NDArray[np.float64],
    edges: NDArray[np.int32],
    ends: NDArray[np.float64],
    workers: int,
) -> NDArray[np.int32]: ...
def proximity3(
    graph: _Adjacency, name: str, beta: float, closed: bool, workers: int
) -> NDArray[np.int32]: ...
def antipodes3(
    graph: _Adjacency,
    simplices: NDArray[np.int32] | None,
    neighbors: NDArray[np.int32] | None,
    workers: int,
) -> NDArray[np.int32]: ...
def spanning3(graph: _Adjacency, workers: int) -> NDArray[np.int32]: ...
def knn3(
    points: NDArray[np.float64], k: int, directed: bool, workers: int
) -> tuple[NDArray[np.int32], NDArray[np.int32]]: ...
def influence3(
    points: NDArray[np.float64], closed: bool, workers: int
) -> tuple[NDArray[np.int32], NDArray[np.int32]]: ...
def not_longer3(
    points: NDArray[np.float64],
    edges: NDArray[np.int32],
    ends: NDArray[np.float64],
    workers: int,
) -> NDArray[np.int32]: ...
def spanning_triangles2(tiling: _Tiling, workers: int) -> NDArray[np.int32]: ...
def of_triangles2(
    tiling: _Tiling, name: str, beta: float, closed: bool, workers: int
) -> NDArray[np.int32]: ...

_Tower = tuple[
    NDArray[np.int32],
    NDArray[np.int32],
    NDArray[np.int32],
    NDArray[np.int32],
    NDArray[np.int32],
    NDArray[np.int32],
    NDArray[np.float64],
    NDArray[np.float64],
    tuple[int, int],
]

def linkage2(
    points: NDArray[np.float64],
    edges: NDArray[np.int32],
    duplicates: NDArray[np.int32],
    workers: int,
) -> NDArray[np.float64]: ...
def linkage3(
    points: NDArray[np.float64],
    edges: NDArray[np.int32],
    duplicates: NDArray[np.int32],
    workers: int,
) -> NDArray[np.float64]: ...
def condensed2(
    points: NDArray[np.float64], k: int, least: int, number: float, workers: int
) -> _Tower: ...
def condensed3(
    points: NDArray[np.float64], k: int, least: int, number: float, workers: int
) -> _Tower: ...
def density2(
    points: NDArray[np.float64], eps: float, k: int, workers: int
) -> tuple[NDArray[np.int32], NDArray[np.bool_]]: ...
def density3(
    points: NDArray[np.float64], eps: float, k: int, workers: int
) -> tuple[NDArray[np.int32], NDArray[np.bool_]]: ...

_Valued = tuple[NDArray[np.int32], NDArray[np.float64]]

def alpha_flat2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    workers: int,
) -> tuple[NDArray[np.float64], _Valued]: ...
def alpha_edges2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    edges: NDArray[np.int32],
    workers: int,
) -> NDArray[np.float64]: ...
def alpha_vertices2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    edges: NDArray[np.int32],
    values: NDArray[np.float64],
) -> NDArray[np.float64]: ...
def alpha_counts2(
    order: NDArray[np.int32], neighbors: NDArray[np.int32], outside: bool
) -> NDArray[np.int32]: ...
def alpha_labels2(kept: NDArray[np.bool_], neighbors: NDArray[np.int32]) -> NDArray[np.int32]: ...
def alpha_flat3(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    workers: int,
) -> tuple[NDArray[np.float64], _Valued]: ...
def alpha_edges3(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    edges: NDArray[np.int32],
    workers: int,
) -> NDArray[np.float64]: ...
def alpha_vertices3(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    edges: NDArray[np.int32],
    values: NDArray[np.float64],
) -> NDArray[np.float64]: ...
def alpha_counts3(
    order: NDArray[np.int32], neighbors: NDArray[np.int32], outside: bool
) -> NDArray[np.int32]: ...
def alpha_labels3(kept: NDArray[np.bool_], neighbors: NDArray[np.int32]) -> NDArray[np.int32]: ...
def alpha_solid3(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    workers: int,
) -> tuple[NDArray[np.float64], _Valued, _Valued]: ...
def alpha_torus2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    periods: tuple[float, float],
    simplices: NDArray[np.int32],
    offsets: NDArray[np.int32],
    partners: NDArray[np.int32],
    workers: int,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int32]]: ...
def alpha_rings2(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    labels: NDArray[np.int32],
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32], NDArray[np.bool_]]: ...
def dig2(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    name: str,
    value: float,
    holes: bool,
) -> NDArray[np.bool_]: ...
def dig3(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    name: str,
    value: float,
) -> NDArray[np.bool_]: ...
def around(
    edges: NDArray[np.int32], npoints: int
) -> tuple[NDArray[np.int32], NDArray[np.int32]]: ...
def edges2(
    simplices: NDArray[np.int32], neighbors: NDArray[np.int32], npoints: int, workers: int
) -> NDArray[np.int32]: ...
def edges3(simplices: NDArray[np.int32], npoints: int, workers: int) -> NDArray[np.int32]: ...
def faces3(
    simplices: NDArray[np.int32], neighbors: NDArray[np.int32], npoints: int, workers: int
) -> NDArray[np.int32]: ...
def below2(
    points: NDArray[np.float64], simplices: NDArray[np.int32], squared_cosine: float, workers: int
) -> NDArray[np.int32]: ...
def areas2(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]: ...
def volumes3(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]: ...
def face_areas3(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]: ...
def face_normals3(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]: ...
def circumcenters2(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]: ...
def circumcenters3(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]: ...
def qualities2(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> list[NDArray[np.float64]]: ...
def qualities3(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> list[NDArray[np.float64]]: ...
def dihedral_angles3(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]: ...
def transforms2(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]: ...
def transforms3(
    points: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]: ...
def find_simplex2(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    xi: NDArray[np.float64],
    workers: int,
) -> NDArray[np.int32]: ...
def constrained2(
    points: NDArray[np.float64],
    segments: NDArray[np.int32],
    split: bool,
    conforming: bool,
    max_vertices: int,
    method: str,
    workers: int,
) -> tuple[ConstrainedTriangulation, tuple[tuple[str, float], ...]]: ...
def components2(
    neighbors: NDArray[np.int32], constrained: NDArray[np.bool_]
) -> NDArray[np.int32]: ...
def numbered_components(
    points: NDArray[np.float64], simplices: NDArray[np.int32], component: NDArray[np.int32]
) -> NDArray[np.int32]: ...

_Parts = tuple[
    NDArray[np.int32],
    NDArray[np.int32],
    NDArray[np.bool_],
    NDArray[np.int32],
    NDArray[np.int32],
]
_Covers = tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int32]]

def components_beside2(parts: _Parts) -> NDArray[np.int32]: ...
def components_inside2(parts: _Parts, covers: _Covers, first: int) -> NDArray[np.int32]: ...
def odd_pairs2(covers: _Covers) -> NDArray[np.int32]: ...
def facet_rows(
    facets: NDArray[np.int32], wanted: NDArray[np.int32], npoints: int, directed: bool
) -> NDArray[np.int32]: ...
def facet_neighbors(simplices: NDArray[np.int32], npoints: int) -> NDArray[np.int32]: ...
def polygon2(
    points: NDArray[np.float64], starts: NDArray[np.int32], nonzero: bool
) -> tuple[NDArray[np.float64], NDArray[np.int32]]: ...
def ring2(points: object) -> tuple[NDArray[np.float64], NDArray[np.int32]] | None: ...
def disks2(points: NDArray[np.float64], simplices: NDArray[np.int32]) -> NDArray[np.float64]: ...
def within2(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    own: int,
    bounds: tuple[float, float, float, float],
    workers: int,
) -> NDArray[np.bool_]: ...
def deepest2(
    points: NDArray[np.float64], corners: NDArray[np.float64], most: int, workers: int
) -> DeepestPoints: ...

@final
class Live2:
    """A 2-D Delaunay triangulation that is edited."""

    def __new__(
        cls,
        points: NDArray[np.float64],
        handles: NDArray[np.int64] | None,
        total: int,
        workers: int,
    ) -> Live2: ...
    def counts(self) -> list[int]: ...
    @property
    def edits(self) -> int:
        """How many edits are complete."""
    def insert(self, points: NDArray[np.float64], workers: int) -> NDArray[np.int64]: ...
    def remove(self, handles: NDArray[np.int64], workers: int) -> None: ...
    def remove_with_segments(
        self, handles: NDArray[np.int64], workers: int
    ) -> NDArray[np.int64]: ...
    def relocate(
        self, handles: NDArray[np.int64], points: NDArray[np.float64], workers: int
    ) -> None: ...
    def faults(self, handles: NDArray[np.int64]) -> list[NDArray[np.int64]]: ...
    def points(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]: ...
    def arrays(self) -> LiveArrays2: ...
    def corners(self, xi: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.float64]]: ...
    def weights(
        self, xi: NDArray[np.float64], known: int
    ) -> tuple[NDArray[np.int64], NDArray[np.float64], int, NDArray[np.int64] | None]: ...
    def nearest(self, xi: NDArray[np.float64]) -> NDArray[np.int64]: ...
    def changes(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]: ...
    def state(self) -> LiveState2: ...
    def restore(self, state: LiveState2, known: int | None = None) -> bool: ...
    def split_crossings(self, split: bool) -> None: ...
    def constraints(self) -> list[bool]: ...
    def insert_segments(self, ends: NDArray[np.int64], workers: int) -> NDArray[np.int64]: ...
    def remove_segments(self, handles: NDArray[np.int64], workers: int) -> None: ...
    def adopt_segments(
        self,
        known: tuple[NDArray[np.int64], NDArray[np.int64]],
        total: int,
        crossings: tuple[NDArray[np.int64], NDArray[np.float64]],
        workers: int,
    ) -> None: ...
    def segments(self) -> LiveSegments2: ...
    def segment_faults(self, handles: NDArray[np.int64]) -> list[NDArray[np.int64]]: ...
    def held(self, handles: NDArray[np.int64]) -> NDArray[np.int64]: ...

@final
class LiveSegments2:
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
class LiveArrays2:
    """The present triangulation."""

    @property
    def handles(self) -> NDArray[np.int64]:
        """The handles of the points, ascending, (n,)."""
    @property
    def points(self) -> NDArray[np.float64]:
        """The points, (n, 2)."""
    @property
    def simplices(self) -> NDArray[np.int32]:
        """Triangles as rows of these, (m, 3)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The triangle opposite each vertex, -1 outside, (m, 3)."""
    @property
    def constrained(self) -> NDArray[np.bool_] | None:
        """Whether the edge opposite each vertex is part of a segment; None without segments."""
    @property
    def duplicates(self) -> NDArray[np.int32]:
        """Rows that repeat earlier rows, and the first of these, (k, 2)."""

@final
class LiveState2:
    """A state of a `Live2`, which never changes."""

    def open(self) -> Live2: ...
    def own_bytes(self, other: LiveState2) -> int: ...

@final
class Live3:
    """A 3-D Delaunay triangulation that is edited."""

    def __new__(
        cls,
        points: NDArray[np.float64],
        handles: NDArray[np.int64] | None,
        total: int,
        workers: int,
    ) -> Live3: ...
    def counts(self) -> list[int]: ...
    @property
    def edits(self) -> int:
        """How many edits are complete."""
    def insert(self, points: NDArray[np.float64], workers: int) -> NDArray[np.int64]: ...
    def remove(self, handles: NDArray[np.int64], workers: int) -> None: ...
    def relocate(
        self, handles: NDArray[np.int64], points: NDArray[np.float64], workers: int
    ) -> None: ...
    def faults(self, handles: NDArray[np.int64]) -> list[NDArray[np.int64]]: ...
    def points(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]: ...
    def arrays(self) -> LiveArrays3: ...
    def corners(self, xi: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.float64]]: ...
    def weights(
        self, xi: NDArray[np.float64], known: int
    ) -> tuple[NDArray[np.int64], NDArray[np.float64], int, NDArray[np.int64] | None]: ...
    def nearest(self, xi: NDArray[np.float64]) -> NDArray[np.int64]: ...
    def changes(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]: ...
    def state(self) -> LiveState3: ...
    def restore(self, state: LiveState3, known: int | None = None) -> bool: ...

@final
class LiveArrays3:
    """The present triangulation."""

    @property
    def handles(self) -> NDArray[np.int64]:
        """The handles of the points, ascending, (n,)."""
    @property
    def points(self) -> NDArray[np.float64]:
        """The points, (n, 3)."""
    @property
    def simplices(self) -> NDArray[np.int32]:
        """Tetrahedra as rows of these, (m, 4)."""
    @property
    def neighbors(self) -> NDArray[np.int32]:
        """The tetrahedron opposite each vertex, -1 outside, (m, 4)."""
    @property
    def duplicates(self) -> NDArray[np.int32]:
        """Rows that repeat earlier rows, and the first of these, (k, 2)."""

@final
class LiveState3:
    """A state of a `Live3`, which never changes."""

    def open(self) -> Live3: ...
    def own_bytes(self, other: LiveState3) -> int: ...

@final
class Locator2:
    def __new__(
        cls,
        points: NDArray[np.float64],
        simplices: NDArray[np.int32],
        neighbors: NDArray[np.int32],
    ) -> Locator2: ...
    def find(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.int32]: ...
    def locate(self, xi: NDArray[np.float64], workers: int) -> Location2: ...
    def nearest(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.int32]: ...
    def along(self, a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.int32]: ...
    def linear(
        self, values: NDArray[np.float64], xi: NDArray[np.float64], order: int, workers: int
    ) -> NDArray[np.float64]: ...
    def clough_tocher(
        self,
        values: NDArray[np.float64],
        gradients: NDArray[np.float64],
        xi: NDArray[np.float64],
        barrier: NDArray[np.bool_] | None,
        order: int,
        workers: int,
    ) -> NDArray[np.float64]: ...
    def clough_tocher_weights(
        self, xi: NDArray[np.float64], barrier: NDArray[np.bool_] | None, workers: int
    ) -> CornerWeights: ...
    def natural(
        self,
        kind: str,
        xi: NDArray[np.float64],
        barrier: NDArray[np.bool_] | None,
        workers: int,
    ) -> NaturalWeights: ...
    def natural_values(
        self,
        kind: str,
        values: NDArray[np.float64],
        gradients: NDArray[np.float64] | None,
        xi: NDArray[np.float64],
        barrier: NDArray[np.bool_] | None,
        order: int,
        workers: int,
    ) -> NDArray[np.float64]: ...
    def leave_one_out(self, kind: str, workers: int) -> WeightRows: ...

def hull2(points: NDArray[np.float64]) -> tuple[NDArray[np.int32], NDArray[np.int32]]: ...
def hull3(points: NDArray[np.float64]) -> Hull3 | None: ...

@final
class Locator3:
    def __new__(
        cls,
        points: NDArray[np.float64],
        simplices: NDArray[np.int32],
        neighbors: NDArray[np.int32],
    ) -> Locator3: ...
    def find(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.int32]: ...
    def within(
        self, xi: NDArray[np.float64], workers: int
    ) -> tuple[NDArray[np.int32], NDArray[np.float64]]: ...
    def locate(self, xi: NDArray[np.float64], workers: int) -> Location3: ...
    def laplace(self, xi: NDArray[np.float64], workers: int) -> NaturalWeights: ...
    def nearest(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.int32]: ...

@final
class CheckedCells:
    """What is known of each cell of a grid."""

    @property
    def areas(self) -> NDArray[np.float64]:
        """Areas in steradians, 0 of cells that have none, (n,)."""
    @property
    def faults(self) -> NDArray[np.uint8]:
        """0, 1 empty, 2 opposite ends of a side, 3 beyond a hemisphere, 4 crossing sides, (n,)."""
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
        """Areas in steradians, (k,)."""
    @property
    def first(self) -> NDArray[np.float64]:
        """Sums over the cells of the first grid, (n,)."""
    @property
    def second(self) -> NDArray[np.float64]:
        """Sums over the cells of the second grid, (m,)."""

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
        """Cells with arcs of great circles as sides.

        They have corners, starts of rings in these, starts of cells in rings, and whether rings
        are holes.
        """
    @staticmethod
    def rows(
        tangents: NDArray[np.float64],
        starts: NDArray[np.int64],
        meridians: NDArray[np.float64],
        numbers: NDArray[np.int32],
        count: int,
    ) -> CellGrid:
        """Cells between meridians and parallels, by rows.

        They have tangents of latitudes, starts of rows in meridians, directions of these, the
        number of the cell east of each or -1, and a count.
        """
    def check(self, crossing: bool, workers: int) -> CheckedCells:
        """Areas and faults; sides that cross are looked for if `crossing`."""
    def overlaps(self, other: CellGrid, workers: int) -> SharedCells:
        """What the cells share with those of another grid; cells with faults share nothing."""

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
        """Derivatives towards east and north, per radian, (k, 2); None if not wanted."""

@final
class SphereLocator:
    def __new__(
        cls,
        vectors: NDArray[np.float64],
        simplices: NDArray[np.int32],
        neighbors: NDArray[np.int32],
        workers: int,
    ) -> SphereLocator: ...
    def weights(
        self,
        kind: str,
        xi: NDArray[np.float64],
        simplex: NDArray[np.int32],
        sloped: bool,
        workers: int,
    ) -> SphereWeights: ...
    def find(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.int32]: ...
    def nearest(self, xi: NDArray[np.float64], workers: int) -> NDArray[np.int32]: ...

def sphere_delaunay(vectors: NDArray[np.float64], workers: int) -> SphereTriangulation: ...
def sphere_constrained(
    vectors: NDArray[np.float64], segments: NDArray[np.int32], workers: int
) -> ConstrainedTriangulation: ...
def sphere_directions(
    lonlat: NDArray[np.float64], degrees: bool, workers: int
) -> NDArray[np.float64]: ...
def sphere_units(vectors: NDArray[np.float64], workers: int) -> NDArray[np.float64]: ...
def sphere_areas(
    vectors: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]: ...
def sphere_circumcenters(
    vectors: NDArray[np.float64], simplices: NDArray[np.int32], workers: int
) -> NDArray[np.float64]: ...
def sphere_dual(
    vectors: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    merged: bool,
    workers: int,
) -> SphereDual: ...
def sphere_spans(
    vectors: NDArray[np.float64], around: NDArray[np.int32], workers: int
) -> NDArray[np.float64]: ...
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
) -> RefinedMesh: ...
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
) -> SmoothedMesh: ...
def judge2(
    points: NDArray[np.float64], simplices: NDArray[np.int32], cos2: float
) -> JudgedTriangles: ...
def check_surface3(
    points: NDArray[np.float64], faces: NDArray[np.int32], limit: int, workers: int
) -> CheckedSurface: ...
def resolve_touches3(
    points: NDArray[np.float64], faces: NDArray[np.int32], limit: int, workers: int
) -> tuple[tuple[NDArray[np.int32], NDArray[np.int32]] | None, FacePairs]: ...

@final
class RecoveryCounts:
    """What happened during a recovery of faces."""

    @property
    def missing_edges(self) -> int: ...
    @property
    def missing_faces(self) -> int: ...
    @property
    def flips(self) -> int: ...
    @property
    def flipped_edges(self) -> int: ...
    @property
    def flipped_faces(self) -> int: ...
    @property
    def segment_points(self) -> int: ...
    @property
    def face_points(self) -> int: ...
    @property
    def suppressed(self) -> int: ...
    @property
    def joined(self) -> int: ...
    @property
    def thinned(self) -> int: ...

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
    def nadded(self) -> int:
        """How many points were added."""
    @property
    def counts(self) -> RecoveryCounts:
        """What happened."""
    @property
    def crowded(self) -> NDArray[np.int32]:
        """Rows of faces near which no double is left for a point; then there are no tetrahedra."""

def recover_faces(
    points: NDArray[np.float64],
    faces: NDArray[np.int32],
    max_points: int,
    flips: bool,
    workers: int,
) -> RecoveredFaces: ...
def improve3(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    labels: NDArray[np.int32],
    fixed: NDArray[np.bool_],
    min_angle: float,
    flips: bool,
    smooth: bool,
    exude: bool,
    turn: bool,
    passes: int,
    progress: Callable[[int, int], object] | None = None,
) -> ImprovedMesh: ...
def combine2(
    indptr: NDArray[np.int64],
    indices: NDArray[np.int32],
    weights: NDArray[np.float64],
    values: NDArray[np.float64],
    slopes: NDArray[np.float64] | None,
    gradients: NDArray[np.float64] | None,
    workers: int,
) -> NDArray[np.float64]: ...
def gradients_global2(
    points: NDArray[np.float64],
    indptr: NDArray[np.int32],
    indices: NDArray[np.int32],
    values: NDArray[np.float64],
    tol: float,
    maxiter: int,
    workers: int,
    floor: float | None = None,
) -> tuple[NDArray[np.float64], NDArray[np.int64]]: ...
def gradients_local2(
    points: NDArray[np.float64],
    indptr: NDArray[np.int32],
    indices: NDArray[np.int32],
    values: NDArray[np.float64],
    degree: int,
    workers: int,
) -> NDArray[np.float64]: ...
def gradients_local3(
    points: NDArray[np.float64],
    indptr: NDArray[np.int32],
    indices: NDArray[np.int32],
    values: NDArray[np.float64],
    vertices: NDArray[np.int32],
    workers: int,
) -> NDArray[np.float64]: ...
def lawson2(
    points: NDArray[np.float64], simplices: NDArray[np.int32], record: bool
) -> FlippedTriangulation: ...
def neighbors2(simplices: NDArray[np.int32], npoints: int) -> NDArray[np.int32]: ...
def orient2d(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]
) -> NDArray[np.int8]: ...
def incircle(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    c: NDArray[np.float64],
    d: NDArray[np.float64],
    canonical: bool,
) -> NDArray[np.int8]: ...
def orient3d(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    c: NDArray[np.float64],
    d: NDArray[np.float64],
) -> NDArray[np.int8]: ...
def insphere(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    c: NDArray[np.float64],
    d: NDArray[np.float64],
    e: NDArray[np.float64],
    canonical: bool,
) -> NDArray[np.int8]: ...
def voronoi2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    workers: int,
) -> Diagram2: ...
def voronoi_clip2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    diagram: Diagram2,
    bounds: tuple[float, float, float, float],
    workers: int,
) -> ClippedCells2: ...
def voronoi3(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    workers: int,
) -> Diagram3: ...
def voronoi_clip3(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    diagram: Diagram3,
    clip_points: NDArray[np.float64],
    clip_starts: NDArray[np.int32],
    clip_corners: NDArray[np.int32],
    clip_planes: NDArray[np.float64],
    workers: int,
) -> ClippedCells3: ...
def measures3(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    diagram: Diagram3,
    workers: int,
) -> CellMeasures3: ...
def regular3(
    points: NDArray[np.float64], weights: NDArray[np.float64], workers: int
) -> RegularTriangulation: ...
def measures2(
    starts: NDArray[np.int32], corners: NDArray[np.float64], workers: int
) -> CellMeasures2: ...
def touched2(
    starts: NDArray[np.int32],
    corners: NDArray[np.float64],
    ridges: NDArray[np.int32],
    segments: NDArray[np.float64],
) -> tuple[NDArray[np.int32], int]: ...
def pieces2(
    starts: NDArray[np.int32],
    corners: NDArray[np.float64],
    ridges: NDArray[np.int32],
    rows: NDArray[np.int32],
    inside: NDArray[np.bool_],
    rings: NDArray[np.int32],
    outline: NDArray[np.float64],
    workers: int,
) -> CellPieces2: ...
def regular2(
    points: NDArray[np.float64], weights: NDArray[np.float64], workers: int
) -> RegularTriangulation: ...
def periodic2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    periods: tuple[float, float],
    workers: int,
) -> PeriodicTriangulation: ...
def periodic_centers2(
    points: NDArray[np.float64],
    weights: NDArray[np.float64] | None,
    periods: tuple[float, float],
    corners: NDArray[np.int32],
    apexes: NDArray[np.int32],
    workers: int,
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]: ...
