"""Diagrams of periodic sets of sites: the arrays of a `dual` from a periodic triangulation.

A vertex of the periodic diagram has translates; those around a site are listed where they are. A
corner of a triangle that is moved by some periods sees the centre of the triangle moved back by as
many. Where triangles share their centre, decided exactly, it is known of each by how many periods
it is moved against that of the first of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.periodic import PeriodicDelaunay

    Longs = NDArray[np.int64]

__all__ = ["of_periodic"]

_AFTER, _BEFORE = [1, 2, 0], [2, 0, 1]


def of_periodic(mesh: PeriodicDelaunay, workers: int) -> dict[str, NDArray[Any]]:
    """Return the diagram of a set with a period in x and in y.

    Parameters
    ----------
    mesh : PeriodicDelaunay
        Its triangulation.
    workers : int
        How many threads may work.

    Returns
    -------
    dict of ndarray
        As from the core, and ``moved``, (r, 2): by how many periods the second site of each ridge
        is moved, seen from the first. The ends of a ridge lie where its first site sees them.
    """
    lengths = np.array(mesh.periods, dtype=np.float64)
    triangle, corner = np.divmod(mesh.partners.astype(np.int64), 3)
    # By how much each neighbour is moved against its own place.
    tau = mesh.offsets[:, _BEFORE] - mesh.offsets[triangle, (corner + 1) % 3]
    apexes = np.dstack((mesh.simplices[triangle, corner], mesh.offsets[triangle, corner] + tau))
    corners = np.dstack((mesh.simplices, mesh.offsets))
    centers, shared = _core.periodic_centers2(
        mesh.points,
        (float(lengths[0]), float(lengths[1])),
        np.ascontiguousarray(corners.reshape(-1, 3), dtype=np.int32),
        np.ascontiguousarray(apexes.reshape(-1, 3), dtype=np.int32),
        workers,
    )
    first, shift = _shared_centers(triangle, tau, shared)
    ridge, edges = _ridges(mesh, shared)
    sites, cells = _cells(mesh, shared)
    t, k = np.divmod(cells, 3)
    entries = np.column_stack((first[t], shift[t] - mesh.offsets[t, k]))
    left, e = np.divmod(edges, 3)
    right, seen_from = triangle[left, e], mesh.offsets[left, (e + 1) % 3]
    ends = np.stack(
        (
            np.column_stack((first[right], shift[right] + tau[left, e] - seen_from)),
            np.column_stack((first[left], shift[left] - seen_from)),
        ),
        axis=1,
    )
    everywhere = np.column_stack((first, shift))
    listed = np.concatenate((entries, ends.reshape(-1, 3), everywhere))
    vertices, number = np.unique(listed, axis=0, return_inverse=True)
    number = number.reshape(-1).astype(np.int32)
    a, b = mesh.simplices[left, (e + 1) % 3], mesh.simplices[left, (e + 2) % 3]
    region = np.full(mesh.npoints, -1, dtype=np.int32)
    region[sites["site"]] = np.arange(len(sites["site"]))
    return {
        "vertices": centers[vertices[:, 0]] + vertices[:, 1:] * lengths,
        "triangle_vertex": number[len(entries) + 2 * len(edges) :].copy(),
        "sites": np.column_stack((a, b)),
        "ends": number[len(entries) : len(entries) + 2 * len(edges)].reshape(-1, 2).copy(),
        "rays": np.empty((0, 2)),
        "moved": mesh.offsets[left, (e + 2) % 3] - seen_from,
        "region": region[mesh.duplicate_of],
        "site": sites["site"],
        "starts": sites["starts"],
        "region_vertices": number[: len(entries)].copy(),
        "region_ridges": ridge[t, (k + 1) % 3],
    }


def _shared_centers(
    neighbor: Longs, tau: NDArray[Any], shared: NDArray[np.bool_]
) -> tuple[Longs, Longs]:
    """The first triangle with the same centre, and by how much its centre is moved from there."""
    first = np.arange(len(neighbor))
    shift = np.zeros((len(neighbor), 2), dtype=np.int64)
    seen = np.zeros(len(neighbor), dtype=bool)
    for start in np.flatnonzero(shared.any(axis=1)).tolist():
        if seen[start]:
            continue
        seen[start] = True
        stack = [start]
        # Each triangle is seen once, and pushed then.
        while stack:
            t = stack.pop()
            for k in np.flatnonzero(shared[t]).tolist():
                other = int(neighbor[t, k])
                if not seen[other]:
                    seen[other] = True
                    first[other] = start
                    shift[other] = shift[t] - tau[t, k]
                    stack.append(other)
    return first, shift


def _ridges(
    mesh: PeriodicDelaunay, shared: NDArray[np.bool_]
) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """The ridge of each edge of each triangle, and for each ridge the first edge that has it."""
    codes = np.arange(shared.size, dtype=np.int64).reshape(-1, 3)
    owner = np.minimum(codes, mesh.partners)
    edges = np.flatnonzero(((owner == codes) & ~shared).reshape(-1))
    number = np.full(shared.size, -1, dtype=np.int32)
    number[edges] = np.arange(len(edges))
    return number[owner], edges


def _cells(
    mesh: PeriodicDelaunay, shared: NDArray[np.bool_]
) -> tuple[dict[str, NDArray[np.int32]], NDArray[np.int64]]:
    """Sites, where the entries of each begin, and the corner (3 t + k) of each entry.

    All sites are gone around at once, a triangle a step, so that there are as many steps as the
    largest number of triangles around one site.
    """
    partner = mesh.partners[:, _AFTER].astype(np.int64)
    after = (partner // 3 * 3 + (partner % 3 + 1) % 3).reshape(-1)
    emits = ~shared[:, _AFTER].reshape(-1)
    site, start = np.unique(mesh.simplices.reshape(-1), return_index=True)
    owners, places, codes = [], [], []
    going, now, step = np.arange(len(site)), start.astype(np.int64), 0
    while len(going):
        owners.append(going)
        places.append(np.full(len(going), step))
        codes.append(now)
        now = after[now]
        further = now != start[going]
        going, now, step = going[further], now[further], step + 1
    owner, place, code = map(np.concatenate, (owners, places, codes))
    order = np.lexsort((place, owner))
    owner, code = owner[order], code[order]
    owner, code = owner[emits[code]], code[emits[code]]
    starts = np.zeros(len(site) + 1, dtype=np.int32)
    np.cumsum(np.bincount(owner, minlength=len(site)), out=starts[1:])
    return {"site": site.astype(np.int32), "starts": starts}, code
