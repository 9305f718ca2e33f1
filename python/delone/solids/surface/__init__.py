"""Surfaces of triangles in 3-D: exact checks, and subdivision where triangles touch.

`check` has the function `check_surface`, `report` its result, `resolve` the function
`resolve_touches`.
"""

from delone.solids.surface.check import check_surface
from delone.solids.surface.report import SurfaceCheck
from delone.solids.surface.resolve import resolve_touches

__all__ = ["SurfaceCheck", "check_surface", "resolve_touches"]
