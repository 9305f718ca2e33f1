"""The command ``delone``: reads files, calls the public interface, and reports.

`app` has the commands and their options, `report` the figures, `show` their output, `exits` the
exit codes. Needs typer and rich (extra ``cli``).
"""

from delone.cli.app import run

__all__ = ["run"]
