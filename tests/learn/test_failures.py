"""The figures of failure modes: errors and counts are those of Python, in each step."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import live_failures
import numpy as np
import pytest

import delone
from delone import Delaunay

if TYPE_CHECKING:
    from browser import Page


def figure(name: str) -> str:
    return f"window.deloneFigures.{name}"


def said(page: Page, name: str) -> list[str]:
    found: list[str] = page.run(f"{figure(name)}.states.map((state) => state.say)")
    return found


def raised(points: Any) -> str:
    """Return the error that delone raises, as the figures write it."""
    with pytest.raises(delone.DeloneError) as caught:
        Delaunay(points)
    return f"{type(caught.value).__name__}: {caught.value}."


def edges_of(points: Any) -> set[tuple[int, int]]:
    return {(min(u, v), max(u, v)) for u, v in Delaunay(points).edges.tolist()}


def strokes(page: Page, name: str, step: int, color: str) -> list[float]:
    """Return the coordinates of the lines of a color in a step."""
    found: list[float] = page.run(
        f"{figure(name)}.states[{step}].layers[0].filter((layer) => layer.kind === 'lines' "
        f"&& layer.color === '{color}').flatMap((layer) => Array.from(layer.segments))"
    )
    return found


def test_a_point_that_moves_onto_another_is_a_duplicate(page: Page) -> None:
    texts = said(page, "twice")
    assert len(texts) == len(live_failures.NEARER)
    angles = []
    for share, text in zip(live_failures.NEARER, texts, strict=True):
        points = [list(row) for row in live_failures.TWICE]
        moves = [q - p for p, q in zip(points[5], points[2], strict=True)]
        points[5] = [math.floor(p + d * share + 0.5) for p, d in zip(points[5], moves, strict=True)]
        mesh = Delaunay(points)
        assert text.startswith(f"{mesh.nsimplex} triangles of 9 rows")
        assert ("row 5 repeats row 2, which delone reports" in text) is (share == 1)
        assert bool(mesh.duplicate_of[5] == 2) is (share == 1)
        if share < 1:
            angles.append(float(text.split("smallest angle is ")[1].split("°")[0]))
            assert angles[-1] == pytest.approx(mesh.quality().smallest_angle.min(), abs=0.0051)
    assert angles[-1] < 1 < angles[0]


def test_points_on_a_line_are_the_error_of_python(page: Page) -> None:
    *above, on = said(page, "line")
    points = [[x, 160] for x, _ in live_failures.LINE]
    assert on == raised(points)
    for text, high in zip(above, (200, 80, 20, 2), strict=True):
        points[3][1] = 160 + high
        least = Delaunay(points).quality().smallest_angle.min()
        assert text.startswith(f"Row 3 is {high} above the line: 5 triangles, smallest angle ")
        assert float(text.split("smallest angle ")[1].split("°")[0]) == pytest.approx(
            least, abs=0.0051
        )


def test_all_triangulations_of_the_grid_are_delaunay(page: Page) -> None:
    texts = said(page, "grid")
    assert all(text.startswith("9 ties, so 512 valid triangulations.") for text in texts)
    drawn = page.run(
        f"{figure('grid')}.states.map((state) => Array.from(state.layers[0][0].corners))"
    )
    rows = {tuple(place): row for row, place in enumerate(live_failures.GRID)}
    seen = []
    for corners in drawn:
        places = np.reshape(corners, (-1, 3, 2)).astype(int).tolist()
        triangles = [[rows[tuple(place)] for place in triangle] for triangle in places]
        delone.testing.assert_delaunay(live_failures.GRID, triangles, canonical=False)
        seen.append(sorted(tuple(sorted(triangle)) for triangle in triangles))
    assert seen[0] == seen[1]
    assert seen[0] == sorted(
        tuple(sorted(t)) for t in Delaunay(live_failures.GRID).simplices.tolist()
    )
    assert len({str(each) for each in seen}) == 3
    changed = [len(strokes(page, "grid", step, "accent")) // 4 for step in range(4)]
    assert changed == [0, 0, 5, 9]


def test_a_moved_point_of_the_grid_breaks_ties(page: Page) -> None:
    if not page.run(f"{figure('grid')}.core.live"):
        return
    assert page.run(f"{figure('grid')}.move(5, 445, 160)")
    assert said(page, "grid")[0].startswith("5 ties, so 32 valid triangulations.")
    page.run(f"{figure('grid')}.reset()")


def test_degrees_give_the_edges_of_another_map(page: Page) -> None:
    ground = live_failures.NORTH
    plane = [[2 * x, y] for x, y in ground]
    wrong = edges_of(plane) - edges_of(ground)
    red = np.reshape(strokes(page, "degrees", 0, "bad"), (-1, 2, 2)).astype(int).tolist()
    assert {tuple(sorted(ground.index(place) for place in edge)) for edge in red} == wrong
    mesh = Delaunay(plane)
    full = sum(
        any(
            delone.predicates.incircle(*(ground[row] for row in t), ground[other]) > 0
            for other in range(len(ground))
            if other not in t
        )
        for t in mesh.simplices.tolist()
    )
    first, second = said(page, "degrees")
    assert f"{len(wrong)} edges (red)" in first
    assert f"{full} of {mesh.nsimplex} circles are not empty" in first
    assert "all circles are empty" in second
    assert full > 0
    assert strokes(page, "degrees", 1, "bad") == []


def test_single_precision_moves_and_joins_points(page: Page) -> None:
    points = np.array(live_failures.survey())
    origin = np.array([live_failures.EASTING, live_failures.NORTHING])
    single = (points + origin).astype(np.float32)
    mesh = Delaunay(single)
    # The rows of one place count as one.
    first = mesh.duplicate_of
    right = {tuple(sorted((first[u], first[v]))) for u, v in edges_of(points)}
    wrong = len(edges_of(single) - right)
    texts = said(page, "offset")
    assert f"{wrong} wrong edges (red), 1 duplicate" in texts[1]
    assert (mesh.duplicate_of != np.arange(len(points))).sum() == 1
    for text in (texts[0], texts[2]):
        assert "No wrong edge, no duplicate" in text
    assert edges_of(points + origin) == edges_of(points)
    least = mesh.quality().smallest_angle.min()
    assert float(texts[1].split("smallest angle ")[1].split("°")[0]) == pytest.approx(
        least, abs=0.0051
    )
    # The longest stroke is as long as half of the step between single-precision numbers.
    moved = np.reshape(strokes(page, "offset", 1, "accent"), (-1, 4))
    assert 0.15 < np.abs(moved[:, 3] - moved[:, 1]).max() <= 0.25


def test_values_that_are_not_numbers_are_the_errors_of_python(page: Page) -> None:
    texts = said(page, "missing")
    points = [list(row) for row in live_failures.GAPS]
    assert texts[0] == f"All coordinates are numbers: {Delaunay(points).nsimplex} triangles."
    points[3][0] = math.nan
    assert texts[1] == raised(points)
    points[6][1] = math.inf
    assert texts[2] == raised(points)
    assert "NonFiniteError" in texts[1]
    points[3][0], points[6][1] = -9999, live_failures.GAPS[6][1]
    assert texts[3].endswith(f"not a place: {Delaunay(points).nsimplex} triangles.")
    rest = live_failures.GAPS[:3] + live_failures.GAPS[4:]
    assert texts[4].endswith(f"new numbers: {Delaunay(rest).nsimplex} triangles.")


def test_a_triangle_that_is_too_small_loses_what_is_said(page: Page) -> None:
    hull = live_failures.HULL
    size = Delaunay(hull).nsimplex
    losses = []
    for factor, text in zip(live_failures.FACTORS, said(page, "enclosing"), strict=True):
        together = Delaunay(hull + live_failures.around(factor)).simplices
        kept = int((together < len(hull)).all(axis=1).sum())
        assert f"There are {kept} triangles; 2n - h - 2 is {size}." in text
        losses.append(size - kept)
        assert ("None is lost" in text) is (kept == size)
    assert losses[0] > losses[3] > 0
    assert losses[-1] == 0
    assert losses == page.run(f"{figure('enclosing')}.states.map((state) => state.lost)")


@pytest.mark.parametrize("name", sorted(live_failures.FIGURES))
def test_figures_are_silent_in_the_console(page: Page, name: str) -> None:
    count = page.run(f"{figure(name)}.states.length")
    for step in range(count):
        page.run(f"{figure(name)}.show({step})")
        assert page.run(f"{figure(name)}.status.textContent") == said(page, name)[step]
    assert page.complaints() == []
    hosts = {address.split("/")[2] for address in page.addresses() if "//" in address}
    assert len(hosts) == 1
