"""Small pictures of scenes, drawn while the worker has nothing better to do.

A control wants a group of them (the rigs, the presets); each comes back as a signal. They never slow the
picture: the worker takes one up only when the still picture is finished, gives it up within one piece when
the window wants to see something, and takes it up again later. A control that is hidden forgets its wishes.
"""

from __future__ import annotations

import dataclasses
import weakref
from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from typing import Any

from qtpy.QtCore import QObject, Signal
from qtpy.QtGui import QImage

from sfumato import Scene, Volume
from sfumato.techniques.frame import Quality

from .jobs import ThumbnailRequest
from .worker import RenderWorker


@dataclass(frozen=True)
class _Look:
    """What a thumbnail shows; the volume is not kept alive by it, nor hashed for it."""

    volume: weakref.ref[Volume] | None
    rest: tuple[Any, ...]
    size: tuple[int, int]
    exposed: bool

    @staticmethod
    def of(scene: Scene, size: tuple[int, int], exposed: bool = False) -> _Look:
        names = (f.name for f in dataclasses.fields(scene) if f.name != "volume")
        volume = None if scene.volume is None else weakref.ref(scene.volume)
        return _Look(volume, tuple(getattr(scene, name) for name in names), size, exposed)

    def same(self, other: _Look) -> bool:
        mine, theirs = (look.volume() if look.volume is not None else None for look in (self, other))
        return (
            mine is theirs
            and mine is not None
            and (self.rest, self.size, self.exposed)
            == (
                other.rest,
                other.size,
                other.exposed,
            )
        )


class Thumbnails(QObject):
    """Wishes for small pictures by group and key, on the window's thread."""

    #: A picture is there: its group, its key and the QImage, whose size is in device pixels.
    ready = Signal(str, object, object)

    def __init__(self, worker: RenderWorker, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._worker = worker
        self._wanted: dict[str, dict[Hashable, _Look]] = {}
        self._drawn: dict[tuple[str, Hashable], tuple[_Look, QImage]] = {}
        worker.thumbnail.connect(self._on_thumbnail)

    @property
    def idle(self) -> bool:
        """Whether every picture that was wanted is there."""
        return not any(self._wanted.values())

    def want(
        self,
        group: str,
        scenes: Mapping[Hashable, Scene],
        size: tuple[int, int],
        *,
        quality: Quality | None = None,
        frames: int = 0,
        first: bool = False,
        timed: bool = False,
        exposed: bool = False,
    ) -> None:
        """Want pictures of scenes, instead of all that this group still wants.

        A picture of the same scene that is there already is told at once.

        Parameters
        ----------
        group : str
            Name of who wants them.
        scenes : mapping
            A scene for each key, in the order in which they are to be drawn; each needs a volume.
        size : (int, int)
            Width and height in device pixels.
        quality, frames : Quality, int
            Those of a small picture, if not given.
        first : bool
            Whether they are drawn before those of other groups, and as soon as there is a picture.
        timed : bool
            Whether the images are to say how long a frame takes (text "seconds").
        exposed : bool
            Whether they are to have an automatic exposure, and to say it in stops (text "exposure").
        """
        looks = {key: _Look.of(scene, size, exposed) for key, scene in scenes.items()}
        known = {key: self._known(group, key, look) for key, look in looks.items()}
        open_wishes = {key: scene for key, scene in scenes.items() if known[key] is None}
        self._wanted[group] = {key: looks[key] for key in open_wishes}
        self._worker.want_thumbnails(
            group,
            [
                ThumbnailRequest(group, key, scene, size, quality, frames, timed, exposed, first)
                for key, scene in open_wishes.items()
            ],
            first,
        )
        for key, image in known.items():
            if image is not None:
                self.ready.emit(group, key, image)

    def forget(self, group: str) -> None:
        """Want nothing more for a group."""
        self._wanted.pop(group, None)
        self._worker.want_thumbnails(group, [])

    def _known(self, group: str, key: Hashable, look: _Look) -> QImage | None:
        drawn = self._drawn.get((group, key))
        return drawn[1] if drawn is not None and drawn[0].same(look) else None

    def _on_thumbnail(self, request: ThumbnailRequest, image: QImage) -> None:
        """Tell a picture, unless the wish for it was replaced while it came here."""
        wanted = self._wanted.get(request.group, {})
        look = wanted.get(request.key)
        if look is None or not look.same(_Look.of(request.scene, request.size, request.exposed)):
            return
        del wanted[request.key]
        self._drawn[request.group, request.key] = look, image
        self.ready.emit(request.group, request.key, image)
