"""A skip that is not listed fails the run."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

CONFTEST = Path(__file__).parents[1] / "conftest.py"
ORACLES = CONFTEST.parent / "oracles"
IN_A_TEST = "import pytest\ndef test_a(): pytest.importorskip('absent_library')\n"
OF_A_MODULE = "import pytest\npytest.importorskip('absent_library')\ndef test_a(): pass\n"
EXPECTED = "import pytest\ndef test_a(): pytest.skip('root may write anywhere')\n"


def run(tmp_path: Path, text: str, *, any_skip: str = "") -> tuple[int, str]:
    folder = tmp_path / "tests" / "distributed"
    folder.mkdir(parents=True)
    shutil.copy(CONFTEST, tmp_path / "tests")
    (folder / "test_resume.py").write_text(text)
    options = ["-q", "-p", "no:cacheprovider", "--rootdir", ".", "-o", f"pythonpath={ORACLES}"]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *options, "tests"],
        cwd=tmp_path, env={**os.environ, "DELONE_ANY_SKIP": any_skip}, capture_output=True,
        text=True, check=False,
    )  # fmt: skip
    return done.returncode, done.stdout


@pytest.mark.parametrize("text", [IN_A_TEST, OF_A_MODULE], ids=["in a test", "of a module"])
def test_what_nobody_expects_fails_the_run(tmp_path: Path, text: str) -> None:
    code, out = run(tmp_path, text)
    assert code == 1
    assert "test_resume.py" in out
    assert "could not import 'absent_library'" in out
    assert "1 error" in out.splitlines()[-1]
    shutil.rmtree(tmp_path / "tests")
    code, out = run(tmp_path, text, any_skip="1")
    # A module without a test in it: nothing was collected.
    assert code == (0 if text == IN_A_TEST else 5)
    assert "1 skipped" in out.splitlines()[-1]


def test_what_is_listed_passes(tmp_path: Path) -> None:
    code, out = run(tmp_path, EXPECTED)
    assert code == 0
    assert "1 skipped" in out.splitlines()[-1]
