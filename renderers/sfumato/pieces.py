"""Work in pieces: generators that yield the share done, 0 to 1, and return a result."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from typing import Generic, TypeVar

Result = TypeVar("Result")


class _Pieces(Generic[Result]):
    """What work yields, one share after the other; afterwards, what it returned."""

    result: Result

    def __init__(self, work: Generator[float, None, Result]) -> None:
        self._work = work

    def __iter__(self) -> Iterator[float]:
        self.result = yield from self._work


def spanned(work: Generator[float, None, Result], low: float, high: float) -> Generator[float, None, Result]:
    """Let a part's progress run from one share of the whole to another."""
    pieces = _Pieces(work)
    for done in pieces:
        yield low + (high - low) * done
    return pieces.result


def finished(work: Generator[float, None, Result], tell: Callable[[float], object] | None = None) -> Result:
    """Do all of it, telling the share done after each piece; returns the result."""
    pieces = _Pieces(work)
    for done in pieces:
        if tell is not None:
            tell(done)
    return pieces.result


__all__ = ["finished", "spanned"]
