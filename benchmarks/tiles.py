"""Tiles against memory: ``python benchmarks/tiles.py [FILE.laz]``, or set DELONE_LIDAR.

Three tables. The first: seconds and peak memory of the serial executor and of `Delaunay`, both from
an npy file to the same Parquet files, at one size of tile and growing numbers of points; each in a
process of its own, in turns, medians; for comparison, `Delaunay` from the file alone, with nothing
written. The second: what tiles exchange on clustered, gridded and track-like data. The
third, where a lidar file is named: two Dask workers with 1.5 GB each, without and with one of them
killed. All triangulations are compared with the one in memory, triangle for triangle.
"""

import argparse
import os
import shutil
import signal
import tempfile
import time
from collections.abc import Callable
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

from delone import Delaunay, datasets, distributed
from delone.distributed.run.usage import peak_memory

LIMIT = "1.5GB"


def apart(work: Callable[..., Any], *arguments: Any) -> tuple[Any, float, float]:
    """Do some work in a fresh process; return its result, its seconds and its peak memory in MB."""
    with get_context("spawn").Pool(1) as pool:
        return pool.apply(measured, (work, *arguments))


def measured(work: Callable[..., Any], *arguments: Any) -> tuple[Any, float, float]:
    """Do some work; return its result, seconds and the peak memory of the process in MB."""
    # pyarrow takes pandas along where it is given arrays of numpy: nobody pays for that here.
    import pandas
    import pyarrow.parquet

    assert pandas and pyarrow.parquet
    start = time.perf_counter()
    found = work(*arguments)
    seconds = time.perf_counter() - start
    return found, seconds, peak_memory() / 1e6


def alone(file: Path) -> int:
    """Triangulate a file in memory, and write nothing."""
    return len(Delaunay(np.load(file)).simplices)


def in_memory(file: Path, folder: Path) -> int:
    """Triangulate a file in memory, and write what tiles write."""
    import pyarrow
    import pyarrow.parquet

    points = np.load(file)
    simplices = Delaunay(points).simplices
    folder.mkdir()
    tables = {
        "vertices": {"id": np.arange(len(points)), "x": points[:, 0], "y": points[:, 1]},
        "triangles": {name: simplices[:, k] for k, name in enumerate("abc")},
    }
    for name, columns in tables.items():
        pyarrow.parquet.write_table(
            pyarrow.table(columns),
            folder / f"{name}.parquet",
            use_dictionary=False,
            compression="lz4",
        )
    return len(simplices)


def in_tiles(file: Path, folder: Path, size: int) -> tuple[int, float]:
    """Triangulate a file in tiles, one after another; triangles, and foreign points a tile."""
    tin = distributed.triangulate(file, folder, tile_points=size)
    return tin.nsimplex, tin.manifest["given"] / tin.ntiles


def canonical(simplices: Any) -> Any:
    """Triangles in one order, each from its smallest corner on."""
    s = np.asarray(simplices, dtype=np.int64)
    k = s.argmin(axis=1)
    turned = np.stack([s[np.arange(len(s)), (k + j) % 3] for j in range(3)], axis=1)
    return turned[np.lexsort(turned.T[::-1])]


def growth(counts: list[int], size: int, runs: int, folder: Path) -> None:
    """Seconds and memory at growing numbers of points."""
    print(f"\nuniform points, tiles of {size:,}: from npy to Parquet; medians of {runs}")
    names = ("points", "alone s", "memory s", "tiles s", "ratio", "memory MB", "tiles MB")
    print(("{:>12}" * 7 + "{:>16}").format(*names, "foreign a tile"))
    for n in counts:
        file, out = folder / "points.npy", folder / "out"
        np.save(file, datasets.uniform(n))
        seconds, peaks = [], []
        for _ in range(runs):
            whole, plain, _ = apart(alone, file)
            again, one, most = apart(in_memory, file, out)
            shutil.rmtree(out)
            (parts, given), other, peak = apart(in_tiles, file, out, size)
            shutil.rmtree(out)
            assert whole == again == parts
            seconds.append((plain, one, other, other / one))
            peaks.append((most, peak))
        plain, one, other, ratio = np.median(seconds, axis=0)
        most, peak = np.max(peaks, axis=0)
        figures = f"{n:12,}{plain:12.2f}{one:12.2f}{other:12.2f}{ratio:12.2f}{most:12,.0f}"
        print(f"{figures}{peak:12,.0f}{given:16,.0f}", flush=True)


def kinds(n: int, tiles: int, folder: Path) -> None:
    """What tiles exchange on data of other kinds."""
    sets = {
        "uniform": datasets.uniform(n),
        "clusters": datasets.gaussian_clusters(n),
        "kuzmin": datasets.kuzmin(n),
        "grid": datasets.grid(n),
        "tracks (Baja)": datasets.baja().points,
    }
    print(f"\n{n:,} points, {tiles} tiles")
    print(f"{'data':16}{'points':>10}{'rounds':>8}{'foreign':>10}{'share':>9}  identical")
    for name, points in sets.items():
        size = -(-len(points) // tiles)
        tin = distributed.triangulate(points, folder / f"kind-{name}", tile_points=size)
        row(name, tin, points)


def row(name: str, tin: Any, points: Any) -> None:
    """Print what tiles exchanged, and whether the triangles are the same."""
    same = np.array_equal(canonical(tin.read_simplices()), canonical(Delaunay(points).simplices))
    given, rounds = tin.manifest["given"], tin.manifest["rounds"]
    share = given / tin.npoints
    print(f"{name:16}{tin.npoints:10,}{rounds:8}{given:10,}{share:9.3%}  {same}", flush=True)


def on_dask(file: Path, folder: Path, size: int, *, kill: bool) -> tuple[Any, float]:
    """Triangulate a file on two Dask workers, one of which may be killed in the middle."""
    from dask.distributed import Client, LocalCluster

    killed: list[int] = []

    def watch(progress: distributed.Progress) -> None:
        if kill and not killed and progress.stage == "begin" and progress.done >= 2:
            killed.append(min(client.run(os.getpid).values()))
            os.kill(killed[0], signal.SIGKILL)

    options = {"n_workers": 2, "threads_per_worker": 1, "memory_limit": LIMIT}
    with LocalCluster(**options, dashboard_address=":0") as cluster, Client(cluster) as client:
        start = time.perf_counter()
        tin = distributed.triangulate(
            file, folder, tile_points=size, executor=client, progress=watch
        )
        seconds = time.perf_counter() - start
    assert bool(killed) == kill
    return tin, seconds


def lidar(file: Path, size: int, folder: Path) -> None:
    """Two workers with little memory, and one of them killed."""
    from delone.io import read_points

    print(f"\n{file.name}, tiles of {size:,}, two Dask workers with {LIMIT} each")
    right = canonical(Delaunay(read_points(file).points).simplices)
    for kill in (False, True):
        tin, seconds = on_dask(file, folder / f"lidar{kill}", size, kill=kill)
        same = np.array_equal(canonical(tin.read_simplices()), right)
        figures = tin.manifest
        print(
            f"{'one killed' if kill else 'undisturbed':12} {tin.npoints:,} points, "
            f"{tin.ntiles} tiles: {seconds:.1f} s, {figures['rounds']} rounds, "
            f"{figures['given']:,} foreign points ({figures['given'] / tin.npoints:.3%}), at most "
            f"{figures['memory'] / 1e6:,.0f} MB a process, identical: {same}",
            flush=True,
        )


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", nargs="?", default=os.environ.get("DELONE_LIDAR"))
    parser.add_argument("--counts", default="1000000,4000000,10000000")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--n", type=int, default=200_000)
    parser.add_argument("--tile-points", type=int, default=1_000_000)
    options = parser.parse_args()
    counts = [int(count) for count in options.counts.split(",") if count]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        growth(counts, options.tile_points, options.runs, folder)
        kinds(options.n, 16, folder)
        if options.file:
            lidar(Path(options.file), 2 * options.tile_points, folder)


if __name__ == "__main__":
    main()
