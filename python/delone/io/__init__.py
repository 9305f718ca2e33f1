"""Reading points, geometries and meshes from files; writing triangulations and rasters.

`read_points` and `write_mesh` choose the format by the suffix of the file. Each module of this
package handles one family of formats and imports the libraries it needs when it is used.
"""

from delone.io.dem import read_raster
from delone.io.drawing import write_drawing
from delone.io.geometryset import GeometrySet
from delone.io.meshfile import MeshFile
from delone.io.pointset import PointSet
from delone.io.quantized_mesh import write_quantized_mesh
from delone.io.raster import raster_suffixes, write_raster
from delone.io.reading import (
    line_numbers,
    read_geometries,
    read_mesh,
    read_points,
    read_surface,
)
from delone.io.registry import input_suffixes
from delone.io.surfacefile import LeftOutWarning, SurfaceFile
from delone.io.tileset import write_tileset
from delone.io.writing import output_suffixes, write_mesh

__all__ = [
    "GeometrySet",
    "LeftOutWarning",
    "MeshFile",
    "PointSet",
    "SurfaceFile",
    "input_suffixes",
    "line_numbers",
    "output_suffixes",
    "raster_suffixes",
    "read_geometries",
    "read_mesh",
    "read_points",
    "read_raster",
    "read_surface",
    "write_drawing",
    "write_mesh",
    "write_quantized_mesh",
    "write_raster",
    "write_tileset",
]
