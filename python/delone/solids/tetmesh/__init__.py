"""Tetrahedral meshes: the class TetMesh, and improvement by moving vertices and by flips.

`improvement` contains the function `improve`, `report` its result; `recovery` contains the report
of `delone.tetrahedralize`, `walls` what `improve` keeps of its faces, `refinement` adds points for
sizes, which are in `lengths`, and shapes, and `relaxing` coarsens and smooths.
"""

from delone.solids.tetmesh.improvement import improve
from delone.solids.tetmesh.recovery import RecoveryReport
from delone.solids.tetmesh.refinement import RefinementReport
from delone.solids.tetmesh.report import ImproveReport
from delone.solids.tetmesh.tetmesh import TetMesh
from delone.solids.tetmesh.validation import TetMeshReport

__all__ = [
    "ImproveReport",
    "RecoveryReport",
    "RefinementReport",
    "TetMesh",
    "TetMeshReport",
    "improve",
]
