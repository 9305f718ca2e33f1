"""A few surveys, and the command run in this process."""

import json
import shutil

import numpy as np
import pytest

from delone.cli import run


@pytest.fixture(scope="session")
def written(tmp_path_factory):
    points = np.random.default_rng(7).integers(0, 2**20, (9997, 3)) / 1024
    points = np.vstack((points, points[[0, 5, 5]]))
    file = tmp_path_factory.mktemp("surveys") / "survey.csv"
    np.savetxt(file, points, delimiter=",", header="x,y,z", comments="", fmt="%.17g")
    return file


@pytest.fixture
def survey(written, tmp_path):
    """Ten thousand points with heights and three duplicates, as CSV; a copy for each test."""
    return shutil.copy(written, tmp_path / "survey.csv")


@pytest.fixture
def command(capsys):
    """Run the command; return exit code, standard output and standard error."""

    def call(*arguments):
        code = run([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return int(code), captured.out, captured.err

    return call


@pytest.fixture
def figures(command):
    """Run the command with --json; return what it prints."""

    def call(*arguments, code=0):
        found, out, err = command(*arguments, "--json")
        assert (found, err) == (code, "")
        return json.loads(out)

    return call
