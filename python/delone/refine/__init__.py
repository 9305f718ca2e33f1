"""Quality mesh generation: domains filled with triangles with bounded angles and sizes.

`refine` contains the function `mesh`, `meshed` the class Mesh, `domains` the input of the core,
`sizing` size functions, `adaptivity` and `smoothing` change meshes, `report` describes the result.
"""

from delone.refine.meshed import Mesh
from delone.refine.refine import mesh
from delone.refine.report import MeshReport

__all__ = ["Mesh", "MeshReport", "mesh"]
