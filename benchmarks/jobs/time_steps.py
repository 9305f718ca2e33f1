"""Many time steps on one geometry: values of scattered stations at the places of a grid.

    python benchmarks/jobs/time_steps.py --stations 50000 --cells 250000 --steps 100

``griddata`` is what most programs call in their loop: it triangulates anew at each step, and runs
for a tenth of the steps. The better way with SciPy triangulates once.
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from sidebyside import compare, stage

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    import numpy as np

    Step = Callable[[np.ndarray], np.ndarray]


def _input(given: argparse.Namespace) -> tuple[np.ndarray, np.ndarray]:
    import numpy as np

    side = round(given.cells**0.5)
    line = np.linspace(0.05, 0.95, side)
    return (
        np.random.default_rng(0).random((given.stations, 2)),
        np.stack(np.meshgrid(line, line), axis=-1),
    )


def delone(given: argparse.Namespace, folder: Path) -> str:
    stations, places = _input(given)
    with stage("import"):
        from delone import Delaunay
        from delone.interpolate import Linear
    with stage("weights"):
        weights = Linear(Delaunay(stations)).weights_at(places)
    return _steps(given.steps, stations, lambda values: weights @ values, folder)


def scipy(given: argparse.Namespace, folder: Path) -> str:
    stations, places = _input(given)
    with stage("import"):
        from scipy.interpolate import LinearNDInterpolator
        from scipy.spatial import Delaunay
    with stage("triangulate"):
        triangulation = Delaunay(stations)

    def step(values: np.ndarray) -> np.ndarray:
        return LinearNDInterpolator(triangulation, values)(places)

    return _steps(given.steps, stations, step, folder)


def griddata(given: argparse.Namespace, folder: Path) -> str:
    stations, places = _input(given)
    with stage("import"):
        from scipy.interpolate import griddata as call

    def step(values: np.ndarray) -> np.ndarray:
        return call(stations, values, places)

    return _steps(max(given.steps // 10, 1), stations, step, folder)


def _steps(steps: int, stations: np.ndarray, step: Step, folder: Path) -> str:
    import numpy as np

    total = 0.0
    with stage("steps"):
        for k in range(steps):
            values = np.sin(3 * stations[:, 0] + 0.1 * k) * np.cos(4 * stations[:, 1])
            found = step(values)
            total += float(np.nanmean(found))
    with stage("write"):
        np.save(folder / "last.npy", found)
    return f"{steps} steps, mean {total / steps:.6f}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--stations", type=int, default=50_000)
    parser.add_argument("--cells", type=int, default=250_000)
    parser.add_argument("--steps", type=int, default=100)
    ways = {"delone": delone, "SciPy once": scipy, "griddata": griddata}
    compare(__doc__, ways, parser)
