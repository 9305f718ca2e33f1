"""Whole JSON that says something else: whatever field of a manifest or note is changed by hand."""

from __future__ import annotations

import contextlib
import copy
import json
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import datasets, distributed
from delone.distributed.store import files
from delone.errors import FileFormatError, InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

POINTS = np.column_stack([datasets.integer_lattice(120, side=14), np.arange(120.0)])
SIZE = 40

# What no field holds, and what some hold.
VALUES: list[Any] = [
    None, True, -5, 0, 1, 7, 2**70, 0.5, 1e300, float("nan"), float("inf"), "", "x", [], [0], {},
    [float("nan")] * 4, [3.0, 3.0, 2.0, 2.0], [0.0, 0.0, 1.0, 1.0],
]  # fmt: skip
# Nothing else tells these; all that can be said is that they are of the right kind.
FREE = ("delone", "crs", "rounds", "given", "memory", "run")


@pytest.fixture(scope="module")
def tin(tmp_path_factory: pytest.TempPathFactory) -> distributed.TiledDelaunay:
    folder = tmp_path_factory.mktemp("lattice") / "tin"
    return distributed.triangulate(POINTS, folder, tile_points=SIZE)


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Where something is in JSON, the whole first."""
    yield path
    if isinstance(value, dict | list):
        for key in value if isinstance(value, dict) else range(len(value)):
            yield from places(value[key], (*path, key))


def put(whole: Any, path: tuple[Any, ...], value: Any) -> Any:
    if not path:
        return value
    changed = copy.deepcopy(whole)
    inner = changed
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    return changed


def without(whole: Any, path: tuple[Any, ...]) -> Any:
    changed = copy.deepcopy(whole)
    inner = changed
    for key in path[:-1]:
        inner = inner[key]
    del inner[path[-1]]
    return changed


def use(tin: distributed.TiledDelaunay) -> None:
    """Do what relies on the manifest."""
    tin.read_simplices()
    asked = POINTS[:5, :2]
    tin.find_simplex(asked)
    tin.interpolate(asked)
    assert isinstance(repr(tin), str)
    assert len(tin.bounds) == 4


def test_every_field_of_the_manifest(tin: distributed.TiledDelaunay, tmp_path: Path) -> None:
    shutil.copytree(tin.path, tmp_path / "tin")
    path = tmp_path / "tin" / "manifest.json"
    whole = json.loads(path.read_text(encoding="utf-8"))
    refused = found = 0
    # What is true of one tile and one node is true of the next.
    first = [p for p in places(whole) if p[:2] not in (("tiles", 1), ("tiles", 2))]
    for place in first:
        for value in VALUES:
            changed = put(whole, place, value)
            if changed == whole:
                continue
            path.write_text(json.dumps(changed), encoding="utf-8")
            try:
                spoilt = distributed.open(tmp_path / "tin")
            except FileFormatError as error:
                assert "manifest.json" in str(error)
                refused += 1
                continue
            with contextlib.suppress(FileFormatError, InputError):
                use(spoilt)
            if place[0] not in FREE:
                assert not spoilt.validate(), (place, value)
                found += 1
    assert refused > 500
    assert found > 50


def test_every_field_is_missed(tin: distributed.TiledDelaunay, tmp_path: Path) -> None:
    shutil.copytree(tin.path, tmp_path / "tin")
    path = tmp_path / "tin" / "manifest.json"
    whole = json.loads(path.read_text(encoding="utf-8"))
    for place in places(whole):
        if place and place[:2] != ("run", "source"):
            path.write_text(json.dumps(without(whole, place)), encoding="utf-8")
            with pytest.raises(FileFormatError, match=r"manifest\.json") as caught:
                distributed.open(tmp_path / "tin")
            if isinstance(place[-1], str) and place != ("format",) and "files" not in place[:-1]:
                assert f"{place[-1]} is missing" in str(caught.value)


@pytest.mark.parametrize("text", ["[" * 100_000, "null", "[]", "3", '"manifest"', "{}"])
def test_manifests_of_another_kind(
    tin: distributed.TiledDelaunay, text: str, tmp_path: Path
) -> None:
    shutil.copytree(tin.path, tmp_path / "tin")
    (tmp_path / "tin" / "manifest.json").write_text(text, encoding="utf-8")
    with pytest.raises(FileFormatError, match=r"manifest\.json"):
        distributed.open(tmp_path / "tin")
    with pytest.raises(FileFormatError, match=r"manifest\.json"):
        distributed.triangulate(POINTS, tmp_path / "tin", tile_points=SIZE)


class Crash(BaseException):
    """What no handler expects."""


@pytest.fixture
def stopped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A run that was stopped before its manifest."""

    def stop(what: str) -> None:
        if what.startswith("before manifest"):
            raise Crash

    monkeypatch.setattr(files, "step", stop)
    with pytest.raises(Crash):
        distributed.triangulate(POINTS, tmp_path / "tin", tile_points=SIZE)
    monkeypatch.setattr(files, "step", lambda what: None)
    return tmp_path / "tin"


def test_every_field_of_every_note(stopped: Path, tmp_path: Path) -> None:
    notes = [stopped / "work" / "run.json", *sorted(stopped.glob("work/done/*/000001.json"))]
    notes += sorted(stopped.glob("work/done/look/000000.json"))
    notes += sorted(stopped.glob("work/done/deal/000000.json"))
    assert {note.parent.name[:4] for note in notes} >= {"look", "deal", "begi", "answ", "proc"}
    for note in notes:
        text = note.read_text(encoding="utf-8")
        whole = json.loads(text)
        for number, place in enumerate(places(whole)):
            value = (None, -5, "x", float("nan"), 2**70, [], {})[number % 7]
            note.write_text(json.dumps(put(whole, place, value)), encoding="utf-8")
            again = tmp_path / "again"
            shutil.copytree(stopped, again)
            try:
                tin = distributed.triangulate(POINTS, again, tile_points=SIZE)
                assert tin.npoints == len(POINTS) or not tin.validate()
            except (FileFormatError, InputError) as error:
                assert note.name in str(error) or "contains a different run" in str(error)
            shutil.rmtree(again)
        note.write_text(text, encoding="utf-8")


def test_torn_arrays_of_a_run(stopped: Path) -> None:
    for name in ("layout.npz", "certain/000001.npy", "parts/000000.npy"):
        path = stopped / "work" / name
        whole = path.read_bytes()
        (stopped / "work" / "done" / "finish" / "000001.json").unlink(missing_ok=True)
        for torn in (b"", whole[: len(whole) // 2], b"x" * len(whole)):
            path.write_bytes(torn)
            with pytest.raises(FileFormatError, match=path.name):
                distributed.triangulate(POINTS, stopped, tile_points=SIZE)
        path.write_bytes(whole)
