"""Whether wheels are fit to be published: size, contents and ABI.

``python .github/check_wheels.py dist/*.whl`` says what each is, or what is wrong with it.
"""

from __future__ import annotations

import fnmatch
import subprocess
import sys
import zipfile
from pathlib import Path

# Four megabytes: what `pip install` downloads.
LARGEST = 4_000_000
INSIDE = (
    "delone/py.typed",
    "delone/_core.pyi",
    "delone/_core*",
    "*.dist-info/licenses/LICENSE-MIT",
    "*.dist-info/licenses/LICENSE-APACHE",
    "*.dist-info/licenses/LICENSE-THIRD-PARTY",
    "*.dist-info/sboms/*.cyclonedx.json",
)
# Nothing else is required by `pip install delone`.
REQUIRED = ["numpy>=1.26"]


def faults(wheel: Path) -> list[str]:
    """What is wrong with one wheel, one phrase each."""
    found = []
    if wheel.stat().st_size > LARGEST:
        found.append(f"{wheel.stat().st_size:,} bytes, more than {LARGEST:,}")
    with zipfile.ZipFile(wheel) as opened:
        names = opened.namelist()
        found += [f"no {pattern}" for pattern in INSIDE if not fnmatch.filter(names, pattern)]
        [stated] = fnmatch.filter(names, "*.dist-info/METADATA")
        lines = opened.read(stated).decode().splitlines()
    needed = [line.removeprefix("Requires-Dist: ") for line in lines if "Requires-Dist: " in line]
    hard = [need for need in needed if "extra ==" not in need]
    if hard != REQUIRED:
        found.append(f"requires {hard}, not {REQUIRED}")
    if "-abi3-" in wheel.name:
        command = [sys.executable, "-m", "abi3audit", "--strict", str(wheel)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            found.append(f"abi3audit: {done.stdout}{done.stderr}")
    return found


def main(wheels: list[Path]) -> int:
    wrong = 0
    for wheel in wheels:
        found = faults(wheel)
        wrong += bool(found)
        print(f"{wheel.name}: {wheel.stat().st_size:,} bytes, {'; '.join(found) or 'all is well'}")
    return 1 if wrong or not wheels else 0


if __name__ == "__main__":
    sys.exit(main([Path(name) for name in sys.argv[1:]]))
