"""Saving and loading diagrams: each kind of clip, and files that contradict themselves."""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import FileFormatError, Voronoi

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

shapely = pytest.importorskip("shapely")

FLAT = np.random.default_rng(1).random((40, 2))
SOLID = np.random.default_rng(2).random((40, 3))
LIGHT = np.random.default_rng(3).random(40) / 50
INF = float("inf")
RING = shapely.Point(0.5, 0.5).buffer(0.4) - shapely.box(0.4, 0.4, 0.6, 0.6)
BOW = shapely.Polygon([(0, 0), (1, 1), (1, 0), (0, 1)])
# Three planes through a corner, one across, with normals that are not exact.
PLANES = [(-1, -0.1, 0, 0), (0.3, -1, 0, 0.1), (0, 0.1, -1, 0), (1, 1, 1.1, -1.7)]

MADE: dict[str, Callable[[], Voronoi]] = {
    "whole": lambda: Voronoi(FLAT),
    "one site": lambda: Voronoi([(1, 2)]),
    "one line": lambda: Voronoi([(0, 0), (0.5, 0.5), (2, 2), (0.5, 0.5)]),
    "box of the sites": lambda: Voronoi(FLAT, clip="box"),
    "box": lambda: Voronoi(FLAT, clip=(0, -1, 1.1, 0.75)),
    "polygon": lambda: Voronoi(FLAT, clip=RING),
    "multipolygon": lambda: Voronoi(FLAT, clip=BOW, fix=True),
    "large polygon": lambda: Voronoi(FLAT * 1e200, clip=shapely.transform(RING, _huge)),
    "weights": lambda: Voronoi(FLAT, weights=LIGHT, clip=RING),
    "two periods": lambda: Voronoi(FLAT, periods=(1, 1.5)),
    "one period": lambda: Voronoi(FLAT, periods=(None, 1), clip=(-1, -INF, 1, INF)),
    "weights and a period": lambda: Voronoi(FLAT, weights=LIGHT, periods=(1.25, None), clip="box"),
    "whole in 3-D": lambda: Voronoi(SOLID),
    "box of the sites in 3-D": lambda: Voronoi(SOLID, clip="box"),
    "box in 3-D": lambda: Voronoi(SOLID, clip=((0, 0, 0), (1, 2, 0.3))),
    "half-spaces": lambda: Voronoi(SOLID, clip=PLANES),
    "hull": lambda: Voronoi(SOLID, clip=delone.ConvexHull(SOLID[::2])),
    "weights in 3-D": lambda: Voronoi(SOLID, weights=LIGHT, clip=SOLID),
}
NAMES = (
    "points",
    "weights",
    "vertices",
    "ridge_points",
    "point_region",
    "simplex_vertices",
    "ridge_vertices",
    "regions",
    "periods",
    "cell_areas",
    "cell_centroids",
    "hidden",
)


def _huge(places: Any) -> Any:
    return places * 1e200


def same(one: Voronoi, other: Voronoi) -> None:
    assert repr(one) == repr(other)
    for name in NAMES:
        a, b = getattr(one, name), getattr(other, name)
        assert np.array_equal(a, b, equal_nan=True) if isinstance(a, np.ndarray) else a == b
    for a, b in zip(one.neighbors, other.neighbors, strict=True):
        assert np.array_equal(a, b)


@pytest.mark.parametrize("name", MADE)
def test_what_is_saved_is_loaded(name: str, tmp_path: Path) -> None:
    diagram = MADE[name]()
    diagram.save(tmp_path / "a")
    found = Voronoi.load(tmp_path / "a")
    same(found, diagram)
    if isinstance(diagram.clip, delone.voronoi.Polyhedron):
        for key, value in vars(diagram.clip).items():
            assert np.array_equal(vars(found.clip)[key], value)
    elif hasattr(diagram.clip, "geom_type"):
        assert shapely.equals_identical(found.clip, diagram.clip)
    else:
        assert found.clip == diagram.clip
    found.save(tmp_path / "b")
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


@pytest.mark.parametrize("name", MADE)
def test_a_pickle_holds_the_arrays(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    diagram = MADE[name]()
    dumped = pickle.dumps(diagram)
    for function in ("voronoi2", "voronoi3", "delaunay2", "delaunay3"):
        monkeypatch.delattr(f"delone._core.{function}", raising=False)
    found = pickle.loads(dumped)
    same(found, diagram)
    assert not found.points.flags.writeable and not found.vertices.flags.writeable


def test_the_clip_of_a_diagram_is_one_for_another() -> None:
    for name in ("box", "polygon", "box in 3-D", "half-spaces", "hull"):
        diagram = MADE[name]()
        same(Voronoi(diagram.points, clip=diagram.clip), diagram)


def spoilt(diagram: Voronoi, path: Path, **changes: Any) -> Path:
    diagram.save(path)
    with np.load(path) as file:
        arrays = dict(file)
    np.savez(path.open("wb"), **(arrays | changes))
    return path


WRONG_FLAT: list[tuple[str, dict[str, Any], str]] = [
    ("polygon", {"outline": np.frombuffer(b"\x01\x03", np.uint8)}, "not well-known binary"),
    ("polygon", {"outline": np.frombuffer(RING.wkb[:-3], np.uint8)}, "not well-known binary"),
    ("polygon", {"outline": np.zeros(9, np.uint8)}, "not well-known binary"),
    ("polygon", {"outline": np.frombuffer(BOW.wkb, np.uint8)}, "invalid"),
    ("polygon", {"outline": np.frombuffer(shapely.Point(1, 2).wkb, np.uint8)}, "got a Point"),
    ("polygon", {"box": np.arange(4.0)}, "two clips"),
    ("polygon", {"weights": np.zeros(3)}, "weights and points"),
    ("polygon", {"weights": np.full(40, np.nan)}, "weights are NaN"),
    ("box", {"box": np.arange(3.0)}, "box is incomplete"),
    ("box", {"box": np.array([0, 0, 0, 1.0])}, "no area"),
    ("box", {"box": np.array([0, 0, np.nan, 1.0])}, "finite"),
    ("box", {"points": np.empty((0, 2))}, "no points"),
    ("box", {"points": np.array([(0, np.inf)])}, "not finite"),
    ("box", {"periods": np.array([1.0])}, "two periods"),
    ("box", {"periods": np.array([1.0, 2.0])}, "two periods"),
    ("two periods", {"periods": np.array([np.nan, np.nan])}, "periods has no number"),
    ("two periods", {"periods": np.array([1.0, -1.0])}, "positive"),
    ("two periods", {"periods": np.array([0.1, np.nan])}, "not less than the period"),
]


@pytest.mark.parametrize(("name", "changes", "message"), WRONG_FLAT)
def test_a_wrong_file(name: str, changes: dict[str, Any], message: str, tmp_path: Path) -> None:
    path = spoilt(MADE[name](), tmp_path / "a.npz", **changes)
    with pytest.raises(FileFormatError, match=message) as caught:
        Voronoi.load(path)
    assert str(path) in str(caught.value)


def _hull() -> dict[str, Any]:
    return MADE["hull"]()._saved()


WRONG_SOLID: list[tuple[Callable[[Any], dict[str, Any]], str]] = [
    (lambda a: {"box": np.arange(6.0)}, "two clips"),
    (lambda a: {"box": np.arange(4.0), "corners": np.empty((0, 3))}, "box is incomplete"),
    (lambda a: {"planes": np.empty((0, 4))}, "has no planes"),
    (lambda a: {"planes": a["planes"][:-1]}, "faces and planes"),
    (lambda a: {"planes": a["planes"] * np.nan}, "not finite"),
    (lambda a: {"planes": a["planes"] * [1, 1, 1, 1.001]}, "does not contain its face"),
    (lambda a: {"planes": np.roll(a["planes"], 1, axis=0)}, "does not contain its face"),
    (lambda a: {"corners": a["corners"] * 1e400}, "not finite"),
    (lambda a: {"starts": a["starts"] + 1}, "faces are out of range"),
    (lambda a: {"starts": np.where(np.arange(len(a["starts"])) == 1, 1, a["starts"])}, "fewer"),
    (lambda a: {"starts": np.where(np.arange(len(a["starts"])) == 1, -9, a["starts"])}, "fewer"),
    (lambda a: {"faces": a["faces"] + 1}, "outside 0 to"),
    (lambda a: {"faces": -a["faces"]}, "outside 0 to"),
    (lambda a: {"faces": a["faces"][::-1]}, "plane does not|closed"),
    (lambda a: {"faces": np.roll(a["faces"], 1)}, "closed surface"),
    (lambda a: {"points": a["points"] * [1, 1, 0]}, "lie in one plane|plane"),
    (lambda a: {"points": a["points"][:3]}, "distinct|span"),
    (lambda a: {"periods": np.ones(2)}, "only available in 2-D"),
]


@pytest.mark.parametrize("case", range(len(WRONG_SOLID)))
def test_a_wrong_file_in_3d(case: int, tmp_path: Path) -> None:
    change, message = WRONG_SOLID[case]
    with np.errstate(all="ignore"):
        changes = {
            name: np.asarray(array).astype(_hull()[name].dtype)
            for name, array in change(_hull()).items()
        }
    with pytest.raises(FileFormatError, match=message):
        Voronoi.load(spoilt(MADE["hull"](), tmp_path / "a.npz", **changes))


@pytest.mark.parametrize("name", ["polygon", "half-spaces", "weights and a period"])
def test_a_truncated_or_damaged_file(name: str, tmp_path: Path) -> None:
    diagram, path = MADE[name](), tmp_path / "a.npz"
    diagram.save(path)
    whole = path.read_bytes()
    rng = np.random.default_rng(4)
    for cut in rng.integers(0, len(whole), 20).tolist():
        path.write_bytes(whole[:cut])
        with pytest.raises(FileFormatError):
            Voronoi.load(path)
    # A file without a checksum, as others may write it: every content is refused or is one.
    for _ in range(40):
        saved = diagram._saved()
        key = rng.choice([key for key, array in saved.items() if array.size])
        array = saved[key].copy()
        raw = array.reshape(-1).view(np.uint8)
        raw[rng.integers(len(raw))] ^= 1 << rng.integers(8)
        try:
            found = Voronoi.load(spoilt(diagram, path, **{key: array}))
        except FileFormatError:
            continue
        assert len(found.cell_areas) == 40


def test_other_classes_and_dimensions_are_told_apart(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    delone.Delaunay(FLAT).save(path)
    with pytest.raises(FileFormatError, match="its format is"):
        Voronoi.load(path)
    Voronoi(SOLID).save(path)
    with pytest.raises(FileFormatError, match="its format is"):
        delone.Delaunay.load(path)
    assert Voronoi.load(path).ndim == 3


def test_shapely_is_needed_for_geometries_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    MADE["box"]().save(tmp_path / "box")
    MADE["polygon"]().save(tmp_path / "polygon")
    monkeypatch.setitem(__import__("sys").modules, "shapely", None)
    assert Voronoi.load(tmp_path / "box").cell_areas.sum() == pytest.approx(1.1 * 1.75)
    with pytest.raises(delone.MissingExtraError):
        Voronoi.load(tmp_path / "polygon")
