"""The exercises that the chapters of the course have, read from their pages."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import NamedTuple

DOCS = Path(__file__).parents[2] / "docs"
sys.path.insert(0, str(DOCS / "extensions"))

import exercise_parts  # noqa: E402

__all__ = ["CHAPTERS", "EXERCISES", "Written"]

CHAPTERS = sorted(
    page for page in (DOCS / "learn").glob("*.rst") if page.stem not in ("index", "try")
)
# The task, the options and the answer of each exercise in a page.
EXERCISE = re.compile(
    r"^\.\. exercise:: (?P<task>.+)\n(?P<options>(?:   .+\n)+)\n(?P<answer>(?:   .*\n|\n)+)",
    re.MULTILINE,
)
OPTION = re.compile(r"^   :(\w+): ((?:.+\n?)(?:    +.+\n?)*)", re.MULTILINE)


class Written(NamedTuple):
    """An exercise as a page has it."""

    page: str
    task: str
    exercise: exercise_parts.Exercise
    answer: str


def exercises_of(page: Path) -> list[Written]:
    """The exercises of a page, in its order."""
    text = page.read_text(encoding="utf-8")
    return [
        Written(
            page.stem,
            found["task"],
            exercise_parts.parsed(
                {name: value.strip() for name, value in OPTION.findall(found["options"])}
            ),
            " ".join(found["answer"].split()),
        )
        for found in EXERCISE.finditer(text)
    ]


EXERCISES = [each for page in CHAPTERS for each in exercises_of(page)]
