"""One call per peer on a closed surface: a `Surface` in, tetrahedra out.

As in `adapters`; but what goes to the judge are counts: tetrahedra, points added and triangles of
the input that are faces of tetrahedra. Each peer, including TetGen, works in processes of its own.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from adapters import Adapter
from numpy.typing import NDArray

if TYPE_CHECKING:
    from pathlib import Path


class Surface(NamedTuple):
    """Points, and triangles as rows of them."""

    points: NDArray[np.float64]
    faces: NDArray[np.int32]


def save(surface: Surface, file: Path) -> None:
    """Write a surface as an npz file."""
    np.savez(file, points=surface.points, faces=surface.faces)


def load(file: str) -> Surface:
    """Read what `save` wrote."""
    with np.load(file) as arrays:
        return Surface(arrays["points"], arrays["faces"])


def counts(surface: Surface, answer: tuple[Any, Any]) -> NDArray[np.int64]:
    """Count tetrahedra, points added, and faces kept, by coordinates."""
    points, tetrahedra = answer
    corners = (surface.points[surface.faces.ravel()] + 0.0).tolist()
    numbers = {tuple(p): n for n, p in enumerate(corners)}
    given = np.array([numbers[tuple(p)] for p in corners])
    rows = np.array([numbers.get(tuple(p), -1) for p in (points + 0.0).tolist()])
    wanted = np.unique(np.sort(given.reshape(-1, 3), axis=1), axis=0)
    faces = np.sort(rows[tetrahedra[:, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]]], axis=-1)
    there = np.unique(faces.reshape(-1, 3), axis=0)
    both = np.unique(np.concatenate((wanted, there)), axis=0)
    kept = len(wanted) + len(there) - len(both)
    used = np.unique(tetrahedra)
    return np.array([len(tetrahedra), np.count_nonzero(rows[used] < 0), kept])


def delone(workers: int = 1) -> Adapter:
    """Delone itself, with what `TetMesh` holds on return."""
    import delone as library

    def fill(surface: Surface) -> tuple[Any, Any]:
        mesh = library.tetrahedralize(surface.points, surface.faces, workers=workers)
        return mesh.points, mesh.simplices

    return Adapter(fill, counts, library.__version__, load)


def tetgen(switches: str) -> Adapter:
    """TetGen by its wheel, with switches of its command line."""
    from importlib.metadata import version

    import tetgen as library

    def fill(surface: Surface) -> tuple[Any, Any]:
        made = library.TetGen(surface.points, surface.faces).tetrahedralize(switches=switches)
        return made[0], made[1]

    return Adapter(fill, counts, version("tetgen"), load)


PEERS = {
    "delone": delone,
    "delone-2-workers": partial(delone, 2),
    "tetgen-p": partial(tetgen, "pQ"),
    "tetgen-pY": partial(tetgen, "pYQ"),
}
