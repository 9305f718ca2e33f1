"""Installs a wheel into fresh environments and runs the quick tests in each.

``python .github/environments.py WHEEL python3.11 python3.12 ...``: for every interpreter one
environment with the oldest releases of NumPy, SciPy and pandas that the wheel, the extras and the
interpreter allow, and one with the newest. Says at the end what was installed and what failed.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]
# The lower bounds that pyproject.toml states, and pandas, which geopandas and xarray require.
LIBRARIES = ("numpy>=1.26", "scipy>=1.13", "pandas>=1.5")
RESOLUTIONS = {"oldest": "lowest-direct", "newest": "highest"}


def quick() -> list[str]:
    """What the quick tests need, from pyproject.toml."""
    with (ROOT / "pyproject.toml").open("rb") as file:
        groups = tomllib.load(file)["dependency-groups"]
    return [need for need in groups["quick"] if isinstance(need, str)]


def run(*command: str | Path, **variables: str) -> None:
    subprocess.run(command, check=True, env={**os.environ, **variables}, cwd=ROOT)


def try_one(wheel: Path, python: str, resolution: str, folder: Path) -> str:
    """The versions in a new environment in which the quick tests pass."""
    run(sys.executable, "-m", "uv", "venv", "-q", "--python", python, folder)
    inside = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    install = [sys.executable, "-m", "uv", "pip", "install", "-q", "--python", str(inside)]
    chosen = ["--only-binary", ":all:", "--resolution", resolution]
    run(*install, *chosen, *LIBRARIES)
    run(*install, "--only-binary", ":all:", *quick(), wheel)
    done = subprocess.run(
        [sys.executable, "-m", "uv", "pip", "list", "--format", "json", "--python", str(inside)],
        check=True, capture_output=True, text=True,
    )  # fmt: skip
    installed = {entry["name"]: entry["version"] for entry in json.loads(done.stdout)}
    run(inside, "-I", "-c", "import delone; assert '.github' not in delone.__file__")
    # Extras are missing on purpose: their tests are skipped.
    command = [inside, "-m", "pytest", "--quick", "-p", "no:cacheprovider"]
    run(*command, PYTHONPATH="", DELONE_ANY_SKIP="1")
    return ", ".join(f"{name} {installed[name]}" for name in ("numpy", "scipy", "pandas"))


def main(wheel: Path, pythons: list[str]) -> int:
    report, failed = [], 0
    for python in pythons:
        for name, resolution in RESOLUTIONS.items():
            with tempfile.TemporaryDirectory() as folder:
                try:
                    said = try_one(wheel, python, resolution, Path(folder) / "environment")
                except subprocess.CalledProcessError as error:
                    said, failed = f"FAILED: {error}", failed + 1
            report.append(f"{python} {name}: {said}")
    print("\n".join(report))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve(), sys.argv[2:]))
