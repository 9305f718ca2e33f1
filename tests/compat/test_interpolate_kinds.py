"""What SciPy's interpolators take besides plain floats: masks, truth values, objects, lines."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest

from delone import MissingExtraError, datasets
from delone.compat import interpolate as own
from delone.compat.scipy import Delaunay, griddata

peer = pytest.importorskip("scipy.interpolate")

POINTS = datasets.uniform(40, seed=8)
VALUES = POINTS[:, 0] - 2 * POINTS[:, 1]
QUERIES = 0.2 + 0.6 * datasets.uniform(50, seed=9)
NAMES = ("LinearNDInterpolator", "NearestNDInterpolator", "CloughTocher2DInterpolator")
KINDS: dict[str, Any] = {
    "truth values": VALUES > 0,
    "objects": VALUES.astype(object),
    "several truth values": np.column_stack((VALUES > 0, VALUES < -1)),
    "masked, nothing of it": np.ma.masked_array(VALUES, mask=False),
    "integers, nothing masked": np.ma.masked_array(np.arange(40)),
}


@pytest.mark.parametrize("kind", [*KINDS])
@pytest.mark.parametrize("name", NAMES)
def test_values_beside_scipy(name: str, kind: str) -> None:
    ours = getattr(own, name)(POINTS, KINDS[kind])(QUERIES)
    theirs = getattr(peer, name)(POINTS, KINDS[kind])(QUERIES)
    assert (ours.dtype, ours.shape) == (theirs.dtype, theirs.shape)
    np.testing.assert_allclose(ours, theirs, rtol=1e-4, atol=1e-4)
    assert type(ours) is np.ndarray


@pytest.mark.parametrize("name", NAMES)
def test_masked_values_are_unknown(name: str) -> None:
    mask = np.arange(40) == 7
    made = getattr(own, name)(POINTS, np.ma.masked_array(VALUES, mask=mask))
    assert np.isnan(made(POINTS[7])).all()
    far = POINTS[np.hypot(*(POINTS - POINTS[7]).T).argmax()]
    assert np.isfinite(made(far)).all()
    assert np.isnan(made.values).tolist() == mask.tolist()
    # Numbers under a mask count for nothing.
    hidden = np.ma.masked_array(np.where(mask, 1e9, VALUES), mask=mask)
    np.testing.assert_array_equal(getattr(own, name)(POINTS, hidden)(QUERIES), made(QUERIES))


@pytest.mark.parametrize("name", NAMES)
def test_masked_queries_have_no_value(name: str) -> None:
    made = getattr(own, name)(POINTS, VALUES)
    mask = np.zeros(QUERIES.shape, dtype=bool)
    mask[3, 1] = True
    plain = made(QUERIES)
    for found in (
        made(np.ma.masked_array(QUERIES, mask=mask)),
        made(np.ma.masked_array(QUERIES[:, 0]), np.ma.masked_array(QUERIES[:, 1], mask=mask[:, 1])),
    ):
        assert np.isnan(found[3])
        np.testing.assert_array_equal(np.delete(found, 3), np.delete(plain, 3))


@pytest.mark.parametrize("name", NAMES)
def test_masked_points(name: str) -> None:
    whole = getattr(own, name)(np.ma.masked_array(POINTS, mask=False), VALUES)
    np.testing.assert_array_equal(whole(QUERIES), getattr(own, name)(POINTS, VALUES)(QUERIES))
    mask = np.zeros(POINTS.shape, dtype=bool)
    mask[[5, 9], 0] = True
    with pytest.raises(ValueError, match="row 5 is masked"):
        getattr(own, name)(np.ma.masked_array(POINTS, mask=mask), VALUES)
    with pytest.raises(ValueError, match="row 5 is masked"):
        x, y = np.ma.masked_array(POINTS, mask=mask).T
        getattr(own, name)((x, y), VALUES)


@pytest.mark.parametrize("name", NAMES)
def test_what_is_no_number_is_refused(name: str) -> None:
    for bad in (["a"] * 40, np.array([2**53 + 1] * 40, dtype=object)):
        with pytest.raises((TypeError, ValueError)):
            getattr(own, name)(POINTS, bad)


def test_masked_queries_lie_in_no_triangle() -> None:
    tri = Delaunay(POINTS)
    queries = np.ma.masked_array(QUERIES[:2], mask=[[True, False], [False, False]])
    found = tri.find_simplex(queries)
    assert found[0] == -1
    assert found[1] == tri.find_simplex(QUERIES[1])
    assert np.isnan(tri.lift_points(queries)[0, 2])


LINE = np.array([0.0, 3, 1, 7, 4.5, 2])
HEIGHTS = np.column_stack((LINE**2, 1j * LINE))


@pytest.mark.parametrize("method", ["linear", "nearest", "cubic"])
@pytest.mark.parametrize("shape", ["n", "n, 1", "tuple", "list", "masked"])
@pytest.mark.parametrize("values", [HEIGHTS[:, 0].real, HEIGHTS, LINE > 2], ids=str)
def test_points_on_a_line(method: str, shape: str, values: Any) -> None:
    points = {
        "n": LINE,
        "n, 1": LINE[:, None],
        "tuple": (LINE,),
        "list": LINE.tolist(),
        "masked": np.ma.masked_array(LINE),
    }[shape]
    for xi in ([0.5, 9.0], np.array([[-1.0, 0.25], [3.0, 6.9]]), (np.array([0.5, 2]),)):
        for more in ({}, {"fill_value": -7.0}, {"rescale": True}):
            ours = griddata(points, values, xi, method=method, **more)
            theirs = peer.griddata(np.asarray(LINE), values, xi, method=method, **more)
            np.testing.assert_array_equal(ours, theirs)


def test_what_a_line_refuses(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ValueError, match="quintic"):
        griddata(LINE, LINE, [1.0], method="quintic")
    with pytest.raises(ValueError, match="quintic"):
        griddata(POINTS, VALUES, [(1.0, 1)], method="quintic")
    with pytest.raises(ValueError, match="griddata"):
        own.LinearNDInterpolator(LINE, LINE)
    monkeypatch.setitem(sys.modules, "scipy.interpolate", None)
    with pytest.raises(MissingExtraError, match=r"griddata of 1-D points needs .*delone\[graph"):
        griddata(LINE, LINE, [1.0])


@pytest.mark.parametrize("name", ["LinearNDInterpolator", "CloughTocher2DInterpolator"])
def test_interpolators_of_scipy_say_what_to_import(name: str) -> None:
    from scipy import interpolate

    from delone.compat import scipy as drop_in
    from delone.errors import DtypeError

    points = np.random.default_rng(0).random((20, 2))
    tri = drop_in.Delaunay(points)
    with pytest.raises(DtypeError, match=r"from delone\.compat\.scipy import LinearNDInterpolator"):
        getattr(interpolate, name)(tri, points[:, 0])
    height = getattr(drop_in, name)(tri, points[:, 0])
    assert np.isclose(height([[0.5, 0.5]]), 0.5).all()
