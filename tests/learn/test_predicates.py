"""The figures of rounded predicates: the exact halves are right, the rounded ones wrong."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import live_predicates
import numpy as np
import pytest

from delone import Delaunay, reference

if TYPE_CHECKING:
    from browser import Page

SIGNS = "window.deloneFigures.signs"
FORMULAS = ("a", "b", "c", "circle")


def choose(page: Page, formula: str, *, wrong: bool = False) -> None:
    options = f"{{ test: '{formula}', wrong: {str(wrong).lower()} }}"
    page.run(f"{SIGNS}.change((figure) => {{ figure.options = {options}; }})")


def shown(page: Page, step: int, panel: int) -> np.ndarray:
    """The numbers of the cells that a panel shows."""
    return np.array(
        page.run(f"Array.from({SIGNS}.states[{step}].layers[{panel}][0].values)"), dtype=int
    )


def rounded(formula: str, cells: np.ndarray) -> np.ndarray:
    """The signs of the formulas in NumPy's doubles."""
    if formula == "circle":
        fixed = np.array(live_predicates.FIXED["incircle"])
        (ax, ay), (bx, by), (cx, cy) = (np.transpose(point - cells) for point in fixed)
        a2, b2, c2 = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
        value = ax * (by * c2 - b2 * cy) - ay * (bx * c2 - b2 * cx) + a2 * (bx * cy - by * cx)
        return np.sign(value)
    a, b = (np.broadcast_to(point, cells.shape) for point in live_predicates.FIXED["orient2d"])
    points = [a, b, cells]
    k = "abc".index(formula)
    (ux, uy), (vx, vy), (wx, wy) = (points[(k + i) % 3].T for i in range(3))
    return np.sign((vx - ux) * (wy - uy) - (vy - uy) * (wx - ux))


@pytest.mark.parametrize("formula", FORMULAS)
def test_signs_are_those_of_fractions_and_of_doubles(page: Page, formula: str) -> None:
    choose(page, formula)
    name = "incircle" if formula == "circle" else "orient2d"
    test = reference.incircle if formula == "circle" else reference.orient
    exponents = live_predicates.EXPONENTS
    many = []
    for step in (0, len(exponents) - 1):
        cells = live_predicates.cells(exponents[step])
        exact = [test(*live_predicates.FIXED[name], cell) for cell in cells.tolist()]
        assert shown(page, step, 1).tolist() == [sign + 1 for sign in exact]
        assert (shown(page, step, 0) == rounded(formula, cells) + 1).all()
        many.append(int((rounded(formula, cells) != exact).sum()))
        said = page.run(f"{SIGNS}.states[{step}].say")
        assert said.startswith(f"{many[-1]:,} sign" if many[-1] else "No sign")
        assert page.run(f"{SIGNS}.states[{step}].wrong") == many[-1]
    # Far away the wrong signs are a band, close by they are everywhere.
    assert many[0] < many[1] / 4
    assert page.complaints() == []


def test_formulas_disagree_with_each_other(page: Page) -> None:
    pictures = []
    for formula in "abc":
        choose(page, formula)
        pictures.append(tuple(shown(page, 6, 0).tolist()))
    assert len(set(pictures)) == 3


def test_wrong_signs_only_are_marked(page: Page) -> None:
    choose(page, "a", wrong=True)
    marked = shown(page, 6, 0)
    choose(page, "a")
    different = shown(page, 6, 0) != shown(page, 6, 1)
    assert (marked == np.where(different, 3, 4)).all()


def test_the_mark_moves_by_key_and_by_click(page: Page) -> None:
    page.run(f"{SIGNS}.show(6); {SIGNS}.element.querySelector('.live-handle').focus()")
    assert "(½ − 2·2⁻⁵³, ½ + 3·2⁻⁵³)" in page.run(f"{SIGNS}.status.textContent")
    assert "floating point says on the line, exactly it is left" in page.run(
        f"{SIGNS}.status.textContent"
    )
    for key in ("ArrowRight", "ArrowRight", "ArrowDown"):
        page.key(key)
    assert "(½, ½ + 2·2⁻⁵³)" in page.run(f"{SIGNS}.status.textContent")
    page.run(f"{SIGNS}.element.scrollIntoView()")
    x, y = page.run(
        f"(() => {{ const paint = {SIGNS}.paints[1]; const box = "
        f"{SIGNS}.canvas.getBoundingClientRect(); "
        "return [box.left + paint.x(60), box.top + paint.y(5)]; })()"
    )
    page.click(x, y)
    assert "(½ + 28·2⁻⁵³, ½ − 27·2⁻⁵³)" in page.run(f"{SIGNS}.status.textContent")
    # Beyond the last cell, the mark stays on it.
    page.run(f"{SIGNS}.move(0, 1e9, -1e9)")
    assert "(½ + 31·2⁻⁵³, ½ − 32·2⁻⁵³)" in page.run(f"{SIGNS}.status.textContent")
    assert page.complaints() == []


@pytest.mark.parametrize("name", ["ring", "turned"])
def test_rounded_triangles_are_wrong_beside_the_right_ones(page: Page, name: str) -> None:
    figure = f"window.deloneFigures.{name}"
    points = np.array(getattr(live_predicates, name)()["points"])
    states = page.run(f"{figure}.states.map(({{ wrong, say }}) => [wrong, say])")
    assert len(states) == len(points) - 2
    assert states[0][0] == 0
    assert states[-1][0] > 3
    for count, (wrong, say) in enumerate(states, start=3):
        assert say.startswith(f"{count} points.")
        exact = len(Delaunay(points[:count]).simplices)
        made = int(re.findall(r"(\d+) triangle", say)[0])
        assert (f"instead of {exact}," in say) is (made != exact)
        assert ("all right" in say) is (wrong == 0 and made == exact)
    assert page.complaints() == []


def test_what_the_page_says_about_the_turned_grid(page: Page) -> None:
    say = page.run("window.deloneFigures.turned.states.map((state) => state.say)")
    assert re.search(r"3 triangles instead of 4, none of them wrong; .* the right area", say[5 - 3])
    assert re.search(r"11 triangles, the right number, \d of them wrong; .* overlap", say[9 - 3])
    assert "15 triangles instead of 7" in page.run("window.deloneFigures.ring.states.at(-1).say")


def test_off_the_tie_rounding_does_no_harm(page: Page) -> None:
    figure = "window.deloneFigures.ring"
    if not page.run(f"{figure}.core.live"):
        pytest.skip("points do not move without the core")
    # Round all points to whole numbers, then move them off the circle.
    page.run(
        f"for (let i = 0; i < 9; i += 1) {figure}.move(i, {figure}.points[2 * i] + i * i % 7, "
        f"{figure}.points[2 * i + 1] - i * i % 5)"
    )
    assert page.run(f"{figure}.states.every((state) => state.wrong === 0)")
    page.run(f"{figure}.reset()")
    assert page.run(f"{figure}.states.some((state) => state.wrong > 0)")


def test_points_on_the_circle_differ_from_it_in_the_last_bits_only() -> None:
    points = np.array(live_predicates.around())
    far = np.hypot(*(points - 300).T)
    assert np.abs(far - 270).max() < 1e-12
    assert {len(Delaunay(points[:k]).simplices) for k in range(3, 10)} == set(range(1, 8))
