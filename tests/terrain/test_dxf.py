"""DXF drawings: faces, points and lines, layers, units, and what is not a drawing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from delone import FileFormatError, InputError
from delone.io import LeftOutWarning, read_geometries, read_points, read_surface
from delone.terrain import TIN

ezdxf = pytest.importorskip("ezdxf")
SQUARE = [(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)]
SPACED = {"row_spacing": 1, "column_spacing": 1}


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
    assert surface.left_out == {"POINT beside faces": 1}
    assert surface.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert (surface.units, surface.lengths) == ("m", "m")
    with pytest.warns(LeftOutWarning, match="1 POINT beside faces"):
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
    _, space, save = drawing
    with pytest.raises(FileFormatError, match="contains none of 3DFACE"):
        read_surface(save("empty.dxf"))
    space.add_text("12.3")
    space.add_hatch()
    with pytest.raises(FileFormatError, match="only 1 TEXT, 1 HATCH"):
        read_surface(save("text.dxf"))
    space.add_point((0, 0, 0))
    surface = read_surface(save("arc.dxf"))
    assert surface.left_out == {"TEXT": 1, "HATCH": 1}
    assert "left out: 1 TEXT, 1 HATCH" in repr(surface)
    with pytest.warns(LeftOutWarning, match="1 TEXT, 1 HATCH"):
        read_points(save("arc.dxf"))
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


def within(lines, center, radius, chord):
    """Whether corners of lines are on a circle and the middles of chords within `chord` of it."""
    for line in lines:
        far = np.linalg.norm(line[:, :2] - center, axis=1)
        middle = np.linalg.norm((line[1:, :2] + line[:-1, :2]) / 2 - center, axis=1)
        assert np.allclose(far, radius) and (middle >= radius - chord).all()


@pytest.mark.parametrize("chord", [None, 0.5, 0.01, 1e-4])
def test_curves_become_chords(drawing, chord):
    _, space, save = drawing
    space.add_arc((5, 1, 2), 3, -90, 90)
    space.add_circle((5, 1, 2), 3)
    space.add_lwpolyline(
        [(5, -2, 1), (5, 4, 1)], format="xyb", close=True, dxfattribs={"elevation": 2}
    )
    space.add_polyline2d([(5, -2, 0), (5, 4, 0)], format="xyb").vertices[0].dxf.bulge = 1
    surface = read_surface(save(), chord=chord)
    assert surface.curves == 4 and not surface.left_out and len(surface.breaklines) == 4
    within(surface.breaklines, (5, 1), 3, chord or 0.003)
    assert [line[0, 2] for line in surface.breaklines] == [2, 2, 2, 0]
    counts = [len(line) for line in surface.breaklines]
    assert abs(counts[1] - counts[2]) <= 1 and (chord != 1e-4 or counts[1] > 300)


def test_splines_and_ellipses(drawing):
    _, space, save = drawing
    space.add_spline([(0, 0, 1), (2, 1.5, 5), (5, 3, 2)])
    space.add_ellipse((0, 0, 4), (2, 0, 0), 0.5)
    spline, ellipse = read_surface(save(), chord=0.01).breaklines
    assert np.allclose(spline[[0, -1]], [(0, 0, 1), (5, 3, 2)])
    assert np.abs(spline - (2, 1.5, 5)).sum(axis=1).min() < 0.5
    assert np.allclose((ellipse[:, 0] / 2) ** 2 + ellipse[:, 1] ** 2, 1)
    assert (ellipse[0] == ellipse[-1]).all()
    assert (ellipse[:, 2] == 4).all()


def test_blocks_are_expanded(drawing):
    made, space, save = drawing
    inner = made.blocks.new("mark")
    inner.add_point((1, 0, 0))
    block = made.blocks.new("spot")
    block.add_blockref("mark", (0, 0, 0))
    block.add_line((0, 0, 0), (2, 0, 0), dxfattribs={"layer": "kerbs"})
    block.add_attdef("NO", (0, 0))
    space.add_blockref("spot", (10, 20, 5), dxfattribs={"rotation": 90, "layer": "spots"})
    insert = space.add_blockref("spot", (0, 0, 7), dxfattribs={"xscale": 3, "yscale": 3})
    insert.add_attrib("NO", "17")
    space.add_blockref("mark", (0, 0, 0), dxfattribs={"row_count": 2, "row_spacing": 5})
    surface = read_surface(save())
    assert np.allclose(surface.points, [(10, 21, 5), (3, 0, 7), (1, 0, 0), (1, 5, 0)])
    assert np.allclose(surface.breaklines, [[(10, 20, 5), (10, 22, 5)], [(0, 0, 7), (6, 0, 7)]])
    assert surface.left_out == {"ATTRIB": 1}
    # Layer 0 of a block is that of the reference.
    assert np.allclose(read_surface(save(), layer="spots").points, [(10, 21, 5)])
    assert len(read_surface(save(), layer="kerbs").breaklines) == 2


def test_blocks_that_expand_without_end(drawing, monkeypatch):
    made, space, save = drawing
    for k in range(30):
        block = made.blocks.new(f"b{k}")
        for x in (0, 1):
            block.add_blockref(f"b{k + 1}", (x, 0))
    made.blocks.new("b30").add_point((0, 0))
    space.add_blockref("b0", (0, 0))
    monkeypatch.setattr("delone.io.dxf_entities._ALWAYS", 1 << 6)
    monkeypatch.setattr("delone.io.dxf_entities._BYTES", 1 << 10)
    with pytest.raises(FileFormatError, match=r"blocks contain far more|repeats block"):
        read_surface(save())
    space.delete_all_entities()
    space.add_blockref(
        "b30", (0, 0), dxfattribs={"row_count": 30000, "column_count": 30000, **SPACED}
    )
    with pytest.raises(FileFormatError, match="900000000 times"):
        read_surface(save())
    space.delete_all_entities()
    made.blocks.get("b30").add_blockref("b29", (0, 0))
    space.add_blockref("b30", (0, 0))
    with pytest.raises(FileFormatError, match="contains itself"):
        read_surface(save())


def test_hidden_layers_are_left_out(drawing):
    made, space, save = drawing
    made.layers.add("off").off()
    made.layers.add("frozen").freeze()
    for layer, z in (("0", 1), ("off", 100), ("frozen", 200)):
        space.add_line((0, z, z), (5, z, z), dxfattribs={"layer": layer})
    space.add_line((0, 9, 9), (5, 9, 9), dxfattribs={"invisible": 1})
    block = made.blocks.new("block")
    block.add_point((0, 0, 3))
    block.add_point((0, 0, 4), dxfattribs={"layer": "off"})
    space.add_blockref("block", (0, 0), dxfattribs={"layer": "frozen"})
    space.add_blockref("block", (0, 0))
    space.add_blockref("block", (5, 0), dxfattribs={"layer": "off"})
    surface = read_surface(save())
    assert [line[0, 2] for line in surface.breaklines] == [1]
    assert surface.points.tolist() == [[0, 0, 3]]
    assert surface.left_out == {"hidden": 8}
    # One that is named is read.
    assert read_surface(save(), layer="off").breaklines[0][0, 2] == 100


@pytest.mark.parametrize("kind", ["3dfaces", "polyface", "mesh"])
def test_meshes(drawing, kind):
    from ezdxf.render import MeshBuilder

    _, space, save = drawing
    mesh = MeshBuilder()
    mesh.vertices = [(0, 0, 0), (4, 0, 1), (4, 4, 2), (0, 4, 1), (2, 8, 5), (2, 2, 9)]
    mesh.faces = [(0, 1, 2), (0, 2, 3)] if kind != "mesh" else [(0, 1, 2, 3), (3, 2, 4)]
    getattr(mesh, f"render_{kind}")(space)
    space.add_line((0, 0, 0), (4, 4, 2))
    surface = read_surface(save())
    assert len(surface.faces) == (3 if kind == "mesh" else 2)
    assert surface.points[surface.faces].tolist()[:2] == [
        [[0, 0, 0], [4, 0, 1], [4, 4, 2]],
        [[0, 0, 0], [4, 4, 2], [0, 4, 1]],
    ]


def test_a_mesh_of_polygons_and_a_grid(drawing):
    _, space, save = drawing
    with space.add_mesh().edit_data() as mesh:
        # An L: its first corner does not see all others.
        mesh.vertices = [(2, 0, 0), (2, 1, 0), (1, 1, 0), (1, 2, 0), (0, 2, 0), (0, 0, 0)]
        mesh.faces = [(0, 1, 2, 3, 4, 5)]
    surface = read_surface(save())
    tin = TIN.from_surface(surface)
    assert len(surface.faces) == 4 and tin.areas.sum() == 3
    space.delete_all_entities()
    grid = space.add_polymesh((3, 3))
    for i in range(3):
        for j in range(3):
            grid.set_mesh_vertex((i, j), (i, j, i * j))
    assert TIN.from_file(save()).heights((2, 2)) == 4


def test_chord_is_for_curves(drawing, tmp_path):
    _, space, save = drawing
    space.add_circle((0, 0), 1)
    for wrong in (0, -1, float("nan"), "x"):
        with pytest.raises((InputError, TypeError), match="chord"):
            read_surface(save(), chord=wrong)
    (tmp_path / "a.csv").write_text("x,y,z\n0,0,1\n4,0,2\n0,4,3\n")
    with pytest.raises(InputError, match="chord is for DXF"):
        TIN.from_file(tmp_path / "a.csv", chord=1)
