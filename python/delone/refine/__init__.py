"""Quality meshes: domains filled with triangles of bounded angles and sizes.

`refine` has the function `mesh`, `meshed` the class Mesh, `domains` what is filled, `sizing` sizes
of all kinds, `adaptivity` and `smoothing` later changes, `report` what was reached.
"""

from delone.refine.meshed import Mesh
from delone.refine.refine import mesh
from delone.refine.report import MeshReport

__all__ = ["Mesh", "MeshReport", "mesh"]
