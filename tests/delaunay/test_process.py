"""How long calls live with signals, limits and other processes; each in a process of its own."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import time

import pytest

posix = pytest.mark.skipif(os.name != "posix", reason="signals and limits of POSIX")


def start(code: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(code)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def finish(process: subprocess.Popen[str]) -> str:
    try:
        out, err = process.communicate(timeout=120)
    except subprocess.TimeoutExpired:
        process.kill()
        raise
    assert process.returncode == 0, err
    return out


@posix
@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("triangulate2", "Delaunay(points, workers=1)"),
        ("validate", "mesh.validate()"),
        ("find", "mesh.find_simplex(queries)"),
    ],
    ids=["triangulate", "validate", "find_simplex"],
)
@pytest.mark.sampled(1)
def test_ctrl_c_ends_one_call(name: str, call: str) -> None:
    # The profiler hears of each call of the core. Only an exception that leaves a call shows that
    # the signal came through from within: one that comes between two calls is tried again.
    process = start(
        f"""
        import signal, sys
        import numpy as np
        from delone import Delaunay

        signal.signal(signal.SIGINT, signal.default_int_handler)
        # Calls take several times the 50 ms between two looks at signals.
        points = np.random.default_rng(0).random((2_000_000, 2))
        queries = points[::-1].copy()
        mesh = Delaunay(points)
        # The first query makes an index, in a call of another name.
        mesh.find_simplex(points[0])
        interrupted = False

        def watch(frame, event, function):
            global interrupted
            if event == "c_exception" and function.__name__ == {name!r}:
                interrupted = True

        print("ready", flush=True)
        while not interrupted:
            try:
                sys.setprofile(watch)
                while True:
                    {call}
            except KeyboardInterrupt:
                sys.setprofile(None)
            print("stopped" if interrupted else "again", flush=True)
        # Nothing is broken: the next call is right.
        again = Delaunay(points)
        assert np.array_equal(again.simplices, mesh.simplices)
        print(bool(again.validate()), flush=True)
        """
    )
    assert process.stdout is not None
    line = process.stdout.readline()
    for _ in range(50):
        if line not in ("ready\n", "again\n"):
            break
        # Some time later: mostly within a call, as hardly any time passes between two of them.
        time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        line = process.stdout.readline()
    if line != "stopped\n":
        process.kill()
    assert line == "stopped\n", process.communicate()[1]
    assert finish(process).split() == ["True"]


@posix
@pytest.mark.parametrize("count", [8, 600], ids=["few", "many"])
def test_ctrl_c_ends_queries_among_very_many_neighbors(count: int) -> None:
    # Each takes a good part of a second, or more: all sites are its neighbors.
    process = start(
        f"""
        import signal
        import numpy as np
        from delone.interpolate import NaturalNeighbor
        signal.signal(signal.SIGINT, signal.default_int_handler)
        angle = np.sort(np.random.default_rng(0).random(20_000)) * 2 * np.pi
        sites = np.column_stack((np.cos(angle), np.sin(angle)))
        height = NaturalNeighbor(sites, angle)
        queries = np.random.default_rng(1).uniform(-0.5, 0.5, ({count}, 2))
        print("ready", flush=True)
        try:
            while True:
                height(queries)
        except KeyboardInterrupt:
            print("stopped")
        """
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    assert finish(process).strip() == "stopped"


@posix
def test_another_handler_is_heard() -> None:
    # What a handler raises comes out of the call; a handler that returns lets it go on.
    process = start(
        """
        import os, signal, threading
        import numpy as np
        from delone import Delaunay

        class Alarm(Exception):
            pass

        heard = []
        def handler(number, frame):
            heard.append(number)
            if len(heard) > 1:
                # A third signal would interrupt what handles the exception.
                signal.setitimer(signal.ITIMER_REAL, 0)
                raise Alarm
        signal.signal(signal.SIGALRM, handler)
        signal.setitimer(signal.ITIMER_REAL, 0.1, 0.1)
        points = np.random.default_rng(0).random((200_000, 2))
        try:
            while True:
                Delaunay(points)
        except Alarm:
            print(len(heard))
        """
    )
    assert finish(process).strip() == "2"


@pytest.mark.skipif(sys.platform != "linux", reason="RLIMIT_AS is kept on Linux alone")
def test_memory_that_cannot_be_had() -> None:
    # The points and a little more fit into the limit, the triangulation does not.
    process = start(
        """
        import resource
        import numpy as np
        from delone import Delaunay
        points = np.random.default_rng(0).random((1_000_000, 2))
        expected = Delaunay(points[:1000])
        size = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (size + 60_000_000,) * 2)
        for workers in (1, 2):
            try:
                Delaunay(points, workers=workers)
            except MemoryError as error:
                print("refused")
        # The process goes on.
        again = Delaunay(points[:1000])
        print(np.array_equal(again.simplices, expected.simplices))
        """
    )
    assert finish(process).split() == ["refused", "refused", "True"]


@pytest.mark.skipif(sys.platform != "linux", reason="RLIMIT_AS is kept on Linux alone")
@pytest.mark.deep
def test_memory_that_runs_out_on_the_way() -> None:
    process = start(
        """
        import os, resource
        import numpy as np
        from delone import Voronoi, lloyd, mesh
        points = np.random.default_rng(0).random((200_000, 2))
        square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        cells = lambda: Voronoi(points, clip="box")
        tasks = [
            (cells, lambda cells: cells.cell_areas),
            (cells, lambda cells: cells.neighbors),
            (lambda: None, lambda _: lloyd(points, (0, 0, 1, 1), max_iter=1)),
            (lambda: None, lambda _: mesh(square, max_area=4e-6)),
        ]
        for before, task in tasks:
            outcomes = set()
            # With nothing at all no thread starts, and the system itself gives up.
            for megabytes in (5, 10, 15, 20, 25, 40, 80, 400):
                child = os.fork()
                if child == 0:
                    given = before()
                    size = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
                    resource.setrlimit(resource.RLIMIT_AS, (size + megabytes * 2**20,) * 2)
                    try:
                        task(given)
                    except MemoryError:
                        os._exit(3)
                    os._exit(0)
                outcomes.add(os.waitpid(child, 0)[1])
            print(outcomes <= {0, 3 << 8})
        """
    )
    assert finish(process).split() == ["True"] * 4


def test_threads_that_cannot_be_had() -> None:
    process = start(
        """
        import os
        # No system has room for such a stack.
        os.environ["RUST_MIN_STACK"] = str(2**60)
        import numpy as np
        from delone import Delaunay
        points = np.random.default_rng(0).random((200_000, 2))
        one, many = (Delaunay(points, workers=workers).simplices for workers in (1, 8))
        print(np.array_equal(one, many))
        """
    )
    assert finish(process).split() == ["True"]


@posix
def test_a_forked_process_uses_what_its_parent_made() -> None:
    process = start(
        """
        import os
        import numpy as np
        from delone import Delaunay
        points = np.random.default_rng(0).random((50_000, 2))
        mesh = Delaunay(points)
        expected = mesh.find_simplex(points)
        child = os.fork()
        if child == 0:
            good = np.array_equal(mesh.find_simplex(points), expected)
            good = good and np.array_equal(Delaunay(points).simplices, mesh.simplices)
            good = good and len(mesh.edges) > 0
            os._exit(0 if good else 1)
        print(os.waitpid(child, 0)[1], bool(mesh.validate()))
        """
    )
    assert finish(process).split() == ["0", "True"]


@posix
def test_processes_of_a_pool_get_and_give_triangulations() -> None:
    process = start(
        """
        import multiprocessing
        import numpy as np
        from delone import Delaunay, datasets

        if __name__ == "__main__":
            sets = [datasets.uniform(500, seed=seed) for seed in range(6)]
            with multiprocessing.get_context("fork").Pool(2) as pool:
                meshes = pool.map(Delaunay, sets)
            print(all(np.array_equal(m.simplices, Delaunay(s).simplices)
                      for m, s in zip(meshes, sets)))
        """
    )
    assert finish(process).strip() == "True"


def test_the_interpreter_lock_is_released() -> None:
    # Another thread counts while one call runs; with the lock held it could not count at all.
    process = start(
        """
        import threading
        import numpy as np
        from delone import Delaunay
        points = np.random.default_rng(0).random((500_000, 2))
        count, done = 0, threading.Event()
        def work():
            Delaunay(points, workers=1)
            done.set()
        thread = threading.Thread(target=work)
        thread.start()
        while not done.wait(0.001):
            count += 1
        thread.join()
        print(count > 3)
        """
    )
    assert finish(process).strip() == "True"
