"""The package ``triangle`` on its own example data, beside the drop-in, where it is installed."""

from __future__ import annotations

import contextlib
import pickle
import select
import subprocess
import sys
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from delone._tiling.plane.quality import below
from delone.compat import triangle as drop_in

package = pytest.importorskip("triangle")


PATIENCE = 60.0


class Worker:
    """The package in a process of its own: some inputs end it, on some it does not come back."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None

    def triangulate(self, tri: dict[str, Any], opts: str) -> dict[str, Any]:
        """Return what the package gives; nothing where it ends or does not come back."""
        if self._process is None:
            script = Path(__file__).with_name("triangle_worker.py")
            self._process = subprocess.Popen(
                [sys.executable, str(script)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
            )
        source, sink = self._process.stdout, self._process.stdin
        assert source is not None
        assert sink is not None
        pickle.dump((tri, opts), sink)
        sink.flush()
        if select.select([source], [], [], PATIENCE)[0]:
            with contextlib.suppress(EOFError):
                found: dict[str, Any] = pickle.load(source)
                return found
        self.stop()
        return {}

    def stop(self) -> None:
        """End the process."""
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
            self._process = None


@pytest.fixture(scope="module")
def theirs() -> Iterator[Worker]:
    worker = Worker()
    yield worker
    worker.stop()


# Those that Triangle itself can mesh; the outline of "box" is open.
NAMES = ("A", "double_hex", "double_hex2", "double_hex3", "dots", "ell", "face",
         "la", "square_circle_hole", "diamond_02_00009")  # fmt: skip

PLANAR = tuple(n for n in NAMES if n not in ("dots", "ell", "diamond_02_00009"))


def data(name: str) -> dict[str, Any]:
    return {key: np.asarray(value) for key, value in package.get_data(name).items()}


def area(out: dict[str, Any]) -> float:
    a, b, c = (np.asarray(out["vertices"])[np.asarray(out["triangles"])[:, k]] for k in range(3))
    u, v = b - a, c - a
    return float((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2)


def boundary_vertices(out: dict[str, Any]) -> set[int]:
    marked = np.flatnonzero(np.asarray(out["vertex_markers"]).ravel() != 0)
    return set(marked.tolist())


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("opts", ["", "p", "pc", "pq", "pq30a0.5", "pqD"])
def test_keys_shapes_and_area(name: str, opts: str, theirs: Worker) -> None:
    given = data(name)
    if "segments" not in given:
        opts = opts.replace("p", "")
    a, b = theirs.triangulate(given, opts), drop_in.triangulate(given, opts)
    if not a:
        # It has not come back; ours has.
        assert len(b["triangles"])
        return
    assert set(a) == set(b)
    for key in a:
        x, y = np.asarray(a[key]), b[key]
        assert x.ndim == y.ndim, key
        assert x.shape[1:] == y.shape[1:], key
        assert x.dtype.kind == y.dtype.kind, key
    assert area(b) == pytest.approx(area(a), rel=1e-9)
    if "j" not in opts:
        n = len(given["vertices"])
        assert np.array_equal(b["vertices"][:n], given["vertices"])
        if "vertex_attributes" in given:
            assert np.array_equal(
                b["vertex_attributes"][:n].ravel(), given["vertex_attributes"].ravel()
            )


@pytest.mark.parametrize("name", PLANAR)
def test_the_same_triangulation_without_quality(name: str, theirs: Worker) -> None:
    """The constrained Delaunay triangulation is one, but for ties."""
    given = data(name)
    a, b = theirs.triangulate(given, "pe"), drop_in.triangulate(given, "pe")
    assert a
    assert len(a["triangles"]) == len(b["triangles"])
    assert len(a["edges"]) == len(b["edges"])
    assert boundary_vertices(a) == boundary_vertices(b)
    ours, other = (
        {tuple(sorted(s)): m for s, m in zip(np.asarray(o["segments"]).tolist(),
                                            np.asarray(o["segment_markers"]).ravel().tolist(),
                                            strict=True)}
        for o in (b, a)
    )  # fmt: skip
    assert ours == other


@pytest.mark.parametrize("name", PLANAR)
def test_angles_are_not_worse_and_triangles_not_many_more(name: str, theirs: Worker) -> None:
    given = data(name)
    a, b = theirs.triangulate(given, "pq30"), drop_in.triangulate(given, "pq30")
    assert a
    bad_a, bad_b = (
        len(
            below(
                np.asarray(o["vertices"], dtype=float),
                np.asarray(o["triangles"], dtype=np.int32),
                30,
            )
        )
        for o in (a, b)
    )
    assert bad_b <= 1.2 * bad_a + 4
    assert len(b["triangles"]) <= 1.15 * len(a["triangles"]) + 10


def test_areas_and_attributes_of_regions(theirs: Worker) -> None:
    points = [(0, 0), (2, 0), (2, 1), (0, 1), (1, 0), (1, 1)]
    segments = [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)]
    regions = [[0.5, 0.5, 7, 0.02], [1.5, 0.5, 3, 0.1]]
    given = {"vertices": points, "segments": segments, "regions": regions}
    for library in (theirs, drop_in):
        out = library.triangulate(given, "pqaA")
        attributes = np.asarray(out["triangle_attributes"]).ravel()
        a, b, c = (
            np.asarray(out["vertices"])[np.asarray(out["triangles"])[:, k]] for k in range(3)
        )
        u, v = b - a, c - a
        sizes = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
        for label, cap in ((7, 0.02), (3, 0.1)):
            assert sizes[attributes == label].sum() == pytest.approx(1)
            assert sizes[attributes == label].max() <= cap


def test_refining_a_mesh_again(theirs: Worker) -> None:
    given = data("A")
    for library in (theirs, drop_in):
        first = library.triangulate(given, "pq20")
        first["triangle_max_area"] = np.full(len(first["triangles"]), 0.005)
        second = library.triangulate(
            {k: first[k] for k in ("vertices", "triangles", "segments", "triangle_max_area")},
            "rpqa",
        )
        assert area(second) == pytest.approx(area(first))
        assert len(second["triangles"]) > len(first["triangles"])


def test_limits_on_added_vertices(theirs: Worker) -> None:
    given = data("A")
    for library in (theirs, drop_in):
        assert len(library.triangulate(given, "pqS5")["vertices"]) <= 29 + 5
        # Stopped, and not refused, where the sizes ask for more.
        few = library.triangulate(given, "pqa0.0001S7")
        assert len(few["vertices"]) <= 29 + 7
        fixed = library.triangulate(given, "pqYYa0.005")
        assert len(fixed["segments"]) == 29
        boundary = library.triangulate(given, "pqYa0.005")
        assert len(boundary["segments"]) == 29


def test_exactly_the_promised_angle() -> None:
    from delone.testing.exact import Mesh
    from delone.testing.meshes import _assert_angles

    out = drop_in.triangulate(data("face"), "pq30")
    bad = below(out["vertices"], out["triangles"], 30)
    exact = Mesh.of(out["vertices"], out["triangles"].astype(np.int64))
    _assert_angles(exact, Fraction(3, 4), bad)
