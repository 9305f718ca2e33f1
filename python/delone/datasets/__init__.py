"""Point sets for examples, tests and benchmarks: seeded generators, two real surveys, land.

Each generator is a function of the number of points and a seed. The 2-D generators are in `plane`
and listed by name in `GENERATORS`, the 3-D ones are in `space` and listed in `GENERATORS3`, and the
surveys are in `samples`.
"""

from delone.datasets.plane import (
    GENERATORS,
    circle,
    collinear_lines,
    duplicates,
    gaussian_clusters,
    grid,
    integer_lattice,
    kuzmin,
    mixed_exponents,
    near_collinear,
    pythagorean_circle,
    spiral,
    tilted_grid,
    uniform,
    utm_millimeters,
)
from delone.datasets.samples import Sample, ahn3, baja, land
from delone.datasets.space import GENERATORS as GENERATORS3

__all__ = [
    "GENERATORS",
    "GENERATORS3",
    "Sample",
    "ahn3",
    "baja",
    "circle",
    "collinear_lines",
    "duplicates",
    "gaussian_clusters",
    "grid",
    "integer_lattice",
    "kuzmin",
    "land",
    "mixed_exponents",
    "near_collinear",
    "pythagorean_circle",
    "spiral",
    "tilted_grid",
    "uniform",
    "utm_millimeters",
]
