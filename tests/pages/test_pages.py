"""The code on the pages of the documentation is run: as doctests, by commands, or when built.

`make test` runs what has prompts (``--doctest-glob``), and `make docs` what plots include. What is
left are blocks without prompts: Python must compile and is listed here with the reason why it is
not run; of commands, the options must exist.
"""

from __future__ import annotations

import doctest
import re
import shlex
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator

DOCS = Path(__file__).parents[2] / "docs"
# The generated folders hold copies, and the folder of pictures holds functions for plots.
PAGES = [
    path
    for path in sorted(DOCS.rglob("*.rst"))
    if not {"_build", "generated", "gallery", "_templates"} & set(path.relative_to(DOCS).parts)
]
BLOCK = re.compile(
    r"^(?P<indent> *)\.\. (?P<kind>code-block|code|sourcecode|plot)::(?P<argument>[^\n]*)\n"
    r"(?P<body>(?:(?P=indent) +[^\n]*\n|[ ]*\n)+)",
    re.MULTILINE,
)

# Python that a test cannot run: the page and the start of the block, and why.
NOT_RUN = {
    ("guide/tiles.rst", "from dask.distributed import"): "starts a cluster; tests/distributed does",
}


def name_of(path: Path) -> str:
    return path.relative_to(DOCS).as_posix()


def blocks(path: Path) -> Iterator[tuple[str, str, str]]:
    """The kind, the argument and the text of each block of a page, without options."""
    for match in BLOCK.finditer(path.read_text(encoding="utf-8") + "\n"):
        lines = match["body"].splitlines()
        rest = [line for line in lines if not re.match(r" +:[a-z-]+:", line)]
        indent = min((len(line) - len(line.lstrip()) for line in rest if line.strip()), default=0)
        yield match["kind"], match["argument"].strip(), "\n".join(r[indent:] for r in rest).strip()


def test_pages_and_blocks_are_found() -> None:
    assert {"index.rst", "guide/tiles.rst"} <= {name_of(path) for path in PAGES}
    kinds = {(kind, argument) for path in PAGES for kind, argument, _ in blocks(path)}
    assert {("plot", ""), ("code-block", "console")} <= kinds


@pytest.mark.parametrize("path", PAGES, ids=name_of)
def test_python_has_prompts_so_that_it_is_run(path: Path) -> None:
    for kind, argument, text in blocks(path):
        if kind == "plot" or argument not in ("python", "py", "python3"):
            continue
        if doctest.DocTestParser().get_examples(text):
            continue
        compile(text, str(path), "exec")
        reasons = [
            why
            for (page, start), why in NOT_RUN.items()
            if page == name_of(path) and text.startswith(start)
        ]
        assert reasons, f"write this with prompts (>>>), so that it is run:\n{text}"


@pytest.mark.parametrize("path", PAGES, ids=name_of)
def test_plots_have_texts(path: Path) -> None:
    """A picture that is not seen is read."""
    text = path.read_text(encoding="utf-8")
    starts = [
        m.end() for m in re.finditer(r"^ *\.\. (?:plot|image|figure)::.*\n", text, re.MULTILINE)
    ]
    for start in starts:
        options = text[start:].split("\n\n", 1)[0]
        assert ":alt:" in options or ":nofigs:" in options, text[start - 60 : start + 60]


def commands(path: Path) -> Iterator[str]:
    """The commands of delone on a page, continued lines joined."""
    for _, argument, text in blocks(path):
        if argument in ("console", "shell", "sh", "bash"):
            for line in text.replace("\\\n", " ").splitlines():
                if line.startswith("$ delone "):
                    yield line.removeprefix("$ ")


COMMANDS = [
    pytest.param(command, id=f"{name_of(path)}:{command}")
    for path in PAGES
    for command in dict.fromkeys(commands(path))
]


@pytest.mark.parametrize("command", COMMANDS)
def test_commands_have_options_that_exist(command: str) -> None:
    """Each subcommand and each option of a shown command is one of the command line."""
    typer = pytest.importorskip("typer")
    from delone.cli.app import app

    group = typer.main.get_command(app)
    words = shlex.split(command, comments=True)[1:]
    sub = group.commands[words[0]]
    known = {name for option in sub.params for name in (*option.opts, *option.secondary_opts)}
    used = {word.partition("=")[0] for word in words[1:] if re.match(r"--?[a-z3]", word)}
    assert used <= known | {"--help"}
