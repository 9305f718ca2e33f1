"""Meshes of FESOM in text files: triangles, and the median dual around nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import delone
from delone import sphere
from delone.sphere import Grid, Overlaps

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray


def written(folder: Path, lonlat: NDArray[np.float64], triangles: NDArray[np.int64]) -> Path:
    rows = [f"{k + 1} {x!r} {y!r} 0" for k, (x, y) in enumerate(lonlat.tolist())]
    (folder / "nod2d.out").write_text("\n".join([str(len(rows)), *rows]))
    rows = [" ".join(map(str, row)) for row in (triangles + 1).tolist()]
    (folder / "elem2d.out").write_text("\n".join([str(len(rows)), *rows]))
    return folder


def mesh(count: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    xyz = np.random.default_rng(3).normal(size=(count, 3))
    made = sphere.Delaunay(xyz=xyz)
    lon, lat = np.arctan2(xyz[:, 1], xyz[:, 0]), np.arctan2(xyz[:, 2], np.hypot(*xyz.T[:2]))
    return np.degrees(np.column_stack((lon, lat))), made.simplices.astype(np.int64)


@pytest.mark.parametrize("part", [False, True])
def test_cells_around_nodes_share_triangles_in_thirds(tmp_path: Path, part: bool) -> None:
    lonlat, triangles = mesh(400)
    # Some clockwise, and a sea with islands.
    triangles[::3] = triangles[::3, ::-1]
    if part:
        triangles = triangles[np.random.default_rng(1).random(len(triangles)) < 0.7]
    folder = written(tmp_path, lonlat, triangles)
    nodes, cells = Grid.from_fesom(folder), Grid.from_fesom(folder, "triangles")
    assert nodes.ncells == 400
    assert cells.ncells == len(triangles)
    assert nodes.areas.sum() == pytest.approx(cells.areas.sum(), rel=1e-13)
    assert nodes.validate().overlapping.size == 0
    table = Overlaps(cells, nodes).matrix.toarray()
    for node in range(400):
        assert set(np.flatnonzero(table[node] > 1e-12)) == set(
            np.flatnonzero((triangles == node).any(axis=1))
        )
    # By plane geometry a third each; on the sphere nearly so, for small triangles.
    small = np.flatnonzero(cells.areas < 0.01)
    for t in small[:50]:
        shares = table[triangles[t], t] / cells.areas[t]
        assert np.allclose(shares, 1 / 3, rtol=0, atol=0.03)


def test_what_is_refused(tmp_path: Path) -> None:
    lonlat, triangles = mesh(20)
    folder = written(tmp_path, lonlat, np.concatenate((triangles, triangles[:1])))
    with pytest.raises(delone.InputError, match="triangles 0 and 36 overlap"):
        Grid.from_fesom(folder)
    with pytest.raises(delone.InputError, match="cells must be"):
        Grid.from_fesom(folder, "edges")
    (folder / "elem2d.out").write_text("3\n1 2 3\n")
    with pytest.raises(delone.FileFormatError, match="must have 3 rows of 3 numbers"):
        Grid.from_fesom(folder)
    (folder / "elem2d.out").write_text("1\n1 2 30\n")
    with pytest.raises(delone.DeloneError, match=r"elem2d\.out"):
        Grid.from_fesom(folder)
    (folder / "nod2d.out").write_text("many\n")
    with pytest.raises(delone.FileFormatError, match=r"nod2d\.out must be a table"):
        Grid.from_fesom(folder)
