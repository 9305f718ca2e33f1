"""SciPy's test modules use marks of SciPy's own test configuration; they are made known here."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

import pytest

MODULES = (
    "scipy.spatial.tests.test_qhull",
    "scipy.interpolate.tests.test_interpnd",
    "scipy.interpolate.tests.test_ndgriddata",
)


def pytest_configure(config: pytest.Config) -> None:
    for name in MODULES:
        try:
            spec = importlib.util.find_spec(name)
        except ModuleNotFoundError:
            continue
        if spec is None or spec.origin is None:
            continue
        text = Path(spec.origin).read_text(encoding="utf-8")
        for mark in sorted(set(re.findall(r"pytest\.mark\.(\w+)", text))):
            config.addinivalue_line("markers", f"{mark}: of SciPy's tests")
