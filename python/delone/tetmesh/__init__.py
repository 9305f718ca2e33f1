"""Tetrahedral meshes: the class TetMesh, and improvement by moving vertices and by flips.

`improvement` has the function `improve`, `report` its result; `recovery` has the report of
`delone.tetrahedralize`, `walls` what `improve` keeps of its faces, `refinement` adds points for
sizes, which are in `lengths`, and shapes.
"""

from delone.tetmesh.improvement import improve
from delone.tetmesh.recovery import RecoveryReport
from delone.tetmesh.refinement import RefinementReport
from delone.tetmesh.report import ImproveReport
from delone.tetmesh.tetmesh import TetMesh
from delone.tetmesh.validation import TetMeshReport

__all__ = [
    "ImproveReport",
    "RecoveryReport",
    "RefinementReport",
    "TetMesh",
    "TetMeshReport",
    "improve",
]
