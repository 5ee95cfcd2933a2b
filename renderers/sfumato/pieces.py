"""Work in pieces: generators that yield the share done, 0 to 1, and return a result."""

from __future__ import annotations

from collections.abc import Callable, Generator
from typing import TypeVar

Result = TypeVar("Result")


def spanned(work: Generator[float, None, Result], low: float, high: float) -> Generator[float, None, Result]:
    """Let a part's progress run from one share of the whole to another."""
    while True:
        try:
            done = next(work)
        except StopIteration as stop:
            result: Result = stop.value
            return result
        yield low + (high - low) * done


def finished(work: Generator[float, None, Result], tell: Callable[[float], object] | None = None) -> Result:
    """Do all of it, telling the share done after each piece; returns the result."""
    while True:
        try:
            done = next(work)
        except StopIteration as stop:
            result: Result = stop.value
            return result
        if tell is not None:
            tell(done)


__all__ = ["finished", "spanned"]
