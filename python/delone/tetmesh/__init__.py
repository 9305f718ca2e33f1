"""Improvement of tetrahedral meshes, by moving vertices and replacing tetrahedra.

`improvement` has the function `improve`, `tetmesh` the class TetMesh, `report` its result.
"""

from delone.tetmesh.improvement import improve
from delone.tetmesh.report import ImproveReport
from delone.tetmesh.tetmesh import TetMesh

__all__ = ["ImproveReport", "TetMesh", "improve"]
