"""Alpha shapes, concave hulls, contours and bands: saved, loaded and pickled."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import delone
from delone import FileFormatError, datasets
from delone.terrain import TIN, Bands, Contours

FLAT, SOLID = datasets.uniform(200), datasets.uniform(60, ndim=3)
HILLS = TIN.from_points(
    np.column_stack((FLAT, np.sin(9 * FLAT[:, 0]))), crs="EPSG:28992", units="m"
)
SHAPES = {
    "shape": lambda: delone.AlphaComplex(FLAT).shape(0.003),
    "all": lambda: delone.AlphaComplex(FLAT).shape(np.inf),
    "weights": lambda: delone.AlphaComplex(FLAT, FLAT[:, 0] / 99).shape(-0.001),
    "periodic": lambda: delone.AlphaComplex(FLAT, periodic=(1.5, None)).shape(0.003),
    "solid": lambda: delone.AlphaComplex(SOLID).shape(0.02),
    "hull": lambda: delone.concave_hull(FLAT, ratio=0.2, holes=True),
    "solid hull": lambda: delone.concave_hull(SOLID, max_edge=0.4),
    "line": lambda: delone.concave_hull([(0, 0), (1, 1), (2, 2)], ratio=1),
}
TABLES = {
    "contours": lambda: HILLS.contours(
        interval=0.25, index=2, min_length=0.2, min_area=0.01, simplify=0.02
    ),
    "no line": lambda: HILLS.contours([99.0]),
    "bands": lambda: HILLS.bands(interval=0.25, min_area=0.01, simplify=0.02),
    "plain": lambda: TIN.from_points(np.column_stack((FLAT, FLAT[:, 0]))).bands([0.5]),
}


@pytest.mark.parametrize("name", SHAPES)
def test_shapes_come_back(name: str, tmp_path: Path) -> None:
    made: Any = SHAPES[name]()
    made.save(tmp_path / "a.npz")
    for again in (type(made).load(tmp_path / "a.npz"), pickle.loads(pickle.dumps(made))):
        assert repr(again) == repr(made) and type(again) is type(made)
        for array in ("points", "simplices", "is_kept", "boundary"):
            found = getattr(again, array)
            assert np.array_equal(found, getattr(made, array)) and not found.flags.writeable
        assert getattr(again, "alpha", None) == getattr(made, "alpha", None)
        assert getattr(again, "betti", None) == getattr(made, "betti", None)
        assert again.crs is None
    assert copy.deepcopy(made) is made
    other = delone.ConcaveHull if isinstance(made, delone.AlphaShape) else delone.AlphaShape
    with pytest.raises(FileFormatError, match="its format is"):
        other.load(tmp_path / "a.npz")


def test_options_come_back(tmp_path: Path) -> None:
    made = delone.AlphaComplex(FLAT, workers=2).shape(0.003)
    assert pickle.loads(pickle.dumps(made))._workers == 2
    hull = delone.concave_hull(FLAT, ratio=0.3, workers=2)
    assert pickle.loads(pickle.dumps(hull))._workers == 2


@pytest.mark.parametrize("name", TABLES)
def test_tables_come_back(name: str, tmp_path: Path) -> None:
    made: Any = TABLES[name]()
    made.save(tmp_path / "a.npz")
    again = type(made).load(tmp_path / "a.npz")
    assert vars(again).keys() == vars(made).keys()
    for field, value in vars(made).items():
        found = getattr(again, field)
        assert np.array_equal(found, value) and type(found) is type(value)
        assert getattr(found, "dtype", None) == getattr(value, "dtype", None)
        assert not isinstance(found, np.ndarray) or not found.flags.writeable
    assert name in ("no line", "plain") or made.small + getattr(made, "short", 1) > 0
    other = Bands if isinstance(made, Contours) else Contours
    with pytest.raises(FileFormatError, match="its format is"):
        other.load(tmp_path / "a.npz")
