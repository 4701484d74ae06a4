"""Failures of operators: one line for the user, never a traceback."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Iterator
from typing import Any

from ..ski_addon.errors import SkiAddonError, one_line

_LOG = logging.getLogger(__name__)


class Failed(Exception):  # noqa: N818 - caught by every operator
    """The operator has reported its failure and is to return {'CANCELLED'}."""


@contextlib.contextmanager
def reported(operator: Any) -> Iterator[None]:
    """Report whatever fails within as one line by `operator`, and raise `Failed`."""
    try:
        yield
    except SkiAddonError as error:
        operator.report({"ERROR"}, str(error))
        raise Failed(str(error)) from error
    except ImportError as error:
        line = f"a part of the add-on is missing ({error}): install the Ski Addon zip for this system again"
        operator.report({"ERROR"}, one_line(line))
        raise Failed(line) from error
    except Exception as error:
        _LOG.exception("unexpected failure")
        line = one_line(f"unexpected {type(error).__name__}: {error}")
        operator.report({"ERROR"}, line)
        raise Failed(line) from error
