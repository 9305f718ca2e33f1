"""Reading points, geometries, surfaces and meshes: the public functions, by file suffix."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from delone._base.arrays import as_choice, as_count
from delone._base.files import existing, no_curves, no_layers
from delone._base.numbers import as_positive
from delone.errors import FileFormatError, InputError
from delone.io.registry import (
    FACETS,
    GEOMETRIES,
    MESH_READERS,
    READ_MESHES,
    READERS,
    SHEETS,
    is_lidar,
    is_point_tiles,
    is_text,
    module_of,
    reader_of,
    suffix_of,
)

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from delone.io.geometryset import GeometrySet
    from delone.io.meshfile import MeshFile
    from delone.io.pointset import PointSet
    from delone.io.surfacefile import SurfaceFile

__all__ = ["line_numbers", "read_geometries", "read_mesh", "read_points", "read_surface"]

# Files of points without values.
_WITHOUT_ATTRIBUTES = (".dxf", ".off", ".dem")


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
        GeoPackage, SQLite, Shapefile, FlatGeobuf, Parquet, GeoParquet, Arrow, Feather, LandXML,
        DXF, the cells of GeoTIFF, ESRI ASCII grids and NetCDF (`read_raster`), the vertices of a
        mesh, or the file ``ept.json`` of Entwine Point Tiles (EPT).
    columns : sequence of str or int, optional
        Columns of x, y and (optionally) z, by name or by number from 0. By default columns are
        recognized by their names; without names the first two or three are used, unless the first
        looks like point numbers, which is an error. For files of geometries: the one attribute
        that is z.
    classes : sequence of int, optional
        Keep the points of these classes (LAS, LAZ and EPT).
    layer : str, optional
        The layer, for files that have several; the array in an npz file; the surface in LandXML, or
        ``"CgPoints"`` for its survey points; the band of a raster.
    attributes : sequence of str or "all", optional
        Further columns to read. "all" means all that are not coordinates: those of text files are
        numbers if every field is one, otherwise strings; the number of the column is appended to
        repeated names. LandXML survey points have ``name``, ``code`` and ``desc``; DXF and OFF have
        none. Dimensions of EPT have the names used in LAS, such as ``classification``.
    chord : float, optional
        The maximum distance of chords from the curves of a DXF file; see `read_surface`.
    bounds : sequence of four float, optional
        Left, bottom, right, top: only points inside or on the border (LAS, LAZ and EPT; fast for
        COPC and EPT, where points outside are not decoded).

    Returns
    -------
    PointSet
        The points, row by row as in the file, including NaN.

    Raises
    ------
    InputError
        `attributes` is a string other than "all".
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
    journals of a GeoPackage, the NODE file next to ELE and POLY, and the nodes of EPT, in the order
    of their levels and positions. If one of these is a link to another file, it is rejected.
    Compressed files that contain more than 64 MiB (text and JSON: 8 MiB) and more than
    200 times their size are rejected; decompress them first. Lines of text longer than 16 MiB are
    rejected as well.

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
    file = existing(path)
    module = reader_of(file)
    if classes is not None and not is_lidar(file):
        raise FileFormatError(f"{file}: only LAS, LAZ and EPT have classes")
    options = {"columns": columns} | _chord(file, chord) | _attributes(attributes, module)
    if is_lidar(file):
        options |= {"classes": classes, "bounds": bounds}
    elif bounds is not None:
        raise FileFormatError(f"{file}: bounds are for LAS, LAZ and EPT, and for read_raster")
    if module.__name__.endswith((".vector", ".arrays", ".landxml", ".dxf", ".dem")):
        options["layer"] = layer
    elif layer is not None:
        raise no_layers(file)
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
    file = existing(path)
    if not is_text(file):
        raise FileFormatError(f"{file} is not a text file: its points are not in lines")
    wanted = [as_count(row, name="rows") for row in rows]
    module = importlib.import_module("delone.io.text")
    found: list[int] = module.line_numbers(file, wanted)
    return found


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
        GeoJSON (also .gz, .xz, .bz2), GeoPackage, SQLite, Shapefile, FlatGeobuf or GeoParquet; the
        lines of LandXML and DXF.
    columns : sequence of str or int, optional
        The one attribute that is the height of each feature, as for contour lines. By default
        heights are those of the coordinates, if any.
    layer : str, optional
        The layer, for files that have several; in LandXML, a surface, an alignment, or
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
    file = existing(path)
    if is_point_tiles(file):
        raise FileFormatError(f"{file} describes points, not geometries: use read_points")
    modules = {suffix: name for suffix, name in READERS.items() if name in GEOMETRIES}
    module = module_of(modules, suffix_of(file), file, "read geometries from")
    read: Callable[..., GeometrySet] = module.read_geometries
    options = _chord(file, chord, SHEETS) | _attributes(attributes, module)
    return read(file, columns=columns, layer=layer, **options)


def _attributes(attributes: Sequence[str] | str, module: Any) -> dict[str, Any]:
    """Return the further columns to read as options of a reader."""
    if not isinstance(attributes, str):
        return {"attributes": tuple(attributes)}
    if attributes != "all":
        raise InputError(f"attributes must be 'all' or names of columns, got {attributes!r:.60}")
    without = module.__name__.endswith(_WITHOUT_ATTRIBUTES)
    return {"attributes": ()} | ({} if without else {"everything": True})


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
        than finite numbers, or faces that refer to unknown points; the message names the line. Or
        northing and easting are swapped, as the declared reference system shows (with pyproj).
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
    (including polyface and polygon meshes) and curves, even in blocks. Layers that are off or
    frozen are left out unless `layer` names them. Text, hatches, solids and references to other
    drawings are left out.

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
    file = existing(path)
    modules = {suffix: name for suffix, name in READERS.items() if name in SHEETS}
    module = module_of(modules, suffix_of(file), file, "read a surface from")
    if order not in (None, "nez", "enz"):
        raise InputError(f"order must be 'nez' or 'enz', got {order!r:.60}")
    plain = "nez" if modules[suffix_of(file)] == "landxml" else "enz"
    read: Callable[..., SurfaceFile] = module.read_surface
    if chord is None:
        return read(file, name=layer, order=order or plain)
    return read(file, name=layer, order=order or plain, **_chord(file, chord))


def _chord(file: Path, chord: float | None, curved: tuple[str, ...] = ("dxf",)) -> dict[str, float]:
    """Return the option `chord` of the reader of files with curves, if it is given."""
    if chord is None:
        return {}
    if READERS.get(suffix_of(file)) not in curved:
        raise no_curves(file)
    return {"chord": as_positive(chord, name="chord")}


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
        Whether faces with more than three corners are an error or become triangles. By default,
        they are an error in VTU, VTK, MSH and MESH, whose polygons may be the cells of a mesh, and
        become triangles in PLY and OBJ. In OFF, SMESH and POLY, they always become triangles.

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
    file = existing(path)
    module = module_of(MESH_READERS, suffix_of(file), file, "read triangles from")
    suffix = suffix_of(file)
    if polygons is None:
        polygons = "split" if suffix in FACETS else "raise"
    split = as_choice(polygons, ("raise", "split"), name="polygons") == "split"
    read: Callable[..., MeshFile] = module.read_mesh
    return read(file, **({"split": True} if split and suffix in READ_MESHES else {}))
