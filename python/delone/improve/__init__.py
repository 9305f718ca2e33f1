"""Improvement of tetrahedral meshes: vertices move and tetrahedra are replaced.

`improve` has the function of that name, `tetmesh` the class TetMesh, `report` what was reached.
"""

from delone.improve.improve import improve
from delone.improve.report import ImproveReport
from delone.improve.tetmesh import TetMesh

__all__ = ["ImproveReport", "TetMesh", "improve"]
