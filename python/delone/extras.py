"""Lazy imports of optional libraries; errors name the extra to install."""

from __future__ import annotations

import importlib
from typing import Any

from delone.errors import MissingExtraError

__all__ = ["require"]


def require(module: str, *, extra: str, what: str) -> Any:
    """Import an optional library, or say how to install it.

    Parameters
    ----------
    module : str
        Dotted name of the module.
    extra : str
        The extra of delone that installs it.
    what : str
        What needs it, to begin a sentence: ``"reading LAZ"``.

    Returns
    -------
    module
        The module.

    Raises
    ------
    MissingExtraError
        The library, or one that it requires, is not installed or cannot be imported.

    Examples
    --------
    >>> from delone.extras import require
    >>> require("json", extra="las", what="this example").__name__
    'json'
    """
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        library = (error.name or module).partition(".")[0]
        message = f'{what} needs {library}, which is not installed: pip install "delone[{extra}]"'
        raise MissingExtraError(message, extra=extra) from error
    except ImportError as error:
        message = f"{what} needs {module}, which is installed but cannot be imported: {error}"
        raise MissingExtraError(message, extra=extra) from error
