"""Every fault that the check of a triangulation in tiles can name, in an output that has no other.

The output is written by hand: strips of the plane as tiles, given triangles, and a manifest that
agrees with them. So nothing but the fault itself can give it away.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from delone import Delaunay, distributed
from delone.distributed.read import proof

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


@dataclass
class Output:
    """Points, triangles as their rows, and the cuts between strips; `write` makes the files."""

    points: Any
    triangles: Any
    cuts: tuple[float, ...] = (2.5,)
    hull: int = 4
    tables: list[dict[str, Any]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.points = np.array(self.points, dtype=np.float64)
        self.triangles = np.array(self.triangles, dtype=np.int64).reshape(-1, 3)
        owner = np.searchsorted(self.cuts, self.points[:, 0], side="right")
        of_triangle = owner[self.triangles].min(axis=1)
        for tile in range(len(self.cuts) + 1):
            triangles = self.triangles[of_triangle == tile]
            own = np.flatnonzero(owner == tile)
            ids = np.concatenate([own, np.setdiff1d(triangles, own)])
            self.tables.append(
                {
                    "id": ids,
                    "points": self.points[ids],
                    "owned": np.arange(len(ids)) < len(own),
                    "triangles": triangles,
                }
            )

    def write(self, folder: Path) -> distributed.TiledDelaunay:
        """Write what the tables hold, and the manifest that they ask for."""
        tin = distributed.triangulate([(0, 0), (1, 0), (0, 1)], folder)
        manifest = json.loads((folder / "manifest.json").read_text())
        manifest["tiles"] = [
            self._tile(folder, tile, table) for tile, table in enumerate(self.tables)
        ]
        owned = np.concatenate([table["points"][table["owned"]] for table in self.tables])
        nodes = range(len(self.cuts))
        manifest |= {
            "bounds": [*owned.min(axis=0).tolist(), *owned.max(axis=0).tolist()],
            "triangles": sum(len(table["triangles"]) for table in self.tables),
            "rows": len(owned),
            "points": len(owned),
            "duplicates": len(owned) - len(np.unique(owned, axis=0)),
            "hull": self.hull,
            "tree": {
                "axis": [0 for _ in nodes],
                "cut": list(self.cuts),
                "children": [[~n, n + 1 if n + 1 < len(nodes) else ~(n + 1)] for n in nodes],
            },
        }
        (folder / "manifest.json").write_text(json.dumps(manifest))
        return distributed.open(tin.path)

    def _tile(self, folder: Path, tile: int, table: dict[str, Any]) -> dict[str, Any]:
        """Write the files of a tile; return what the manifest says of it."""
        points, owned = table["points"], table["owned"]
        ids = table["id"].tolist()
        corners = np.array([ids.index(v) for v in table["triangles"].ravel().tolist()], dtype="i4")
        columns = {
            "vertices": {
                "id": table["id"].astype("u8"),
                "x": points[:, 0],
                "y": points[:, 1],
                "owned": owned,
            },
            "triangles": dict(zip("abc", corners.reshape(-1, 3).T, strict=True)),
        }
        found: dict[str, Any] = {
            "tile": tile,
            "files": {name: f"{name}/tile={tile:06}.parquet" for name in columns},
            "points": int(owned.sum()),
            "foreign": int((~owned).sum()),
            "triangles": len(table["triangles"]),
            "box": box(points[owned]),
            "extent": box(points) if len(table["triangles"]) else None,
        }
        for name, values in columns.items():
            path = folder / found["files"][name]
            pq.write_table(pa.table(values), path)
            found[f"{name}_sha256"] = hashlib.sha256(path.read_bytes()).hexdigest()
        return found


def box(points: Any) -> list[float]:
    return [*points.min(axis=0).tolist(), *points.max(axis=0).tolist()]


# A square cut in the middle, four points inside, of which two are on either side of the cut.
SQUARE = [(0, 0), (5, 0), (5, 5), (0, 5), (1, 2), (2, 4), (4, 3), (3.5, 1)]


def square() -> Output:
    return Output(SQUARE, Delaunay(SQUARE).simplices)


def wide() -> Output:
    """A strip with a point near either end."""
    points = [
        (0, 0),
        (10, 0),
        (10, 5),
        (0, 5),
        (1, 2),
        (9, 3),
        (4, 1),
        (4.5, 4),
        (6, 1.5),
        (6.5, 4.5),
    ]
    return Output(points, Delaunay(points).simplices, cuts=(5.5,))


def faults(output: Output, folder: Path) -> tuple[str, ...]:
    report = output.write(folder / "tin").validate()
    assert bool(report) == (not report.faults)
    return report.faults


def test_nothing_is_wrong_with_outputs_by_hand(tmp_path: Path) -> None:
    assert faults(square(), tmp_path) == ()
    # Ties and duplicates.
    points = [(x, y) for x in range(6) for y in range(4)] * 2
    (tmp_path / "grid").mkdir()
    assert faults(Output(points, Delaunay(points).simplices), tmp_path / "grid") == ()


@pytest.mark.parametrize("axis", [0, 1])
def test_copies_that_lie_elsewhere(axis: int, tmp_path: Path) -> None:
    output = square()
    table = output.tables[0]
    row = int(np.flatnonzero(~table["owned"])[-1])
    table["points"][row, axis] += 2.0**-40
    copy = table["id"][row]
    assert faults(output, tmp_path) == (f"vertex {copy} of tile 0 differs from that of tile 1",)


@pytest.mark.parametrize("number", [4, 99])
def test_copies_of_points_that_there_are_not(number: int, tmp_path: Path) -> None:
    """At the place of the point 5, by the number 4 and by one beyond all; no triangle has it."""
    output = square()
    table = output.tables[1]
    assert table["owned"].all()
    assert output.tables[0]["id"][output.tables[0]["owned"]].max() == 5
    table["id"] = np.append(table["id"], number)
    table["points"] = np.concatenate([table["points"], output.points[[5]]])
    table["owned"] = np.append(table["owned"], False)
    tin = output.write(tmp_path / "tin")
    manifest = json.loads((tmp_path / "tin" / "manifest.json").read_text())
    manifest["rows"], manifest["dropped"] = 108, 100
    (tmp_path / "tin" / "manifest.json").write_text(json.dumps(manifest))
    report = distributed.open(tin.path).validate()
    assert report.faults == (f"vertex {number} of tile 1 differs from that of tile 0",)


@pytest.mark.parametrize(
    "points",
    [
        # The last point lies in the circle of the others; and on it, against the rule of ties.
        [(0, 0), (3, -4), (3, 4), (4, 0)],
        [(-5, 0), (3, -4), (3, 4), (5, 0)],
    ],
)
def test_an_edge_between_tiles_that_is_not_delaunay(points: Any, tmp_path: Path) -> None:
    output = Output(points, [(0, 1, 2), (3, 2, 1)])
    assert faults(output, tmp_path) == ("an edge between tiles 0 and 1 is not Delaunay",)
    # The other diagonal is right, and both triangles are of the first tile.
    (tmp_path / "right").mkdir()
    assert faults(Output(points, [(0, 1, 3), (0, 3, 2)]), tmp_path / "right") == ()


@pytest.mark.parametrize(
    "points",
    [
        [(0, 0), (2, -4), (2, 4), (2.25, 0)],
        [(-5, 0), (3, -4), (3, 4), (5, 0)],
    ],
)
def test_an_edge_of_a_tile_that_is_not_delaunay(points: Any, tmp_path: Path) -> None:
    far = [(9, 0)]
    mesh = [(0, 1, 2), (3, 2, 1), (3, 1, 4), (3, 4, 2)]
    found = faults(Output([*points, *far], mesh, cuts=(7,)), tmp_path)
    assert found == ("tile 0: the edge of triangles 0 and 1 is not Delaunay",)


def test_triangles_of_two_tiles_that_are_folded_over(tmp_path: Path) -> None:
    """Both lie to the left of the edge 1 -> 2."""
    points = [(0, 0), (3, -4), (3, 4), (2.75, 0)]
    found = faults(Output(points, [(0, 1, 2), (3, 1, 2)], hull=0), tmp_path)
    assert found[0] == "triangles of tiles 0 and 1 overlap"


def test_an_edge_of_three_tiles(tmp_path: Path) -> None:
    points = [(0, 0), (20, -4), (20, 4), (5, 0), (24, 0)]
    output = Output(points, [(0, 1, 2), (3, 1, 2), (4, 2, 1)], cuts=(2.5, 10), hull=0)
    assert faults(output, tmp_path)[0] == "an edge has more than two triangles"


def test_a_boundary_that_meets_itself(tmp_path: Path) -> None:
    """Two triangles with one common corner: as many as so many points have."""
    points = [(0, 0), (0, 2), (2, 1), (4, 0), (4, 2)]
    output = Output(points, [(0, 2, 1), (2, 3, 4)], hull=0)
    assert faults(output, tmp_path) == ("the boundary meets itself",)


def test_tiles_without_any_triangle(tmp_path: Path) -> None:
    found = faults(Output(SQUARE, [], hull=0), tmp_path)
    assert found == (
        "the boundary meets itself",
        "0 triangles instead of 14: a point is missing",
    )


RING = [(0, 0), (8, 0), (4, 8), (3, 2), (5, 2), (4, 4)]
AROUND = [s for s in Delaunay(RING).simplices.tolist() if set(s) != {3, 4, 5}]


def test_a_boundary_of_several_cycles(tmp_path: Path) -> None:
    """A hole means too many triangles, two parts too few; both together the right number."""
    cycles = "the boundary is not a single cycle: there is a hole"
    apart = [(20, 0), (24, 0), (20, 4)]
    (tmp_path / "hole").mkdir()
    (tmp_path / "parts").mkdir()
    assert faults(Output(RING, AROUND, hull=0), tmp_path / "hole") == (
        cycles,
        "6 triangles instead of 4: a point is missing",
    )
    assert faults(Output(RING[:3] + apart, [(0, 1, 2), (3, 4, 5)], hull=0), tmp_path / "parts") == (
        cycles,
        "2 triangles instead of 4: a point is missing",
    )
    both = Output(RING + apart, [*AROUND, (6, 7, 8)], cuts=(4.5,), hull=0)
    assert faults(both, tmp_path) == (cycles,)


def test_a_boundary_that_goes_round_twice(tmp_path: Path) -> None:
    """Convex at each corner, and as many triangles as is right."""
    angles = np.radians([0, 120, 240, 390, 510, 630])
    points = [(0.125, 0.0625), *np.column_stack([np.cos(angles), np.sin(angles)])]
    fan = [(0, k, k % 6 + 1) for k in range(1, 7)]
    output = Output(points, fan, cuts=(0.0,), hull=6)
    assert faults(output, tmp_path) == ("the boundary winds more than once",)


@pytest.mark.parametrize("row", [8, 9])
def test_a_boundary_with_a_notch(row: int, tmp_path: Path) -> None:
    """A triangle less and an edge of the boundary more: the count is right."""
    points = [*SQUARE, (2, 0.25), (2.25, 4.875)]
    mesh = Delaunay(points).simplices
    outside = (points[row][1] > 2) * 5.0
    flat = np.array(
        [row in s and sum(points[v][1] == outside for v in s) == 2 for s in mesh.tolist()]
    )
    assert flat.sum() == 1
    output = Output(points, mesh[~flat])
    assert faults(output, tmp_path) == ("the boundary is not convex",)


@pytest.mark.parametrize("window", [1, 4, 1 << 28])
def test_a_row_that_two_tiles_own(
    window: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(proof, "_WINDOW", window)
    (tmp_path / "right").mkdir()
    assert faults(wide(), tmp_path / "right") == ()
    # The points 4 and 5 lie inside, far from each other; row 9 is the last one of all.
    number = np.array([0, 1, 2, 3, 9, 9, 6, 7, 8, 5])
    output = wide()
    for table in output.tables:
        for name in ("id", "triangles"):
            table[name] = number[table[name]]
    found = faults(output, tmp_path)
    assert found == ("row 9 is a point of tile 1 and of another tile",)


def test_a_triangle_in_the_files_of_another_tile(tmp_path: Path) -> None:
    output = square()
    whole = output.tables[1]["triangles"]
    assert len(whole) > 1
    output.tables[1]["triangles"] = whole[1:]
    table = output.tables[0]
    table["triangles"] = np.concatenate([table["triangles"], whole[:1]])
    more = np.setdiff1d(whole[0], table["id"])
    table["id"] = np.concatenate([table["id"], more])
    table["points"] = np.concatenate([table["points"], output.points[more]])
    table["owned"] = np.append(table["owned"], np.zeros(len(more), dtype=bool))
    assert faults(output, tmp_path) == ("tile 0 has a triangle of another tile",)


def test_a_point_that_another_tile_should_own(tmp_path: Path) -> None:
    """It is a second point at the place of another one, so that no triangle has it."""
    output = square()
    table = output.tables[0]
    table["id"] = np.append(table["id"], 8)
    table["points"] = np.concatenate([table["points"], output.points[[6]]])
    table["owned"] = np.append(table["owned"], True)
    found = faults(output, tmp_path)
    assert found[0] == "tile 0 has a point of another tile"


def test_a_vertex_that_a_tile_has_twice(tmp_path: Path) -> None:
    output = square()
    table = output.tables[0]
    row = np.flatnonzero(~table["owned"])[:1]
    for name in ("id", "points", "owned"):
        table[name] = np.concatenate([table[name], table[name][row]])
    assert faults(output, tmp_path) == ("tile 0 has a vertex twice",)


def test_a_triangle_and_its_other_side(tmp_path: Path) -> None:
    """They are neighbours across all three edges."""
    points = [(0, 0), (2, 0), (0, 2), (5, 5)]
    found = faults(Output(points, [(0, 1, 2), (0, 2, 1)], hull=0), tmp_path)
    assert found[0] == "tile 0: triangle 1 is not counter-clockwise"


def test_an_edge_that_two_triangles_of_a_tile_have_in_one_sense(tmp_path: Path) -> None:
    points = [(0, 0), (2, 0), (0, 2), (1, 2), (5, 5)]
    found = faults(Output(points, [(0, 1, 2), (0, 1, 3)], hull=0), tmp_path)
    assert any(f.startswith("tile 0: ") and "occurs twice" in f for f in found), found


@pytest.mark.parametrize("corners", [(0, 2, 1), (0, 0, 1)])
def test_a_triangle_that_does_not_turn_left(corners: Any, tmp_path: Path) -> None:
    points = [(0, 0), (2, 0), (0, 2), (5, 5)]
    found = faults(Output(points, [corners], hull=0), tmp_path)
    assert found[0] == "tile 0: triangle 0 is not counter-clockwise"


@pytest.mark.parametrize("lost", [4, 7])
def test_a_point_that_no_triangle_has(lost: int, tmp_path: Path) -> None:
    rest = np.delete(np.arange(8), lost)
    mesh = rest[Delaunay(np.array(SQUARE)[rest]).simplices]
    right = 2 * 8 - 2 - 4
    assert faults(Output(SQUARE, mesh), tmp_path) == (
        f"{right - 2} triangles instead of {right}: a point is missing",
    )


@pytest.mark.parametrize("table", ["vertices", "triangles"])
def test_files_that_are_others_or_lost(table: str, tmp_path: Path) -> None:
    tin = square().write(tmp_path / "tin")
    path = tmp_path / "tin" / table / "tile=000001.parquet"
    pq.write_table(pq.read_table(path), path, compression="gzip")
    name = f"{table}/tile=000001.parquet"
    assert tin.validate().faults == (f"{name} is not the file that was written",)
    path.unlink()
    found = tin.validate().faults
    assert found[0] == f"{name} is missing"
    assert found[1].startswith("tile 1 cannot be read: ")
    # Of what the other tile says alone, nothing follows.
    assert all("instead of" not in fault and "boundary" not in fault for fault in found)


def changed(tin: distributed.TiledDelaunay, change: Callable[[Any], None]) -> tuple[str, ...]:
    """The faults where the manifest says something else."""
    path = tin.path / "manifest.json"
    manifest = json.loads(path.read_text())
    change(manifest)
    path.write_text(json.dumps(manifest))
    return distributed.open(tin.path).validate().faults


@pytest.mark.parametrize("tile", [0, 1])
@pytest.mark.parametrize("name", ["points", "foreign", "triangles", "box", "extent"])
def test_what_the_manifest_says_of_a_tile(name: str, tile: int, tmp_path: Path) -> None:
    tin = square().write(tmp_path / "tin")
    right = tin.manifest["tiles"][tile][name]
    wrong = right + 1 if isinstance(right, int) else [right[0] - 1.0, *right[1:]]

    def change(manifest: Any) -> None:
        manifest["tiles"][tile][name] = wrong
        # Sums that must agree with those of the tiles, so that the file can be opened at all.
        if name in {"points", "triangles"}:
            manifest[name] += 1
        if name == "points":
            manifest["rows"] += 1
        if name == "box":
            manifest["bounds"][0] = min(t["box"][0] for t in manifest["tiles"])

    found = changed(tin, change)
    assert f"tile {tile}: {name} is {right} instead of {wrong} in the manifest" in found
    sums = {"points": 2, "triangles": 1}.get(name, 0)
    assert len(found) == 1 + sums


@pytest.mark.parametrize("name", ["points", "triangles", "duplicates", "hull", "bounds", "rows"])
def test_what_the_manifest_says_of_all_tiles(name: str, tmp_path: Path) -> None:
    tin = square().write(tmp_path / "tin")
    right = tin.manifest[name]
    wrong = right + 1 if isinstance(right, int) else [right[0] - 1.0, *right[1:]]
    found = changed(tin, lambda manifest: manifest.__setitem__(name, wrong))
    assert f"the manifest says {name} {wrong} instead of {right}" in found
    assert len(found) == 1
