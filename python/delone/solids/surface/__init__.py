"""Surfaces of triangles in 3-D: exact checks, and subdivision where triangles touch or cross.

`check` contains `check_surface`, `report` its result; `resolve` and `imprint` contain the functions
that cut faces where they meet, at existing vertices and at new ones.
"""

from delone.solids.surface.check import check_surface
from delone.solids.surface.imprint import ImprintedSurface, imprint_surface
from delone.solids.surface.report import SurfaceCheck
from delone.solids.surface.resolve import resolve_touches

__all__ = [
    "ImprintedSurface",
    "SurfaceCheck",
    "check_surface",
    "imprint_surface",
    "resolve_touches",
]
