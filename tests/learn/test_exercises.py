"""The exercises of the course: answers by Python, verdicts in Chromium, the code to download."""

from __future__ import annotations

import math
import subprocess
import sys
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import exercise_parts
import numpy as np
import pytest

import delone
from chapters import CHAPTERS, EXERCISES
from delone.reference import circumcircle

if TYPE_CHECKING:
    from browser import Page

NUMBERS = [n for n, each in enumerate(EXERCISES) if each.exercise.kind == "number"]
CHOICES = [n for n, each in enumerate(EXERCISES) if each.exercise.kind == "choice"]
ASKED = [n for n, each in enumerate(EXERCISES) if each.exercise.kind == "figure"]


def last_height_with_an_upper_side() -> float:
    """How far up the fifth point goes until the edge between the upper corners is gone."""
    corners = [(0, 0), (4, 0), (4, 3), (0, 3)]
    for y in (Fraction(k, 4) for k in range(4, 20)):
        edges = delone.Delaunay([*corners, (2.0, float(y))]).edges
        if (2, 3) not in {tuple(sorted(edge)) for edge in edges.tolist()}:
            return float(y)
    raise AssertionError("the edge stays")


def bad_triangles_of_a_star_of_six() -> int:
    """How many triangles fewer there are without the middle of a hexagon."""
    ring = [(math.cos(k), math.sin(k)) for k in range(6)]
    assert len(delone.Delaunay([*ring, (0.1, 0.2)]).simplices) == 6
    return len(delone.Delaunay(ring).simplices)


def triangles_of_a_thousand() -> int:
    mesh = delone.Delaunay(np.random.default_rng(0).random((1000, 2)))
    assert len(mesh.hull) == 18
    return len(mesh.simplices)


def dihedral_angle() -> float:
    corners = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], dtype=float)
    return float(delone.Delaunay(corners).quality().smallest_dihedral[0])


RIGHT = {
    "empty_circle": triangles_of_a_thousand,
    "five_points": last_height_with_an_upper_side,
    "insertion": bad_triangles_of_a_star_of_six,
    "predicates": (8_000_000**2).bit_length,
    "slivers": dihedral_angle,
    "failures": lambda: np.spacing(5_400_000.0) * 1e9,
}


def test_each_chapter_has_exercises_and_its_code() -> None:
    assert len(CHAPTERS) == 10
    for page in CHAPTERS:
        text = page.read_text(encoding="utf-8")
        found = [each for each in EXERCISES if each.page == page.stem]
        assert len(found) == text.count(".. exercise::") >= 2, page.stem
        assert all(each.answer for each in found)
        assert text.count(".. chapter-code::\n") == 1, page.stem
    assert len(ASKED) >= 5


@pytest.mark.parametrize("number", NUMBERS)
def test_numbers_are_those_of_python(number: int) -> None:
    page, _, exercise, _ = EXERCISES[number]
    assert abs(RIGHT[page]() - exercise.answer) <= exercise.tolerance
    for hint, said in exercise.hints:
        assert said
        assert not hint or abs(float(hint) - exercise.answer) > exercise.tolerance
    assert [hint for hint, _ in exercise.hints][-1] == ""


def test_four_points_on_a_circle_are_the_reason_for_four() -> None:
    # What the hint for 4 says: there the fifth point is on the circle of the corners.
    assert circumcircle((0, 0), (4, 0), (4, 3)) == circumcircle((0, 0), (4, 0), (2, 4))


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"number": "1", "right": "Yes"},
        {"number": "many"},
        {"right": "Yes"},
        {"right": "Yes", "wrong": "No"},
        {"figure": "five"},
    ],
)
def test_exercises_that_cannot_be_judged_are_refused(options: dict[str, str]) -> None:
    with pytest.raises(ValueError, match=r"exercise|says why|could not convert"):
        exercise_parts.parsed(options)


# In the browser.


def answer(page: Page, number: int, value: str | int | None = None) -> tuple[str, bool]:
    """Give an answer, press the button, and return what the page says, and if the answer opens."""
    element = f"window.deloneExercises[{number}].element"
    kind = EXERCISES[number].exercise.kind
    if kind == "number":
        page.run(f"{element}.querySelector('input').value = {str(value)!r}")
    elif value is not None:
        page.run(f"{element}.querySelectorAll('input')[{value}].checked = true")
    page.run(f"{element}.querySelector('button').click()")
    said = page.run(f"{element}.querySelector('.exercise-verdict').textContent")
    return said, page.run(f"{element}.querySelector('details').open")


@pytest.mark.parametrize("number", NUMBERS)
def test_numbers_are_judged(shared: Page, number: int) -> None:
    exercise = EXERCISES[number].exercise
    for text in ("", "many", "1,2,3", "--4", "1e999"):
        assert answer(shared, number, text) == ("Write a number.", False)
    hints = dict(exercise.hints)
    for hint, said in exercise.hints:
        assert answer(shared, number, hint or "-77") == (f"Wrong. {said}", False)
    beyond = exercise.answer + exercise.tolerance * 1.01 + (exercise.tolerance == 0)
    want = next((said for hint, said in hints.items() if hint and float(hint) == beyond), hints[""])
    assert answer(shared, number, beyond) == (f"Wrong. {want}", False)
    assert answer(shared, number, exercise.answer) == ("Right.", True)
    assert shared.complaints() == []


def test_numbers_may_be_written_in_several_ways(page: Page) -> None:
    thousand = next(n for n in NUMBERS if EXERCISES[n].exercise.answer == 1980)
    for text in (" 1980 ", "1,980", "1 980", "1980.0", "+1980", "1.98e3"):
        assert answer(page, thousand, text) == ("Right.", True)
    small = next(n for n in NUMBERS if EXERCISES[n].exercise.answer == 0.93)
    for text in ("0.93", "0,93", ".931"):
        assert answer(page, small, text)[0] == "Right."
    assert answer(page, small, "−0.93")[0].startswith("Wrong.")


def test_enter_checks_a_number(page: Page) -> None:
    element = f"window.deloneExercises[{NUMBERS[0]}].element"
    page.run(f"{element}.querySelector('input').focus()")
    for key in "12":
        page.key(key)
    page.key("Enter")
    assert page.run(f"{element}.dataset.verdict") == "wrong"


@pytest.mark.parametrize("number", CHOICES)
def test_choices_are_judged(shared: Page, number: int) -> None:
    choices = EXERCISES[number].exercise.choices
    assert [reason for _, reason in choices].count("") == 1
    assert answer(shared, number) == ("Choose an answer.", False)
    wrong = [k for k, (_, reason) in enumerate(choices) if reason]
    for k in wrong:
        assert answer(shared, number, k) == (f"Wrong. {choices[k][1]}", False)
    (right,) = set(range(len(choices))) - set(wrong)
    assert answer(shared, number, right) == ("Right.", True)
    assert shared.complaints() == []


# The last point in the middle, the others around it.
AROUND = """f.change((c) => {
    const n = c.points.length / 2 - 1;
    c.points = c.points.map((_, k) => {
        const [row, at] = [k >> 1, (2 * Math.PI * (k >> 1)) / n];
        if (row === n) return k % 2 ? 300 : 500;
        return Math.round(k % 2 ? 300 + 250 * Math.sin(at) : 500 + 250 * Math.cos(at));
    });
})"""


def placed(*points: float) -> str:
    return f"f.change((c) => {{ c.points = Float64Array.of({str(points)[1:-1]}); }})"


def with_segments(rows: list[int]) -> str:
    return f"f.change((c) => {{ c.options = {{ ...c.options, segments: {rows} }}; }})"


# A change of the figure that is not enough, what is missing, and one that is.
SOLVED = {
    "flatTriangle": ("f.move(1, 440, 160)", "The largest angle is", "f.move(1, 440, 101)"),
    "twoNeighbors": ("f.move(4, 2, 3.75)", "The neighbors of p4 are p0, p1", "f.move(4, 2, 4.75)"),
    "bothLegal": (
        placed(100, 100, 500, 90, 500, 400, 100, 400),
        "One of the diagonals is illegal.",
        placed(100, 100, 500, 100, 500, 400, 100, 400),
    ),
    "eightNeighbors": ("f.move(0, 500, 300)", "The most neighbors that a point inside", AROUND),
    "fourEdges": (with_segments([]), "There are 0 segments; draw one.", None),
}


@pytest.mark.parametrize("number", ASKED)
def test_figures_are_judged(shared: Page, number: int) -> None:
    exercise = EXERCISES[number].exercise
    figure = f"window.deloneFigures.{exercise.figure}"
    if not shared.run(f"{figure}.core.live || Boolean({figure}.kind.free)"):
        said, is_open = answer(shared, number)
        assert said.startswith("This copy of the site comes without the compiled core")
        assert not is_open
        return
    shared.run(f"{figure}.reset()")
    said, is_open = answer(shared, number)
    assert said.startswith("Not yet. ") and not is_open
    before, missing, after = SOLVED[exercise.check]
    shared.run(f"(() => {{ const f = {figure}; {before}; }})()")
    said, is_open = answer(shared, number)
    assert said.startswith(f"Not yet. {missing}") and not is_open
    if after is None:
        # A segment between any two points: some remove four edges, some do not.
        verdicts = set()
        for u in range(4):
            for v in range(u + 1, shared.run(f"{figure}.points.length / 2")):
                shared.run(f"(() => {{ const f = {figure}; {with_segments([u, v])}; }})()")
                verdicts.add(answer(shared, number)[0].partition(" removes")[0])
        assert verdicts == {"Right.", "Not yet. The segment"}
    else:
        shared.run(f"(() => {{ const f = {figure}; {after}; }})()")
        assert answer(shared, number) == ("Right.", True)
    shared.run(f"{figure}.reset()")
    assert answer(shared, number)[0].startswith("Not yet. ")
    assert shared.complaints() == []


def test_moved_corners_do_not_count(page: Page) -> None:
    number = next(n for n in ASKED if EXERCISES[n].exercise.check == "twoNeighbors")
    figure = "window.deloneFigures.five"
    button = f"{figure}.element.querySelector('.live-reset')"
    assert page.run(f"{button}.textContent") == "Back to the five points"
    if not page.run(f"{figure}.core.live"):
        return
    # From beyond a corner three are seen.
    page.run(f"{figure}.move(4, 5.5, 4.5)")
    assert answer(page, number)[0] == "Not yet. The neighbors of p4 are p1, p2, p3."
    page.run(f"{figure}.reset()")
    page.run(f"{figure}.move(2, 5, 5)")
    page.run(f"{figure}.move(4, 2, -3)")
    assert 'A corner has moved: "Back to the five points"' in answer(page, number)[0]
    page.run(f"{button}.click()")
    assert page.run(f"Array.from({figure}.points)") == [0, 0, 4, 0, 4, 3, 0, 3, 2, 1]
    page.run(f"{figure}.change((c) => {{ c.options = {{ ...c.options, four: true }}; }})")
    assert "p4 is deleted" in answer(page, number)[0]
    page.run(f"{figure}.reset()")


def test_the_way_to_the_figure(page: Page) -> None:
    number = ASKED[0]
    figure = EXERCISES[number].exercise.figure
    element = f"window.deloneExercises[{number}].element"
    page.run(f"{element}.querySelectorAll('button')[1].click()")
    assert page.run(
        f"window.deloneFigures.{figure}.element.contains(document.activeElement)"
    ) is page.run(f"Boolean(window.deloneFigures.{figure}.element.querySelector('.live-handle'))")


def test_answers_do_not_leave_the_page(page: Page, site: str) -> None:
    before = len(page.addresses())
    for number in NUMBERS:
        answer(page, number, "12")
    for number in CHOICES:
        answer(page, number, 0)
    for number in ASKED:
        answer(page, number)
    assert page.complaints() == []
    assert len(page.addresses()) == before
    home = site.rpartition("/")[0]
    assert all(each.startswith((home, "data:", "blob:")) for each in page.addresses())
    assert page.run("localStorage.length + sessionStorage.length") == 0
    assert page.run("document.cookie") == ""


# The code of a chapter.


@pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
def test_programs_print_what_the_page_shows(path: Path, tmp_path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    program = exercise_parts.script(text, exercise_parts.title_of(text))
    (tmp_path / "chapter.py").write_text(program, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-W", "error", "chapter.py"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    shown = [line[2:] for line in program.splitlines() if line.startswith("# ")]
    assert shown, "the chapter has no code"
    printed = [line for line in done.stdout.splitlines() if line]
    assert [line for line in printed if line.strip("'") not in {x.strip("'") for x in shown}] == []
    assert len(printed) >= len(shown)
