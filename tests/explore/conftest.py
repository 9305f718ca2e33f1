"""A mesh, its exploration, a served page and a browser for it."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

import numpy as np
import pytest

from browser import Browser, chromium
from delone import Delaunay
from delone.explorer.server import ExploreServer
from delone.explorer.state import Exploration

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.fixture
def mesh() -> Delaunay:
    """Sixty points and their triangles."""
    return Delaunay(np.random.default_rng(3).random((60, 2)))


@pytest.fixture
def server(mesh: Delaunay) -> Iterator[ExploreServer]:
    """A running server of that mesh, with the x coordinates as values."""
    state = Exploration(mesh, values=mesh.points[:, 0])
    with ExploreServer(state, name="sixty <b>points</b>.csv") as made:
        thread = threading.Thread(target=made.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        try:
            yield made
        finally:
            made.shutdown()
            thread.join()


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """One browser for all pages."""
    if chromium() is None:
        pytest.skip("no Chromium is installed")
    with Browser() as found:
        yield found
