"""What is kept on the GPU for the next frame, by content key, within a byte budget."""

from __future__ import annotations

import os
from collections import OrderedDict
from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from typing import Any, Protocol, TypeVar

from ..errors import GpuError

T = TypeVar("T")

#: Bytes kept for frames to come, unless the user says otherwise.
DEFAULT_BUDGET = 2 << 30
#: Environment variable by which the user says so, in MiB.
VARIABLE = "SFUMATO_GPU_BUDGET_MB"
#: Smallest and largest budget in MiB.
LIMITS = (16, 1 << 20)


def user_budget() -> int:
    """Return the budget in bytes: ``SFUMATO_GPU_BUDGET_MB`` or `DEFAULT_BUDGET`.

    Raises
    ------
    GpuError
        If the variable holds anything but a whole number of MiB within `LIMITS`.
    """
    text = os.environ.get(VARIABLE, "").strip()
    if not text:
        return DEFAULT_BUDGET
    if not text.isdecimal() or not LIMITS[0] <= int(text) <= LIMITS[1]:
        low, high = LIMITS
        raise GpuError(f"{VARIABLE}={text}", f"a whole number of MiB from {low} to {high} is needed")
    return int(text) << 20


class Guest(Protocol):
    """Something that keeps GPU objects by itself, but within the store's budget."""

    @property
    def bytes_in_use(self) -> int:
        """Bytes of all that it keeps."""
        ...

    @property
    def bytes_needed(self) -> int:
        """Bytes of what it keeps for the frame that is being drawn."""
        ...

    def give_up(self, excess: int) -> None:
        """Free at least so many bytes, but nothing that the frame needs."""
        ...


class Store:
    """A least-recently-used cache of GPU objects (anything with ``release()``) and of tables on the CPU.

    What a frame that is being drawn has asked for stays, whatever the budget; all else is freed, the oldest
    first, as soon as there is more than the budget allows.

    Parameters
    ----------
    budget : int, optional
        Bytes, guests included; `user_budget` if not given.
    """

    def __init__(self, budget: int | None = None) -> None:
        self.budget = user_budget() if budget is None else budget
        self._items: OrderedDict[Hashable, tuple[Any, int]] = OrderedDict()
        self._guests: dict[str, list[Guest]] = {}
        self._frames = 0
        self._pinned: set[Hashable] = set()
        self.bytes_needed = 0

    @contextmanager
    def frame(self) -> Iterator[None]:
        """Keep whatever is asked for within the block until it ends; blocks may overlap."""
        self._frames += 1
        try:
            yield
        finally:
            self._frames -= 1
            if not self._frames:
                self.bytes_needed = self._count_needed()
                self._pinned.clear()

    def _count_needed(self) -> int:
        """Return the bytes of all that the frame asked for; `bytes_needed` keeps those of the latest one."""
        own = sum(size for key, (_, size) in self._items.items() if key in self._pinned)
        return own + sum(guest.bytes_needed for guests in self._guests.values() for guest in guests)

    def pin(self, key: Hashable) -> None:
        """Keep what is under a key, here or with a guest, while a frame is drawn."""
        if self._frames:
            self._pinned.add(key)

    def is_pinned(self, key: Hashable) -> bool:
        """Whether a frame that is being drawn needs what is under a key."""
        return key in self._pinned

    def admit(self, name: str, guest: Guest) -> None:
        """Count what a guest keeps as ours from now on, until `dismiss`."""
        self._guests.setdefault(name, []).append(guest)

    def dismiss(self, guest: Guest) -> None:
        """Forget a guest."""
        for guests in self._guests.values():
            if guest in guests:
                guests.remove(guest)

    def get(
        self,
        key: Hashable,
        make: Callable[[], T],
        size: Callable[[T], int] | int = 0,
        most: int | None = None,
    ) -> T:
        """Return what is kept under a key, or make and keep it.

        Parameters
        ----------
        key : hashable
            Content key; starts with a word that says what the thing is.
        make : callable
            Makes the thing.
        size : callable or int
            Its bytes on the GPU.
        most : int, optional
            So many whose keys start with the same word are kept, the newest: of small things that a drag makes anew
            with each move, a driver holds more than their bytes.
        """
        self.pin(key)
        if key in self._items:
            self._items.move_to_end(key)
            return self._items[key][0]  # type: ignore[no-any-return]
        self.make_room()
        thing = make()
        self._items[key] = (thing, size(thing) if callable(size) else size)
        self.make_room(key)
        if most is not None:
            self._keep_newest(key, most)
        return thing

    def _keep_newest(self, key: Hashable, most: int) -> None:
        """Free the oldest things whose keys start as one does, but for so many, and nothing that a frame needs."""
        alike = [other for other in self._items if _word(other) == _word(key)]
        for other in alike[:-most]:
            if other not in self._pinned:
                _release(self._items.pop(other)[0])

    def holds(self, key: Hashable) -> bool:
        """Tell whether something is kept under a key."""
        return key in self._items

    def make_room(self, newest: Hashable = None) -> None:
        """Free the oldest things until the budget is kept, but nothing that a frame needs; guests' things last."""
        for key in [key for key in self._items if key not in self._pinned and key != newest]:
            if self._excess <= 0:
                return
            _release(self._items.pop(key)[0])
        for guest in [guest for guests in self._guests.values() for guest in guests]:
            if self._excess > 0:
                guest.give_up(self._excess)

    @property
    def _excess(self) -> int:
        """Bytes above the budget."""
        return self.bytes_in_use + self.bytes_of_guests - self.budget

    def drop(self, predicate: Callable[[Hashable], bool]) -> None:
        """Free everything whose key satisfies a predicate."""
        for key in [k for k in self._items if predicate(k)]:
            _release(self._items.pop(key)[0])

    @property
    def bytes_in_use(self) -> int:
        """Bytes of all that is kept here."""
        return sum(size for _, size in self._items.values())

    @property
    def bytes_of_guests(self) -> int:
        """Bytes of all that guests keep."""
        return sum(guest.bytes_in_use for guests in self._guests.values() for guest in guests)

    def listing(self) -> list[tuple[str, int]]:
        """Return what is kept, guests included, and its bytes, the largest first."""
        rows = [(_word(key), size) for key, (_, size) in self._items.items()]
        rows += [(name, guest.bytes_in_use) for name, guests in self._guests.items() for guest in guests]
        return sorted(rows, key=lambda row: -row[1])

    def things(self) -> list[tuple[str, Any]]:
        """Return what is kept here, each with the word that its key begins with."""
        return [(_word(key), thing) for key, (thing, _) in self._items.items()]

    def clear(self) -> None:
        """Free everything; guests free what is theirs."""
        self.drop(lambda _: True)


def _word(key: Hashable) -> str:
    """Return the word that a key starts with: what is kept under it."""
    return str(key[0] if isinstance(key, tuple) else key)


def _release(thing: Any) -> None:
    for part in thing if isinstance(thing, tuple) else (thing,):
        if hasattr(part, "release"):
            part.release()
