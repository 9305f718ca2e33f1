"""A thousand time steps between stations: weights computed once, a matrix product for each step.

Water levels at scattered gauges are interpolated to a raster for every hour of six weeks, by
natural neighbors. Run it: ``python examples/tides.py``.
"""

import numpy as np

from delone.datasets import uniform
from delone.interpolate import NaturalNeighbor

HOURS = 1000


def main() -> None:
    """Interpolate every hour and follow the highest water."""
    gauges = 100 * uniform(300, seed=8)
    x, y = np.meshgrid(np.arange(5.0, 95.0, 2.0), np.arange(5.0, 95.0, 2.0))
    places = np.stack((x, y), axis=-1)
    table = NaturalNeighbor(gauges).weights(places)

    highest, when = -np.inf, 0
    for hour in range(HOURS):
        phase = 2 * np.pi * hour / 12.42
        level = (
            np.cos(phase - gauges[:, 0] / 40) * (1 + 0.3 * np.cos(phase / 29)) - gauges[:, 1] / 500
        )
        surface = table @ level
        assert surface.shape == x.shape
        assert np.nanmin(surface) >= level.min() - 1e-12
        assert np.nanmax(surface) <= level.max() + 1e-12
        if np.nanmax(surface) > highest:
            highest, when = float(np.nanmax(surface)), hour
    print(f"{HOURS:,} hours on {x.size:,} nodes from {len(gauges)} gauges")
    print(f"highest water {highest:.3f} m, in hour {when}")


if __name__ == "__main__":
    main()
