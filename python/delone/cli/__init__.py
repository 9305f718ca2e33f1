"""The command ``delone``: reads files, calls the public interface, and reports.

`app` is the command line, `commands` the list of commands, `report` computes the figures, `show`
prints them, and `exits` defines the exit codes. Needs typer and rich (extra ``cli``).
"""

from delone.cli.app import run

__all__ = ["run"]
