"""delone in unusual environments; each case is a process of its own that does a day's work.

Only the zip archive fails, because the system cannot load an extension module from one: it raises
ImportError.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import delone

PACKAGE = Path(delone.__file__).parent
linux = pytest.mark.skipif(sys.platform != "linux", reason="prctl and limits of Linux alone")

# Triangulates, interpolates, and writes and reads a file next to the program; prints what it found.
WORK = """
import sys
sys.path.insert(0, sys.argv[1])
from pathlib import Path
import numpy as np
import delone
from delone.interpolate import Linear
points = np.array([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)], dtype=float)
mesh = delone.Delaunay(points)
folder = Path(sys.argv[2])
mesh.save(folder / "netz Ü.npz")
again = delone.Delaunay.load(folder / "netz Ü.npz")
np.savetxt(folder / "points Ü.csv", points, delimiter=",", header="x,y", comments="")
from delone import io
assert len(io.read_points(folder / "points Ü.csv").points) == 5
assert bool(again.validate()), again.validate()
try:
    delone.Delaunay([(0, 0), (1, 1), (2, 2)])
except delone.DegenerateInputError as error:
    assert "one line" in ascii(str(error)), ascii(str(error))
print(again.nsimplex, round(float(Linear(points, points[:, 0])([(1.0, 1.0)])[0]), 12))
"""
RIGHT = "4 1.0\n"


def run(
    *options: str,
    folder: Path,
    package: Path = PACKAGE.parent,
    code: str = WORK,
    **variables: str,
) -> subprocess.CompletedProcess[str]:
    """The work in a Python with these options and environment variables."""
    return subprocess.run(
        [sys.executable, *options, "-c", code, str(package), str(folder)],
        cwd=folder, env={**os.environ, **variables}, capture_output=True, text=True, check=False,
        encoding="utf-8", errors="replace",
    )  # fmt: skip


def require_right(done: subprocess.CompletedProcess[str]) -> None:
    assert (done.returncode, done.stdout, done.stderr) == (0, RIGHT, "")


@pytest.mark.parametrize(
    "variables",
    [
        {"LC_ALL": "C"},
        {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
        {"LC_ALL": "POSIX", "PYTHONIOENCODING": "ascii"},
    ],
    ids=["C", "C without UTF-8", "ASCII output"],
)
def test_locale(variables: dict[str, str], tmp_path: Path) -> None:
    # An argument in UTF-8 and a source in UTF-8 reach Python in any locale; the file names in the
    # program are the same in all of them where the system takes bytes.
    plain = WORK.replace("Ü", "u") if variables.get("PYTHONUTF8") == "0" else WORK
    require_right(run(folder=tmp_path, code=plain, **variables))


@pytest.mark.parametrize("options", [["-I"], ["-O"], ["-OO"], ["-B", "-s", "-E"]], ids=" ".join)
def test_options(options: list[str], tmp_path: Path) -> None:
    require_right(run(*options, folder=tmp_path))


def test_development_mode_without_a_warning(tmp_path: Path) -> None:
    # Faults of other libraries' modules are theirs.
    require_right(run("-X", "dev", "-W", "error:::delone", folder=tmp_path))


def test_folder_with_spaces_and_letters_of_other_scripts(tmp_path: Path) -> None:
    folder = tmp_path / "Möbel & Städte" / "三角形 plan"
    folder.mkdir(parents=True)
    shutil.copytree(PACKAGE, folder / "delone", ignore=shutil.ignore_patterns("__pycache__"))
    require_right(run(folder=folder, package=folder))


def test_home_that_cannot_be_written(tmp_path: Path) -> None:
    # Not even root can make a folder below a file.
    home = tmp_path / "file"
    home.write_text("")
    places = ("HOME", "USERPROFILE", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "LOCALAPPDATA")
    require_right(run(folder=tmp_path, **dict.fromkeys(places, str(home / "home"))))


def test_nothing_is_written_into_the_home(tmp_path: Path) -> None:
    home, folder = tmp_path / "home", tmp_path / "work"
    home.mkdir()
    folder.mkdir()
    require_right(run(folder=folder, HOME=str(home), XDG_CACHE_HOME=str(home / "cache")))
    assert list(home.iterdir()) == []


def test_zip_archive_is_an_import_error(tmp_path: Path) -> None:
    archive = tmp_path / "packages.zip"
    with zipfile.ZipFile(archive, "w") as opened:
        for path in PACKAGE.rglob("*"):
            if path.suffix != ".pyc" and path.is_file():
                opened.write(path, Path("delone") / path.relative_to(PACKAGE))
    done = run("-I", folder=tmp_path, package=archive, code=WORK.replace("import delone\n", TRIED))
    assert (done.returncode, done.stdout) == (0, "True True\n"), done.stderr


TRIED = """
try:
    import delone
except ImportError as error:
    print(isinstance(error, ImportError), "_core" in str(error))
    sys.exit()
"""

# Both limits are set after NumPy is there, whose own libraries may start threads.
LIMITED = """
import os, sys, threading
sys.path.insert(0, sys.argv[1])
import numpy as np
from delone import Delaunay, Voronoi
points = np.random.default_rng(0).random((300_000, 2))
right = Delaunay(points, workers=1).simplices
{limit}
for workers in (None, 8):
    assert np.array_equal(Delaunay(points, workers=workers).simplices, right)
assert len(Voronoi(points[:1000], workers=8).cell_areas) == 1000
print("4 1.0")
"""
NO_THREADS = """
import resource
if os.geteuid() == 0:
    os.setresuid(65534, 65534, 65534)
resource.setrlimit(resource.RLIMIT_NPROC, (0, 0))
try:
    threading.Thread(target=print).start()
except RuntimeError:
    pass
else:
    raise SystemExit("a thread was started")
"""
NO_HUGE_PAGES = """
import ctypes
PR_SET_THP_DISABLE, PR_GET_THP_DISABLE = 41, 42
libc = ctypes.CDLL(None)
assert libc.prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0) == 0
assert libc.prctl(PR_GET_THP_DISABLE, 0, 0, 0, 0) == 1
"""


@linux
@pytest.mark.parametrize("limit", [NO_THREADS, NO_HUGE_PAGES], ids=["threads", "huge pages"])
def test_without(limit: str, tmp_path: Path) -> None:
    require_right(run(folder=tmp_path, code=LIMITED.format(limit=limit)))
