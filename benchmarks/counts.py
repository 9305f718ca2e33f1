"""Counts instructions of fixed jobs, and compares them with the counts stored next to this file.

    python benchmarks/counts.py [--update] [JOB ...]

A count is no time: it is nearly the same on every machine, whatever else that does. Valgrind's
callgrind counts what `crates/core/examples/counts.rs` does inside its jobs. Code for newer
processors is left out by the feature `baseline`, as callgrind knows no AVX-512.

Exit codes: 0 if no job takes more than the tolerance, or if valgrind is not installed, which a line
says; 1 if one does. A compiler of another version makes other code: then counts are printed and
nothing fails.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
STORED = Path(__file__).with_name("counts.json")

# How much more a job may take, relatively. The same code counts alike to a thousandth: what remains
# are copies in the C library, which are chosen by processor.
TOLERANCE = 0.02
# How much a job may change, either way, before the last lines name it.
NOTABLE = 0.01
# Where the function's name begins and ends with anything: it is generic, and its name has a hash.
COUNTED = "*counts*counted*"
BUILD = (
    *("cargo", "build", "--quiet", "--profile", "counts", "--features", "baseline"),
    *("-p", "delone-core", "--example", "counts"),
)


def compiler() -> str:
    """Return the version of the compiler and what it compiles for."""
    said = subprocess.run(["rustc", "-vV"], capture_output=True, text=True, check=True).stdout
    found = dict(line.split(": ", 1) for line in said.splitlines() if ": " in line)
    return f"{found['release']} {found['host']}"


def build() -> Path:
    """Build the example and return where it is."""
    subprocess.run(BUILD, cwd=ROOT, check=True)
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    return target / "counts" / "examples" / "counts"


def count(program: Path, job: str) -> int:
    """Return the number of instructions of one job."""
    callgrind = (
        *("valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"),
        *("--collect-atstart=no", f"--toggle-collect={COUNTED}"),
    )
    ran = subprocess.run([*callgrind, program, job], capture_output=True, text=True, check=False)
    collected = re.search(r"Collected : (\d+)", ran.stderr)
    if ran.returncode or not collected or not int(collected[1]):
        sys.exit(f"no count of {job}:\n{ran.stderr}")
    return int(collected[1])


def line(job: str, now: int, before: int | None) -> str:
    """Return what to print about a job."""
    change = "new" if before is None else f"{100 * (now / before - 1):+.2f} %"
    return f"{job:12} {now:>13,} {change:>9}"


def exceeds(now: int, before: int | None) -> bool:
    """Return whether a job takes more than it may."""
    return before is not None and now > before * (1 + TOLERANCE)


def is_notable(now: int, before: int | None) -> bool:
    """Return whether a job takes clearly more or less than before."""
    return before is not None and abs(now - before) > before * NOTABLE


def compare(counts: dict[str, int], stored: dict[str, int], *, same: bool) -> int:
    """Print counts next to the stored ones; return the exit code."""
    for job, now in counts.items():
        print(line(job, now, stored.get(job)))
    changed = [job for job, now in counts.items() if is_notable(now, stored.get(job))]
    if changed:
        print(f"changed by more than {NOTABLE:.0%}: {', '.join(changed)}")
    slower = [job for job, now in counts.items() if exceeds(now, stored.get(job))]
    if slower and same:
        print(f"more than {TOLERANCE:.0%} above benchmarks/counts.json: {', '.join(slower)}")
        print("If that is meant, store the new counts: make counts COUNTS=--update")
        return 1
    return 0


def main() -> int:
    """Count, and compare or store."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("jobs", nargs="*", metavar="JOB")
    parser.add_argument("--update", action="store_true", help="store the counts")
    given = parser.parse_args()
    if shutil.which("valgrind") is None:
        print("instructions are not counted: valgrind is not installed")
        return 0
    program = build()
    jobs = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
    counts = {job: count(program, job) for job in given.jobs or jobs}
    known = json.loads(STORED.read_text()) if STORED.exists() else {"compiler": "", "counts": {}}
    here = compiler()
    same = here == known["compiler"]
    if not same and known["compiler"]:
        print(f"stored with {known['compiler']}, counted with {here}: nothing fails")
    code = compare(counts, known["counts"], same=same)
    if given.update:
        kept = {**known["counts"], **counts} if same else counts
        text = json.dumps({"compiler": here, "counts": kept}, indent=2)
        STORED.write_text(text + "\n")
        return 0
    return code


if __name__ == "__main__":
    sys.exit(main())
