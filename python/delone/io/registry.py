"""Readers by file suffix: tables of formats, and what the suffix of a file says.

Modules are named here and imported on use, so an unused format costs nothing.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from delone._base.files import existing, path_of
from delone.errors import FileFormatError
from delone.io.compressed import SUFFIXES

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping
    from pathlib import Path

__all__ = [
    "FACETS",
    "GEOMETRIES",
    "LANDXML",
    "MESHES",
    "MESH_READERS",
    "READERS",
    "READ_MESHES",
    "SHEETS",
    "TETGEN",
    "TRIANGLE",
    "holds_geometries",
    "holds_surface",
    "input_suffixes",
    "is_lidar",
    "is_point_tiles",
    "is_text",
    "mesh_suffixes",
    "module_of",
    "reader_of",
    "suffix_of",
]

_JSON = (".geojson", ".json")
MESHES = (".vtu", ".ply", ".obj", ".stl", ".msh")
# Formats that are read, and written with what solvers need.
READ_MESHES = (*MESHES, ".vtk", ".mesh")
# Formats of surfaces, in which polygons are facets.
FACETS = (".ply", ".obj")
TRIANGLE = (".node", ".ele", ".poly")
TETGEN = (".smesh", ".face")
LANDXML = (".xml", ".landxml")
READERS = {
    **dict.fromkeys((".csv", ".tsv", ".txt", ".xyz", ".pts", ".dat"), "text"),
    **dict.fromkeys((".npy", ".npz"), "arrays"),
    **dict.fromkeys((".las", ".laz"), "las"),
    **dict.fromkeys((*_JSON, ".gpkg", ".sqlite", ".shp", ".fgb"), "vector"),
    **dict.fromkeys((".parquet", ".arrow", ".feather"), "parquet"),
    **dict.fromkeys(READ_MESHES, "mesh"),
    **dict.fromkeys(TRIANGLE, "triangle"),
    **dict.fromkeys(LANDXML, "landxml"),
    ".dxf": "dxf",
    ".off": "off",
    **dict.fromkeys((".tif", ".tiff", ".asc", ".nc"), "dem"),
}
# The file that describes an octree of lidar points, whatever its folder.
_POINT_TILES = "ept.json"
SHEETS = ("landxml", "dxf")
GEOMETRIES = ("vector", "parquet", *SHEETS)
MESH_READERS = {
    ".npz": "arrays",
    **dict.fromkeys(READ_MESHES, "mesh"),
    ".ele": "triangle",
    **dict.fromkeys((".poly", *TETGEN), "tetgen"),
    ".off": "off",
}


def input_suffixes() -> tuple[str, ...]:
    """Return the suffixes of the files that `read_points` reads.

    Returns
    -------
    tuple of str
        The suffixes, with the dot.

    Examples
    --------
    >>> from delone.io import input_suffixes
    >>> ".laz" in input_suffixes()
    True
    """
    return tuple(READERS)


def mesh_suffixes() -> tuple[str, ...]:
    """Return the suffixes of the files that `read_mesh` reads."""
    return tuple(MESH_READERS)


def is_text(path: str | os.PathLike[str]) -> bool:
    """Return whether the suffix is that of a text file of points, which `line_numbers` can read."""
    suffixes = [suffix.lower() for suffix in path_of(path).suffixes]
    if suffixes and suffixes[-1] in SUFFIXES:
        suffixes.pop()
    return bool(suffixes) and READERS.get(suffixes[-1]) == "text"


def holds_geometries(path: str | os.PathLike[str]) -> bool:
    """Return whether `read_geometries` can read a file; no error for an unknown suffix.

    Parquet files are opened to check whether they are GeoParquet.
    """
    file = existing(path)
    module = READERS.get(suffix_of(file))
    if module != "parquet":
        return module == "vector" and not is_point_tiles(file)
    return bool(importlib.import_module("delone.io.parquet").holds_geometries(file))


def holds_surface(path: str | os.PathLike[str]) -> bool:
    """Return whether `read_surface` reads files with this suffix."""
    return READERS.get(path_of(path).suffix.lower()) in SHEETS


def is_point_tiles(path: str | os.PathLike[str]) -> bool:
    """Return whether the name is that of the file which describes Entwine Point Tiles."""
    return path_of(path).name == _POINT_TILES


def is_lidar(path: str | os.PathLike[str]) -> bool:
    """Return whether a file has points with classes: LAS, LAZ or Entwine Point Tiles."""
    return READERS.get(path_of(path).suffix.lower()) == "las" or is_point_tiles(path)


def suffix_of(file: Path) -> str:
    """Return the suffix in lower case, without that of a compressed file."""
    suffixes = [suffix.lower() for suffix in file.suffixes]
    if suffixes and suffixes[-1] in SUFFIXES:
        suffixes.pop()
        if suffixes and READERS.get(suffixes[-1]) != "text" and suffixes[-1] not in _JSON:
            raise FileFormatError(
                f"{file}: only text files and GeoJSON can be read compressed; decompress it"
            )
    return suffixes[-1] if suffixes else ""


def module_of(modules: Mapping[str, str], suffix: str, file: Path, verb: str) -> Any:
    """Return the module for a suffix; an unknown one is an error that says what is known."""
    if suffix not in modules:
        what = f"files that end in {suffix}" if suffix else "a file without a suffix"
        raise FileFormatError(
            f"{file}: cannot {verb} {what}; known suffixes are {' '.join(modules)}"
        )
    return importlib.import_module(f"delone.io.{modules[suffix]}")


def reader_of(file: Path) -> Any:
    """Return the module that reads the points of a file."""
    if is_point_tiles(file):
        return importlib.import_module("delone.io.ept")
    return module_of(READERS, suffix_of(file), file, "read")
