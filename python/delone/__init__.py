"""Exact, canonical and fast Delaunay triangulation.

>>> from delone import Delaunay
>>> Delaunay([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)])
<Delaunay of 5 points: 4 triangles>

`Delaunay` triangulates 2-D or 3-D points; `ConstrainedDelaunay` and `from_geometry` also take
segments and polygons. `mesh` and `improve` create triangles and tetrahedra of good quality,
`tetrahedralize` fills closed surfaces with tetrahedra. Related
structures are `Voronoi`, `ConvexHull`, `RegularTriangulation` and `PeriodicDelaunay`. The modules
`graphs`, `cluster`, `terrain`, `interpolate`, `distributed`, `io`, `plot`, `predicates`,
`datasets`, `testing`, `reference` and `compat` contain the rest. All errors are subclasses of
`DeloneError`.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

try:
    from delone._core import __version__
except ImportError as error:
    raise ImportError(
        f"the compiled module of delone cannot be loaded ({error}). Install delone for this Python "
        "and platform with pip; it cannot be imported from a zip archive"
    ) from error
from delone import predicates
from delone._base.georeference import CRSWarning, GeographicWarning
from delone._base.units import UnitsWarning
from delone._tiling.higher.thin import NearlyFlatWarning
from delone._tiling.plane.quality import Quality
from delone._tiling.space.quality import TetQuality
from delone.delaunay import Delaunay
from delone.errors import (
    BudgetExceededError,
    BusyError,
    ConflictingValuesError,
    CrossingFacesError,
    CrossingSegmentsError,
    CrowdedFacesError,
    DanglingFacesError,
    DegenerateInputError,
    DeloneError,
    DirectionError,
    DtypeError,
    EditConflictError,
    FileFormatError,
    HandleError,
    InputError,
    InternalError,
    LimitError,
    MissingExtraError,
    NonFiniteError,
    OpenSurfaceError,
    OutputError,
    OutsideError,
    ShapeError,
)
from delone.memory import TooLargeError
from delone.validation import ValidationReport

if TYPE_CHECKING:
    from delone import (
        cluster,
        compat,
        datasets,
        distributed,
        graphs,
        interpolate,
        plot,
        reference,
        sphere,
        terrain,
        testing,
    )
    from delone import io as io
    from delone._tiling.location import Location
    from delone._tiling.space import PlaneTriangulation
    from delone.alpha.concave import concave_hull
    from delone.alpha.filtration import AlphaComplex
    from delone.alpha.shape import AlphaShape, ConcaveHull
    from delone.areal.overlaps import AreaWeights, OverlapReport, Overlaps
    from delone.constrained.delaunay import ConstrainedDelaunay
    from delone.constrained.editing import Editing
    from delone.constrained.polygons import PolygonTriangles, from_geometry, triangulate_polygon
    from delone.constrained.segments import SegmentReport
    from delone.constrained.validation import ConstrainedReport
    from delone.dynamic.dynamic import Dynamic
    from delone.estimation import Estimate, estimate
    from delone.explorer.widget import explore
    from delone.flips import LawsonResult, lawson
    from delone.hull import ConvexHull
    from delone.periodic import PeriodicDelaunay
    from delone.refine.distances import SizeByDistance
    from delone.refine.meshed import Mesh
    from delone.refine.refine import mesh
    from delone.refine.report import MeshReport
    from delone.regular import RegularTriangulation
    from delone.solids.surface.check import check_surface
    from delone.solids.surface.imprint import ImprintedSurface, imprint_surface
    from delone.solids.surface.report import SurfaceCheck
    from delone.solids.surface.resolve import resolve_touches
    from delone.solids.tetmesh.improvement import improve
    from delone.solids.tetmesh.recovery import RecoveryReport
    from delone.solids.tetmesh.refinement import RefinementReport
    from delone.solids.tetmesh.report import ImproveReport
    from delone.solids.tetmesh.tetmesh import TetMesh
    from delone.solids.tetmesh.validation import TetMeshReport
    from delone.solids.tetrahedra.filling import tetrahedralize
    from delone.voronoi.centroidal import LloydResult, lloyd
    from delone.voronoi.diagram import Voronoi

# Without `io`: after a star import, that name would no longer be the standard library's.
__all__ = [
    "AlphaComplex",
    "AlphaShape",
    "AreaWeights",
    "BudgetExceededError",
    "BusyError",
    "CRSWarning",
    "ConcaveHull",
    "ConflictingValuesError",
    "ConstrainedDelaunay",
    "ConstrainedReport",
    "ConvexHull",
    "CrossingFacesError",
    "CrossingSegmentsError",
    "CrowdedFacesError",
    "DanglingFacesError",
    "DegenerateInputError",
    "Delaunay",
    "DeloneError",
    "DirectionError",
    "DtypeError",
    "Dynamic",
    "EditConflictError",
    "Editing",
    "Estimate",
    "FileFormatError",
    "GeographicWarning",
    "HandleError",
    "ImprintedSurface",
    "ImproveReport",
    "InputError",
    "InternalError",
    "LawsonResult",
    "LimitError",
    "LloydResult",
    "Location",
    "Mesh",
    "MeshReport",
    "MissingExtraError",
    "NearlyFlatWarning",
    "NonFiniteError",
    "OpenSurfaceError",
    "OutputError",
    "OutsideError",
    "OverlapReport",
    "Overlaps",
    "PeriodicDelaunay",
    "PlaneTriangulation",
    "PolygonTriangles",
    "Quality",
    "RecoveryReport",
    "RefinementReport",
    "RegularTriangulation",
    "SegmentReport",
    "ShapeError",
    "SizeByDistance",
    "SurfaceCheck",
    "TetMesh",
    "TetMeshReport",
    "TetQuality",
    "TooLargeError",
    "UnitsWarning",
    "ValidationReport",
    "Voronoi",
    "__version__",
    "check_surface",
    "cluster",
    "compat",
    "concave_hull",
    "datasets",
    "distributed",
    "estimate",
    "explore",
    "from_geometry",
    "graphs",
    "imprint_surface",
    "improve",
    "interpolate",
    "lawson",
    "lloyd",
    "mesh",
    "plot",
    "predicates",
    "reference",
    "resolve_touches",
    "sphere",
    "terrain",
    "testing",
    "tetrahedralize",
    "triangulate_polygon",
]

# Imported on first access, because not every program needs them, so that `import delone` is fast:
# modules, and classes and functions by their modules.
_MODULES = {
    "cluster",
    "alpha",
    "compat",
    "constrained",
    "datasets",
    "distributed",
    "dynamic",
    "exchange",
    "explorer",
    "flips",
    "graphs",
    "hull",
    "interpolate",
    "io",
    "periodic",
    "plot",
    "reference",
    "refine",
    "regular",
    "solids",
    "sphere",
    "terrain",
    "testing",
    "voronoi",
}
_HOMES = {
    "AlphaComplex": "alpha.filtration",
    "AlphaShape": "alpha.shape",
    "AreaWeights": "areal.overlaps",
    "ConcaveHull": "alpha.shape",
    "ConstrainedDelaunay": "constrained.delaunay",
    "ConstrainedReport": "constrained.validation",
    "ConvexHull": "hull",
    "Dynamic": "dynamic.dynamic",
    "Editing": "constrained.editing",
    "Estimate": "estimation",
    "ImprintedSurface": "solids.surface.imprint",
    "ImproveReport": "solids.tetmesh.report",
    "Location": "_tiling.location",
    "PlaneTriangulation": "_tiling.space",
    "LawsonResult": "flips",
    "LloydResult": "voronoi.centroidal",
    "Mesh": "refine.meshed",
    "MeshReport": "refine.report",
    "OverlapReport": "areal.overlaps",
    "Overlaps": "areal.overlaps",
    "PeriodicDelaunay": "periodic",
    "PolygonTriangles": "constrained.polygons",
    "RecoveryReport": "solids.tetmesh.recovery",
    "RefinementReport": "solids.tetmesh.refinement",
    "RegularTriangulation": "regular",
    "SegmentReport": "constrained.segments",
    "SizeByDistance": "refine.distances",
    "SurfaceCheck": "solids.surface.report",
    "TetMesh": "solids.tetmesh.tetmesh",
    "TetMeshReport": "solids.tetmesh.validation",
    "Voronoi": "voronoi.diagram",
    "check_surface": "solids.surface.check",
    "concave_hull": "alpha.concave",
    "estimate": "estimation",
    "explore": "explorer.widget",
    "from_geometry": "constrained.polygons",
    "imprint_surface": "solids.surface.imprint",
    "improve": "solids.tetmesh.improvement",
    "lawson": "flips",
    "lloyd": "voronoi.centroidal",
    "mesh": "refine.refine",
    "resolve_touches": "solids.surface.resolve",
    "tetrahedralize": "solids.tetrahedra.filling",
    "triangulate_polygon": "constrained.polygons",
}


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        found = getattr(importlib.import_module(f"delone.{_HOMES[name]}"), name)
        globals()[name] = found
        return found
    if name in _MODULES:
        return importlib.import_module(f"delone.{name}")
    raise AttributeError(f"module {__name__!r:.80} has no attribute {name!r:.80}")


def __dir__() -> list[str]:
    return sorted({*globals(), *_MODULES, *_HOMES})
