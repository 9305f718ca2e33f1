"""The page of the command, the view and the widget in a headless Chromium."""

from __future__ import annotations

import base64
import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import ConstrainedDelaunay, Delaunay, InputError, PeriodicDelaunay
from delone.explorer import script
from delone.explorer.state import Exploration
from delone.explorer.widget import source

if TYPE_CHECKING:
    from collections.abc import Callable

    from browser import Browser, Page
    from delone.explorer.server import ExploreServer

VIEW = "window.explored"


@pytest.fixture
def page(server: ExploreServer, browser: Browser) -> Page:
    found = browser.page(server.address)
    found.wait(VIEW)
    return found


def place(page: Page, x: float, y: float) -> list[float]:
    """Where coordinates of the mesh are in the window."""
    code = f"""(() => {{
        const [px, py] = {VIEW}.toScreen({x!r}, {y!r});
        const box = {VIEW}.canvas.getBoundingClientRect();
        return [px + box.left, py + box.top];
    }})()"""
    found: list[float] = page.run(code)
    return found


def color(page: Page, x: float, y: float) -> list[int]:
    """Red, green and blue of the canvas at coordinates of the mesh, after drawing."""
    code = f"""(() => {{
        {VIEW}.drawNow();
        const [px, py] = {VIEW}.toScreen({x!r}, {y!r}).map(Math.floor);
        return Array.from({VIEW}.context.getImageData(px, py, 1, 1).data.slice(0, 3));
    }})()"""
    found: list[int] = page.run(code)
    return found


def test_the_page_is_silent_and_asks_for_nothing_else(server: ExploreServer, page: Page) -> None:
    assert page.complaints() == []
    asked = set(page.addresses()) - {"data:,"}
    assert all(each.startswith(server.address) for each in asked)
    assert len(asked) == 10
    assert page.run("document.title") == "sixty <b>points</b>.csv - delone"
    assert page.run("document.querySelector('h1').innerHTML").startswith("sixty &lt;b&gt;")


def test_the_policy_of_the_page_stops_other_scripts(page: Page) -> None:
    code = "document.body.append(Object.assign(document.createElement('script'), {text: 'x = 1'}))"
    page.run(code)
    assert page.run("typeof x") == "undefined"
    assert any("Content Security Policy" in each for each in page.complaints())


def test_a_click_picks_the_triangle_that_python_finds(server: ExploreServer, page: Page) -> None:
    mesh = server.state.mesh
    queries = np.random.default_rng(8).uniform(-0.1, 1.1, (300, 2))
    found = page.run(
        f"{json.dumps(queries.tolist())}.map(([x, y]) => {VIEW}.pick(...{VIEW}.toScreen(x, y)))"
    )
    assert [each["triangle"] for each in found] == mesh.find_simplex(queries).tolist()
    centers = mesh.points[mesh.simplices].mean(axis=1)
    for triangle in (0, mesh.nsimplex - 1, 41):
        page.click(*place(page, *centers[triangle].tolist()))
        corners = ", ".join(map(str, mesh.simplices[triangle].tolist()))
        said = page.run("document.querySelector('[aria-live]').textContent")
        assert said.startswith(f"Triangle {triangle}: vertices {corners}; smallest angle ")
        angle = float(said.partition("smallest angle ")[2].partition(". ")[0].rstrip("."))
        assert angle == pytest.approx(mesh.quality().smallest_angle[triangle], rel=1e-3)
        assert page.run(f"{VIEW}.selected.triangle") == triangle


def test_a_click_picks_the_nearest_point(server: ExploreServer, page: Page) -> None:
    mesh = server.state.mesh
    for row in (0, 17, 59):
        x, y = place(page, *mesh.points[row].tolist())
        page.click(x + 2, y - 1)
        assert page.run(f"{VIEW}.selected.vertex") == row
        a, b = mesh.points[row].tolist()
        said = page.run("document.querySelector('[aria-live]').textContent")
        assert said.endswith(f"Point {row} at ({a!r}, {b!r}); values {a!r}.")
    far = page.run(f"{VIEW}.vertexAt(...{VIEW}.toScreen(3, 3))")
    assert far == -1


def test_picking_among_many_triangles(browser: Browser, server: ExploreServer) -> None:
    points = np.random.default_rng(4).normal(size=(20_000, 2))
    mesh = Delaunay(points)
    server.state = Exploration(mesh)
    page = browser.page(server.address)
    page.wait(VIEW)
    queries = np.random.default_rng(5).normal(size=(200, 2)) * 2
    code = f"{json.dumps(queries.tolist())}.map(([x, y]) => {VIEW}.triangleAt(x, y))"
    assert page.run(code) == mesh.find_simplex(queries).tolist()
    # Short edges are drawn as gray levels, the others as lines.
    stats = page.run(f"{VIEW}.setLayers({{hull: false}}), {VIEW}.drawNow(), {VIEW}.stats")
    assert stats["edges"] + stats["merged"] == len(mesh.edges)
    assert stats["merged"] > stats["edges"] > 0


def test_picking_around_holes(browser: Browser, server: ExploreServer) -> None:
    rings = [(i, i // 4 * 4 + (i + 1) % 4) for i in range(12)]
    corners = [(0, 0), (9, 0), (9, 9), (0, 9), (2, 2), (4, 2), (4, 7), (2, 7)]
    corners += [(5, 3), (8, 3), (8, 6), (5, 6)]
    mesh = ConstrainedDelaunay(corners, rings, holes=[(3, 3), (6, 4)])
    server.state = Exploration(mesh)
    page = browser.page(server.address)
    page.wait(VIEW)
    assert page.run(f"Array.from({VIEW}.edges.neighbors)") == mesh.neighbors.ravel().tolist()
    queries = np.random.default_rng(1).uniform(-1, 10, (200, 2))
    # From each triangle to each place: across holes, too, where the walk ends.
    code = f"""{json.dumps(queries.tolist())}.map(([x, y]) =>
        Array.from({{length: {mesh.nsimplex}}}, (_, t) => {{
            {VIEW}.lastTriangle = t;
            return {VIEW}.triangleAt(x, y);
        }}))"""
    expected = np.broadcast_to(mesh.find_simplex(queries)[:, None], (200, mesh.nsimplex))
    assert page.run(code) == expected.tolist()


def test_only_what_is_in_the_window_is_drawn(server: ExploreServer, page: Page) -> None:
    every = len(server.state.mesh.edges)
    drawn = f"{VIEW}.drawNow(), {VIEW}.stats.edges + {VIEW}.stats.merged"
    assert page.run(f"{VIEW}.setLayers({{hull: false}}), {drawn}") == every
    assert 0 < page.run(f"{VIEW}.zoomBy(20), {drawn}") < every / 4
    # Lines far outside are clipped at any zoom, and fitting brings everything back.
    assert page.run(f"{VIEW}.zoomBy(1e12), {drawn}") <= 3
    assert page.run(f"{VIEW}.fit(), {drawn}") == every
    assert page.complaints() == []


def test_a_dragged_point_is_triangulated_by_python(server: ExploreServer, page: Page) -> None:
    before = np.array(server.state.mesh.points)
    row = int(np.argmin(((before - 0.5) ** 2).sum(axis=1)))
    x, y = before[row].tolist()
    start = place(page, x, y)
    page.run(f"{VIEW}.select({{triangle: 5, vertex: 3}})")
    page.mouse("Moved", *start)
    assert page.run(f"{VIEW}.canvas.style.cursor") == "move"
    page.mouse("Pressed", *start)
    for step in range(1, 6):
        page.mouse("Moved", start[0] + 9 * step, start[1] - 5 * step, held=True)
    page.mouse("Released", start[0] + 45, start[1] - 25)
    scale = page.run(f"{VIEW}.scale")
    page.wait(f"Math.abs({VIEW}.mesh.points[{2 * row}] - {x!r} - 45 / {scale!r}) < 1e-9")
    # The last position is sent after the answer to the one before.
    page.run("new Promise((done) => setTimeout(done, 300))")
    mesh = server.state.mesh
    assert mesh.points[row] == pytest.approx([x + 45 / scale, y + 25 / scale])
    moved = before.copy()
    moved[row] = mesh.points[row]
    assert np.array_equal(mesh.points, moved)
    shown = page.run(f"Array.from({VIEW}.mesh.triangles)")
    assert shown == Delaunay(moved).simplices.ravel().tolist()
    # The numbers of triangles are others now, those of points are the same.
    assert page.run(f"{VIEW}.selected") == {"triangle": -1, "vertex": 3}
    # Dragging anything else pans, and moves no point.
    page.mouse("Pressed", start[0] + 4, 90)
    page.mouse("Moved", start[0] + 90, 120, held=True)
    page.mouse("Released", start[0] + 90, 120)
    assert np.array_equal(server.state.mesh.points, moved)
    assert page.complaints() == []


def test_a_refused_move_is_undone_and_said(server: ExploreServer, page: Page) -> None:
    before = page.run(f"Array.from({VIEW}.mesh.points)")
    page.run(f"{VIEW}.press = {{vertex: 0, grip: [0, 0]}}, {VIEW}.mesh.movable = 60")
    server.state.move = refusing  # type: ignore[method-assign]
    page.run(f"{VIEW}.dragged(5, 5, 'end')")
    page.wait("document.querySelector('[aria-live]').textContent === 'points collide'")
    page.wait(f"{VIEW}.mesh.points[0] === {before[0]!r}")
    assert page.run(f"Array.from({VIEW}.mesh.points)") == before


def refusing(*_: Any) -> bytes:
    raise InputError("points collide")


def test_keys_pan_zoom_and_select(page: Page) -> None:
    page.run(f"{VIEW}.canvas.focus()")
    scale, center = page.run(f"[{VIEW}.scale, {VIEW}.center]")
    page.key("+")
    assert page.run(f"{VIEW}.scale") == pytest.approx(1.25 * scale)
    page.key("-")
    page.key("ArrowRight")
    assert page.run(f"{VIEW}.center[0]") > center[0]
    page.key("ArrowDown")
    assert page.run(f"{VIEW}.center[1]") < center[1]
    page.key("0")
    assert page.run(f"[{VIEW}.scale, {VIEW}.center]") == [scale, center]
    page.key("PageDown")
    page.key("PageDown")
    assert page.run(f"{VIEW}.selected.triangle") == 1
    page.key("PageUp")
    assert page.run(f"{VIEW}.selected.triangle") == 0
    page.key("Escape")
    assert page.run(f"{VIEW}.selected") is None
    page.key("Enter")
    at_center = page.run(f"{VIEW}.pick({VIEW}.size[0] / 2, {VIEW}.size[1] / 2).triangle")
    assert page.run(f"{VIEW}.selected.triangle") == at_center >= 0


def test_the_wheel_zooms_at_the_mouse(page: Page) -> None:
    x, y = 200, 300
    at = f"(() => {{const b = {VIEW}.canvas.getBoundingClientRect();"
    at += f" return {VIEW}.toWorld({x} - b.left, {y} - b.top)}})()"
    scale, before = page.run(f"{VIEW}.scale"), page.run(at)
    page.mouse("Wheel", x, y, deltaX=0, deltaY=-100)
    page.wait(f"{VIEW}.scale > {1.3 * scale!r}")
    assert page.run(at) == pytest.approx(before)


def test_screen_readers_have_names_for_everything(page: Page) -> None:
    tree = page.call("Accessibility.getFullAXTree")["nodes"]
    named = {
        (node["role"]["value"], node.get("name", {}).get("value", ""))
        for node in tree
        if not node.get("ignored")
    }
    roles = {role for role, _ in named}
    assert {"application", "checkbox", "button", "status", "heading"} <= roles
    assert all(name for role, name in named if role in ("application", "checkbox", "button"))
    (label,) = (name for role, name in named if role == "application")
    assert label.startswith("Delaunay of 60 points")
    assert "plus and minus zoom" in label


def test_layers_are_switched(server: ExploreServer, page: Page) -> None:
    mesh = server.state.mesh
    triangle = int(np.argmax(mesh.areas))
    center = mesh.points[mesh.simplices[triangle]].mean(axis=0).tolist()
    assert color(page, *center) == [255, 255, 255]
    names = page.run(
        "Array.from(document.querySelectorAll('[data-layer]'), (b) => b.dataset.layer)"
    )
    assert names == ["triangles", "quality", "values", "circles", "dual", "hull", "points"]
    page.run("document.querySelector('[data-layer=quality]').click()")
    assert color(page, *center) != [255, 255, 255]
    page.run("document.querySelector('[data-layer=quality]').click()")
    for name in ("circles", "dual", "points", "hull", "triangles"):
        before = page.run(f"{VIEW}.drawNow(), {VIEW}.canvas.toDataURL()")
        page.run(f"document.querySelector('[data-layer={name}]').click()")
        assert page.run(f"{VIEW}.drawNow(), {VIEW}.canvas.toDataURL()") != before, name


def test_colors_of_values_follow_the_values(server: ExploreServer, page: Page) -> None:
    mesh = server.state.mesh
    page.run(f"{VIEW}.setLayers({{values: true, triangles: false, points: false, hull: false}})")
    scale = page.run(f"{VIEW}.colors.values")
    centers = mesh.points[mesh.simplices].mean(axis=1)
    low, high = mesh.points[:, 0].min(), mesh.points[:, 0].max()
    for triangle in np.argsort(mesh.areas)[-20:]:
        x, y = centers[triangle].tolist()
        expected = scale[int((x - low) / (high - low) * len(scale))]
        # The mean may lie at the boundary of two colors.
        assert np.abs(np.subtract(color(page, x, y), expected)).max() <= 12


@pytest.mark.parametrize(("dark", "paper"), [(False, [255, 255, 255]), (True, [20, 24, 28])])
def test_the_page_is_light_or_dark(
    server: ExploreServer, browser: Browser, dark: bool, paper: list[int]
) -> None:
    page = browser.page(server.address, dark=dark)
    page.wait(VIEW)
    assert color(page, 1.15, 0.5) == paper
    body = page.run("getComputedStyle(document.body).backgroundColor")
    assert body == f"rgb({', '.join(map(str, paper))})"
    page.run("document.documentElement.style.setProperty('--delone-paper', '#010203')")
    page.run("new Promise((done) => setTimeout(done, 50))")
    assert color(page, 1.15, 0.5) == [1, 2, 3]


def test_pixels_of_dense_screens_are_used(page: Page) -> None:
    page.resize(800, 700, 2.0)
    page.wait(f"{VIEW}.canvas.width === 2 * {VIEW}.canvas.clientWidth")
    assert page.run(f"{VIEW}.canvas.height === 2 * {VIEW}.canvas.clientHeight")


def test_copies_of_points_do_not_move(browser: Browser, server: ExploreServer) -> None:
    points = np.random.default_rng(6).random((20, 2))
    server.state = Exploration(PeriodicDelaunay(points, (1, 1)))
    page = browser.page(server.address)
    page.wait(VIEW)
    movable = page.run(f"Array.from({VIEW}.mesh.rows, (_, i) => {VIEW}.options.movable(i))")
    assert movable == [i < 20 for i in range(len(movable))]
    assert page.run(f"{VIEW}.idOf(20)") < 20


# A model as anywidget passes it to `render`.
MODEL = """
globalThis.model = {
  values: {}, sent: [], saved: 0, handlers: {},
  get(name) { return this.values[name]; },
  set(name, value) { this.values[name] = value; },
  save_changes() { this.saved += 1; },
  send(message) { this.sent.push(message); },
  on(name, act) { (this.handlers[name] ||= []).push(act); },
  off(name, act) { this.handlers[name] = this.handlers[name].filter((each) => each !== act); },
  tell(name, ...given) { for (const act of this.handlers[name] || []) act(...given); },
};
globalThis.bytes = (text) =>
  new DataView(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
"""


@pytest.fixture
def widget(browser: Browser, mesh: Delaunay) -> Callable[[], Page]:
    def rendered() -> Page:
        page = browser.page("data:text/html,<!doctype html><title>w</title><body></body>")
        page.run(MODEL)
        scene = base64.b64encode(Exploration(mesh).packed()).decode()
        module = base64.b64encode(source().encode()).decode()
        page.run(f"model.values = {{scene: bytes('{scene}'), layers: {{}}, height: 300}}")
        page.run(
            f"import('data:text/javascript;base64,{module}').then(({{default: w}}) => {{"
            "globalThis.leave = w.render({model, el: document.body}) })"
        )
        return page

    return rendered


def test_the_widget_reports_what_is_picked(widget: Callable[[], Page], mesh: Delaunay) -> None:
    page = widget()
    center = "(() => {const b = document.querySelector('canvas').getBoundingClientRect();"
    page.click(*page.run(f"{center} return [b.left + b.width / 2, b.top + b.height / 2]}})()"))
    picked = page.run("model.values.selected")
    assert mesh.find_simplex([[picked["x"], picked["y"]]]).tolist() == [picked["triangle"]]
    assert page.run("model.saved") == 1
    page.run("document.querySelector('[data-layer=circles]').click()")
    assert page.run("model.values.layers.circles") is True
    assert page.run("model.saved") == 2
    assert page.run("document.querySelector('canvas').clientHeight") == 300
    page.run("leave()")
    assert page.run("document.body.children.length") == 0
    assert page.run("Object.values(model.handlers).flat().length") == 0
    assert page.complaints() == []


def test_the_widget_sends_moves_and_takes_the_answer(
    widget: Callable[[], Page], mesh: Delaunay
) -> None:
    page = widget()
    code = """(() => {
        const b = document.querySelector('canvas').getBoundingClientRect();
        const scene = model.values.scene;
        return [b.left, b.top, b.width, b.height];
    })()"""
    left, top, width, height = page.run(code)
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    scale = min(0.46 * width / ((high - low)[0] / 2), 0.46 * height / ((high - low)[1] / 2))
    row = int(np.argmin(((mesh.points - (low + high) / 2) ** 2).sum(axis=1)))
    dx, dy = ((mesh.points[row] - (low + high) / 2) * scale).tolist()
    x, y = left + width / 2 + dx, top + height / 2 - dy
    page.mouse("Pressed", x, y)
    page.mouse("Moved", x + 20, y, held=True)
    page.mouse("Moved", x + 30, y, held=True)
    page.mouse("Released", x + 30, y)
    # One message, until it is answered.
    (message,) = page.run("model.sent")
    assert (message["kind"], message["vertex"]) == ("move", row)
    state = Exploration(mesh)
    block = base64.b64encode(state.move(row, message["x"], message["y"])).decode()
    page.run(f"model.values.scene = bytes('{block}')")
    page.run(f"model.tell('msg:custom', {{number: {message['number']!r}, error: ''}})")
    page.wait("model.sent.length === 2")
    assert page.run("model.sent[1].x") == pytest.approx(message["x"] + 10 / scale)
    page.run("model.tell('msg:custom', {number: model.sent[1].number, error: 'no place'})")
    page.wait("document.querySelector('[aria-live]').textContent === 'no place'")
    assert page.complaints() == []


def test_the_page_loads_the_files_that_the_server_has() -> None:
    text = "".join(
        script(name) for name in ("page.html", "page.js", "scene.js", "view.js", "paint.js")
    )
    assert "http" not in text.replace("https://", "http")
    assert "innerHTML" not in text
