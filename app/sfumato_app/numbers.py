"""Numbers on the command line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from cyclopts import Token


def whole(_kind: Any, tokens: Sequence[Token]) -> int:
    """Read a whole number; cyclopts by itself takes 1.5 as 1."""
    return int(tokens[0].value)
