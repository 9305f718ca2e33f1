"""Lazy imports of optional libraries; errors name the extra to install."""

from __future__ import annotations

import importlib
from typing import Any

from delone.errors import MissingExtraError

__all__ = ["require"]


def require(module: str, *, extra: str, what: str) -> Any:
    """Import an optional library for `what` ("reading LAZ"), or name the extra to install."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        library = (error.name or module).partition(".")[0]
        message = f'{what} needs {library}, which is not installed: pip install "delone[{extra}]"'
        raise MissingExtraError(message, extra=extra) from error
    except ImportError as error:
        message = f"{what} needs {module}, which is installed but cannot be imported: {error}"
        raise MissingExtraError(message, extra=extra) from error
