"""Points from files, triangulations to files.

`read_points` and `write_mesh` choose by the suffix of the file; one module of this package knows
one family of formats, and imports the library it needs when it is used.
"""

from delone.io.pointset import PointSet
from delone.io.registry import (
    MeshFile,
    input_suffixes,
    output_suffixes,
    read_mesh,
    read_points,
    write_mesh,
)

__all__ = [
    "MeshFile",
    "PointSet",
    "input_suffixes",
    "output_suffixes",
    "read_mesh",
    "read_points",
    "write_mesh",
]
