"""Entry point of the command ``delone`` and of ``python -m delone``.

The command needs the extra ``cli``; without it, a one-line message says so.
"""

from __future__ import annotations

import sys

__all__ = ["main"]

_MISSING_EXTRA = 6  # as in `delone.cli.exits`, which cannot be imported then


def main() -> None:
    """Run the command and exit with one of the codes that ``--help`` lists."""
    try:
        import rich  # noqa: F401
        import typer  # noqa: F401
    except ImportError as error:
        line = f'the command needs {error.name}, which is not installed: pip install "delone[cli]"'
        print(f"delone: {line}", file=sys.stderr)
        raise SystemExit(_MISSING_EXTRA) from None
    from delone.cli import run

    raise SystemExit(run(sys.argv[1:]))


if __name__ == "__main__":
    main()
