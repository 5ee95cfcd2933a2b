"""What is measured: something that draws one finished frame of a setting."""

from __future__ import annotations

from typing import Protocol

import numpy as np


class Contender(Protocol):
    """Draws one setting in one way; what happens once is done when it is made or warmed up."""

    def settle(self) -> None:
        """Bring back what others have pushed out of the budget of kept light; called before each turn, not timed."""
        ...

    def draw(self) -> None:
        """Draw one frame of full quality and wait until it is finished."""
        ...

    def light(self) -> np.ndarray:
        """Draw a frame and return linear light, float32 in [0, 1], shape (height, width, 3), row 0 on top."""
        ...


class Unavailable(Exception):  # noqa: N818 - not an error: the row is left out and says why
    """A contender cannot take part here; the message says why."""
