"""LandXML surfaces: round trips, files of other programs, mistakes and hostile files."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import delone
from delone import ConflictingValuesError, FileFormatError, InputError
from delone.io import LeftOutWarning, read_geometries, read_points, read_surface, write_mesh
from delone.terrain import TIN

pytest.importorskip("lxml")
FILES = Path(__file__).parent / "files"
ARRAYS = ("points", "z", "simplices", "neighbors", "breaklines", "soft")


def random_tin(seed: int = 0, **options) -> TIN:
    xyz = np.random.default_rng(seed).random((300, 3)) * [1, 1, 0.1] + [2e5, 5e5, -3]
    return TIN.from_points(xyz, **{"crs": "EPSG:28992", "units": "m"} | options)


def document(
    points: str = "", faces: str = "", *, source: str = "", before: str = "", surface: str = "a"
) -> str:
    """A file with one surface; each element on a line of its own, the first point on line 4."""
    return (
        f'<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2">{before}\n'
        f'<Surfaces><Surface name="{surface}"><SourceData>{source}</SourceData><Definition>\n'
        f"<Pnts>\n{points}</Pnts>\n<Faces>\n{faces}</Faces></Definition></Surface></Surfaces>"
        "</LandXML>"
    )


POINTS = '<P id="a">0 0 1</P>\n<P id="b">0 4 2</P>\n<P id="c">3 4 3</P>\n<P id="d">3 0 4</P>\n'
METER = '<Units><Metric linearUnit="meter"/></Units>'


def written(tmp_path: Path, text: str, name: str = "a.xml") -> Path:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def corners(tin: TIN, rows) -> set:
    """Triangles or edges by the bits of the coordinates of their vertices."""
    return {frozenset(map(tuple, tin.xyz[row].tolist())) for row in rows}


@pytest.mark.parametrize("suffix", [".xml", ".landxml"])
@pytest.mark.parametrize("seed", range(3))
def test_round_trips_bit_for_bit(tmp_path, seed, suffix):
    folder = tmp_path / "site one"
    folder.mkdir()
    lines = {"breaklines": [[(2e5 + 0.2, 5e5 + 0.2, 3), (2e5 + 0.8, 5e5 + 0.7, 4)]]}
    for options in ({}, {"units": "us-ft", "crs": "EPSG:2263"}, lines):
        tin = random_tin(seed, **options)
        write_mesh(folder / f"ground level{suffix}", tin)
        again = TIN.from_file(folder / f"ground level{suffix}")
        for name in ARRAYS:
            assert np.array_equal(getattr(again, name), getattr(tin, name)), name
        assert (again.units, again.crs) == (tin.units, tin.crs)
        assert again.validate()
        assert [path.name for path in folder.iterdir()] == [f"ground level{suffix}"]


@pytest.mark.parametrize("seed", range(3))
def test_round_trips_of_holes_and_outlines(tmp_path, seed):
    x, y = 2e5, 5e5
    ring = [(x + 0.4, y + 0.4, 0), (x + 0.6, y + 0.4, 0), (x + 0.6, y + 0.6, 0)]
    soft = [[(x + 0.1, y + 0.9, 3), (x + 0.8, y + 0.8, 4)]]
    tin = random_tin(seed, holes=[ring], soft_breaklines=soft, max_edge=0.15)
    write_mesh(tmp_path / "a.xml", tin)
    again = TIN.from_file(tmp_path / "a.xml")
    assert corners(again, again.simplices) == corners(tin, tin.simplices)
    for soft in (False, True):
        of_tin, of_again = (corners(t, t.breaklines[t.soft == soft]) for t in (tin, again))
        sides = corners(tin, tin.edges)
        assert of_tin & sides == of_again
    assert again.volume_to(-2.0).cut == pytest.approx(tin.volume_to(-2.0).cut, rel=1e-12)
    # Without the faces, the boundary and the hole are the extent.
    afresh = TIN.from_file(tmp_path / "a.xml", faces=False)
    assert afresh.areas.sum() == pytest.approx(tin.areas.sum(), rel=1e-9)


def test_faces_that_are_not_delaunay_are_kept(tmp_path):
    # The other diagonal of a kite.
    points = '<P id="1">0 0 0</P><P id="2">1 4 9</P><P id="3">0 8 0</P><P id="4">-1 4 9</P>'
    path = written(tmp_path, document(points, "<F>1 2 3</F><F>1 3 4</F>"))
    tin = TIN.from_file(path)
    assert corners(tin, tin.simplices) == {
        frozenset({(0.0, 0.0, 0.0), (4.0, 1.0, 9.0), (8.0, 0.0, 0.0)}),
        frozenset({(0.0, 0.0, 0.0), (4.0, -1.0, 9.0), (8.0, 0.0, 0.0)}),
    }
    assert tin.heights((4, 0)) == 0 and tin.soft.tolist() == [True] and tin.validate()
    assert TIN.from_file(path, faces=False).heights((4, 0)) == 9


@pytest.mark.parametrize("seed", range(4))
def test_faces_in_any_way_around_with_ties(tmp_path, seed):
    rng = np.random.default_rng(seed)
    x, y = (each.ravel() for each in np.meshgrid(np.arange(6), np.arange(6)))
    ids = np.arange(36).reshape(6, 6)
    faces = []
    for i in range(5):
        for j in range(5):
            a, b, c, d = ids[i, j], ids[i, j + 1], ids[i + 1, j + 1], ids[i + 1, j]
            pair = [(a, b, c), (a, c, d)] if rng.random() < 0.5 else [(a, b, d), (b, c, d)]
            faces += [rng.permutation(face) for face in pair]
    points = "".join(f'<P id="{k}">{y[k]} {x[k]} {k % 7}</P>\n' for k in range(36))
    text = document(points, "".join(f"<F>{a} {b} {c}</F>\n" for a, b, c in faces))
    tin = TIN.from_file(written(tmp_path, text))
    xyz = np.column_stack((x, y, np.arange(36) % 7)).astype(float)
    expected = {frozenset(map(tuple, xyz[list(face)].tolist())) for face in faces}
    assert corners(tin, tin.simplices) == expected
    assert tin.validate()


def test_a_file_as_civil_3d_writes_it():
    surface = read_surface(FILES / "civil3d.xml")
    assert repr(surface) == ("<SurfaceFile of 6 points: 4 faces, 2 breaklines, heights in us-ft>")
    assert (surface.name, surface.lengths, surface.crs) == ("EG", "us-ft", "EPSG:2263")
    tin = TIN.from_surface(surface)
    # Northing first; the invisible face and its point are outside.
    assert tin.xyz[0].tolist() == [1000000, 200000, 10]
    assert tin.nsimplex == 4 and tin.npoints == 5
    assert np.isnan(tin.heights((1000020, 200004)))
    assert corners(tin, tin.breaklines) == {
        frozenset({(1000000.0, 200000.0, 10.0), (1000004.0, 200004.0, 14.0)})
    }
    assert tin.units == "us-ft" == tin.contours([12]).units == tin.bands([12]).units
    assert tin.volume_to(10).units == "us-ft" and tin.volume_to(10).crs == "EPSG:2263"


def test_a_file_as_12d_writes_it(tmp_path):
    path = FILES / "12d.xml"
    with pytest.raises(FileFormatError, match=r"several surfaces.*'tin survey', 'tin design'"):
        read_surface(path)
    with pytest.raises(FileFormatError, match="no surface 'tin'; its surfaces are 'tin survey'"):
        TIN.from_file(path, layer="tin")
    assert TIN.from_file(path, layer="tin survey").z.tolist() == [41.25, 42.5, 43.125, 42]
    design = TIN.from_file(path, layer="tin design")
    assert design.areas.sum() == pytest.approx(96)
    assert design.heights((300005, 6250002)) == 41
    assert np.isnan(design.heights((300005, 6250005)))
    assert design.units == "m" and design.crs is None
    assert len(read_points(path, layer="tin design")) == 6
    shapely = pytest.importorskip("shapely")
    lines = read_geometries(path, layer="tin design").geometries
    assert shapely.get_type_id(lines).tolist() == [1, 3, 3]


@pytest.mark.parametrize("version", ["1.0", "1.1", "1.2", None])
def test_versions(tmp_path, version):
    space = f'xmlns="http://www.landxml.org/schema/LandXML-{version}"' if version else ""
    text = document(POINTS, "<F>a b c</F>\n<F>a c d</F>\n").replace(
        'xmlns="http://www.landxml.org/schema/LandXML-1.2"', space
    )
    surface = read_surface(written(tmp_path, text))
    assert surface.points.tolist() == [[0, 0, 1], [4, 0, 2], [4, 3, 3], [0, 3, 4]]
    assert surface.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert surface.units is None


MISTAKES = {
    "no id": (POINTS.replace(' id="b"', ""), "", "line 5: this point has no id"),
    "id twice": (POINTS.replace('"c"', '"a"'), "", "line 6: a second point has the id 'a'"),
    "nan": (POINTS.replace("0 4 2", "0 nan 2"), "", "line 5: 'nan' is not a finite number"),
    "huge": (POINTS.replace("0 4 2", "0 1e999 2"), "", "line 5: .* range of doubles"),
    "text": (POINTS.replace("0 4 2", "0 4 high"), "", "line 5: 'high' is not a finite number"),
    "underscore": (POINTS.replace("0 4 2", "0 4_0 2"), "", "line 5: '4_0' is not"),
    "no height": (POINTS.replace("0 4 2", "0 4"), "", "line 5: 3 numbers for each point"),
    "two points": (POINTS.replace("0 4 2", "0 4 2 0 4 2"), "", "line 5: point 'b' has 6 numbers"),
    "unknown": (POINTS, "<F>a b c</F>\n<F>a b x</F>\n", "line 11: a face refers to point 'x'"),
    "corners": (POINTS, "<F>a b</F>\n", "line 10: a face has three points, or four"),
    "repeated": (POINTS, "<F>a b a</F>\n", "line 2: all faces .* repeat a corner"),
    "invisible": (POINTS, '<F i="1">a b c</F>\n', "line 2: all faces .* are invisible"),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_mistakes_have_their_line(tmp_path, name):
    points, faces, message = MISTAKES[name]
    with pytest.raises(FileFormatError, match=message):
        read_surface(written(tmp_path, document(points, faces)))


def test_points_may_follow_their_faces(tmp_path):
    text = document(POINTS, "<F>a b c</F>\n")
    pnts, faces = text.index("<Pnts>"), text.index("<Faces>")
    end = text.index("</Definition>")
    text = text[:pnts] + text[faces:end] + text[pnts:faces] + text[end:]
    assert read_surface(written(tmp_path, text)).faces.tolist() == [[0, 1, 2]]


def test_faces_that_overlap_or_are_walls(tmp_path):
    both = document(POINTS, "<F>a b c</F><F>b c d</F>")
    with pytest.raises(InputError, match=r"faces overlap.*first \(.*faces=False"):
        TIN.from_file(written(tmp_path, both))
    inside = POINTS + '<P id="e">1 2 0</P>'
    with pytest.raises(InputError, match="faces overlap"):
        TIN.from_file(written(tmp_path, document(inside, "<F>a b c</F><F>a e b</F>")))
    wall = POINTS + '<P id="e">0 0 9</P>'
    faces = "<F>a b c</F><F>e c d</F>"
    path = written(tmp_path, document(wall, faces))
    with pytest.raises(ConflictingValuesError, match=r"\(0, 0\): 1 to 9"):
        TIN.from_file(path)
    assert TIN.from_file(path, duplicates="max").heights((0, 0)) == 9
    flat = document(POINTS.replace("3 4 3", "0 8 3"), "<F>a b c</F><F>a b d</F>")
    assert TIN.from_file(written(tmp_path, flat)).nsimplex == 1
    with pytest.raises(InputError, match="no face has an area"):
        TIN.from_file(written(tmp_path, flat.replace("<F>a b d</F>", "")))


def test_lines_beside_faces_are_refused(tmp_path):
    path = written(tmp_path, document(POINTS, "<F>a b c</F>"))
    with pytest.raises(InputError, match="has faces, so max_edge changes nothing: faces=False"):
        TIN.from_file(path, max_edge=3)
    assert TIN.from_file(path, faces=False, max_edge=5).nsimplex == 2


def test_swapped_coordinates_are_found_by_the_system(tmp_path):
    pytest.importorskip("pyproj")
    text = (FILES / "civil3d.xml").read_text(encoding="utf-8")
    path = written(tmp_path, text)
    assert TIN.from_file(path).points[0].tolist() == [1000000, 200000]
    # In the Netherlands, northings are beyond 300 km and eastings below 280 km.
    place = '<P id="a">155000 463000 1</P>\n<P id="b">155000 463004 1</P>\n'
    place += '<P id="c">155004 463000 1</P>\n'
    text = document(place, "<F>a b c</F>", before='<CoordinateSystem epsgCode="28992"/>')
    path = written(tmp_path, text)
    with pytest.raises(FileFormatError, match=r"northing are swapped.*order='enz'"):
        TIN.from_file(path)
    assert TIN.from_file(path, order="enz").points[0].tolist() == [155000, 463000]
    with pytest.raises(FileFormatError, match=r"northing are swapped.*order='nez'"):
        TIN.from_file(FILES / "civil3d.xml", order="enz")
    plain = written(tmp_path, document(place, "<F>a b c</F>"))
    assert TIN.from_file(plain).points[0].tolist() == [463000, 155000]
    with pytest.raises(InputError, match="order must be"):
        read_surface(plain, order="xyz")


def test_files_that_are_something_else(tmp_path):
    for text, message in (
        ("<Other/>", "root is <Other>"),
        ("<LandXML/>", "contains no surface"),
        ("<LandXML><Surfaces>", "not valid XML"),
        ("PK\x03\x04", "not valid XML"),
        (
            document(POINTS).replace("<Definition", '<Definition surfType="grid"'),
            "is a grid without faces",
        ),
        ("<LandXML>" + "<a>" * 5000 + "</a>" * 5000 + "</LandXML>", "not valid XML"),
        (
            document(POINTS, before=METER.replace("meter", "furlong")),
            "linearUnit must be a unit of length",
        ),
        (document(POINTS, before='<CoordinateSystem epsgCode="x"/>'), "epsgCode 'X' is not"),
        (document(POINTS, before='<CoordinateSystem ogcWktCode="/etc/passwd"/>'), "names a file"),
    ):
        with pytest.raises(FileFormatError, match=message):
            read_surface(written(tmp_path, text))


def test_long_texts_are_refused(tmp_path):
    source = f"<DataPoints><PntList3D>{'1 2 3 ' * 2_000_000}</PntList3D></DataPoints>"
    with pytest.raises(FileFormatError, match="not valid XML"):
        read_surface(written(tmp_path, document(source=source)))


def test_units_are_written_and_never_mixed(tmp_path):
    xyz = np.array([(0, 0, 1), (4, 0, 1), (4, 4, 1), (0, 4, 1)])
    for given, known in (("feet", "ft"), ("USSurveyFoot", "us-ft"), ("Meters", "m"), ("mm", "mm")):
        tin = TIN.from_points(xyz, units=given)
        assert tin.units == known
        write_mesh(tmp_path / "a.xml", tin)
        assert TIN.from_file(tmp_path / "a.xml").units == known
        tin.save(tmp_path / "a.npz")
        assert TIN.load(tmp_path / "a.npz").units == known
    # The last file states millimeters.
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert TIN.from_file(tmp_path / "a.xml", units="mm").units == "mm"
    for faces in (True, False):
        with pytest.warns(delone.UnitsWarning, match="states heights in mm, and units='ft'"):
            assert TIN.from_file(tmp_path / "a.xml", units="ft", faces=faces).units == "ft"
    feet, meters, unknown = (TIN.from_points(xyz, units=u) for u in ("ft", "m", None))
    with pytest.raises(
        InputError, match=r"heights are in ft and in m: multiply those in m by 3\.28"
    ):
        feet.volume_to(meters)
    assert feet.volume_to(unknown).area == 16
    with pytest.warns(delone.UnitsWarning, match="names none"):
        write_mesh(tmp_path / "b.xml", unknown)
    assert TIN.from_file(tmp_path / "b.xml").units is None
    with pytest.raises(InputError, match="units must be a unit of length"):
        TIN.from_points(xyz, units="furlong")


def test_units_of_systems(tmp_path):
    pytest.importorskip("pyproj")
    xyz = np.array([(1e6, 2e5, 1), (1e6 + 4, 2e5, 1), (1e6, 2e5 + 4, 1)])
    with pytest.warns(delone.UnitsWarning, match="x and y are in us-ft and heights in m"):
        tin = TIN.from_points(xyz, crs="EPSG:2263", units="m")
    write_mesh(tmp_path / "a.xml", tin)
    assert 'linearUnit="USSurveyFoot"' in (tmp_path / "a.xml").read_text()
    with pytest.warns(delone.UnitsWarning, match="x and y are in us-ft and heights in m"):
        assert TIN.from_file(tmp_path / "a.xml").units == "m"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # Amersfoort / RD New with heights above NAP, in meters.
        assert TIN.from_points(xyz, crs="EPSG:7415").units == "m"
    with pytest.raises(InputError, match="vertical axis"):
        TIN.from_points(xyz, crs="EPSG:7415", units="ft")
    text = document(POINTS, "<F>a b c</F>", before=METER + '<CoordinateSystem epsgCode="2263"/>')
    with pytest.warns(delone.UnitsWarning, match="x and y are in m, but those of EPSG:2263"):
        TIN.from_surface(read_surface(written(tmp_path, text)))
    with pytest.warns(delone.GeographicWarning, match="EPSG:4326"):
        TIN.from_points([(4, 52, 0), (5, 52, 0), (4, 53, 0)], crs="EPSG:4326")


def test_outlines_and_lines_are_joined_up_to_their_ends(tmp_path):
    x = np.arange(9.0)
    grid = np.array([(i, j, 0.0) for i in x for j in x])
    star = [[(7, 7, 0), (7, 4, 0)], [(7, 7, 0), (4, 7, 0)], [(7, 7, 0), (4, 4, 0)]]
    hole = [(1.5, 1.5, 0), (2.5, 1.5, 0), (2.5, 2.5, 0), (1.5, 2.5, 0)]
    tin = TIN.from_points(grid, breaklines=star, holes=[hole], units="m")
    write_mesh(tmp_path / "a.xml", tin)
    text = (tmp_path / "a.xml").read_text()
    assert (text.count('"outer"'), text.count('"void"')) == (1, 1)
    surface = read_surface(tmp_path / "a.xml")
    assert sorted(map(len, surface.breaklines)) == [4, 4, 4, 5]
    assert [len(ring) for ring in surface.boundary + surface.holes] == [33, 5]
    # Two triangles that share a corner have two outlines.
    points = '<P id="e">-3 -4 0</P><P id="f">-3 0 0</P>' + "".join(reversed(POINTS.splitlines()))
    touching = TIN.from_file(
        written(tmp_path, document(points, "<F>a b c</F><F>a e f</F>", before=METER))
    )
    write_mesh(tmp_path / "b.xml", touching)
    assert [len(ring) for ring in read_surface(tmp_path / "b.xml").boundary] == [4, 4]


def test_what_the_format_cannot_store(tmp_path):
    tin = random_tin()
    with pytest.raises(FileFormatError, match="need heights"):
        write_mesh(tmp_path / "a.xml", delone.Delaunay(tin.points))
    with pytest.raises(FileFormatError, match="cannot store edges"):
        write_mesh(tmp_path / "a.xml", tin, edges=True)
    with pytest.raises(FileFormatError, match="cannot store attributes"):
        write_mesh(tmp_path / "a.xml", tin, attributes={"a": tin.z})
    with pytest.raises(FileFormatError, match="finite height"):
        write_mesh(tmp_path / "a.xml", tin, z=np.full(tin.npoints, np.nan))
    assert list(tmp_path.iterdir()) == []


def test_the_lines_of_a_file_count_without_its_faces():
    afresh = TIN.from_file(FILES / "civil3d.xml", faces=False)
    assert afresh.areas.sum() == pytest.approx(64)
    ends = corners(afresh, afresh.breaklines[afresh.soft])
    assert frozenset({(1000000.0, 200002.0, 12.0), (1000002.0, 200002.0, 12.0)}) in ends


CORNERS = (
    '<Pnts><P id="1">0 0 1</P><P id="2">0 10 2</P><P id="3">10 10 3</P><P id="4">10 0 4</P></Pnts>'
)


def surface_of(tmp_path, faces, *, kind="TIN", source=""):
    path = tmp_path / "faces.xml"
    path.write_text(
        '<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2"><Surfaces><Surface name="EG">'
        f'{source}<Definition surfType="{kind}">{CORNERS}<Faces>{faces}</Faces></Definition>'
        "</Surface></Surfaces></LandXML>"
    )
    return path


@pytest.mark.parametrize(
    ("kind", "faces", "left_out", "quads"),
    [
        ("TIN", "<F>1 2 3</F><F>1 3 4</F><F>3 1 2</F><F>3 2 1</F>", {"repeated face": 2}, 0),
        ("TIN", "<F>1 2 3</F><F>1 3 3</F><F>1 3 4</F>", {"face that repeats a corner": 1}, 0),
        ("TIN", "<F>1 2 3</F><F i='1'>1 3 3</F><F>1 3 4</F>", {}, 0),
        ("TIN", "<F b='0'>1 2 3</F><F b='1'>1 3 4</F>", {"mark of breaklines (b) of a face": 1}, 0),
        ("grid", "<F>1 2 3 4</F>", {}, 1),
        ("GRID", "<F>1 2 3</F><F>1 3 4</F>", {}, 0),
    ],
)
def test_faces_that_other_programs_read(tmp_path, kind, faces, left_out, quads):
    path = surface_of(tmp_path, faces, kind=kind)
    surface = read_surface(path)
    assert surface.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert (surface.left_out, surface.quads) == (left_out, quads)
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        tin = TIN.from_file(path)
    assert tin.areas.sum() == 100
    assert [each.category for each in found] == [LeftOutWarning] * bool(left_out)


def test_faces_of_other_numbers_of_points(tmp_path):
    for faces in ("<F>1 2</F>", "<F>1 2 3 4 1</F>"):
        with pytest.raises(FileFormatError, match="three points, or four in a grid"):
            read_surface(surface_of(tmp_path, faces))
    with pytest.raises(FileFormatError, match="a grid without faces"):
        read_surface(surface_of(tmp_path, "", kind="grid"))


def test_walls_and_what_is_no_surface_are_counted(tmp_path):
    source = (
        '<SourceData><PointFiles><PointFile fileName="a.txt"/></PointFiles><Breaklines>'
        '<Breakline brkType="wall" brkWallHt="2"><PntList3D>1 5 5 9 5 6</PntList3D></Breakline>'
        '<Breakline brkType="standard"><PntList3D>1 7 5 9 7 6</PntList3D></Breakline>'
        "<RetWall/></Breaklines><DataPoints><PntList3D>4 8 9 5 8 9</PntList3D></DataPoints>"
        "</SourceData>"
    )
    surface = read_surface(surface_of(tmp_path, "<F>1 2 3</F><F>1 3 4</F>", source=source))
    assert surface.left_out == {
        "PointFile": 1,
        "upper line of a wall": 1,
        "RetWall": 1,
        "DataPoints beside faces": 2,
    }
    assert surface.breaklines[0].tolist() == [[5, 1, 5], [5, 9, 6]]
    with pytest.warns(LeftOutWarning, match="1 upper line of a wall"):
        TIN.from_surface(surface)
