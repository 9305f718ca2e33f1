"""The examples of the gallery: their folders in order, what each needs, and which are left out.

The docstring of an example says what to install, for example ``pip install "delone[plot,fem]"``. An
example is left out of the gallery where one of these packages is missing; the build says so.
"""

from __future__ import annotations

import ast
import re
import tomllib
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import TYPE_CHECKING, Any

from packaging.requirements import Requirement
from sphinx.errors import ExtensionError
from sphinx.util import logging

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
FOLDERS = (
    "points",
    "terrain",
    "constraints",
    "meshes",
    "voronoi",
    "interpolation",
    "climate",
    "solids",
    "neighbors",
    "large",
)
INSTALL = re.compile(r"``pip install ([^`]+)``")


def examples() -> list[Path]:
    """Return all examples."""
    return sorted(EXAMPLES.glob("*/*.py"))


def requirements(path: Path) -> Iterator[Requirement]:
    """Return what the docstring of an example asks to install, with the extras resolved."""
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    docstring = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    for command in INSTALL.findall(docstring):
        for word in command.split():
            wanted = Requirement(word.strip("\"'"))
            if wanted.name != "delone":
                yield wanted
            for extra in sorted(wanted.extras):
                yield from map(Requirement, extras["project"]["optional-dependencies"][extra])


def missing(path: Path) -> list[str]:
    """Return the packages that an example needs and that are not installed."""
    names = []
    for wanted in requirements(path):
        try:
            distribution(wanted.name)
        except PackageNotFoundError:
            names.append(wanted.name)
    return names


def left_out_pattern() -> str:
    """Return the regular expression of the examples that cannot run here."""
    names = [f"{path.parent.name}/{path.name}" for path in examples() if missing(path)]
    return "|".join(f"/{re.escape(name)}$" for name in names) or r"__init__\.py"


def scrapers() -> tuple[Any, ...]:
    """Return what collects the figures of an example: matplotlib."""
    return ("matplotlib",)


def reset(gallery_conf: dict[str, Any], path: str) -> None:
    """Give all figures of the gallery the same size."""
    del gallery_conf, path
    import matplotlib.pyplot as plt

    plt.rcParams.update({"figure.figsize": (7, 4.6), "figure.dpi": 110})


def report(app: Any) -> None:
    """Say which examples are left out, and fail if none is left."""
    del app
    everything = examples()
    lacking = {path: names for path in everything if (names := missing(path))}
    if len(lacking) == len(everything):
        raise ExtensionError("no example can run here: install the extras of delone")
    for path, names in lacking.items():
        # A plain print: the line appears also where the build is quiet.
        print(f"gallery: without {path.parent.name}/{path.name}, which needs {', '.join(names)}")
    logging.getLogger(__name__).info("gallery: %d examples", len(everything) - len(lacking))
