"""The examples of these pages run as doctests, each page in an empty folder without a screen."""

import sys
from pathlib import Path

import matplotlib
import pytest
from matplotlib.artist import Artist

matplotlib.use("Agg")


def _drawn(value: object) -> bool:
    """Whether a value is an artist of matplotlib, or has one: what a call drew or set."""
    if isinstance(value, list | tuple):
        return any(_drawn(each) for each in value)
    return isinstance(value, Artist)


@pytest.fixture(autouse=True)
def _empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let examples write files where nothing lies in their way."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture(autouse=True)
def _silent_artists(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let examples call ``ax.set(...)`` without a name for its result: pages show no artists."""
    show = sys.__displayhook__
    monkeypatch.setattr(sys, "__displayhook__", lambda value: _drawn(value) or show(value))
