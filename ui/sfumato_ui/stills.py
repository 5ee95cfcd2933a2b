"""Finished still pictures: what was drawn to the end a moment ago, and is wanted again, is there at once.

Undo and redo, the picture without light and back, and kept views go to and fro between few pictures. They lie in
main memory, as images; the frames of the last one, which can yet be changed, are in `refinement`.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from sfumato.techniques.frame import Quality

from .jobs import Picture, ViewRequest

#: How many are kept at most, and in how many bytes.
MOST = 16
MOST_BYTES = 256 << 20


class Stills:
    """The last finished pictures of one volume, of which those that were not seen for longest go first."""

    def __init__(self) -> None:
        self._volume: Any = None
        #: What each depends on, and the picture; the one that was seen last comes last.
        self._pictures: list[tuple[Any, Picture]] = []

    def keep(self, request: ViewRequest, quality: Quality, picture: Picture | None) -> None:
        """Keep a finished picture of what was requested; an audit's are not kept."""
        if picture is None or not picture.settled or picture.audit is not None:
            return
        self._take_out(request, quality)
        self._pictures.append((_key_of(request, quality), picture))
        while len(self._pictures) > MOST or self._bytes > MOST_BYTES:
            del self._pictures[0]

    def find(self, request: ViewRequest, quality: Quality) -> Picture | None:
        """Return the finished picture of what is requested, if it is there."""
        found = None if request.audit > 0 else self._take_out(request, quality)
        if found is None:
            return None
        self._pictures.append((_key_of(request, quality), found))
        return replace(found, scene=request.scene, interactive=request.interactive)

    def _take_out(self, request: ViewRequest, quality: Quality) -> Picture | None:
        """Take out a picture, and let go of all that are of another volume: they would keep its data."""
        if request.scene.volume is not self._volume:
            self._pictures.clear()
            self._volume = request.scene.volume
        key = _key_of(request, quality)
        found = next((picture for its, picture in self._pictures if its == key), None)
        self._pictures = [(its, picture) for its, picture in self._pictures if its != key]
        return found

    @property
    def _bytes(self) -> int:
        return sum(picture.image.sizeInBytes() for _, picture in self._pictures)


def _key_of(request: ViewRequest, quality: Quality) -> Any:
    """Return all that the finished picture depends on."""
    return request.scene.with_(bookmarks=()), request.size, request.frames, quality
