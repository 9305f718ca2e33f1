"""The figures of Voronoi cells and of the lift: what they draw and say, turned and stepped."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import live_cells
import pytest

from delone import Delaunay, Voronoi

if TYPE_CHECKING:
    from browser import Page

VORONOI = "window.deloneFigures.voronoi"
LIFT = "window.deloneFigures.lift"
BOX = (0, 0, 1000, 600)


def shown(page: Page, figure: str) -> list[dict[str, Any]]:
    """Return text and layers of all states; typed arrays become lists."""
    found: list[dict[str, Any]] = page.run(
        f"{figure}.states.map((state) => ({{say: state.say, layers: state.layers.map((panel) => "
        "panel.map((layer) => Object.fromEntries(Object.entries(layer).map(([name, value]) => "
        "[name, ArrayBuffer.isView(value) ? Array.from(value) : value]))))}))"
    )
    return found


def choose(page: Page, figure: str, **options: object) -> None:
    text = ", ".join(f"{name}: {value!r}" for name, value in options.items())
    page.run(f"{figure}.change((f) => {{ f.options = {{ ...f.options, {text} }}; }})")


def drawn(state: dict[str, Any], panel: int = 0, **style: object) -> list[dict[str, Any]]:
    """Return the layers of a panel with these properties."""
    return [
        layer
        for layer in state["layers"][panel]
        if all(layer.get(name) == value for name, value in style.items())
    ]


def test_filled_cells_are_those_of_python(page: Page) -> None:
    areas = Voronoi(live_cells.SITES, clip=BOX).cell_areas
    states = shown(page, VORONOI)
    assert len(states) == len(live_cells.SITES)
    for row, state in enumerate(states):
        (cell,) = drawn(state, kind="path")
        xy = list(zip(cell["xy"][::2], cell["xy"][1::2], strict=True))
        twice = sum(a * d - b * c for (a, b), (c, d) in zip(xy, xy[1:] + xy[:1], strict=True))
        assert abs(twice) / 2 == pytest.approx(areas[row])
    assert page.complaints() == []


def test_outlines_have_the_perimeters_of_python(page: Page) -> None:
    state = shown(page, VORONOI)[0]
    (lines,) = drawn(state, kind="lines", color="second")
    sides = zip(*(lines["segments"][k::4] for k in range(4)), strict=True)
    total = sum(math.dist((a, b), (c, d)) for a, b, c, d in sides)
    assert total == pytest.approx(Voronoi(live_cells.SITES, clip=BOX).cell_perimeters.sum())


def test_points_say_neighbors_and_whether_cells_are_bounded(page: Page) -> None:
    mesh = Delaunay(live_cells.SITES)
    degrees = [0] * len(mesh.points)
    for u, v in mesh.edges.tolist():
        degrees[u] += 1
        degrees[v] += 1
    hull = set(mesh.hull.tolist())
    for row, state in enumerate(shown(page, VORONOI)):
        assert f"its {degrees[row]} neighbors" in state["say"]
        assert ("unbounded" in state["say"]) is (row in hull)


def test_ridges_have_their_two_points_as_nearest(page: Page) -> None:
    choose(page, VORONOI, pair="edge")
    points = live_cells.SITES
    mesh = Delaunay(points)
    states = shown(page, VORONOI)
    assert len(states) == len(mesh.edges)
    crossings = 0
    for state, (u, v) in zip(states, sorted(map(sorted, mesh.edges.tolist())), strict=True):
        assert f"between {u} and {v}," in state["say"]
        ax, ay, bx, by = next(layer for layer in drawn(state, width=3) if "color" in layer and
                              layer["segments"][:2] != points[u])["segments"]  # fmt: skip
        for s in (0.001, 0.1, 0.5, 0.999):
            place = (ax + s * (bx - ax), ay + s * (by - ay))
            far = [math.dist(place, point) for point in points]
            assert far[u] == pytest.approx(far[v])
            assert far[u] == pytest.approx(min(far))
        sides = [
            (points[v][0] - points[u][0]) * (y - points[u][1])
            - (points[v][1] - points[u][1]) * (x - points[u][0])
            for x, y in ((ax, ay), (bx, by))
        ]
        assert ("Here they cross" in state["say"]) is (sides[0] >= 0 >= sides[1])
        crossings += "Here they cross" in state["say"]
    assert 0 < crossings < len(states)
    page.run(f"{VORONOI}.reset()")


def test_vertices_are_corners_of_three_cells(page: Page) -> None:
    choose(page, VORONOI, pair="triangle")
    seen = 0
    for state in shown(page, VORONOI):
        (center,) = [layer["xy"] for layer in drawn(state, kind="dots", radius=6)]
        if not (0 <= center[0] <= 1000 and 0 <= center[1] <= 600):
            assert "outside the picture" in state["say"]
            continue
        seen += 1
        cells = drawn(state, kind="path")
        assert len(cells) == 3
        for cell in cells:
            corners = zip(cell["xy"][::2], cell["xy"][1::2], strict=True)
            assert min(math.dist(center, corner) for corner in corners) < 1e-6
    assert seen > 8
    page.run(f"{VORONOI}.reset()")


@pytest.mark.parametrize("pair", ["edge", "triangle"])
def test_choices_step_forward_and_back(page: Page, pair: str) -> None:
    choose(page, VORONOI, pair=pair)
    count = page.run(f"{VORONOI}.states.length")
    seen = []
    for step in [*range(count), *reversed(range(count))]:
        page.run(f"{VORONOI}.show({step})")
        seen.append(page.run(f"{VORONOI}.canvas.toDataURL()"))
    assert seen == seen[::-1]
    assert len(set(seen)) == count
    page.run(f"{VORONOI}.reset()")
    assert page.complaints() == []


def test_a_click_chooses_the_part_under_it(page: Page) -> None:
    page.run(f"{VORONOI}.kind.click({VORONOI}, [870, 340], 0)")
    assert page.run(f"{VORONOI}.step") == 4
    choose(page, VORONOI, pair="triangle")
    page.run(f"{VORONOI}.kind.click({VORONOI}, [450, 330], 0)")
    triangle = page.run(f"{VORONOI}.status.textContent").split(":")[0]
    assert triangle.startswith("Triangle ")
    assert sorted(map(int, triangle[9:].split(", "))) == [6, 7, 10]
    page.run(f"{VORONOI}.reset()")


def test_seen_from_above_the_lower_hull_is_the_triangulation(page: Page) -> None:
    choose(page, LIFT, turn=0, tilt=90)
    state = shown(page, LIFT)[0]
    (top,) = drawn(state, 1, kind="dots", color="point")
    plane = [(value - 300) / 300 for row in live_cells.LIFTED for value in row]
    assert top["xy"] == pytest.approx(plane)
    page.run(f"{LIFT}.reset()")


def test_seen_from_above_the_cut_is_the_circle(page: Page) -> None:
    choose(page, LIFT, turn=0, tilt=90)
    for state in shown(page, LIFT):
        (circle,) = [layer["circles"] for layer in drawn(state, kind="circles")]
        (cut,) = drawn(state, 1, kind="lines", color="accent")
        x, y = ((value - 300) / 300 for value in circle[:2])
        places = zip(cut["segments"][::2], cut["segments"][1::2], strict=True)
        far = [math.dist((x, y), place) for place in places]
        assert far == pytest.approx([circle[2] / 300] * len(far))
    page.run(f"{LIFT}.reset()")


def test_projection_turns_without_stretching_and_depth_grows_away(page: Page) -> None:
    code = (
        "import('./_static/learn/spin.js').then(({{ projection }}) => {{ "
        "const project = projection({{ turn: {turn}, tilt: {tilt} }}); "
        "return [...project(3, -4, 12), project.depth(3, -4, 12)]; }})"
    )
    for turn, tilt in ((0, 0), (0, 90), (25, 14), (-130, -60)):
        found = page.run(code.format(turn=turn, tilt=tilt))
        assert math.hypot(*found) == pytest.approx(13)
    assert page.run(code.format(turn=0, tilt=0)) == pytest.approx([3, 12, -4])
    assert page.run(code.format(turn=0, tilt=90)) == pytest.approx([3, -4, -12])


def test_lifted_points_have_their_heights(page: Page) -> None:
    choose(page, LIFT, turn=0, tilt=0)
    state = shown(page, LIFT)[0]
    (top,) = drawn(state, 1, kind="dots", color="point")
    heights = [((x - 300) ** 2 + (y - 300) ** 2) / 300**2 for x, y in live_cells.LIFTED]
    assert top["xy"][1::2] == pytest.approx(heights)
    page.run(f"{LIFT}.reset()")


def test_the_lowest_point_above_a_plane_is_that_of_the_lifted_points(page: Page) -> None:
    lifted = [[(v - 300) / 300 for v in row] for row in live_cells.LIFTED]
    lifted = [[x, y, x * x + y * y] for x, y in lifted]
    for state in shown(page, LIFT):
        rows = [int(row) for row in state["say"].split("corners ")[1].split(" cuts")[0].split(", ")]
        a = lifted[rows[0]]
        u, v = ([p - q for p, q in zip(lifted[row], a, strict=True)] for row in rows[1:])
        normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        above = [
            sum(n * (p[i] - a[i]) for i, n in enumerate(normal)) / normal[2]
            for row, p in enumerate(lifted)
            if row not in rows
        ]
        said = float(state["say"].split("lowest is ")[1].split(" ")[0])
        assert said == pytest.approx(min(above), abs=0.0006)
        assert said > 0


def test_keys_and_mouse_turn_the_drawing_and_back(page: Page) -> None:
    def look() -> tuple[Any, ...]:
        return tuple(page.run(f"[{LIFT}.options.turn, {LIFT}.options.tilt]"))

    start, image = look(), page.run(f"{LIFT}.canvas.toDataURL()")
    page.run(f"{LIFT}.canvas.scrollIntoView(); {LIFT}.canvas.focus()")
    page.key("ArrowRight")
    page.key("ArrowDown")
    assert look() == (start[0] + 6, start[1] + 6)
    assert page.run(f"{LIFT}.canvas.toDataURL()") != image
    page.key("ArrowLeft")
    page.key("ArrowUp")
    assert look() == start
    assert page.run(f"{LIFT}.canvas.toDataURL()") == image
    box = page.run(
        "(({left, top, width, height}) => [left, top, width, height])"
        f"({LIFT}.canvas.getBoundingClientRect())"
    )
    x, y = box[0] + 0.75 * box[2], box[1] + 0.9 * box[3]
    page.mouse("Moved", x, y)
    page.mouse("Pressed", x, y)
    page.mouse("Moved", x + 40, y - 20, held=True)
    page.mouse("Released", x + 40, y - 20)
    assert look() == (start[0] + 20, start[1] - 10)
    page.run(f"{LIFT}.reset()")
    assert page.run(f"{LIFT}.canvas.toDataURL()") != image
    page.run(f"{LIFT}.show(2)")
    assert page.run(f"{LIFT}.canvas.toDataURL()") == image
    assert page.complaints() == []
