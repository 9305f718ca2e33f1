"""The list of commands: complete, the same as in the modules, and loaded when needed."""

from __future__ import annotations

import inspect
import subprocess
import sys
from importlib import import_module

import pytest

from delone.cli.commands import COMMANDS, TASKS


@pytest.mark.parametrize("name", COMMANDS)
def test_summaries_are_those_of_the_functions(name, command):
    listed = COMMANDS[name]
    function = getattr(import_module(f"delone.cli.{listed.module}"), listed.function)
    summary = inspect.cleandoc(function.__doc__).partition("\n\n")[0]
    assert " ".join(summary.split()) == listed.summary
    code, out, _ = command(name, "--help")
    assert code == 0 and listed.summary in " ".join(out.split())


def test_every_module_with_a_command_is_listed(command):
    _, out, _ = command("--help")
    assert all(f"\n  {name} " in out for name in COMMANDS)
    assert command("unknown")[0] == 2
    assert command("contour")[2] == "delone: No such command 'contour'. Did you mean 'contours'?\n"


@pytest.mark.parametrize("columns", ["60", "80", "200"])
def test_help_shows_whole_summaries_by_task(command, monkeypatch, columns):
    monkeypatch.setenv("COLUMNS", columns)
    assert sorted(name for names in TASKS.values() for name in names) == sorted(COMMANDS)
    _, out, _ = command("--help")
    text, at = " ".join(out.partition("Exit codes:")[0].split("--help")[1].split()), 0
    assert "..." not in text
    for task, names in TASKS.items():
        for wanted in (f"{task}:", *(f"{name} {COMMANDS[name].summary}" for name in names)):
            assert wanted in text[at:]
            at = text.index(wanted, at)


def test_help_loads_no_command():
    code = (
        "import sys; from delone.cli import run; run(['--help']);"
        "print(*(name for name in sys.modules if name.startswith('delone.')))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.splitlines()[-1].split())
    assert "delone.cli.commands" in loaded
    assert not loaded & {f"delone.cli.{listed.module}" for listed in COMMANDS.values()}
    assert not loaded & {"delone.io", "delone.voronoi", "delone.terrain", "delone.distributed"}


# Commands whose module has another name: those that share one, and what makes a whole site.
OTHERS = {
    "crossval": "interpolate",
    "contours": "terrain",
    "profile": "terrain",
    "volume": "terrain",
    "terrain": "site",
}


@pytest.mark.parametrize("name", COMMANDS)
def test_the_module_of_a_command_has_its_name(name: str) -> None:
    assert COMMANDS[name].module == OTHERS.get(name, name)
