"""What all tests share: hypothesis settings and the corpus of hard inputs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pytest
from hypothesis import settings

if TYPE_CHECKING:
    from numpy.typing import NDArray

# No test asserts a time, so an example that happens to be slow is no failure.
settings.register_profile("delone", deadline=None, print_blob=True)
settings.load_profile("delone")

CORPUS = Path(__file__).parent / "corpus"


class CorpusCase(NamedTuple):
    """A hard input that must triangulate."""

    name: str
    points: NDArray[np.float64]
    sentence: str


class DegenerateCase(NamedTuple):
    """An input that must raise DegenerateInputError for the reason given."""

    name: str
    points: NDArray[np.float64]
    sentence: str
    reason: str


def _read(path: Path) -> tuple[NDArray[np.float64], dict[str, Any]]:
    case = json.loads(path.read_text(encoding="utf-8"))
    return np.array(case["points"], dtype=np.float64).reshape(-1, 2), case


def _files(folder: Path) -> list[Any]:
    return [pytest.param(path, id=path.stem) for path in sorted(folder.glob("*.json"))]


@pytest.fixture(params=_files(CORPUS))
def corpus_case(request: pytest.FixtureRequest) -> CorpusCase:
    """One hard input after the other: name, points, and a sentence why it is hard."""
    points, case = _read(request.param)
    return CorpusCase(request.param.stem, points, case["sentence"])


@pytest.fixture(params=_files(CORPUS / "degenerate"))
def degenerate_case(request: pytest.FixtureRequest) -> DegenerateCase:
    """One input without any triangle after the other, and the reason to be raised."""
    points, case = _read(request.param)
    return DegenerateCase(request.param.stem, points, case["sentence"], case["reason"])
