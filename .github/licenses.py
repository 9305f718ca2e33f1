"""The licenses of the Rust packages that are compiled into the wheels, as one file.

``python .github/licenses.py`` writes LICENSE-THIRD-PARTY, ``--check`` compares it. Read from
``cargo metadata`` and from the sources that Cargo has fetched: what the extension module links on
any platform, without build scripts, macros that run at compile time, and tests. A license that is
not in `ALLOWED`, or a package without its text, is an error.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
WRITTEN = ROOT / "LICENSE-THIRD-PARTY"
MODULE = "delone-bindings"
ALLOWED = {"MIT", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "Zlib", "Unlicense", "Unicode-3.0"}
ALLOWED |= {"Apache-2.0 WITH LLVM-exception"}
HEAD = """\
The compiled module delone._core contains, besides delone, the Rust packages below and Rust's
standard library, which is under MIT OR Apache-2.0. Of licenses joined by OR, delone uses MIT, or
the first that is listed. The text of Apache-2.0 is in LICENSE-APACHE.
Made by .github/licenses.py.
"""


def metadata() -> dict[str, Any]:
    command = ["cargo", "metadata", "--format-version=1", "--locked"]
    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def linked(found: dict[str, Any]) -> list[dict[str, Any]]:
    """The packages of other authors that end up in the module."""
    packages = {package["id"]: package for package in found["packages"]}
    nodes = {node["id"]: node for node in found["resolve"]["nodes"]}
    todo = [ident for ident, package in packages.items() if package["name"] == MODULE]
    seen: set[str] = set()
    while todo:
        ident = todo.pop()
        kinds = {kind for target in packages[ident]["targets"] for kind in target["kind"]}
        if ident in seen or "proc-macro" in kinds:
            continue
        seen.add(ident)
        for needed in nodes[ident]["deps"]:
            if any(kind["kind"] is None for kind in needed["dep_kinds"]):
                todo.append(needed["pkg"])
    others = [packages[ident] for ident in seen if packages[ident]["source"] is not None]
    return sorted(others, key=lambda package: (package["name"], package["version"]))


def choice(package: dict[str, Any]) -> str:
    """The license that is used, of those offered."""
    offered = package["license"].replace("/", " OR ").strip("()").split(" OR ")
    names = [name.strip(" ()") for name in offered]
    allowed = [name for name in names if set(name.split(" AND ")) <= ALLOWED]
    if not allowed:
        raise SystemExit(f"{package['name']}: {package['license']} is not allowed")
    return "MIT" if "MIT" in allowed else allowed[0]


def text(package: dict[str, Any], license_used: str) -> str:
    folder = Path(package["manifest_path"]).parent
    files = sorted(path for path in folder.iterdir() if path.name[:3].upper() in ("LIC", "COP"))
    kind = license_used.partition("-")[0].upper()
    wanted = [path for path in files if kind in path.name.upper()]
    general = [path for path in files if path.stem.upper() in ("LICENSE", "LICENCE", "COPYING")]
    for path in [*wanted, *general]:
        return path.read_text(encoding="utf-8").strip()
    if license_used == "Apache-2.0":
        return "The text is in LICENSE-APACHE."
    raise SystemExit(f"{package['name']}: no text of {license_used} in {[f.name for f in files]}")


def written() -> str:
    """All of them, each text once."""
    by_text: dict[str, list[str]] = {}
    for package in linked(metadata()):
        used = choice(package)
        name = f"{package['name']} {package['version']} ({package['license']}), used under {used}"
        by_text.setdefault(text(package, used), []).append(name)
    parts = ["\n".join(names) + "\n\n" + body for body, names in by_text.items()]
    return HEAD + "".join(f"\n{'-' * 99}\n{part}\n" for part in parts)


def main() -> None:
    if "--check" not in sys.argv[1:]:
        WRITTEN.write_text(written(), encoding="utf-8")
    elif WRITTEN.read_text(encoding="utf-8") != written():
        raise SystemExit(f"{WRITTEN.name} is out of date: python .github/licenses.py")


if __name__ == "__main__":
    main()
