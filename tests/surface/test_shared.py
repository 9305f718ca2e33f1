"""Public surfaces, where they are at hand: which are valid, and which cross."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone

if TYPE_CHECKING:
    from numpy.typing import NDArray

FOLDER = Path(__file__).parents[3] / "shared" / "data" / "surfaces"
# Its faces are polygons with up to seven corners, which are not convex.
POLYGONS = {"mpi.off"}

pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="needs public surfaces")


def read(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return the points and triangles of an OFF or OBJ file; polygons become fans."""
    rows = [line.split("#")[0].split() for line in path.read_text(errors="replace").splitlines()]
    rows = [row for row in rows if row]
    if path.suffix == ".obj":
        points = [row[1:4] for row in rows if row[0] == "v"]
        rings = [[int(c.split("/")[0]) - 1 for c in row[1:]] for row in rows if row[0] == "f"]
    else:
        counts, start = (rows[1], 2) if len(rows[0]) == 1 else (rows[0][1:], 1)
        n, m = int(counts[0]), int(counts[1])
        points = [row[:3] for row in rows[start : start + n]]
        lines = rows[start + n : start + n + m]
        rings = [[int(v) for v in row[1 : 1 + int(row[0])]] for row in lines]
    fans = [(r[0], r[k], r[k + 1]) for r in rings for k in range(1, len(r) - 1)]
    return np.array(points, dtype=float), np.array(fans)


def files(folder: str, suffix: str) -> list[Any]:
    found = sorted((FOLDER / folder).glob("*" + suffix)) if FOLDER.is_dir() else []
    return [pytest.param(path, id=path.name) for path in found]


@pytest.mark.parametrize("path", files("refuse", ".obj"))
def test_surfaces_that_cross_are_refused(path: Path) -> None:
    check = delone.check_surface(*read(path))
    assert check.ncrossing and not check
    with pytest.raises(delone.CrossingFacesError):
        check.raise_if_bad()


@pytest.mark.parametrize("path", files("tetgentests", ".off"))
@pytest.mark.deep("bunny00.off", "turbine.off")
@pytest.mark.sampled(8)
def test_valid_surfaces(path: Path) -> None:
    check = delone.check_surface(*read(path))
    assert bool(check) == (path.name not in POLYGONS)
    assert check.closed
