"""What a thread tells the window, which may be gone by then."""

from __future__ import annotations

from contextlib import suppress
from typing import Any


def tell(signal: Any, *values: object) -> None:
    """Emit a signal from a thread; nothing happens if its owner was deleted in the meantime."""
    with suppress(RuntimeError):  # Signal source has been deleted
        signal.emit(*values)
