"""SciPy's test module uses marks of SciPy's own test configuration; they are made known here."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

import pytest


def pytest_configure(config: pytest.Config) -> None:
    try:
        spec = importlib.util.find_spec("scipy.spatial.tests.test_qhull")
    except ModuleNotFoundError:
        return
    if spec is None or spec.origin is None:
        return
    text = Path(spec.origin).read_text(encoding="utf-8")
    for mark in sorted(set(re.findall(r"pytest\.mark\.(\w+)", text))):
        config.addinivalue_line("markers", f"{mark}: of SciPy's tests")
