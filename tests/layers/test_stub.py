"""The stub of the compiled module says what is in it."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

from delone import _core

ROOT = Path(__file__).parents[2]


@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy is not installed")
def test_the_stub_fits_the_module() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "delone._core"],
        cwd=ROOT / "python",
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_version_is_that_of_the_workspace() -> None:
    import tomllib

    cargo = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))
    assert _core.__version__ == cargo["workspace"]["package"]["version"]
