"""The command ``terrain``: its files are those of separate commands, its page loads nothing."""

import json
import re
from html.parser import HTMLParser
from urllib.parse import unquote

import geopandas
import numpy as np
import pytest
import shapely

from delone.cli import site, surfaces
from delone.io import read_points
from delone.terrain import TIN


@pytest.fixture
def hill(tmp_path):
    """A survey with a line, in a folder of its own."""
    random = np.random.default_rng(3)
    xy = random.random((2000, 2)) * 100
    z = 9 * np.exp(-(((xy - 50) / 25) ** 2).sum(axis=1)) + random.random(2000) / 9
    path = tmp_path / "hill.csv"
    np.savetxt(path, np.column_stack((xy, z)), delimiter=",", header="x,y,z", comments="")
    road = shapely.LineString([(20, 20), (60, 55), (80, 50)])
    geopandas.GeoDataFrame(geometry=[road], crs="EPSG:28992").to_file(tmp_path / "road.gpkg")
    return path


class Page(HTMLParser):
    """Tags and texts of a page."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.texts = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.texts.append(data)


COMMON = ("--crs", "EPSG:28992", "--units", "m", "--max-edge", "9")


def test_files_are_those_of_separate_commands(hill, command, tmp_path):
    site_, road = tmp_path / "site", tmp_path / "road.gpkg"
    lines = ("--smooth", "1", "--min-length", "5", "--simplify", "0.2", "--min-area", "2")
    code, _, err = command(
        "terrain", hill, *COMMON, "--contours", "0.5", "--bands", "2", *lines, "--dem", "2",
        "--hillshade", "--slope", "--aspect", "--profile", road, "-o", site_,
    )  # fmt: skip
    assert (code, err) == (0, "")
    for name, own in (
        ("contours", ("--interval", "0.5", *lines)),
        ("bands", ("--bands", "--interval", "2", "--min-area", "2", "--simplify", "0.2")),
    ):
        alone = tmp_path / f"{name}.gpkg"
        assert command("contours", hill, *COMMON, *own, "-o", alone)[0] == 0
        a, b = geopandas.read_file(site_ / alone.name), geopandas.read_file(alone)
        assert len(a) > 4
        assert a.equals(b)
        assert a.crs == b.crs
    for name in ("dem", "hillshade", "slope", "aspect"):
        alone = tmp_path / f"{name}.tif"
        own = () if name == "dem" else (f"--{name}",)
        assert command("dem", hill, *COMMON, "-r", "2", *own, "-o", alone)[0] == 0
        assert (site_ / alone.name).read_bytes() == alone.read_bytes()
    alone = tmp_path / "road.csv"
    assert command("profile", hill, road, *COMMON, "-o", alone)[0] == 0
    assert (site_ / "profile-road.csv").read_bytes() == alone.read_bytes()
    assert len(list(site_.iterdir())) == 8


def test_the_surface_is_made_once(hill, figures, tmp_path, monkeypatch):
    made = []
    real = TIN.from_points.__func__

    def counted(cls, *args, **options):
        made.append(len(args[0].points))
        return real(cls, *args, **options)

    reads = []
    monkeypatch.setattr(TIN, "from_points", classmethod(counted))
    monkeypatch.setattr(
        surfaces, "read_points", lambda *a, **k: reads.append(a) or read_points(*a, **k)
    )
    found = figures(
        "terrain", hill, *COMMON, "--contours", 1, "--dem", 4, "--volume", 2, "-o", tmp_path / "s"
    )
    assert made == [2000]
    assert len(reads) == 1
    products = {each["product"]: each for each in found["products"]}
    alone = figures("volume", hill, 2, *COMMON)
    assert {name: products["volume"][name] for name in ("cut", "fill", "area")} == {
        name: alone[name] for name in ("cut", "fill", "area")
    }
    assert products["volume"]["volume_units"] == "m3"
    assert found["outputs"][-1].endswith("index.html")


def test_the_page_has_pictures_and_numbers_and_loads_nothing(hill, figures, tmp_path):
    found = figures(
        "terrain", hill, *COMMON, "--contours", 1, "--dem", 4, "--volume", 2,
        "--profile", tmp_path / "road.gpkg", "-o", tmp_path / "s",
    )  # fmt: skip
    text = (tmp_path / "s" / "index.html").read_text(encoding="utf-8")
    page = Page(text)
    assert {tag for tag, _ in page.tags}.isdisjoint({"script", "link", "iframe", "object"})
    assert not any(name.startswith("on") for _, given in page.tags for name in given)
    images = [given for tag, given in page.tags if tag == "img"]
    assert len(images) == 5
    assert all(each["src"].startswith("data:image/png;base64,") and each["alt"] for each in images)
    links = [unquote(given["href"]) for tag, given in page.tags if tag == "a"]
    assert links == ["./contours.gpkg", "./dem.tif", "./profile-road.csv"]
    assert all((tmp_path / "s" / link).exists() for link in links)
    assert "default-src 'none'" in text
    assert not re.search(r"https?:", text)
    for product in found["products"]:
        for value in product.values():
            if isinstance(value, float):
                assert any(part.startswith(f"{value:.10g}") for part in page.texts)


@pytest.mark.filterwarnings("error")
def test_volumes_to_several_surfaces(hill, figures, command, tmp_path):
    table = np.loadtxt(hill, delimiter=",", skiprows=1)
    others = [tmp_path / "plan" / "design.csv", tmp_path / "design.csv"]
    others[0].parent.mkdir()
    for path, rise in zip(others, (0.5, -1.25), strict=True):
        moved = table + np.array([0, 0, rise])
        np.savetxt(path, moved[::3], delimiter=",", header="x,y,z", comments="")
    goals = [3, *others, 4.5]
    options = [each for goal in goals for each in ("--volume", goal)]
    found = figures("terrain", hill, *COMMON[:4], "--dem", 5, *options, "-o", tmp_path / "site")
    products = found["products"][1:]
    names = ["volume 3", "volume design", "volume design 2", "volume 4.5"]
    assert [each["product"] for each in products] == names
    assert [each.get("height", each.get("surface")) for each in products] == [
        3, "design.csv", "design.csv", 4.5
    ]  # fmt: skip
    for goal, each in zip(goals, products, strict=True):
        alone = figures("volume", hill, goal, *COMMON[:4])
        for name in ("cut", "fill", "net", "area", "volume_units"):
            assert each[name] == alone[name]
    assert len({each["cut"] for each in products}) == 4
    page = Page((tmp_path / "site" / "index.html").read_text(encoding="utf-8"))
    pictures = [given["alt"] for tag, given in page.tags if tag == "img"]
    assert [("level" in alt, "other surface" in alt) for alt in pictures[2:]] == [
        (True, False), (False, True), (False, True), (True, False)
    ]  # fmt: skip
    assert len({given["src"] for tag, given in page.tags if tag == "img"}) == len(pictures)
    # Each picture is that of the volume alone.
    figures("terrain", hill, *COMMON[:4], "--volume", others[0], "-o", tmp_path / "one")
    alone = Page((tmp_path / "one" / "index.html").read_text(encoding="utf-8"))
    first, second = (
        [given["src"] for tag, given in each.tags if tag == "img"] for each in (page, alone)
    )
    assert first[3] == second[1]
    # The files of surfaces are inputs, which are not replaced.
    raster = tmp_path / "site" / "dem.tif"
    before = raster.read_bytes()
    options = ["--dem", 4, "--volume", raster, "-o", tmp_path / "site"]
    code, _, err = command("terrain", hill, *options)
    assert (code, "replace the input" in err, raster.read_bytes()) == (2, True, before)
    code, _, err = command("terrain", hill, "--volume", tmp_path / "none.csv", "-o", tmp_path / "x")
    assert (code, "neither a file nor a height" in err) == (3, True)
    assert not (tmp_path / "x").exists()


def test_a_volume_without_common_area_has_no_picture(hill, figures, tmp_path):
    table = np.loadtxt(hill, delimiter=",", skiprows=1) + np.array([1e4, 0, 0])
    far = tmp_path / "far.csv"
    np.savetxt(far, table, delimiter=",", header="x,y,z", comments="")
    options = [*COMMON[:4], "--quiet", "--volume", far, "--volume", 2]
    found = figures("terrain", hill, *options, "-o", tmp_path / "site")["products"]
    assert [each["product"] for each in found] == ["volume far", "volume 2"]
    assert found[0]["area"] == 0 < found[1]["area"]
    page = Page((tmp_path / "site" / "index.html").read_text(encoding="utf-8"))
    pictures = [given["alt"] for tag, given in page.tags if tag == "img"]
    assert len(pictures) == 2 and "level" in pictures[1]


def test_a_volume_of_any_height_keeps_the_other_products(hill, command, tmp_path):
    options = [*COMMON[:4], "--volume", "1e308", "--volume", "2", "--contours", "1"]
    code, _, err = command("terrain", hill, *options, "-o", tmp_path / "site")
    assert code == 0
    assert "note: the page omits a plot: a plot cannot show values beyond 1e+305" in err
    assert (tmp_path / "site" / "contours.gpkg").exists()
    page = Page((tmp_path / "site" / "index.html").read_text(encoding="utf-8"))
    titles = [text for text in page.texts if text.startswith("Volume")]
    assert titles == ["Volume 1e308", "Volume 2"]
    assert sum("level" in given["alt"] for tag, given in page.tags if tag == "img") == 1


@pytest.mark.parametrize("name", ["terrain", "volume"])
def test_an_empty_height_is_named(hill, command, tmp_path, name):
    options = ["--volume", "", "-o", tmp_path / "site"] if name == "terrain" else [""]
    code, _, err = command(name, hill, *options, *COMMON[:4])
    assert code and "an empty string: neither a file nor a height" in err


HOSTILE = "<img src=x onerror=alert(1)>&\"'%41"


def test_hostile_names_are_text(hill, command, tmp_path):
    road, survey = tmp_path / f"{HOSTILE}.geojson", tmp_path / f"{HOSTILE}\udcff.csv"
    (tmp_path / "road.gpkg").unlink()
    survey.write_bytes(hill.read_bytes())
    line = {"type": "LineString", "coordinates": [[20, 20], [80, 50]]}
    road.write_text(json.dumps(line))
    folder = tmp_path / "site <b>"
    code, _, err = command("terrain", survey, "--profile", road, "--units", "m", "-o", folder)
    assert code == 0, err
    text = (folder / "index.html").read_text(encoding="utf-8")
    assert "<img src=x" not in text
    page = Page(text)
    # A byte that is not UTF-8 is shown as such.
    assert f"{HOSTILE}\ufffd.csv" in page.texts
    assert all(given["src"].startswith("data:") for tag, given in page.tags if tag == "img")
    (link,) = [given["href"] for tag, given in page.tags if tag == "a"]
    name = unquote(link.removeprefix("./"))
    assert (folder / name).exists()
    assert name == f"profile-{HOSTILE}.csv"


@pytest.mark.parametrize(
    ("options", "code", "text"),
    [
        ((), 2, "one or more of"),
        (("--hillshade",), 2, "--hillshade needs --dem"),
        (("--dem", "1", "--simplify", "1"), 2, "are for --contours"),
        (("--dem", "1", "--min-area", "1"), 2, "--contours and --bands"),
        (("--contours", "-1"), 2, "--contours must be above 0"),
        (("--bands", "0"), 2, "--bands must be above 0"),
        (("--dem", "inf"), 2, "--dem must be above 0 and finite"),
        (("--dem", "1", "--profile", "none.gpkg"), 3, "none.gpkg"),
    ],
)
def test_what_is_refused_leaves_no_folder(hill, command, tmp_path, *, options, code, text):
    found, _, err = command("terrain", hill, *options, "-o", tmp_path / "site")
    assert (found, text in err) == (code, True), err
    assert not (tmp_path / "site").exists()


def test_inputs_stay(hill, command, tmp_path):
    folder = tmp_path / "site"
    folder.mkdir()
    lakes = folder / "contours.gpkg"
    geopandas.GeoDataFrame(geometry=[shapely.box(40, 40, 60, 60)]).to_file(lakes)
    before = lakes.read_bytes()
    code, _, err = command("terrain", hill, "--contours", 1, "--level", lakes, "-o", folder)
    assert (code, "replace the input" in err) == (2, True)
    assert lakes.read_bytes() == before
    code, _, err = command("terrain", hill, "--contours", 1, "-o", hill)
    assert (code, "not a folder" in err) == (5, True)


def test_two_profiles_of_one_name(hill, command, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    line = shapely.LineString([(10, 50), (90, 50)])
    geopandas.GeoDataFrame(geometry=[line]).to_file(other / "road.gpkg")
    both = ("--profile", tmp_path / "road.gpkg", "--profile", other / "road.gpkg")
    code, _, err = command("terrain", hill, *COMMON, *both, "-o", tmp_path / "site")
    assert code == 0, err
    names = {path.name for path in (tmp_path / "site").iterdir()}
    assert names == {"profile-road.csv", "profile-road 2.csv", "index.html"}


def test_a_page_without_pictures_of_nothing(hill, command, tmp_path):
    assert site._rows({"a_b": None, "c_d": 1234}) == [("c d", "1,234")]
    code, _, err = command("terrain", hill, "--contours", 1000, "-o", tmp_path / "site")
    assert code == 0, err


def test_contours_on_the_page_keep_their_ends_and_shapes():
    from matplotlib.figure import Figure

    from delone.cli.site import _RUN, _draw_contours

    x = np.linspace(0, 20, 120)
    random = np.random.default_rng(2)
    heights = np.sin(x)[:, None] * np.cos(x) + random.random((120, 120)) / 5
    grid = np.stack((*np.meshgrid(x, x), heights), axis=-1)
    found = TIN.from_points(grid.reshape(-1, 3)).contours(interval=0.05)
    assert len(found.points) > 2 * _RUN and found.index.any()
    for size, least in ((1e-9, 1.0), (0.1, 0.2)):
        ax = Figure().add_subplot()
        _draw_contours(found, size, ax)
        lines = {False: [], True: []}
        for drawn in ax.collections:
            wide = drawn.get_linewidths()[0] > 1
            assert all(len(path.vertices) <= _RUN for path in drawn.get_paths())
            # The last point of an artist is the first of the next one.
            parts = [path.vertices for path in drawn.get_paths()]
            points = np.concatenate([parts[0], *(each[1:] for each in parts[1:])])
            breaks = np.flatnonzero(np.isnan(points[:, 0]))
            lines[wide] = [part[~np.isnan(part[:, 0])] for part in np.split(points, breaks)]
        for wide in (False, True):
            rows = np.flatnonzero(found.index == wide)
            assert len(lines[wide]) == len(rows)
            for k, line in zip(rows, lines[wide], strict=True):
                whole = found.coordinates(k)
                assert (line[0] == whole[0]).all() and (line[-1] == whole[-1]).all()
        count = sum(len(line) for both in lines.values() for line in both)
        assert least * len(found.points) <= count <= len(found.points)
        assert size > 0.01 or count == len(found.points)
        assert size < 0.01 or count < 0.8 * len(found.points)


def test_an_error_of_a_later_product_leaves_no_file(hill, command, tmp_path, monkeypatch):
    folder = tmp_path / "site"
    options = ("terrain", hill, "--contours", 1, "--dem", 4, "-o", folder)

    def fail(*_, **__):
        raise MemoryError("no room for the page")

    with monkeypatch.context() as patched:
        patched.setattr(site, "_write_page", fail)
        code, _, err = command(*options)
    assert (code, "no room for the page" in err, folder.exists()) == (7, True, False)
    # A folder with files of an earlier run is unchanged.
    assert command(*options)[0] == 0
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    hill.write_bytes(hill.read_bytes().replace(b"\n1", b"\n2"))
    with monkeypatch.context() as patched:
        patched.setattr(site, "_write_page", fail)
        assert command(*options)[0] == 7
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.parametrize(
    "case",
    [
        (("--contours", "1", "--dem", "1e-6"), 7, "cells needs"),
        (("--contours", "1", "--bands", "1e-9"), 4, "levels between the heights"),
        (("--contours", "1", "--smooth", "9"), 2, "--smooth must be"),
        (("--contours", "1", "--simplify", "-1"), 2, "--simplify must be"),
        (("--contours", "1", "--profile", "two.geojson"), 2, "--profile must be one line"),
    ],
)
def test_what_is_known_is_refused_first(hill, command, tmp_path, monkeypatch, case):
    options, code, text = case
    two = {"type": "MultiLineString", "coordinates": [[[1, 1], [2, 2]], [[3, 3], [4, 4]]]}
    (tmp_path / "two.geojson").write_text(json.dumps(two))
    options = [each.replace("two.geojson", f"{tmp_path}/two.geojson") for each in options]

    def contours(*_, **__):
        raise AssertionError("work before the check")

    monkeypatch.setattr(TIN, "contours", contours)
    found, _, err = command("terrain", hill, *options, "-o", tmp_path / "site")
    assert (found, text in err) == (code, True), err
    assert "bounds" not in err
    assert not (tmp_path / "site").exists()


def test_errors_of_writing_name_the_folder(hill, command, tmp_path, monkeypatch):
    def fail(path, *_, **__):
        raise OSError(28, "No space left on device", str(path))

    monkeypatch.setattr(site, "raster_writer", lambda _: fail)
    code, _, err = command("terrain", hill, "--dem", 4, "-o", tmp_path / "site")
    assert (code, f"{tmp_path / 'site' / 'dem.tif'}: " in err) == (5, True), err
    assert ".delone-" not in err
    assert not (tmp_path / "site").exists()


def test_files_of_earlier_runs_are_named(hill, command, figures, tmp_path):
    folder, road = tmp_path / "site", tmp_path / "road.gpkg"
    found = figures("terrain", hill, *COMMON, "--dem", 4, "--profile", road, "-o", folder)
    assert found["files_of_earlier_runs"] is None
    (folder / "mine.txt").write_text("kept")
    options = ("terrain", hill, *COMMON, "--contours", 1, "-o", folder)
    found = figures(*options)
    assert found["files_of_earlier_runs"] == ["dem.tif", "profile-road.csv"]
    code, out, _ = command(*options)
    assert (code, "dem.tif, profile-road.csv" in out) == (0, True)
    # An input is no product of an earlier run, and a link is written through.
    (folder / "contours.gpkg").rename(tmp_path / "lines.gpkg")
    (folder / "contours.gpkg").symlink_to(tmp_path / "lines.gpkg")
    before = (tmp_path / "lines.gpkg").stat().st_mtime_ns
    found = figures(*options, "--quiet", "--volume", folder / "dem.tif")
    assert found["files_of_earlier_runs"] == ["profile-road.csv"]
    assert (folder / "contours.gpkg").is_symlink()
    assert (tmp_path / "lines.gpkg").stat().st_mtime_ns > before
    assert {path.name for path in folder.iterdir()} == {
        "contours.gpkg", "dem.tif", "index.html", "mine.txt", "profile-road.csv"
    }  # fmt: skip
