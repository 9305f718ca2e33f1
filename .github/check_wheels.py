"""Whether wheels are fit to be published: name, tags, metadata, size, contents and ABI.

``python .github/check_wheels.py dist/*.whl`` says what each is, or what is wrong with it.
"""

from __future__ import annotations

import email
import fnmatch
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import check_release

# Nine megabytes: what `pip install` downloads. Of eight, the core takes 5.6 and the data sets 1.2.
LARGEST = 9_000_000
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
# An index refuses other platforms, such as linux_x86_64. Wheels for Pyodide go to the page of the
# release.
NAME = re.compile(
    r"delone-(?P<version>[^-]+)-(?P<tags>cp3\d+-(?:abi3|abi3t|abi3\.abi3t|cp3\d+t?)"
    r"-(?:(?:many|musl)linux|macosx_|win_(?:amd|arm)64|pyodide_|pyemscripten_|emscripten_)[\w.]*)\.whl"
)
# What users see beside the package on an index, and the links there.
FIELDS = ("Author", "Summary", "License-Expression", "Requires-Python", "Keywords")
LINKS = {"Homepage", "Documentation", "Changelog", "Repository", "Issues"}


def metadata_faults(text: str) -> list[str]:
    """What is wrong with the metadata of a wheel or an sdist, one phrase each."""
    stated = email.message_from_string(text)
    found = [f"no {field} in the metadata" for field in FIELDS if not stated[field]]
    version = check_release.versions()["Cargo.toml"]
    if (stated["Name"], stated["Version"]) != ("delone", version):
        found.append(f"is {stated['Name']} {stated['Version']}, not delone {version}")
    links = {link.split(",")[0] for link in stated.get_all("Project-URL", [])}
    found += [f"no link {name}" for name in sorted(LINKS - links)]
    if len(str(stated.get_payload())) < 1000:
        found.append("the README is not its description")
    if "markdown" not in str(stated["Description-Content-Type"]):
        found.append("the description is not said to be Markdown")
    needed = stated.get_all("Requires-Dist", [])
    hard = [need for need in needed if "extra ==" not in need]
    if hard != REQUIRED:
        found.append(f"requires {hard}, not {REQUIRED}")
    return found


def tag_faults(wheel: Path, stated: str) -> list[str]:
    """What is wrong with the name of a wheel, and with the tags in its file WHEEL."""
    match = NAME.fullmatch(wheel.name)
    if match is None:
        return ["no index takes a wheel with this name"]
    interpreter, abi, platforms = match["tags"].split("-")
    named = {f"{interpreter}-{a}-{p}" for a in abi.split(".") for p in platforms.split(".")}
    inside = set(email.message_from_string(stated).get_all("Tag", []))
    return [] if inside == named else [f"the tags inside are {sorted(inside)}"]


def faults(wheel: Path, *, audit: bool = True) -> list[str]:
    """What is wrong with one wheel, one phrase each; abi3audit is asked about the ABI."""
    found = []
    if wheel.stat().st_size > LARGEST:
        found.append(f"{wheel.stat().st_size:,} bytes, more than {LARGEST:,}")
    with zipfile.ZipFile(wheel) as opened:
        names = opened.namelist()
        found += [f"no {pattern}" for pattern in INSIDE if not fnmatch.filter(names, pattern)]
        [stated] = fnmatch.filter(names, "*.dist-info/METADATA")
        found += metadata_faults(opened.read(stated).decode())
        [tags] = fnmatch.filter(names, "*.dist-info/WHEEL")
        found += tag_faults(wheel, opened.read(tags).decode())
    if audit and "-abi3-" in wheel.name:
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
