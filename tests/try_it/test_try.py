"""The page for readers' points, in a headless Chromium: what it reads, says, draws and changes."""

from __future__ import annotations

import json
import re
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import ConvexHull, Delaunay, DeloneError, GeographicWarning
from delone.io import line_numbers, read_points

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from contextlib import AbstractContextManager

    from browser import Browser, Page

    Write = Callable[[Path, str], None]
    Serve = Callable[[Path], AbstractContextManager[str]]

sys.path.insert(0, str(Path(__file__).parents[2] / "docs" / "extensions"))

import live_files

TEXTS = {
    "comma.csv": "x,y\n0,0\n4,0\n4,3\n0,3\n2,1\n",
    "semicolon.csv": "id;northing;easting\n1;0;0\n2;0;4\n3;3;4\n",
    "decimal-commas.csv": "x;y\n0,5;1,5\n4,0;0\n4;3,25\n",
    "tab.tsv": "a\tlon\tlat\n1\t0\t0\n2\t4\t0\n3\t4\t3\n",
    "bar.txt": "x|y\n0|0\n4|0\n4|3\n",
    "space.xyz": "0 0 7\n 4  0 8\n4\t3 9\n",
    "counted.pts": "3\n0 0\n4 0\n4 3\n",
    "comments.csv": "# a survey\n# x, y\n\n0, 0\n4, 0 \n# more\n4, 3\n",
    "quotes.csv": '"x","y","name"\n"0","0","a, b"\n4,0,c\n"4",3,"d"\n',
    "returns.csv": "x,y\r\n0,0\r\n4,0\r\n4,3\r\n",
    "forms.csv": "x,y\n+.5,1.\n1e-3,-2E+2\n0,0\n",
    "marked.csv": "\ufeffx,y\n0,0\n4,0\n4,3\n",
    "twice.csv": "X_COORD,Y [m]\n0,0\n4,0\n4,3\n4,0\n",
    "nan.csv": "x,y\n0,0\n\nnan,0\n4,3\n0,3\n",
    "infinite.csv": "x,y\n0,0\n1,inf\n# no\n4,-Infinity\n0,3\n",
    "few.csv": "x,y\n0,0\n1,1\n0,0\n",
    "one.csv": "x,y\n0,0\n",
    "line.csv": "x,y\n0,0\n1,1\n2,2\n0.5,0.5\n",
    "empty.csv": "",
    "header.csv": "x,y\n",
    "words.csv": "the quick brown fox\njumps over\n",
    "letter.csv": "x,y\n0,0\n4,b\n4,3\n",
    "it's.csv": "x,y\n0,0\n4,a b\n4,3\n",
    "blank.csv": "x,y,z\n0,0,1\n4,,1\n4,3,1\n",
    "short.csv": "x,y\n0,0\n4\n4,3\n",
    "short.xyz": "0 0\n4 0\n4\n",
    "long.csv": "x,y\n0,0\n4,0\n4,3,1\n",
    "claims.pts": "4\n0 0\n4 0\n4 3\n",
    "claims-much.pts": "12345678901234567890\n0 0\n4 0\n",
    "which.csv": "a,b,c\n0,0,1\n4,0,1\n4,3,1\n",
    "both.csv": "lon,x,lat,lat\n0,0,1,2\n4,0,1,2\n4,3,1,2\n",
    "zero.csv": "x,y\n0,0\n\0\0,1\n4,3\n",
    "latin.csv": "x,y,stra\u00dfe\n0,0,1\n4,0,1\n4,3,1\n",
    "wide.csv": "x,y\n0,0\n4,0\n4,3\n",
}
CODES = {"latin.csv": "latin-1", "wide.csv": "utf-16"}


@pytest.fixture(scope="module")
def address(
    core: Path, write_page: Write, serve: Serve, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[str]:
    del core
    folder = tmp_path_factory.mktemp("try")
    write_page(folder, live_files.points_html(live=True))
    with serve(folder) as found:
        yield f"{found}/index.html"


@pytest.fixture
def page(address: str, browser: Browser) -> Page:
    found = browser.page(address, size=(800, 1000))
    found.wait("window.deloneTry")
    found.run("window.deloneTry.then(() => 1)")
    settle(found)
    return found


def settle(page: Page) -> None:
    """Wait until everything is read and drawn."""
    page.run(
        "(async () => { const page = await window.deloneTry; const { picture } = page; "
        "while (page.reading || picture.job || picture.stale "
        "|| (picture.shown.cells && !picture.scene.cells)) "
        "await new Promise((done) => setTimeout(done, 10)); })()"
    )


def ask(page: Page, code: str) -> Any:
    """Evaluate code that returns something, with `page`, `picture` and `scene`."""
    return json.loads(
        page.run(
            "(async () => { const page = await window.deloneTry; const { picture } = page; "
            f"const {{ scene }} = picture; const found = await (async () => {{ {code} }})(); "
            "return JSON.stringify(found ?? null); })()"
        )
    )


def read(page: Page, content: bytes, source: str) -> dict[str, Any]:
    """Read a file as the page does: the picture, or what is wrong."""
    page.run(
        f"(async () => {{ const file = new File([Uint8Array.from({list(content)})], "
        f"{json.dumps(source)}); await (await window.deloneTry).readFile(file); }})()"
    )
    settle(page)
    found: dict[str, Any] = ask(
        page,
        "const { problem, status } = page.parts; "
        "if (!problem.hidden) return { problem: problem.textContent, said: status.textContent }; "
        "return { points: [...scene.points], hull: [...scene.hull], summary: page.summary, "
        "triangles: [...scene.triangles.subarray(0, 3 * scene.count)], said: status.textContent };",
    )
    return found


def flat(rows: Any) -> list[float]:
    return np.asarray(rows, dtype=float).ravel().tolist()


def edges_of(mesh: Delaunay) -> Any:
    return np.linalg.norm(np.diff(mesh.points[mesh.edges], axis=1)[:, 0], axis=1)


@pytest.mark.parametrize("name", TEXTS)
def test_files_and_errors_are_those_of_python(
    page: Page, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    content = TEXTS[name].encode(CODES.get(name, "utf-8"))
    (tmp_path / name).write_bytes(content)
    found = read(page, content, name)
    try:
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always", GeographicWarning)
            mesh = Delaunay(read_points(name))
    except DeloneError as error:
        right = f"{type(error).__name__}: {error}"
        rows = getattr(error, "rows", ())
        if len(rows):
            lines = line_numbers(name, rows.tolist())
            noun = "line" if len(lines) == 1 else "lines"
            right += f" ({noun} {', '.join(map(str, lines))} of {name})"
        assert found == {"problem": right, "said": ""}
        return
    assert "problem" not in found, found
    assert found["points"] == flat(mesh.points)
    assert found["triangles"] == flat(mesh.simplices)
    assert found["said"].startswith(f"{len(mesh.points):,} points from {name}")
    assert ("distances are distorted" in found["said"]) is bool(warned)
    assert page.complaints() == []


def test_statistics_are_those_of_python(page: Page) -> None:
    points = np.random.default_rng(2).random((300, 2))
    points[250] = points[17]
    text = "x,y\n" + "".join(f"{x!r},{y!r}\n" for x, y in points.tolist())
    found = read(page, text.encode(), "many.csv")
    mesh, hull = Delaunay(points), ConvexHull(points)
    summary = found["summary"]
    assert found["points"] == flat(points)
    assert found["triangles"] == flat(mesh.simplices)
    assert found["hull"] == flat(hull.vertices)
    assert (summary["points"], summary["duplicates"]) == (300, 1)
    assert (summary["triangles"], summary["edges"]) == (len(mesh.simplices), len(mesh.edges))
    assert summary["hull"] == len(hull.vertices)
    lengths = edges_of(mesh)
    assert summary["shortest"] == pytest.approx(lengths.min())
    assert summary["mean"] == pytest.approx(lengths.mean())
    assert summary["longest"] == pytest.approx(lengths.max())
    assert summary["area"] == pytest.approx(hull.volume)
    assert summary["minAngle"] == pytest.approx(mesh.quality().smallest_angle.min())
    shown = ask(page, "return [...page.parts.table.querySelectorAll('dd')].map((e) => e.innerText)")
    assert shown[:3] == ["300", "1", f"{len(mesh.simplices):,}"]


def test_vertices_of_geojson_are_points(page: Page) -> None:
    shapes = [
        {"type": "Point", "coordinates": [9, 9, 1]},
        {"type": "LineString", "coordinates": [[0, 0], [1, 2]]},
        {"type": "Polygon", "coordinates": [[[5, 0], [6, 0], [6, 1], [5, 0]]]},
        {
            "type": "GeometryCollection",
            "geometries": [{"type": "MultiPoint", "coordinates": [[3, 3]]}],
        },
        None,
    ]
    features = [{"type": "Feature", "properties": {}, "geometry": each} for each in shapes]
    text = json.dumps({"type": "FeatureCollection", "features": features})
    found = read(page, text.encode(), "shapes.geojson")
    assert found["points"] == [9, 9, 0, 0, 1, 2, 5, 0, 6, 0, 6, 1, 3, 3]
    assert "repeats the first" in found["said"]
    alone = read(page, json.dumps(shapes[2]).encode(), "x.json")
    assert alone["points"] == [5, 0, 6, 0, 6, 1]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('{"type": "Point",\n"coordinates": [1 2]}', "x.geojson cannot be read: line 2: "),
        ('{"type": "Point",\n"coordinates": [1, NaN]}', "x.geojson cannot be read: line 2: "),
        ('{"type": "Poi', "x.geojson cannot be read: line 1: "),
        ("", "x.geojson is empty"),
        ("\n{", "x.geojson cannot be read: line 2: "),
        ("[1, 2]", "x.geojson cannot be read: its geometry has no type"),
        ('{"type": "Pint"}', 'x.geojson cannot be read: its geometry has the unknown type "Pint"'),
        ('{"type": "Point"}', "x.geojson cannot be read: its geometry has no coordinates"),
        ('{"type": "FeatureCollection"}', "x.geojson cannot be read: it has no list of features"),
        ('{"type": "FeatureCollection", "features": []}', "x.geojson contains no points"),
        (
            '{"type": "FeatureCollection", "features": [null, '
            '{"type": "Point", "coordinates": ["a", 1]}]}',
            "x.geojson cannot be read: feature 1 has a position that is not two numbers",
        ),
        ('{"type": "MultiPoint", "coordinates": [[0, 0], [1, 1]]}', "DegenerateInputError: 2 "),
        ('{"type": "MultiPoint", "coordinates": [[0, 0], [1, 1e999]]}', "NonFiniteError: 1 "),
    ],
)  # fmt: skip
def test_wrong_geojson_is_refused(page: Page, text: str, said: str) -> None:
    found = read(page, text.encode(), "x.geojson")
    assert said in found["problem"]
    assert page.complaints() == []


def test_limits(page: Page) -> None:
    line = b"0,0\n"
    assert "100,000 points" in read(page, line * 100_001, "x.csv")["problem"]
    assert "x.csv has 10,000,001 bytes" in ask(
        page,
        "const file = new File([new Uint8Array(10_000_001)], 'x.csv'); "
        "await page.readFile(file); return page.parts.problem.textContent;",
    )
    count = 100_000
    found = ask(
        page,
        f"let text = ''; for (let k = 0; k < {count}; k += 1) "
        "text += `${k % 317} ${k * k % 911}\\n`; "
        "await page.readFile(new File([text], 'x.txt')); "
        "return [page.parts.problem.hidden, page.summary.points, page.summary.duplicates > 0];",
    )
    assert found == [True, count, True]


def test_columns_are_chosen_by_name(page: Page) -> None:
    page.run("document.querySelector('#try-columns').value = 'c, a'")
    found = read(page, b"a,b,c\n0,9,1\n4,9,5\n3,9,0\n", "x.csv")
    assert found["points"] == [1, 0, 5, 4, 0, 3]
    assert "Columns: c, a." in found["said"]
    wrong = read(page, b"a,b\n0,9\n", "x.csv")
    assert wrong["problem"] == (
        "FileFormatError: x.csv has no column 'c'; its columns are a, b"
    )  # fmt: skip


def test_pasted_text_is_read(page: Page) -> None:
    page.run("document.querySelector('#try-text').value = '0 0\\n2 0\\n0 2\\n2 2\\n1 1'")
    page.run("document.querySelector('.try-run').click()")
    settle(page)
    assert ask(page, "return page.summary.triangles") == 4
    page.run("document.querySelector('#try-text').value = '0 0\\n2 x\\n0 2'")
    page.run("document.querySelector('.try-run').click()")
    settle(page)
    problem = ask(page, "return page.parts.problem.textContent")
    assert problem == "FileFormatError: The text: line 2 (row 1), column 1 is 'x', not a number"
    # The last picture stays.
    assert ask(page, "return scene.count") == 4


def test_nothing_is_requested_once_the_page_is_there(page: Page, address: str) -> None:
    before = page.addresses()
    assert all(found.startswith((address.rpartition("/")[0], "data:")) for found in before)
    read(page, TEXTS["comma.csv"].encode(), "secret.csv")
    page.run("document.querySelector('#try-cells').click()")
    for name in ("many", "grid", "spiral"):
        page.run(f"window.deloneTry.then((page) => page.readSample('{name}'))")
    ask(page, "page.hand.grab(3); await page.hand.drag(3, 1, 1); await page.hand.drop();")
    assert page.addresses() == before
    assert page.complaints() == []


# The second move changes shapes only: no triangle goes or comes.
MOVES = [(0.35, -0.01), (0.35, -0.011), (0.5, 0.5), (0.0, 0.0), (1.4, -0.3), (60.0, 3.0)]


@pytest.mark.parametrize("sample", ["grid", "random", "many"])
def test_dragged_points_end_in_the_triangulation(page: Page, sample: str) -> None:
    ask(page, f"await page.readSample('{sample}')")
    settle(page)
    triangles = "[...scene.triangles.subarray(0, 3 * scene.count)]"
    for u, v in MOVES:
        moved = (
            "const [x0, y0, x1, y1] = scene.box(); page.hand.grab(7); "
            f"await page.hand.drag(7, x0 + {u} * (x1 - x0), y0 + {v} * (y1 - y0)); "
        )
        points, found, hull = ask(
            page, f"{moved} return [[...scene.points], {triangles}, [...scene.hull]]"
        )
        mesh = Delaunay(np.reshape(points, (-1, 2)))
        right = {frozenset(row) for row in mesh.simplices.tolist()}
        assert len(found) == 3 * len(right)
        assert {frozenset(found[k : k + 3]) for k in range(0, len(found), 3)} == right
        assert hull == ConvexHull(mesh.points).vertices.tolist()
    # Once it rests, order and numbers are those of the points, too.
    count, found, order = ask(
        page,
        "await page.hand.drop(); const now = picture.scene; return [page.summary.triangles, "
        "[...now.triangles], [...now.hull]]",
    )
    assert count == len(mesh.simplices)
    assert found == flat(mesh.simplices)
    assert order == ConvexHull(mesh.points).vertices.tolist()
    assert page.complaints() == []


DIFFERENT = """
  const pixels = () => picture.back.getContext("2d")
    .getImageData(0, 0, picture.back.width, picture.back.height).data;
  const some = pixels();
  picture.draw();
  while (picture.job) await new Promise((done) => setTimeout(done, 5));
  const all = pixels();
  let count = 0;
  for (let k = 0; k < all.length; k += 1) count += Math.abs(all[k] - some[k]) > 100;
  return count;
"""


# The last point is a corner of the hull that goes inside: long, thin triangles go with it.
@pytest.mark.parametrize(
    ("sample", "row", "at"),
    [
        ("many", "9", "[481, 290]"),
        ("many", "9", "[-30, 700]"),
        ("grid", "9", "[7.4, 6.6]"),
        ("random", "scene.hull[0]", "[scene.points[2 * row] + 9, scene.points[2 * row + 1]]"),
    ],
)
def test_what_is_drawn_again_is_the_whole_picture(
    page: Page, sample: str, row: str, at: str
) -> None:
    ask(page, f"await page.readSample('{sample}')")
    settle(page)
    before = ask(page, "return picture.front.toDataURL()")
    different = ask(
        page,
        f"const row = {row}; const [x, y] = {at}; for (let k = 1; k <= 5; k += 1) "
        f"await page.hand.drag(row, x + k, y - k); {DIFFERENT}",
    )
    assert different < 60
    assert ask(page, "return picture.front.toDataURL()") != before


def test_two_results_at_once_leave_the_last(page: Page) -> None:
    ask(page, "page.readSample('most'); page.readSample('grid'); await page.readSample('spiral')")
    settle(page)
    assert ask(page, "return [page.summary.points, scene.points.length / 2]") == [800, 800]


def test_points_that_fall_on_a_line_can_be_moved_back(page: Page) -> None:
    read(page, b"0 0\n4 0\n2 1\n", "x.txt")
    drag = "page.hand.grab(2); await page.hand.drag(2, 2, {}); await page.hand.drop();"
    ask(page, drag.format(0))
    assert "all 3 distinct points lie on one line" in ask(
        page, "return page.parts.problem.textContent"
    )
    assert ask(page, "return [scene.count, scene.hull.length]")[0] == 0
    ask(page, drag.format(-1))
    assert ask(page, "return [page.parts.problem.hidden, scene.count]") == [True, 1]


def frame(page: Page) -> tuple[float, float, float, float]:
    page.run("document.querySelector('.try-canvas').scrollIntoView({ block: 'center' })")
    left, top, width, height = page.run(
        "(() => { const box = document.querySelector('.try-canvas').getBoundingClientRect(); "
        "return [box.left, box.top, box.width, box.height]; })()"
    )
    return left, top, width, height


def camera(page: Page) -> tuple[float, float, float]:
    x, y, scale = ask(page, "const { camera } = picture; return [camera.x, camera.y, camera.scale]")
    return x, y, scale


def on_screen(page: Page, row: int) -> tuple[float, float]:
    left, top, *_ = frame(page)
    x, y = ask(page, f"return [picture.camera.px(scene.points[{2 * row}]), "
               f"picture.camera.py(scene.points[{2 * row + 1}])]")  # fmt: skip
    return left + x, top + y


def test_the_mouse_moves_the_picture_and_points(page: Page) -> None:
    left, top, width, height = frame(page)
    x0, y0, scale = camera(page)
    # In a corner without points.
    page.mouse("Moved", left + 3, top + 3)
    page.mouse("Pressed", left + 3, top + 3)
    page.mouse("Moved", left + 33, top + 23, held=True)
    page.mouse("Released", left + 33, top + 23)
    assert camera(page) == pytest.approx((x0 - 30 / scale, y0 + 20 / scale, scale))
    page.mouse("Wheel", left + width / 2, top + height / 2, deltaX=0, deltaY=-200)
    settle(page)
    assert camera(page)[2] > scale * 1.1
    before = ask(page, "return [...scene.points]")
    x, y = on_screen(page, 123)
    page.mouse("Pressed", x, y)
    page.mouse("Moved", x + 40, y - 10, held=True)
    page.run("window.deloneTry.then((page) => page.hand.running)")
    page.mouse("Released", x + 40, y - 10)
    page.run("window.deloneTry.then((page) => page.hand.running)")
    after = ask(page, "return [...picture.scene.points]")
    changed = [k for k in range(len(before)) if before[k] != after[k]]
    assert changed == [246, 247]
    assert after[246] > before[246]
    assert page.complaints() == []


def touch(page: Page, kind: str, *at: tuple[float, float]) -> None:
    points = [{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(at)]
    page.call("Input.dispatchTouchEvent", type=f"touch{kind}", touchPoints=points)


def test_fingers_move_and_enlarge(page: Page) -> None:
    page.call("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)
    left, top, width, height = frame(page)
    x0, y0, scale = camera(page)
    page.run("document.querySelector('#try-move').click()")
    touch(page, "Start", (left + 50, top + 50))
    touch(page, "Move", (left + 90, top + 40))
    touch(page, "End")
    assert camera(page) == pytest.approx((x0 - 40 / scale, y0 - 10 / scale, scale), rel=1e-3)
    middle = (left + width / 2, top + height / 2)
    touch(page, "Start", middle)
    touch(page, "Start", middle, (middle[0] + 50, middle[1]))
    touch(page, "Move", middle, (middle[0] + 150, middle[1]))
    touch(page, "End")
    settle(page)
    assert camera(page)[2] == pytest.approx(3 * scale, rel=0.05)
    page.run("document.querySelector('#try-move').click()")
    row = ask(
        page, "return picture.nearest(picture.camera.width / 2, picture.camera.height / 2, 1e9)"
    )
    x, y = on_screen(page, row)
    touch(page, "Start", (x + 3, y))
    touch(page, "Move", (x + 33, y + 30))
    touch(page, "End")
    page.run("window.deloneTry.then((page) => page.hand.running)")
    assert ask(page, "return picture.scene.edited || page.parts.status.textContent.includes('new')")
    assert page.complaints() == []


def test_keys_move_the_picture_and_a_point(page: Page) -> None:
    page.run("document.querySelector('.try-canvas').focus()")
    x0, y0, scale = camera(page)
    page.key("ArrowRight")
    page.key("ArrowUp")
    assert camera(page) == pytest.approx((x0 + 60 / scale, y0 + 60 / scale, scale))
    page.key("+")
    assert camera(page)[2] == pytest.approx(1.5 * scale)
    page.key("-")
    page.key("0")
    assert camera(page) == pytest.approx((x0, y0, scale))
    settle(page)
    before = ask(page, "return [...scene.points]")
    page.key("Enter")
    page.key("ArrowRight")
    page.run("window.deloneTry.then((page) => page.hand.running)")
    page.key("Enter")
    page.run("window.deloneTry.then((page) => page.client.ask('ready'))")
    after = ask(page, "return [...picture.scene.points]")
    changed = [k for k in range(len(before)) if before[k] != after[k]]
    assert len(changed) == 1
    assert after[changed[0]] == pytest.approx(before[changed[0]] + 8 / scale)
    # Another arrow moves the picture again.
    page.key("ArrowLeft")
    assert camera(page)[0] == pytest.approx(x0 - 60 / scale)
    # Tab leaves the picture: the keyboard is not held.
    page.call("Input.dispatchKeyEvent", type="rawKeyDown", key="Tab", windowsVirtualKeyCode=9)
    assert page.run("document.activeElement.className") != "live-canvas try-canvas"


def test_layers_and_files(page: Page) -> None:
    ask(page, "await page.readSample('grid')")
    settle(page)
    pictures = {ask(page, "return picture.front.toDataURL()")}
    for name in ("cells", "triangles", "hull", "points"):
        page.run(f"document.querySelector('#try-{name}').click()")
        settle(page)
        pictures.add(ask(page, "return picture.front.toDataURL()"))
    assert len(pictures) == 5
    files = ask(
        page,
        "const { trianglesCsv, pointsCsv, geojson } = await import('./_static/learn/try/save.js'); "
        "return [trianglesCsv(scene), pointsCsv(scene), geojson(scene), page.svg()];",
    )
    triangles, points, shapes, svg = files
    rows = [[int(v) for v in line.split(",")] for line in triangles.splitlines()[1:]]
    corners = [[float(v) for v in line.split(",")] for line in points.splitlines()[1:]]
    assert rows == Delaunay(corners).simplices.tolist()
    polygons = json.loads(shapes)["features"]
    assert [list(each["properties"].values()) for each in polygons] == rows
    ring = polygons[0]["geometry"]["coordinates"][0]
    assert ring == [corners[v] for v in [*rows[0], rows[0][0]]]
    assert svg.startswith("<svg ")
    assert svg.count("<path") >= 1


@pytest.mark.parametrize("width", [390, 1280])
@pytest.mark.parametrize("dark", [False, True])
def test_nothing_is_wider_than_the_window(
    browser: Browser, address: str, width: int, dark: bool
) -> None:
    page = browser.page(address, size=(width, 900), dark=dark)
    page.wait("window.deloneTry")
    page.run("window.deloneTry.then(() => 1)")
    assert page.run("document.documentElement.scrollWidth") <= width
    assert page.complaints() == []


def test_without_the_core_the_page_says_so(
    browser: Browser, write_page: Write, serve: Serve, tmp_path: Path
) -> None:
    write_page(tmp_path, live_files.points_html(live=False))
    with serve(tmp_path) as found:
        page = browser.page(f"{found}/index.html")
        page.run("window.deloneTry.then(() => 1)")
        assert "without the compiled core" in page.run("document.body.innerText")
        assert page.complaints() == []


def test_a_point_of_an_edge_of_the_hull_becomes_a_corner(page: Page) -> None:
    read(page, b"0 0\n2 0\n4 0\n2 3\n", "x.txt")
    assert ask(page, "return [...scene.hull]") == [0, 2, 3]
    # No triangle goes or comes.
    assert ask(page, "await page.hand.drag(1, 2, -0.1); return [...picture.scene.hull]") == [
        0,
        1,
        2,
        3,
    ]


def test_places_are_filled_without_gaps(page: Page) -> None:
    wrong = ask(
        page,
        """
        const { Slots } = await import("./_static/learn/try/slots.js");
        let state = 7;
        const random = (n) => (state = (state * 48271) % 2147483647) % n;
        const triangle = (k) => [k, k + 1000, k + 2000];
        const names = (list) => JSON.stringify(list.map((k) => triangle(k).join()).sort());
        let there = Array.from({ length: 40 }, (_, k) => k);
        const slots = new Slots(Int32Array.from(there.flatMap(triangle)), 3000);
        // What a page has: it writes what it is told.
        const kept = Array.from(slots.triangles);
        for (let round = 1; round <= 400; round += 1) {
          const gone = there.filter(() => random(100) < 30);
          const added = Array.from({ length: random(gone.length + 5) }, (_, k) => k)
            .map((k) => (round % 2 ? 500 : 0) + k + 100).filter((k) => !there.includes(k));
          const flat = (list) => Int32Array.from(list.flatMap(triangle));
          const { count, writes } = slots.apply({ gone: flat(gone), added: flat(added) });
          for (let k = 0; k < writes.length; k += 4) {
            for (let j = 0; j < 3; j += 1) kept[3 * writes[k] + j] = writes[k + 1 + j];
          }
          there = [...there.filter((k) => !gone.includes(k)), ...added];
          const shown = Array.from({ length: count }, (_, t) => kept[3 * t]);
          if (names(shown) !== names(there)) return [round, count, there.length];
        }
        return null;
        """,
    )
    assert wrong is None


@pytest.mark.parametrize("moved", [False, True])
def test_each_edge_is_drawn(page: Page, moved: bool) -> None:
    if moved:
        ask(page, "await page.hand.drag(7, 100, 700); await page.hand.drag(8, 900, 300);")
    svg, points = ask(
        page,
        "picture.shown = { triangles: true }; return [page.svg(), [...picture.scene.points]]",
    )
    mesh = Delaunay(np.reshape(points, (-1, 2)))
    lines = re.findall(r"M([-\d.]+ [-\d.]+)L([-\d.]+ [-\d.]+)(?=[M\"])", svg)
    drawn = {frozenset(line) for line in lines}
    assert len(drawn) == len(mesh.edges)
