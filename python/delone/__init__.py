"""Exact, canonical and fast Delaunay triangulation.

>>> from delone import Delaunay
>>> Delaunay([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)])
<Delaunay of 5 points: 4 triangles>

`Delaunay` triangulates 2-D or 3-D points; `ConstrainedDelaunay` and `from_geometry` also take
segments and polygons. `mesh` and `improve` create triangles and tetrahedra of good quality. Related
structures are `Voronoi`, `ConvexHull`, `RegularTriangulation` and `PeriodicDelaunay`. The modules
`interpolate`, `distributed`, `io`, `plot`, `predicates`, `datasets`, `testing`, `reference` and
`compat` have the rest. All errors are subclasses of `DeloneError`.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from delone import predicates
from delone._core import __version__
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.constrained.editing import Editing
from delone.constrained.polygons import PolygonTriangles, from_geometry, triangulate_polygon
from delone.constrained.segments import SegmentReport
from delone.constrained.validation import ConstrainedReport
from delone.delaunay import Delaunay
from delone.errors import (
    BudgetExceededError,
    BusyError,
    ConflictingValuesError,
    CrossingSegmentsError,
    DegenerateInputError,
    DeloneError,
    DtypeError,
    FileFormatError,
    InputError,
    InternalError,
    LimitError,
    MissingExtraError,
    NonFiniteError,
    OutputError,
    ShapeError,
)
from delone.flips import LawsonResult, lawson
from delone.georeference import CRSWarning, GeographicWarning
from delone.hull import ConvexHull
from delone.periodic import PeriodicDelaunay
from delone.plane.quality import Quality
from delone.refine.meshed import Mesh
from delone.refine.refine import mesh
from delone.refine.report import MeshReport
from delone.regular import RegularTriangulation
from delone.space.quality import TetQuality
from delone.tetmesh import improve
from delone.tetmesh.report import ImproveReport
from delone.tetmesh.tetmesh import TetMesh
from delone.validation import ValidationReport
from delone.voronoi import LloydResult, Voronoi, lloyd

if TYPE_CHECKING:
    from delone import (
        compat,
        datasets,
        distributed,
        interpolate,
        io,
        plot,
        reference,
        testing,
    )

__all__ = [
    "BudgetExceededError",
    "BusyError",
    "CRSWarning",
    "ConflictingValuesError",
    "ConstrainedDelaunay",
    "ConstrainedReport",
    "ConvexHull",
    "CrossingSegmentsError",
    "DegenerateInputError",
    "Delaunay",
    "DeloneError",
    "DtypeError",
    "Editing",
    "FileFormatError",
    "GeographicWarning",
    "ImproveReport",
    "InputError",
    "InternalError",
    "LawsonResult",
    "LimitError",
    "LloydResult",
    "Mesh",
    "MeshReport",
    "MissingExtraError",
    "NonFiniteError",
    "OutputError",
    "PeriodicDelaunay",
    "PolygonTriangles",
    "Quality",
    "RegularTriangulation",
    "SegmentReport",
    "ShapeError",
    "TetMesh",
    "TetQuality",
    "ValidationReport",
    "Voronoi",
    "__version__",
    "compat",
    "datasets",
    "distributed",
    "from_geometry",
    "improve",
    "interpolate",
    "io",
    "lawson",
    "lloyd",
    "mesh",
    "plot",
    "predicates",
    "reference",
    "testing",
    "triangulate_polygon",
]

# Modules that not every program needs; they are imported on first access.
_LAZY = frozenset(
    {
        "compat",
        "datasets",
        "distributed",
        "interpolate",
        "io",
        "plot",
        "reference",
        "testing",
    }
)


def __getattr__(name: str) -> Any:
    if name in _LAZY:
        return importlib.import_module(f"delone.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *_LAZY})
