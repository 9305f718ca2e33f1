"""The examples of these pages run as doctests, each page in an empty folder without a screen."""

from pathlib import Path

import matplotlib
import pytest

matplotlib.use("Agg")


@pytest.fixture(autouse=True)
def _empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let examples write files where nothing lies in their way."""
    monkeypatch.chdir(tmp_path)
