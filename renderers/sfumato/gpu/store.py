"""What is kept on the GPU for the next frame, by content key, within a byte budget."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Any, TypeVar

T = TypeVar("T")

#: Bytes kept beyond what the current frame needs.
DEFAULT_BUDGET = 2 << 30


class Store:
    """A least-recently-used cache of GPU objects (anything with ``release()``) and of tables on the CPU."""

    def __init__(self, budget: int = DEFAULT_BUDGET) -> None:
        self.budget = budget
        self._items: OrderedDict[Hashable, tuple[Any, int]] = OrderedDict()

    def get(self, key: Hashable, make: Callable[[], T], size: Callable[[T], int] | int = 0) -> T:
        """Return what is kept under a key, or make and keep it.

        Parameters
        ----------
        key : hashable
            Content key; starts with a word that says what the thing is.
        make : callable
            Makes the thing.
        size : callable or int
            Its bytes on the GPU.
        """
        if key in self._items:
            self._items.move_to_end(key)
            return self._items[key][0]  # type: ignore[no-any-return]
        self._make_room()
        thing = make()
        self._items[key] = (thing, size(thing) if callable(size) else size)
        return thing

    def _make_room(self) -> None:
        while self._items and self.bytes_in_use > self.budget:
            _, (old, _) = self._items.popitem(last=False)
            _release(old)

    def drop(self, predicate: Callable[[Hashable], bool]) -> None:
        """Free everything whose key satisfies a predicate."""
        for key in [k for k in self._items if predicate(k)]:
            _release(self._items.pop(key)[0])

    @property
    def bytes_in_use(self) -> int:
        """Bytes of all that is kept."""
        return sum(size for _, size in self._items.values())

    def listing(self) -> list[tuple[str, int]]:
        """Return what is kept and its bytes, the largest first."""
        rows = [
            (str(key[0] if isinstance(key, tuple) else key), size) for key, (_, size) in self._items.items()
        ]
        return sorted(rows, key=lambda row: -row[1])

    def clear(self) -> None:
        """Free everything."""
        self.drop(lambda _: True)


def _release(thing: Any) -> None:
    for part in thing if isinstance(thing, tuple) else (thing,):
        if hasattr(part, "release"):
            part.release()
