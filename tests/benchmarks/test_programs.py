"""The programs run on small inputs, so that they keep up with the interface of delone."""

import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "benchmarks"
SMALL = {
    "alpha.py": ["--n", "300", "--runs", "1"],
    "higher.py": ["--sets", "4-D uniform,6-D compositions", "--size", "0.02", "--rounds", "1"],
    "hull.py": ["--n", "2000", "--runs", "1"],
    "improve.py": ["300"],
    "interpolate.py": ["--n", "50", "--queries", "100", "--runs", "1"],
    "regrid.py": ["--nside", "4", "--sites", "50", "--largest", "8", "--runs", "1"],
    "sphere.py": ["--n", "300", "--many", "1000", "--runs", "1"],
    "voronoi3.py": ["--n", "200", "--queries", "100", "--runs", "1"],
}


@pytest.mark.parametrize("program", SMALL)
@pytest.mark.sampled(2)
def test_a_program_runs(program: str) -> None:
    pytest.importorskip("scipy")
    done = subprocess.run(
        [sys.executable, str(FOLDER / program), *SMALL[program]],
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) > 3


@pytest.mark.parametrize("peer", ["delone", "delone-no-segments", "delone-split"])
def test_delone_takes_segments(peer: str) -> None:
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]); import line_adapters, lines\n"
        "given = lines.long_segments(8)\n"
        "call = line_adapters.PEERS[sys.argv[2]]()\n"
        "given = given if 'split' in sys.argv[2] else lines.points_and_ring(100)\n"
        "print(len(call.simplices(given, call.call(given))))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(FOLDER), peer],
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) > 8
