"""Tetrahedra that share a face without being neighbors are found, in files and by validation."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import delone
from delone import FileFormatError, datasets

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(scope="module")
def mesh() -> delone.TetMesh:
    return delone.improve(delone.Delaunay(datasets.uniform(30, ndim=3)))


def separated(mesh: delone.TetMesh, everywhere: bool) -> np.ndarray:
    neighbors = mesh.neighbors.copy()
    if everywhere:
        neighbors[:] = -1
    else:
        t, k = (int(each[0]) for each in np.nonzero(neighbors >= 0))
        other = neighbors[t, k]
        neighbors[other, neighbors[other] == t] = -1
        neighbors[t, k] = -1
    return neighbors


@pytest.mark.parametrize("everywhere", [False, True])
def test_a_face_of_two_tetrahedra_that_are_not_neighbors(
    tmp_path: Path, mesh: delone.TetMesh, everywhere: bool
) -> None:
    neighbors = separated(mesh, everywhere)
    wrong = delone.TetMesh._of(mesh._arrays() | {"neighbors": neighbors}, mesh.report)
    report = wrong.validate()
    assert not report
    assert len(report.neighbors) == (mesh.nsimplex if everywhere else 2)
    assert mesh.validate()
    file = tmp_path / "a.npz"
    mesh.save(file)
    with np.load(file) as found:
        arrays = dict(found) | {"neighbors": neighbors}
    np.savez(file, **arrays)
    with pytest.raises(FileFormatError, match="not mutual"):
        delone.TetMesh.load(file)
