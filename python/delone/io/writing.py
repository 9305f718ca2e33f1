"""Writing meshes: formats by file suffix, what each has a place for, and `write_mesh`.

Modules are named here and imported on use, so an unused format costs nothing.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_choice, as_flag, as_plain_array
from delone._base.atomic import replacing
from delone._base.files import path_of
from delone._base.georeference import as_crs, crs_of
from delone._base.values import require_mapping
from delone.errors import DtypeError, FileFormatError, InputError
from delone.exchange.second import as_order
from delone.io.content import Wanted
from delone.io.referencing import warn_if_left_out
from delone.io.registry import LANDXML, MESHES, TETGEN, TRIANGLE, module_of

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from numpy.typing import ArrayLike, NDArray

    from delone.exchange.parts import HasParts

__all__ = ["WITH_CRS", "output_suffixes", "write_mesh", "writer"]

_WRITERS = {
    **dict.fromkeys(MESHES, "mesh"),
    **dict.fromkeys((".xdmf", ".med", ".inp", ".su2", ".vtk", ".mesh"), "fem"),
    **dict.fromkeys(TRIANGLE, "triangle"),
    **dict.fromkeys(TETGEN, "tetgen"),
    ".off": "off",
    ".glb": "gltf",
    ".json": "cityjson",
    **dict.fromkeys((".gpkg", ".geojson"), "vector"),
    ".npz": "arrays",
    **dict.fromkeys(LANDXML, "landxml"),
    **dict.fromkeys((".png", ".svg"), "picture"),
}
# Formats that store tetrahedra or 3-D triangles, or draw them.
_TETRAHEDRA = (
    *(".vtu", ".msh", ".xdmf", ".med", ".inp", ".su2", ".vtk", ".mesh", ".npz", ".png"),
    *(".node", ".ele", ".poly", *TETGEN),
)
_SURFACES = (
    *MESHES,
    ".npz",
    ".xdmf",
    ".med",
    ".inp",
    ".vtk",
    ".mesh",
    ".png",
    ".off",
    ".glb",
    ".node",
    ".poly",
    *TETGEN,
)
# Formats that store second-order elements.
_SECOND_ORDER = (".vtu", ".msh", ".xdmf", ".med", ".inp", ".vtk", ".ele", ".node")
# Formats that store triangles that share no points.
_SEPARATE = (*MESHES, ".npz", ".xdmf", ".gpkg", ".geojson")
_HOLDERS: dict[str, tuple[tuple[str, ...], str]] = {
    "triangles": (tuple(_WRITERS), "triangles"),
    "separate": (_SEPARATE, "triangles that share no points"),
    "surface": (_SURFACES, "surfaces in 3-D"),
    "tetrahedra": (_TETRAHEDRA, "tetrahedra"),
}
# Formats that can store a reference system, or label the axes with it.
_LABELS = (".png", ".svg")
WITH_CRS = (".gpkg", ".geojson", ".json", ".npz", ".glb", *LANDXML, *_LABELS)


def output_suffixes() -> tuple[str, ...]:
    """Return the suffixes of the files that `write_mesh` writes.

    Returns
    -------
    tuple of str
        The suffixes, with the dot.

    Examples
    --------
    >>> from delone.io import output_suffixes
    >>> ".vtu" in output_suffixes()
    True
    """
    return tuple(_WRITERS)


def write_mesh(
    path: str | os.PathLike[str],
    triangulation: HasParts,
    *,
    z: ArrayLike | None = None,
    crs: Any = None,
    edges: bool = False,
    attributes: Mapping[str, ArrayLike] | None = None,
    order: int = 1,
    version: str | None = None,
) -> None:
    """Write a triangulation to a file; the suffix determines the format.

    Parameters
    ----------
    path : str or path-like
        VTU, PLY, OBJ, STL, OFF, MSH, XDMF, MED, INP, SU2, VTK (legacy), MESH (Medit),
        Triangle's NODE, ELE and POLY, TetGen's NODE, ELE, FACE, SMESH and POLY, GeoPackage,
        GeoJSON, LandXML (.xml, .landxml), npz, PNG or SVG. An existing file is replaced only once
        the new one is complete.
    triangulation : Delaunay, ConstrainedDelaunay, Mesh, TetMesh or another mesh
        What to write; also a `RegularTriangulation`, a `PeriodicDelaunay` or a 3-D `ConvexHull`.
        Tetrahedra go to VTU, MSH, XDMF, MED, INP, SU2, VTK, MESH, NODE, ELE, FACE, SMESH,
        POLY and PNG, those of a `Delaunay` or `TetMesh` to npz as well. The surface of a hull goes
        to VTU, MSH, PLY, OBJ, STL, OFF, XDMF, MED, INP, VTK, MESH, NODE, FACE, SMESH, POLY and PNG.
        Tetrahedra and hulls are written without `z` and `crs`.
    z : array_like of float, shape (n,), optional
        Heights, the third coordinate, by default those of a `delone.terrain.TIN`; in plots, the
        color, with shading if there are 2000 triangles or more, but never on a `Mesh`.
    crs : str, int or pyproj.CRS, optional
        Coordinate reference system, for GeoPackage, GeoJSON, LandXML, npz and labels of plots; by
        default that of the triangulation, which `delone.from_geometry` keeps. Nothing is
        transformed.
    edges : bool, optional
        Write edges instead of triangles, to VTU, MSH, GeoPackage or GeoJSON; plots show both.
    attributes : mapping of str to array_like, optional
        Values by point (n,) or by simplex (m,), for VTU, MSH, PLY, GeoPackage and GeoJSON.
    order : {1, 2}, optional
        With 2, second-order elements, for VTU, MSH, XDMF, MED, INP, VTK, ELE and NODE, with a node
        in the middle of each edge: after the points, in the order of ``triangulation.edges``.
        Attributes have one value per point, per simplex, or per node.
    version : {"2.2", "4.1"}, optional
        Version of an MSH file. By default 2.2, which more programs read, if segments or faces have
        markers or tetrahedra have regions; otherwise 4.1, which orders simplices by group.

    Raises
    ------
    FileFormatError
        Unknown suffix, or data that the format cannot store.
    InputError
        `z` or an attribute has the wrong length, or `triangulation` is not a triangulation.
    MissingExtraError
        The library for this format is not installed.
    OutputError
        The file cannot be written; it is also an OSError.

    Warns
    -----
    CRSWarning
        `crs` is given, but the format cannot store it.
    UnitsWarning
        A LandXML file does not name units, because the unit of the heights is unknown.

    Notes
    -----
    Vertex numbers in the file are the rows of ``triangulation.points``; duplicates remain as points
    that no triangle uses. Coordinates are written as doubles, or with all their digits; in INP
    files, whose numbers have 20 characters at most, with 13 digits or more.

    For a `ConstrainedDelaunay`, the triangles that are kept are written. VTU, MSH, XDMF, GeoPackage
    and GeoJSON contain their `region` and, if there are polygons, ``polygon`` as attributes;
    ``segment`` of an edge is 1 if it is part of a segment, otherwise 0. An npz file contains the
    whole object.

    For a `PeriodicDelaunay`, each triangle has its own three points in the file, with ``row``, the
    row of ``triangulation.points`` that each point is a copy of; `z` and attributes are by row.

    LandXML needs heights. For a TIN, it also contains breaklines, outlines, units and the reference
    system.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone import Delaunay
    >>> from delone.io import read_points, write_mesh
    >>> mesh = Delaunay([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_mesh(Path(folder) / "mesh.npz", mesh)
    ...     len(read_points(Path(folder) / "mesh.npz"))
    5
    """
    suffix, kind = path_of(path).suffix.lower(), _kind(triangulation)
    lines = as_flag(edges, name="edges")
    if lines and not hasattr(triangulation, "edges"):
        name = type(triangulation).__name__
        raise InputError(f"this {name} has no edges to write; write delone.Delaunay(points)")
    flat = kind in ("triangles", "separate")
    if not flat and z is not None:
        raise FileFormatError("3-D points already have heights: z must be None")
    if flat and z is None:
        z = getattr(triangulation, "z", None)  # a surface has its own
    given = _plain(attributes, suffix)
    _require_place(path, triangulation, kind, edges=lines)
    write = _writer(path, kind)
    further: dict[str, Any] = {} if version is None else {"version": _version(version, suffix)}
    if as_order(order) == 2:
        further["order"] = _second_order(suffix, edges=lines)
    system = as_crs(crs)
    warn_if_left_out(path, system, WITH_CRS if flat else _LABELS)
    if system is None and flat:
        system = crs_of(triangulation)
    with replacing(path) as temporary:
        write(temporary, triangulation, z=z, crs=system, edges=lines, attributes=given, **further)


def _kind(triangulation: Any) -> str:
    """Return which simplices are to be written: a key of `_HOLDERS`."""
    shapes = (np.shape(getattr(triangulation, name, ())) for name in ("points", "simplices"))
    coordinates, corners = (shape[1] if len(shape) == 2 else 0 for shape in shapes)
    # Meshes of other packages declare by ndim that they are triangulations.
    if hasattr(triangulation, "_parts") or getattr(triangulation, "ndim", 0) == corners - 1:
        if (coordinates, corners) == (2, 3):
            return "separate" if hasattr(triangulation, "offsets") else "triangles"
        if coordinates == 3 and corners in (3, 4):
            return "surface" if corners == 3 else "tetrahedra"
    name = type(triangulation).__name__
    if coordinates > 3 and corners == coordinates + 1:
        raise InputError(
            f"no mesh format stores simplices in {coordinates}-D: {name}.save writes them"
        )
    raise InputError(f"cannot write an object of type {name}: pass a triangulation or a mesh")


def _require_place(path: str | os.PathLike[str], mesh: Any, kind: str, *, edges: bool) -> None:
    """Reject what the format cannot store."""
    name, suffix = type(mesh).__name__, path_of(path).suffix.lower()
    if suffix == ".npz" and not hasattr(mesh, "save"):
        raise FileFormatError(f"{path}: .npz files cannot store a {name}; use .vtu")
    if kind == "separate" and edges:
        raise FileFormatError(f"{path}: edges of a {name} are not written; write its triangles")


def _second_order(suffix: str, *, edges: bool) -> int:
    if edges or suffix not in _SECOND_ORDER:
        what = "edges" if edges else f"{suffix} files"
        raise FileFormatError(
            f"{what} cannot store second-order elements: write them to {', '.join(_SECOND_ORDER)}"
        )
    return 2


def _version(version: str, suffix: str) -> str:
    if suffix != ".msh":
        raise FileFormatError(f"{suffix} files have no version to choose; only .msh files do")
    return as_choice(version, ("2.2", "4.1"), name="version")


def _plain(
    attributes: Mapping[str, ArrayLike] | None, suffix: str
) -> dict[str, NDArray[Any]] | None:
    """Return attributes as arrays of dtypes that the format can store."""
    if attributes is None:
        return None
    require_mapping(attributes, "attributes")
    found = {}
    for name, values in attributes.items():
        array = as_plain_array(values, f"attribute {name!r}")
        kind = array.dtype.kind
        if (suffix in MESHES and kind not in "iufb") or (suffix == ".npz" and kind == "O"):
            raise DtypeError(
                f"attribute {name!r:.80} must hold real numbers in {suffix} files, got dtype "
                f"{array.dtype}"
            )
        found[name] = array
    return found


def writer(
    path: str | os.PathLike[str], *, space: bool = False, surface: bool = False, order: int = 1
) -> Callable[..., None]:
    """Return the function that writes this suffix in place, after importing its library.

    It takes the arguments of `write_mesh`. With `space`, tetrahedra will be written; with
    `surface`, triangles in 3-D; with ``order=2``, second-order elements, except to images.
    """
    write = _writer(path, "surface" if surface else "tetrahedra" if space else "triangles")
    suffix = path_of(path).suffix.lower()
    if as_order(order) == 1 or suffix in _LABELS:
        return write
    return partial(write, order=_second_order(suffix, edges=False))


def _writer(path: str | os.PathLike[str], kind: str) -> Callable[..., None]:
    file = path_of(path)
    suffix = file.suffix.lower()
    holders, what = _HOLDERS[kind]
    if suffix in _WRITERS and suffix not in holders:
        others = ", ".join(holders)
        raise FileFormatError(f"{file}: {suffix} files cannot store {what}; use {others}")
    module = module_of(_WRITERS, suffix, file, "write")
    if hasattr(module, "require_libraries"):
        module.require_libraries(suffix)

    def write(place: Path, mesh: HasParts, **given: Any) -> None:
        module.write_mesh(place, mesh, Wanted(**given))

    return write
