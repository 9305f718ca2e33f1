"""Surfaces of triangles in 3-D: exact checks, and subdivision where triangles touch.

`check` has the function `check_surface`, `report` its result, `resolve` the function
`resolve_touches`.
"""

from delone.surface.check import check_surface
from delone.surface.report import SurfaceCheck
from delone.surface.resolve import resolve_touches

__all__ = ["SurfaceCheck", "check_surface", "resolve_touches"]
