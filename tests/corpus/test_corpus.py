"""The corpus is what it says, and the reference answers all of it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from delone.reference import bowyer_watson
from delone.testing import assert_delaunay

FOLDER = Path(__file__).parent
FILES = sorted(FOLDER.rglob("*.json"))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_file_is_complete(path: Path) -> None:
    case = json.loads(path.read_text(encoding="utf-8"))
    assert case["sentence"].endswith(".")
    ndim = 3 if path.parent.name in ("space", "sphere") else 2
    assert all(len(point) == ndim for point in case["points"])
    assert np.isfinite(np.array(case["points"], dtype=np.float64)).all()
    assert ("reason" in case) == (path.parent.name == "degenerate")
    copied = path.stem.split("-")[0] in ("delaunator", "earcut", "poly2tri")
    assert ("source" in case) == copied
    starts = case.get("rings", [0])
    assert starts[0] == 0 and starts == sorted(set(starts)) and starts[-1] <= len(case["points"])


def test_names_differ() -> None:
    assert len({path.stem for path in FILES}) == len(FILES) >= 50


@pytest.mark.sampled(15)
def test_reference_triangulates(corpus_case: tuple[str, np.ndarray, str]) -> None:
    points = corpus_case[1]
    # The reference is quadratic; a connected part of the large cases keeps what is hard in them.
    points = points[:400]
    assert_delaunay(points, bowyer_watson(points.tolist()))
