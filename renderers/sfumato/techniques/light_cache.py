"""Light volumes that are kept, so that what does not move need not be swept again."""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Callable, Generator, Hashable, Iterator
from typing import Any

from ..gpu import Store

#: Bytes of textures that are kept; the lamps of the present frame are kept in any case.
BUDGET = 512 << 20
BYTES_PER_TEXEL = 4
#: Textures that are kept at most: three for each of sixteen lamps. Of small ones a driver holds more than their bytes.
MOST = 48
#: Part of a device's whole budget that light volumes may take.
SHARE = 0.25


class LightCache:
    """Least recently used textures by what was swept into them; old ones are swept over.

    Parameters
    ----------
    make : callable
        Makes a texture of a size.
    budget : int
        Bytes.
    bytes_per_texel : int
        Of its textures.
    store : Store, optional
        Whose budget these bytes are taken from, `SHARE` of it at most.
    """

    def __init__(
        self,
        make: Any,
        budget: int = BUDGET,
        store: Store | None = None,
        bytes_per_texel: int = BYTES_PER_TEXEL,
    ) -> None:
        self._make = make
        self._bytes = bytes_per_texel
        self._own_budget = budget
        self._store = store
        self._kept: OrderedDict[Hashable, Any] = OrderedDict()
        if store is not None:
            store.admit("light volumes", self)

    @property
    def budget(self) -> int:
        """Bytes of textures that may be kept."""
        return (
            self._own_budget
            if self._store is None
            else min(self._own_budget, int(self._store.budget * SHARE))
        )

    def swept(
        self,
        key: Hashable,
        size: tuple[int, int, int],
        sweep: Callable[[Any], Iterator[float]],
        in_use: int = 0,
    ) -> Generator[float, None, Any]:
        """Return the texture that holds a sweep; if none does, sweep into one, yielding the share done.

        A sweep that is given up leaves nothing behind. The `in_use` newest of those kept are left alone.
        """
        kept = self.find(key)
        if kept is not None:
            return kept
        texture, complete = self.take(size, in_use), False
        try:
            yield from sweep(texture)
            complete = True
        finally:
            if not complete:
                texture.release()
        self.keep(key, texture)
        return texture

    def find(self, key: Hashable) -> Any:
        """Return the texture that holds a sweep, or None."""
        if key in self._kept:
            self._kept.move_to_end(key)
            self._pin(key)
        return self._kept.get(key)

    def take(self, size: tuple[int, int, int], in_use: int) -> Any:
        """Return a texture of a size to sweep into; the `in_use` newest of those kept are left alone.

        It is not kept before `keep` says that the sweep is complete.
        """
        return self.make_room(size, in_use) or self._make(size)

    def make_room(self, size: tuple[int, int, int], in_use: int = 0) -> Any:
        """Give up old textures until one of a size fits; returns one that has that size already, or None."""
        wanted = math.prod(size) * self._bytes
        while len(self._kept) > in_use and (
            self.bytes_in_use + wanted > self.budget or len(self._kept) >= MOST
        ):
            _, old = self._kept.popitem(last=False)
            if old.size == size:
                return old
            old.release()
        return None

    def keep(self, key: Hashable, texture: Any) -> None:
        """Keep a texture whose sweep is complete."""
        self._kept[key] = texture
        self._pin(key)
        if self._store is not None:
            self._store.make_room()

    def _pin(self, key: Hashable) -> None:
        if self._store is not None:
            self._store.pin((id(self), key))

    def _needed(self, key: Hashable) -> bool:
        return self._store is not None and self._store.is_pinned((id(self), key))

    def give_up(self, excess: int) -> None:
        """Free the oldest textures, at least so many bytes, but none that the frame being drawn needs."""
        for key in [key for key in self._kept if not self._needed(key)]:
            if excess <= 0:
                return
            texture = self._kept.pop(key)
            excess -= self._size(texture)
            texture.release()

    @property
    def bytes_in_use(self) -> int:
        """Bytes of all that is kept."""
        return sum(self._size(texture) for texture in self._kept.values())

    @property
    def bytes_needed(self) -> int:
        """Bytes of what is kept for the frame that is being drawn."""
        return sum(self._size(texture) for key, texture in self._kept.items() if self._needed(key))

    def _size(self, texture: Any) -> int:
        return int(math.prod(texture.size)) * self._bytes

    def release(self) -> None:
        """Free everything."""
        if self._store is not None:
            self._store.dismiss(self)
        self.clear()

    def clear(self) -> None:
        """Free all textures; it can be used again."""
        for texture in self._kept.values():
            texture.release()
        self._kept.clear()
