"""Readers and writers by file suffix, and the public functions that use them.

Modules are named here and imported on use, so an unused format costs nothing.
"""

from __future__ import annotations

import importlib
import os
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_choice, as_count, as_flag, as_number, as_plain_array
from delone._base.atomic import replacing
from delone._base.georeference import as_crs, crs_of
from delone.errors import DtypeError, FileFormatError, InputError
from delone.exchange.second import as_order
from delone.io.compressed import SUFFIXES
from delone.io.content import Wanted
from delone.io.referencing import warn_if_left_out

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from delone.exchange.parts import HasParts
    from delone.io.geometryset import GeometrySet
    from delone.io.meshfile import MeshFile
    from delone.io.pointset import PointSet
    from delone.io.surfacefile import SurfaceFile

__all__ = [
    "holds_geometries",
    "holds_surface",
    "input_suffixes",
    "is_text",
    "line_numbers",
    "mesh_suffixes",
    "output_suffixes",
    "read_geometries",
    "read_mesh",
    "read_points",
    "read_surface",
    "write_mesh",
]

_JSON = (".geojson", ".json")
_MESHES = (".vtu", ".ply", ".obj", ".stl", ".msh")
# Those that are read, and written with what solvers need.
_READ_MESHES = (*_MESHES, ".vtk", ".mesh")
# Those of surfaces, where polygons are facets.
_FACETS = (".ply", ".obj")
_TRIANGLE = (".node", ".ele", ".poly")
_TETGEN = (".smesh", ".face")
_LANDXML = (".xml", ".landxml")
_READERS = {
    **dict.fromkeys((".csv", ".tsv", ".txt", ".xyz", ".pts", ".dat"), "text"),
    **dict.fromkeys((".npy", ".npz"), "arrays"),
    **dict.fromkeys((".las", ".laz"), "las"),
    **dict.fromkeys((*_JSON, ".gpkg", ".shp", ".fgb"), "vector"),
    **dict.fromkeys((".parquet", ".arrow", ".feather"), "parquet"),
    **dict.fromkeys(_READ_MESHES, "mesh"),
    **dict.fromkeys(_TRIANGLE, "triangle"),
    **dict.fromkeys(_LANDXML, "landxml"),
    ".dxf": "dxf",
    ".off": "off",
    **dict.fromkeys((".tif", ".tiff", ".asc", ".nc"), "dem"),
}
_WRITERS = {
    **dict.fromkeys(_MESHES, "mesh"),
    **dict.fromkeys((".xdmf", ".med", ".inp", ".su2", ".vtk", ".mesh"), "fem"),
    **dict.fromkeys(_TRIANGLE, "triangle"),
    **dict.fromkeys(_TETGEN, "tetgen"),
    ".off": "off",
    ".glb": "gltf",
    ".json": "cityjson",
    **dict.fromkeys((".gpkg", ".geojson"), "vector"),
    ".npz": "arrays",
    **dict.fromkeys(_LANDXML, "landxml"),
    **dict.fromkeys((".png", ".svg"), "picture"),
}
# What holds tetrahedra, or triangles in 3-D, or draws them.
_TETRAHEDRA = (
    *(".vtu", ".msh", ".xdmf", ".med", ".inp", ".su2", ".vtk", ".mesh", ".npz", ".png"),
    *(".node", ".ele", ".poly", *_TETGEN),
)
_SURFACES = (
    *_MESHES,
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
    *_TETGEN,
)
# What holds elements of second order.
_SECOND_ORDER = (".vtu", ".msh", ".xdmf", ".med", ".inp", ".vtk", ".ele", ".node")
# What holds triangles that share no points.
_SEPARATE = (*_MESHES, ".npz", ".xdmf", ".gpkg", ".geojson")
_HOLDERS: dict[str, tuple[tuple[str, ...], str]] = {
    "triangles": (tuple(_WRITERS), "triangles"),
    "separate": (_SEPARATE, "triangles that share no points"),
    "surface": (_SURFACES, "surfaces in 3-D"),
    "tetrahedra": (_TETRAHEDRA, "tetrahedra"),
}
_SHEETS = ("landxml", "dxf")
# Files of points without values.
_WITHOUT_ATTRIBUTES = (".dxf", ".off", ".dem")
_GEOMETRIES = ("vector", "parquet", *_SHEETS)
# Formats that can store a reference system, or label the axes with it.
_LABELS = (".png", ".svg")
WITH_CRS = (".gpkg", ".geojson", ".json", ".npz", ".glb", *_LANDXML, *_LABELS)
_MESH_READERS = {
    ".npz": "arrays",
    **dict.fromkeys(_READ_MESHES, "mesh"),
    ".ele": "triangle",
    **dict.fromkeys((".poly", *_TETGEN), "tetgen"),
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
    return tuple(_READERS)


def mesh_suffixes() -> tuple[str, ...]:
    """Return the suffixes of the files that `read_mesh` reads."""
    return tuple(_MESH_READERS)


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


def read_points(
    path: str | os.PathLike[str],
    *,
    columns: Sequence[str | int] | None = None,
    classes: Sequence[int] | None = None,
    layer: str | None = None,
    attributes: Sequence[str] | str = (),
    chord: float | None = None,
    bounds: Sequence[float] | None = None,
) -> PointSet:
    r"""Read points from a file; the suffix determines the format.

    Parameters
    ----------
    path : str or path-like
        CSV, TSV, TXT, XYZ, PTS, DAT or GeoJSON (these also .gz, .xz, .bz2), npy, npz, LAS, LAZ,
        GeoPackage, Shapefile, FlatGeobuf, Parquet, GeoParquet, Arrow, Feather, LandXML, DXF, the
        cells of GeoTIFF, ESRI ASCII grids and NetCDF (`read_raster`), or the vertices of a mesh.
    columns : sequence of str or int, optional
        Columns of x, y and (optionally) z, by name or by number from 0. By default columns are
        recognized by their names; without names the first two or three are used, unless the first
        looks like point numbers, which is an error. For files of geometries: the one attribute
        that is z.
    classes : sequence of int, optional
        Keep the points of these classes (LAS and LAZ).
    layer : str, optional
        The layer, for files that have several; the array of an npz file; the surface of LandXML,
        or ``"CgPoints"`` for its survey points; the band of a raster.
    attributes : sequence of str or "all", optional
        Further columns to read. "all" means all that are not coordinates: those of text files are
        numbers if every field is one, otherwise strings; the number of the column is appended to
        repeated names. Survey points of LandXML have ``name``, ``code`` and ``desc``; DXF and OFF
        have none.
    chord : float, optional
        The maximum distance of chords from the curves of a DXF file; see `read_surface`.
    bounds : sequence of four float, optional
        Left, bottom, right, top: only points inside or on the border (LAS and LAZ; quick for COPC).

    Returns
    -------
    PointSet
        The points, row by row as in the file, including NaN.

    Raises
    ------
    InputError
        `attributes` is another string.
    FileNotFoundError
        There is no such file.
    FileFormatError
        Unknown suffix; the file is empty, truncated or not what its suffix or header says; a column
        or layer is missing; `classes` or `bounds` leave no point, or do not apply to the format.
    MissingExtraError
        The library for this format is not installed.
    MemoryError
        There is not enough memory for the contents of the file.

    Notes
    -----
    Coordinates are the exact doubles of the file; decimals are rounded to the nearest double.
    Integers beyond 2**53 and, in tables, decimals with more digits than a double can distinguish
    are rejected. No memory is allocated for what a header declares before the size of the file
    confirms it. Nothing that a file refers to is opened, except the parts of a Shapefile, the
    journals of a GeoPackage, and the NODE file next to ELE and POLY. Files beside a file that are
    links to others are rejected. Compressed files that contain more than 64 MiB (text and JSON:
    8 MiB) and more than 200 times their size are rejected; decompress them first. Lines of text
    longer than 16 MiB are rejected as well.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone.io import read_points
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "survey.csv"
    ...     _ = file.write_text("id,lat,lon,depth\n1,52.0,4.25,-3\n2,52.5,4.5,-7\n")
    ...     survey = read_points(file)
    >>> survey.points
    array([[ 4.25, 52.  ],
           [ 4.5 , 52.5 ]])
    >>> survey.z
    array([-3., -7.])
    """
    file = _existing(path)
    suffix = _suffix(file)
    module = _module(_READERS, suffix, file, "read")
    if classes is not None and suffix not in (".las", ".laz"):
        raise FileFormatError(f"{file}: only LAS and LAZ files have classes")
    options = {"columns": columns} | _chord(file, chord) | _attributes(attributes, module)
    if module.__name__.endswith(".las"):
        options |= {"classes": classes, "bounds": bounds}
    elif bounds is not None:
        raise FileFormatError(f"{file}: bounds are for LAS and LAZ files, and for read_raster")
    if module.__name__.endswith((".vector", ".arrays", ".landxml", ".dxf", ".dem")):
        options["layer"] = layer
    elif layer is not None:
        raise FileFormatError(f"{file}: {suffix} files have no layers")
    read: Callable[..., PointSet] = module.read_points
    return read(file, **options)


def line_numbers(path: str | os.PathLike[str], rows: Sequence[int]) -> list[int]:
    r"""Return the line numbers of rows of points in a text file.

    Parameters
    ----------
    path : str or path-like
        CSV, TSV, TXT, XYZ, PTS or DAT, also compressed.
    rows : sequence of int
        Rows of the result of `read_points`, from 0.

    Returns
    -------
    list of int
        Line numbers from 1, as in editors; headers, comments and blank lines count.

    Raises
    ------
    FileNotFoundError
        There is no such file.
    FileFormatError
        The file is not a text file of points, or does not have such a row.

    Notes
    -----
    The file is read again, up to the last of these rows.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone.io import line_numbers
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "survey.csv"
    ...     _ = file.write_text("x,y\n0,0\n# pause\n4,nan\n")
    ...     line_numbers(file, [1])
    [4]
    """
    file = _existing(path)
    if not is_text(file):
        raise FileFormatError(f"{file} is not a text file: its points are not in lines")
    wanted = [as_count(row, name="rows") for row in rows]
    module = importlib.import_module("delone.io.text")
    found: list[int] = module.line_numbers(file, wanted)
    return found


def is_text(path: str | os.PathLike[str]) -> bool:
    """Return whether the suffix is that of a text file of points, which `line_numbers` can read."""
    suffixes = [suffix.lower() for suffix in Path(path).suffixes]
    if suffixes and suffixes[-1] in SUFFIXES:
        suffixes.pop()
    return bool(suffixes) and _READERS.get(suffixes[-1]) == "text"


def holds_geometries(path: str | os.PathLike[str]) -> bool:
    """Return whether `read_geometries` can read a file; no error for an unknown suffix.

    Parquet files are opened to see if they are GeoParquet.
    """
    file = _existing(path)
    module = _READERS.get(_suffix(file))
    if module != "parquet":
        return module == "vector"
    return bool(importlib.import_module("delone.io.parquet").holds_geometries(file))


def read_geometries(
    path: str | os.PathLike[str],
    *,
    columns: Sequence[str | int] | None = None,
    layer: str | None = None,
    attributes: Sequence[str] | str = (),
    chord: float | None = None,
) -> GeometrySet:
    """Read points, lines and areas from a file; the suffix determines the format.

    Parameters
    ----------
    path : str or path-like
        GeoJSON (also .gz, .xz, .bz2), GeoPackage, Shapefile, FlatGeobuf or GeoParquet; the lines of
        LandXML and DXF.
    columns : sequence of str or int, optional
        The one attribute that is the height of each feature, as for contour lines. By default
        heights are those of the coordinates, if any.
    layer : str, optional
        The layer, for files that have several; of LandXML a surface, an alignment, or
        ``"Alignments"`` for all.
    attributes : sequence of str or "all", optional
        Further columns to read, as for `read_points`; alignments have ``name`` and ``start``.
    chord : float, optional
        The maximum distance of chords from the curves of DXF files (`read_surface`) and of
        alignments.

    Returns
    -------
    GeometrySet
        One geometry for each feature, in the order of the file. `delone.from_geometry` accepts it
        and keeps its reference system.

    Raises
    ------
    FileNotFoundError, FileFormatError, MissingExtraError, InputError
        As for `read_points`.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone.io import read_geometries
    >>> text = '{"type": "LineString", "coordinates": [[0, 0], [4, 4]]}'
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "line.geojson"
    ...     _ = file.write_text(text)
    ...     read_geometries(file).geometries
    array([<LINESTRING (0 0, 4 4)>], dtype=object)
    """
    file = _existing(path)
    modules = {suffix: name for suffix, name in _READERS.items() if name in _GEOMETRIES}
    module = _module(modules, _suffix(file), file, "read geometries from")
    read: Callable[..., GeometrySet] = module.read_geometries
    options = _chord(file, chord, _SHEETS) | _attributes(attributes, module)
    return read(file, columns=columns, layer=layer, **options)


def _attributes(attributes: Sequence[str] | str, module: Any) -> dict[str, Any]:
    """Return the further columns to read as options of a reader."""
    if not isinstance(attributes, str):
        return {"attributes": tuple(attributes)}
    if attributes != "all":
        raise InputError(f"attributes must be 'all' or names of columns, got {attributes!r:.60}")
    without = module.__name__.endswith(_WITHOUT_ATTRIBUTES)
    return {"attributes": ()} | ({} if without else {"everything": True})


def holds_surface(path: str | os.PathLike[str]) -> bool:
    """Return whether the suffix is that of a file which `read_surface` reads."""
    return _READERS.get(Path(path).suffix.lower()) in _SHEETS


def read_surface(
    path: str | os.PathLike[str],
    *,
    layer: str | None = None,
    order: str | None = None,
    chord: float | None = None,
) -> SurfaceFile:
    """Read the surface of a LandXML or DXF file: points, faces, lines and units.

    Parameters
    ----------
    path : str or path-like
        LandXML 1.0, 1.1 or 1.2 (.xml, .landxml), or DXF.
    layer : str, optional
        The name of the surface, for LandXML files that have several, or ``"CgPoints"`` for its
        survey points; for DXF the layers to read, separated by commas, by default all.
    order : {"nez", "enz"}, optional
        Whether northings come first in a LandXML file, as in the standard (the default), or
        eastings.
    chord : float, optional
        Curves of a DXF file (arcs, circles, ellipses, splines, bulges of polylines) become chords
        that are at most this far from the curve, in its units; by default a thousandth of the
        radius of each arc, and of the extent of other curves.

    Returns
    -------
    SurfaceFile
        The contents of the file, and in `left_out` the counts of what was not read.
        `delone.terrain.TIN.from_file` makes a surface from it.

    Raises
    ------
    FileNotFoundError
        There is no such file.
    FileFormatError
        The file is not what its suffix says, has no such surface or layer, contains something other
        than finite numbers, or faces of unknown points; the message has the line. Northing and
        easting are swapped, as the declared reference system shows (with pyproj).
    InputError
        `order` is not one of its choices.
    MissingExtraError
        lxml (extra ``landxml``) or ezdxf (extra ``dxf``) is not installed.

    Notes
    -----
    Invisible faces (``i="1"``) are left out, and the neighbors of faces are ignored. Faces that
    repeat others or a corner are left out and counted; faces with four corners, as in grids, become
    two triangles. For walls, the lower line is read. Boundaries of the types void, hole, hide and
    inner are holes, island is an island in a hole; all others are boundaries. Contours are soft
    breaklines. For DXF, the model space is read: 3DFACE, MESH, POINT, LINE, LWPOLYLINE, POLYLINE
    (including polyface and polygon meshes) and curves, also in blocks. Layers that are off or
    frozen are left out unless `layer` names them; so are texts, hatches, solids and references to
    other drawings.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone.io import read_surface
    >>> text = '<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2"><Units><Metric '
    >>> text += 'linearUnit="meter"/></Units><Surfaces><Surface name="ground"><Definition>'
    >>> text += '<Pnts><P id="1">0 0 5</P><P id="2">0 4 6</P><P id="3">3 0 7</P></Pnts>'
    >>> text += "<Faces><F>1 2 3</F></Faces></Definition></Surface></Surfaces></LandXML>"
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "site.xml"
    ...     _ = file.write_text(text)
    ...     surface = read_surface(file)
    >>> surface
    <SurfaceFile of 3 points: 1 face, 0 breaklines, heights in m>
    >>> surface.points[1].tolist()
    [4.0, 0.0, 6.0]
    """
    file = _existing(path)
    modules = {suffix: name for suffix, name in _READERS.items() if name in _SHEETS}
    module = _module(modules, _suffix(file), file, "read a surface from")
    if order not in (None, "nez", "enz"):
        raise InputError(f"order must be 'nez' or 'enz', got {order!r:.60}")
    plain = "nez" if modules[_suffix(file)] == "landxml" else "enz"
    read: Callable[..., SurfaceFile] = module.read_surface
    if chord is None:
        return read(file, name=layer, order=order or plain)
    return read(file, name=layer, order=order or plain, **_chord(file, chord))


def _chord(file: Path, chord: float | None, curved: tuple[str, ...] = ("dxf",)) -> dict[str, float]:
    """Return the option `chord` of the reader of files with curves, if it is given."""
    if chord is None:
        return {}
    if _READERS.get(_suffix(file)) not in curved:
        raise InputError(f"{file}: chord is for DXF files, which have curves")
    distance = as_number(chord, name="chord")
    if not distance > 0:
        raise InputError(f"chord must be a distance above 0, got {distance:g}")
    return {"chord": distance}


def read_mesh(path: str | os.PathLike[str], *, polygons: str | None = None) -> MeshFile:
    """Read triangles or tetrahedra from a file, unchanged.

    Parameters
    ----------
    path : str or path-like
        An npz file of a `Delaunay`, `ConstrainedDelaunay`, `RegularTriangulation`, `Mesh` or
        `TetMesh`, or VTU, VTK (legacy), PLY, OBJ, STL, OFF, MSH, MESH (Medit), or Triangle's ELE
        with its NODE next to it. Tetrahedra, with regions and marked faces, are read from npz, VTU,
        VTK, MSH, MESH and TetGen's ELE (no faces); its FACE, SMESH and POLY have triangles in 3-D.
    polygons : {"raise", "split"}, optional
        Whether faces with more than three corners are an error or become triangles. By default an
        error in VTU, VTK, MSH and MESH, whose polygons may be the cells of a mesh, and triangles
        in PLY and OBJ. In OFF, SMESH and POLY they always become triangles.

    Returns
    -------
    MeshFile
        Points and simplices in the order of the file. Indices are in range; nothing else has been
        validated.

    Raises
    ------
    FileNotFoundError
        There is no such file.
    FileFormatError
        Unknown suffix; the file is truncated, or contains neither triangles nor tetrahedra.
    MissingExtraError
        The library for this format is not installed.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone import Delaunay
    >>> from delone.io import read_mesh
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     Delaunay([(0, 0), (4, 0), (4, 3)]).save(Path(folder) / "mesh.npz")
    ...     read_mesh(Path(folder) / "mesh.npz").simplices.shape
    (1, 3)
    """
    file = _existing(path)
    module = _module(_MESH_READERS, _suffix(file), file, "read triangles from")
    suffix = _suffix(file)
    if polygons is None:
        polygons = "split" if suffix in _FACETS else "raise"
    split = as_choice(polygons, ("raise", "split"), name="polygons") == "split"
    read: Callable[..., MeshFile] = module.read_mesh
    return read(file, **({"split": True} if split and suffix in _READ_MESHES else {}))


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
        What to write: also a `RegularTriangulation`, a `PeriodicDelaunay` or a `ConvexHull` in 3-D.
        Tetrahedra go to VTU, MSH, XDMF, MED, INP, SU2, VTK, MESH, NODE, ELE, FACE, SMESH,
        POLY and PNG, those of a `Delaunay` or `TetMesh` to npz as well. The surface of a hull goes
        to VTU, MSH, PLY, OBJ, STL, OFF, XDMF, MED, INP, VTK, MESH, NODE, FACE, SMESH, POLY and PNG.
        Both are written without `z` and `crs`.
    z : array_like of float, shape (n,), optional
        Heights, the third coordinate, by default those of a `delone.terrain.TIN`; in plots the
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
        With 2, elements of second order, for VTU, MSH, XDMF, MED, INP, VTK, ELE and NODE: with a
        node in the middle of each edge, in the order of ``triangulation.edges`` behind the points.
        Attributes are those of points, of simplices, or of all nodes.
    version : {"2.2", "4.1"}, optional
        Version of an MSH file. By default 2.2, which more programs read, where segments or faces
        have markers or tetrahedra have regions; otherwise 4.1, which orders simplices by group.

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
        A LandXML file names no units, because those of the heights are unknown.

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
    suffix, kind = Path(path).suffix.lower(), _kind(triangulation)
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
    """Tell which simplices there are to be written: a key of `_HOLDERS`."""
    shapes = (np.shape(getattr(triangulation, name, ())) for name in ("points", "simplices"))
    coordinates, corners = (shape[1] if len(shape) == 2 else 0 for shape in shapes)
    # Meshes of others say by ndim that they are triangulations.
    if hasattr(triangulation, "_parts") or getattr(triangulation, "ndim", 0) == corners - 1:
        if (coordinates, corners) == (2, 3):
            return "separate" if hasattr(triangulation, "offsets") else "triangles"
        if coordinates == 3 and corners in (3, 4):
            return "surface" if corners == 3 else "tetrahedra"
    name = type(triangulation).__name__
    if coordinates > 3 and corners == coordinates + 1:
        raise InputError(
            f"no format of meshes has simplices in {coordinates}-D: {name}.save writes them"
        )
    raise InputError(f"cannot write an object of type {name}: pass a triangulation or a mesh")


def _require_place(path: str | os.PathLike[str], mesh: Any, kind: str, *, edges: bool) -> None:
    """Refuse what the format has no place for."""
    name, suffix = type(mesh).__name__, Path(path).suffix.lower()
    if suffix == ".npz" and not hasattr(mesh, "save"):
        raise FileFormatError(f"{path}: .npz files cannot store a {name}; use .vtu")
    if kind == "separate" and edges:
        raise FileFormatError(f"{path}: edges of a {name} are not written; write its triangles")


def _second_order(suffix: str, *, edges: bool) -> int:
    if edges or suffix not in _SECOND_ORDER:
        what = "edges" if edges else f"{suffix} files"
        raise FileFormatError(
            f"{what} have no second order here: write elements to {', '.join(_SECOND_ORDER)}"
        )
    return 2


def _version(version: str, suffix: str) -> str:
    if suffix != ".msh":
        raise FileFormatError(f"{suffix} files have no version to choose; only .msh files do")
    return as_choice(version, ("2.2", "4.1"), name="version")


def _plain(
    attributes: Mapping[str, ArrayLike] | None, suffix: str
) -> dict[str, NDArray[Any]] | None:
    """Attributes as arrays of dtypes that the format can store."""
    if attributes is None:
        return None
    if not hasattr(attributes, "items"):
        raise DtypeError(f"attributes must be a mapping of names to arrays, got {attributes!r:.60}")
    found = {}
    for name, values in attributes.items():
        array = as_plain_array(values, f"attribute {name!r}")
        kind = array.dtype.kind
        if (suffix in _MESHES and kind not in "iufb") or (suffix == ".npz" and kind == "O"):
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
    `surface`, triangles in 3-D; with ``order=2``, elements of second order, except to images.
    """
    write = _writer(path, "surface" if surface else "tetrahedra" if space else "triangles")
    suffix = Path(path).suffix.lower()
    if as_order(order) == 1 or suffix in _LABELS:
        return write
    return partial(write, order=_second_order(suffix, edges=False))


def _writer(path: str | os.PathLike[str], kind: str) -> Callable[..., None]:
    file = Path(path)
    suffix = file.suffix.lower()
    holders, what = _HOLDERS[kind]
    if suffix in _WRITERS and suffix not in holders:
        others = ", ".join(holders)
        raise FileFormatError(f"{file}: {suffix} files cannot store {what}; use {others}")
    module = _module(_WRITERS, suffix, file, "write")
    if hasattr(module, "require_libraries"):
        module.require_libraries(suffix)

    def write(place: Path, mesh: HasParts, **given: Any) -> None:
        module.write_mesh(place, mesh, Wanted(**given))

    return write


def _suffix(file: Path) -> str:
    suffixes = [suffix.lower() for suffix in file.suffixes]
    if suffixes and suffixes[-1] in SUFFIXES:
        suffixes.pop()
        if suffixes and _READERS.get(suffixes[-1]) != "text" and suffixes[-1] not in _JSON:
            raise FileFormatError(
                f"{file}: only text files and GeoJSON can be read compressed; decompress it"
            )
    return suffixes[-1] if suffixes else ""


def _module(modules: Mapping[str, str], suffix: str, file: Path, verb: str) -> Any:
    if suffix not in modules:
        what = f"files that end in {suffix}" if suffix else "a file without a suffix"
        raise FileFormatError(
            f"{file}: cannot {verb} {what}; known suffixes are {' '.join(modules)}"
        )
    return importlib.import_module(f"delone.io.{modules[suffix]}")


def _existing(path: str | os.PathLike[str]) -> Path:
    file = Path(path)
    if not file.exists():
        raise FileNotFoundError(f"{file}: no such file")
    if file.is_dir():
        raise FileFormatError(f"{file} is a folder, not a file")
    if not file.is_file():
        # Files are read twice: their format and sizes are checked before they are read.
        raise FileFormatError(f"{file} is a pipe or device; write its contents to a file first")
    if file.stat().st_size == 0:
        raise FileFormatError(f"{file} is empty")
    return file
