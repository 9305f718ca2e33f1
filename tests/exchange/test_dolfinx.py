"""DOLFINx takes the arrays: sizes by tag, and a solution of second order that is exact.

DOLFINx comes from Debian or conda-forge. Where it is missing, tests of the arrays remain, in
`test_exchange` and `test_second_order`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import delone
import solids

dolfinx = pytest.importorskip("dolfinx")

SHELLS = solids.joined(solids.box((0, 0, 0), (4, 4, 4)), solids.box((1, 1, 1), (2, 2, 2)))
SOLID = delone.tetrahedralize(
    *SHELLS,
    face_markers=np.arange(24) // 2 + 1,
    regions=[(0.5, 0.5, 0.5, 7), (1.5, 1.25, 1.5, 3)],
    extra_points=np.random.default_rng(5).uniform(2.2, 3.8, (40, 3)),
)
FLAT = delone.mesh([(0, 0), (2, 0), (2, 2), (0, 2)], max_area=0.1, segment_markers=[4, 5, 6, 7])
SIZES: dict[str, tuple[Any, dict[int, float], dict[int, float]]] = {
    "tetrahedron": (
        SOLID,
        {3: 1.0, 7: 63.0},
        {marker: 16.0 if marker <= 6 else 1.0 for marker in range(1, 13)},
    ),
    "triangle": (FLAT, {0: 4.0}, dict.fromkeys((4, 5, 6, 7), 2.0)),
}


def domain(cell: str, order: int, ndim: int) -> Any:
    import ufl

    if hasattr(ufl, "VectorElement"):
        return ufl.Mesh(ufl.VectorElement("Lagrange", ufl.Cell(cell), order))
    from basix.ufl import element

    return ufl.Mesh(element("Lagrange", cell, order, shape=(ndim,)))


def tags(mesh: Any, ndim: int, entities: Any, values: Any) -> Any:
    """The tags of cells or facets, as DOLFINx makes them of the files of Gmsh."""
    given = getattr(mesh, "_mesh", mesh)
    nodes, own = dolfinx.io.distribute_entity_data(given, ndim, entities, values)
    mesh.topology.create_connectivity(ndim, 0)
    mesh.topology.create_connectivity(ndim, mesh.topology.dim)
    try:
        from dolfinx.graph import adjacencylist as as_list
    except ImportError:
        as_list = dolfinx.cpp.graph.AdjacencyList_int32
    return dolfinx.mesh.meshtags_from_entities(mesh, ndim, as_list(nodes), own)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("cell", SIZES)
def test_sizes_by_tag_and_a_solution(cell: str, order: int) -> None:
    import ufl
    from dolfinx import fem
    from dolfinx.fem.petsc import LinearProblem
    from mpi4py import MPI

    made, regions, markers = SIZES[cell]
    ndim = made.ndim
    arrays = made.to_dolfinx_arrays(order=order)
    mesh = dolfinx.mesh.create_mesh(
        MPI.COMM_WORLD, arrays["cells"], arrays["x"], domain(cell, order, ndim)
    )
    cells = tags(mesh, ndim, arrays["cells"], arrays["cell_tags"])
    facets = tags(mesh, ndim - 1, arrays["facets"], arrays["facet_tags"])
    dx = ufl.Measure("dx", domain=mesh, subdomain_data=cells)
    outer = ufl.Measure("ds", domain=mesh, subdomain_data=facets)
    inner = ufl.Measure("dS", domain=mesh, subdomain_data=facets)
    one = fem.Constant(mesh, 1.0)

    def size(*measures: Any) -> float:
        return float(sum(fem.assemble_scalar(fem.form(one * each)) for each in measures))

    assert {tag: size(dx(tag)) for tag in regions} == pytest.approx(regions)
    assert {tag: size(outer(tag), inner(tag)) for tag in markers} == pytest.approx(markers)
    make = getattr(fem, "functionspace", None) or fem.FunctionSpace
    space = make(mesh, ("Lagrange", 2))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    exact = fem.Function(space)
    exact.interpolate(lambda x: (x[:ndim] ** 2).sum(axis=0) + x[0] * x[1])
    boundary = dolfinx.mesh.exterior_facet_indices(mesh.topology)
    given = fem.dirichletbc(exact, fem.locate_dofs_topological(space, ndim - 1, boundary))
    solved = LinearProblem(
        ufl.inner(ufl.grad(u), ufl.grad(v)) * dx,
        fem.Constant(mesh, -2.0 * ndim) * v * dx,
        bcs=[given],
        petsc_options={"ksp_type": "preonly", "pc_type": "lu"},
    ).solve()
    assert solved.x.array == pytest.approx(exact.x.array, abs=1e-10)
