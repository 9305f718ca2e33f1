"""DXF drawings: faces, points and lines, layers, units, and what is not a drawing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from delone import FileFormatError, InputError
from delone.io import read_geometries, read_points, read_surface
from delone.terrain import TIN

ezdxf = pytest.importorskip("ezdxf")
SQUARE = [(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)]


@pytest.fixture
def drawing(tmp_path):
    """A drawing, and a function that writes it into a folder with spaces."""
    made = ezdxf.new()
    made.units = 6
    folder = tmp_path / "site one"
    folder.mkdir()

    def save(name: str = "ground level.dxf") -> Path:
        made.saveas(folder / name)
        return folder / name

    return made, made.modelspace(), save


def test_faces_are_the_triangles(drawing):
    _, space, save = drawing
    space.add_3dface([(0, 0, 0), (4, 1, 9), (8, 0, 0)])
    space.add_3dface([(0, 0, 0), (8, 0, 0), (4, -1, 9), (4, -1, 9)])
    space.add_line((0, 0, 0), (8, 0, 0))
    space.add_point((100, 100, 100))
    surface = read_surface(save())
    assert surface.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert (surface.units, surface.lengths) == ("m", "m")
    tin = TIN.from_surface(surface)
    assert tin.heights((4, 0)) == 0 and tin.npoints == 4 and not tin.soft.any()
    assert tin.units == "m" and tin.validate()


def test_faces_with_four_corners(drawing):
    _, space, save = drawing
    space.add_3dface(SQUARE)
    assert read_surface(save()).faces.tolist() == [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize(
    ("code", "units"), [(0, None), (1, "in"), (2, "ft"), (4, "mm"), (21, "us-ft")]
)
def test_points_lines_and_units(drawing, code, units):
    made, space, save = drawing
    made.header["$INSUNITS"] = code
    for corner in SQUARE:
        space.add_point(corner)
    space.add_lwpolyline([(1, 1), (1, 3)], dxfattribs={"elevation": 5})
    space.add_polyline3d([(2, 1, 6), (2, 2, 7), (2.5, 3, 6)])
    space.add_polyline2d([(3, 1), (3, 3)], dxfattribs={"elevation": (0, 0, 2)})
    space.add_line((3.5, 1, 1), (3.5, 3, 4))
    path = save()
    tin = TIN.from_file(path)
    expected = [5, 5, 6, 7, 2, 1, 2.5]
    places = [(1, 2), (1, 3), (2, 1), (2, 2), (3, 2), (3.5, 1), (3.5, 2)]
    assert tin.heights(places).tolist() == expected
    assert tin.units == units and len(tin.breaklines) == 5
    assert len(read_points(path)) == 4 + 9
    shapely = pytest.importorskip("shapely")
    assert shapely.get_num_points(read_geometries(path).geometries).tolist() == [2, 3, 2, 2]


def test_closed_and_tilted_polylines(drawing):
    _, space, save = drawing
    space.add_lwpolyline([(1, 1), (3, 1), (3, 3)], close=True, dxfattribs={"elevation": 5})
    # A mirrored plane: x changes its sign, and so does the height.
    down = {"elevation": -7, "extrusion": (0, 0, -1)}
    space.add_lwpolyline([(-5, 1), (-5, 3)], dxfattribs=down)
    closed, mirrored = read_surface(save()).breaklines
    assert closed.tolist() == [[1, 1, 5], [3, 1, 5], [3, 3, 5], [1, 1, 5]]
    assert mirrored == pytest.approx(np.array([[5, 1, 7], [5, 3, 7]]))


def test_layers(drawing):
    made, space, save = drawing
    for name in ("spots", "kerbs", "frame, title"):
        made.layers.add(name)
    for corner in SQUARE:
        space.add_point(corner, dxfattribs={"layer": "spots"})
    space.add_line((1, 1, 3), (3, 1, 3), dxfattribs={"layer": "kerbs"})
    space.add_line((-90, -90, 0), (90, 90, 0), dxfattribs={"layer": "frame, title"})
    path = save()
    assert len(read_surface(path).breaklines) == 2
    assert len(TIN.from_file(path, layer="SPOTS, kerbs").breaklines) == 1
    assert len(TIN.from_file(path, layer="spots").breaklines) == 0
    assert len(read_surface(path, layer="frame, title").breaklines) == 1
    with pytest.raises(FileFormatError, match=r"on layer 'roads'; .* frame, title, kerbs, spots"):
        TIN.from_file(path, layer="spots,roads")
    assert len(read_points(path, layer="kerbs")) == 2
    with pytest.raises(FileFormatError, match="contains no lines"):
        read_geometries(path, layer="spots")


def test_what_is_not_read_is_named(drawing):
    made, space, save = drawing
    with pytest.raises(FileFormatError, match="contains none of 3DFACE"):
        read_surface(save("empty.dxf"))
    block = made.blocks.new("survey")
    block.add_point((0, 0, 0))
    space.add_blockref("survey", (0, 0))
    with pytest.raises(FileFormatError, match="only 1 INSERT: explode them first"):
        read_surface(save("insert.dxf"))
    space.add_lwpolyline([(0, 0, 1), (4, 0, 0)], format="xyb", dxfattribs={"layer": "arcs"})
    with pytest.raises(FileFormatError, match=r"LWPOLYLINE \w+ on layer 'arcs' has arcs"):
        read_surface(save("arc.dxf"))
    with pytest.raises(FileFormatError, match="order is for LandXML"):
        read_surface(save("arc.dxf"), order="nez")


@pytest.mark.parametrize(
    "content",
    [
        b"\x00\x01\x02garbage" * 50,
        b"AC1032" + bytes(500),
        b"  0\nSECTION\n  2\nHEADER\n",
        b"<LandXML/>",
        b"AutoCAD Binary DXF\r\n\x1a\x00" + bytes(range(256)),
        b"0\nSECTION\n2\nENTITIES\n0\nPOINT\n10\nnan\n20\n0\n30\n0\n0\nENDSEC\n0\nEOF\n",
        b"0\nSECTION\n2\nENTITIES\n0\nPOINT\n10\nx\n20\n0\n0\nENDSEC\n0\nEOF\n",
    ],
    ids=["garbage", "DWG", "cut", "XML", "binary", "nan", "text"],
)
def test_other_files_are_refused(tmp_path, content):
    path = tmp_path / "a.dxf"
    path.write_bytes(content)
    with pytest.raises(FileFormatError, match=r"a\.dxf"):
        read_surface(path)


def test_only_surfaces_have_an_order(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("x,y,z\n0,0,1\n4,0,2\n0,4,3\n")
    with pytest.raises(InputError, match="order is for LandXML"):
        TIN.from_file(path, order="enz")
