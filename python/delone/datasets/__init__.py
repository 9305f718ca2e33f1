"""Point sets to try, test and measure with: seeded generators, and two real surveys.

Each generator is a function of the number of points and a seed. `plane` has those of the plane,
which `GENERATORS` lists by name, `space` those of space, which `GENERATORS3` lists, and `samples`
the surveys.
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
    utm_millimetres,
)
from delone.datasets.samples import Sample, ahn3, baja
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
    "mixed_exponents",
    "near_collinear",
    "pythagorean_circle",
    "spiral",
    "tilted_grid",
    "uniform",
    "utm_millimetres",
]
