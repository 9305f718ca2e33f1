"""Poisson's equation on an island: scikit-fem on meshes of delone, with its order of convergence.

The outline of Gotland is meshed at four sizes. On each mesh linear elements solve
``-Laplace u = f`` with u given on the coast, for a solution that is known; its error in the mean
square must fall with the square of the size. Run it: ``python examples/poisson.py``; it needs
``pip install "delone[fem]"``.
"""

import json
from pathlib import Path

import numpy as np
import skfem
from skfem.models.poisson import laplace

import delone

COAST = Path(__file__).parent / "data" / "gotland.geojson"
# Waves of the solution, in radians per kilometer.
KX, KY = 0.05, 0.04
SIZES = (2.0, 1.0, 0.5, 0.25)


def outline() -> dict:
    """Return the island in kilometers from its middle, on a cylinder that touches there."""
    ring = np.array(json.loads(COAST.read_text())["geometry"]["coordinates"][0])
    middle = ring.mean(axis=0)
    east, north = ((ring - middle) * 111.2 * (np.cos(np.radians(middle[1])), 1)).T
    return {"type": "Polygon", "coordinates": [np.column_stack((east, north)).tolist()]}


def exact(x: np.ndarray) -> np.ndarray:
    """Return the solution."""
    return np.sin(KX * x[0]) * np.cosh(0.02 * x[0]) * np.cos(KY * x[1])


def load(x: np.ndarray) -> np.ndarray:
    """Return minus the Laplacian of the solution."""
    a, b, c = np.sin(KX * x[0]), np.cosh(0.02 * x[0]), np.cos(KY * x[1])
    da, db = KX * np.cos(KX * x[0]), 0.02 * np.sinh(0.02 * x[0])
    return (KX**2 + KY**2 - 0.02**2) * a * b * c - 2 * da * db * c


def solve(mesh: delone.Mesh) -> float:
    """Solve on one mesh and return the error in the mean square."""
    basis = skfem.Basis(mesh.to_skfem(), skfem.ElementTriP1())
    stiffness = laplace.assemble(basis)
    right = skfem.LinearForm(lambda v, w: load(w.x) * v).assemble(basis)
    coast = basis.get_dofs().flatten()
    values = np.zeros(basis.N)
    values[coast] = exact(mesh.points[coast].T)
    solution = skfem.solve(*skfem.condense(stiffness, right, x=values, D=coast))
    error = skfem.Functional(lambda w: (w.u - exact(w.x)) ** 2)
    return float(np.sqrt(error.assemble(basis, u=basis.interpolate(solution))))


def main() -> None:
    """Solve on meshes of falling size, and check how fast the error falls."""
    island = outline()
    errors = []
    for size in SIZES:
        mesh = delone.mesh(island, size=size)
        errors.append(solve(mesh))
        angle = mesh.report.smallest_angle
        print(f"size {size:4g} km: {mesh.nsimplex:6,} triangles, angles from {angle:.1f} degrees, "
              f"error {errors[-1]:.2e}")  # fmt: skip
    order = np.polyfit(np.log(SIZES), np.log(errors), 1)[0]
    print(f"order of convergence {order:.2f}")
    assert 1.8 < order < 2.3


if __name__ == "__main__":
    main()
