"""Executes the `run:` steps of the workflows on this machine, which must be Linux.

``python .github/run_steps.py`` runs every step that has a meaning here, ``FILE/JOB ...`` those of
some jobs, such as ``checks.yml/workflows``; ``--list`` says what would run. Each job gets a clone
of the last commit, a virtual environment in place of actions/setup-python, and the matrix entries
that run on Linux for this processor. Uploaded artifacts are handed to the jobs that download them.
Steps that need what a machine does not have are listed in `ELSEWHERE` with the reason. Variables
that are set, such as PYTHONS="3.11 3.13", win over those of the steps. Needs PyYAML.
"""

from __future__ import annotations

import fnmatch
import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).parents[1]
WORKFLOWS = ROOT / ".github" / "workflows"
ORDER = ("checks.yml", "nightly.yml", "docs.yml", "wheels.yml", "release.yml")
# File, job and step: why it does not run here.
ELSEWHERE = {
    "checks.yml/minimum-rust/*": "fetches another Rust toolchain",
    "nightly.yml/*": "takes hours; make test-deep and make mutants are its steps",
    "wheels.yml/wheels/Build the wheels and run the quick tests in each": "needs containers",
    "release.yml/page/*": "publishes",
    "docs.yml/publish/*": "publishes",
}
# What runs in place of a step that does not: its output is needed by later ones.
INSTEAD = {
    "wheels.yml/wheels/Build the wheels and run the quick tests in each": (
        'python -m pip install -q "maturin>=1.9,<2" ziglang\n'
        "maturin build --release --zig --compatibility manylinux_2_17 -i python --out dist\n"
    ),
}


@dataclass
class Job:
    """One job of one workflow, for one entry of its matrix."""

    file: str
    name: str
    steps: list[dict[str, Any]]
    matrix: dict[str, str] = field(default_factory=dict)

    def title(self) -> str:
        chosen = ", ".join(str(value) for value in self.matrix.values())
        return f"{self.file}/{self.name}" + (f" ({chosen})" if chosen else "")


def entries(job: dict[str, Any]) -> list[dict[str, str]]:
    """The entries of a matrix that are for Linux on this processor."""
    included = job.get("strategy", {}).get("matrix", {}).get("include", [{}])
    same = [entry for entry in included if entry.get("runner", "ubuntu-24.04") == "ubuntu-24.04"]
    return [entry for entry in same if entry.get("platform", "linux") == "linux"]


def jobs(wanted: list[str]) -> list[Job]:
    found = []
    for path in sorted(WORKFLOWS.glob("*.yml")):
        for name, job in yaml.safe_load(path.read_text(encoding="utf-8"))["jobs"].items():
            chosen = not wanted or f"{path.name}/{name}" in wanted
            if "steps" in job and chosen:
                found += [Job(path.name, name, job["steps"], e) for e in entries(job)]
    return found


def filled(text: str, matrix: dict[str, str]) -> str:
    """The text with the expressions of the workflows replaced."""
    values = {f"matrix.{key}": str(value) for key, value in matrix.items()}
    values["github.ref_name"] = os.environ.get("TAG", "v0.0.0")
    # The one condition that is used: `A != 'b' && 'c' || 'd'`.
    condition = re.compile(r"\$\{\{ ([\w.]+) != '([^']*)' && '([^']*)' \|\| '([^']*)' \}\}")
    text = condition.sub(lambda m: m[3] if values.get(m[1], "") != m[2] else m[4], text)
    return re.sub(r"\$\{\{ ([\w.-]+) \}\}", lambda m: values.get(m[1], ""), text)


def reason(job: Job, step: dict[str, Any]) -> str | None:
    name = f"{job.file}/{job.name}/{step.get('name', '')}"
    return next((why for pattern, why in ELSEWHERE.items() if fnmatch.fnmatch(name, pattern)), None)


def hand_over(step: dict[str, Any], job: Job, clone: Path, artifacts: Path) -> None:
    """What the actions for artifacts do, with a folder in place of a server."""
    chosen = {key: filled(str(value), job.matrix) for key, value in step.get("with", {}).items()}
    if "/upload-artifact@" in step["uses"]:
        folder = artifacts / chosen["name"]
        folder.mkdir(exist_ok=True)
        files = list(clone.glob(chosen["path"]))
        if not files:
            raise SystemExit(f"{job.title()}: nothing to upload at {chosen['path']}")
        for path in files:
            shutil.copy(path, folder)
    elif "/download-artifact@" in step["uses"]:
        into = clone / chosen["path"]
        into.mkdir(exist_ok=True)
        patterns = chosen.get("pattern", "*").strip("{}").split(",")
        for folder in artifacts.iterdir():
            if any(fnmatch.fnmatch(folder.name, pattern) for pattern in patterns):
                shutil.copytree(folder, into, dirs_exist_ok=True)


def execute(script: str, step: dict[str, Any], job: Job, clone: Path, environment: Path) -> int:
    variables = {key: filled(str(value), job.matrix) for key, value in step.get("env", {}).items()}
    path = f"{environment / 'bin'}{os.pathsep}{os.environ['PATH']}"
    inherited = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "VIRTUAL_ENV")}
    return subprocess.run(
        ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", filled(script, job.matrix)],
        cwd=clone, check=False,
        env={**variables, **inherited, "PATH": path, "CI": "true"},
    ).returncode  # fmt: skip


def run(job: Job, folder: Path, artifacts: Path) -> list[str]:
    """Runs the steps of one job until one fails; a line for each."""
    clone, environment = folder / "clone", folder / "environment"
    version = job.matrix.get("python")
    python = shutil.which(f"python{version}") if version else sys.executable
    if python is None:
        return [f"not here  {job.title()}: no python{version} on the PATH"]
    subprocess.run(["git", "clone", "-q", str(ROOT), str(clone)], check=True)
    subprocess.run([python, "-m", "venv", str(environment)], check=True)
    said = []
    for step in job.steps:
        if "uses" in step:
            hand_over(step, job, clone, artifacts)
            continue
        name, why = step.get("name", "?"), reason(job, step)
        script = INSTEAD.get(f"{job.file}/{job.name}/{name}") if why else step["run"]
        if script is None:
            said.append(f"not here  {job.title()}: {name} ({why})")
            continue
        code = execute(script, step, job, clone, environment)
        state = "FAILED" if code else "replaced" if why else "passed"
        said.append(f"{state:<9} {job.title()}: {name}" + (f" ({why})" if why else ""))
        if code:
            break
    return said


def main(arguments: list[str]) -> int:
    wanted = [argument for argument in arguments if not argument.startswith("--")]
    chosen = jobs(wanted)
    if "--list" in arguments:
        for job in chosen:
            for step in job.steps:
                if "run" in step:
                    print(f"{job.title()}: {step.get('name')} [{reason(job, step) or 'runs'}]")
        return 0
    report: list[str] = []
    with tempfile.TemporaryDirectory() as artifacts:
        # The files in the order of what they hand over to each other.
        for job in sorted(chosen, key=lambda job: ORDER.index(job.file)):
            with tempfile.TemporaryDirectory() as folder:
                report += run(job, Path(folder), Path(artifacts))
    print("\n".join(report))
    return 1 if any(line.startswith("FAILED") for line in report) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
