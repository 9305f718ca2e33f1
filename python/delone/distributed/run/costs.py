"""Cost model of a run, with a few measured constants.

The constants are measured by ``benchmarks/tiles.py``; the guide's page on planning shows how
accurate they are.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from delone._base.renames import renamed
from delone.distributed.pure.tiles import HALO
from delone.distributed.run.sources import PIECE

__all__ = ["Plan", "estimate"]

# Bytes of a worker process that imported the package and pyarrow, and additional bytes for each
# point of a tile or of a piece.
_BASE, _MEMORY, _PIECE = 150e6, 190.0, 80.0
# Bytes on disk for each point: of a temporary row, of two temporary triangles, of the output.
_ROW, _WAITING, _OUTPUT = 32.0, 24.0, 62.0
# Seconds of one core for each point, without the decompression of files.
_SECONDS = 1.2e-6
# Number of rounds of queries.
_ROUNDS = 3


@renamed(tiles="ntiles")
@dataclass(frozen=True)
class Plan:
    """The estimated resources of a run.

    Parameters
    ----------
    points : int
        Number of points of the source.
    ntiles : int
        Number of tiles.
    pieces : int
        Number of pieces in which the source is read.
    tasks : int
        Total number of tasks.
    foreign : int
        Points that a tile receives from other tiles.
    worker_memory : int
        Bytes per worker.
    disk : int
        Bytes on disk during the run.
    output : int
        Bytes on disk after the run.
    seconds : float
        Time with all workers, without the decompression of the source.

    Examples
    --------
    >>> from delone import distributed
    >>> need = distributed.plan(10_000_000, workers=2)
    >>> need.ntiles, need.worker_memory, need.seconds
    (5, 530000000, 6.0)
    """

    points: int
    ntiles: int
    pieces: int
    tasks: int
    foreign: int
    worker_memory: int
    disk: int
    output: int
    seconds: float


def estimate(points: int, tile_points: int, workers: int, attributes: int) -> Plan:
    """Estimate the resources for a number of points; see `plan`."""
    tiles = max(1, math.ceil(points / tile_points))
    pieces = max(1, math.ceil(points / PIECE))
    size = points / tiles
    row = _ROW + 8 * attributes
    foreign = round(HALO * math.sqrt(size)) if tiles > 1 else 0
    rounds = _ROUNDS if tiles > 1 else 0
    return Plan(
        points=points,
        ntiles=tiles,
        pieces=pieces,
        tasks=2 * pieces + tiles * (2 + 2 * rounds),
        foreign=foreign,
        worker_memory=round(
            _BASE + max(_MEMORY * size, _PIECE * PIECE) + 24 * attributes * max(size, PIECE)
        ),
        disk=round((row + _WAITING + _OUTPUT + 8 * attributes) * points),
        output=round((_OUTPUT + 8 * attributes) * points),
        seconds=_SECONDS * points / max(workers, 1),
    )
