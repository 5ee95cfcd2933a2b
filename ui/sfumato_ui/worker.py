"""The thread that renders: it always takes the newest request, and nobody waits for it.

While the user interacts, a request is drawn once at drag quality, and finished even if a newer one is
there: a hand that keeps moving must see pictures. When the scene is still, full quality follows and
jittered frames accumulate; that work is dropped within one piece (some 50 ms) when a newer scene comes.
What waits for a picture at rest (thumbnails, exposures) is drawn between those frames.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import replace
from typing import Any

from qtpy.QtCore import QObject, QThread, Signal

from sfumato import GpuError, Scene
from sfumato.exposure import exposure_for
from sfumato.techniques.frame import DRAG, FULL, Quality

from .jobs import (
    Picture,
    SaveRequest,
    ThumbnailRequest,
    ViewRequest,
    image_from,
    image_of,
)
from .refinement import Refinement
from .settings import gpu_budget
from .stills import Stills
from .wording import one_line, remedy_of

#: Qualities while the user drags, finest first; the worker keeps to the finest that is quick enough.
DRAG_LADDER = (
    DRAG,
    Quality(scale=0.35, step=3.0, light=3.0, progressive=True),
    Quality(scale=0.25, step=4.0, light=4.0, progressive=True),
)
#: Still pictures: light that takes long comes by and by, and is seen to.
STILL = replace(FULL, progressive=True)
#: A drag frame slower than this, in seconds, makes the next one coarser; one quicker than a fifth, finer.
DRAG_SECONDS = 0.25
#: Quality and jittered frames of thumbnails.
THUMBNAIL = Quality(step=3.0, light=3.0, progressive=True)
THUMBNAIL_FRAMES = 2
#: A drag's frame that takes longer than this, in seconds, shows its progress.
SLOW_SECONDS = 0.5
#: Seconds for which a picture is to be at rest before thumbnails are drawn between its frames.
IDLE_SECONDS = 1.0


class RenderWorker(QObject):
    """Owns the renderer and its thread; the methods are called from the window's thread."""

    #: A picture, told in the window's thread: all who listen hear of it within one event.
    picture = Signal(object)
    progress = Signal(float)
    #: The renderer is there (its name).
    ready = Signal(str)
    #: Something went wrong: one line, and what would help (as in `GpuError`); the worker lives on.
    failed = Signal(str, str)
    saved = Signal(str)
    save_progress = Signal(float)
    save_cancelled = Signal()
    #: A file could not be written: one line; the view is not affected.
    save_failed = Signal(str)
    #: A thumbnail is drawn (its request, the QImage).
    thumbnail = Signal(object, object)
    #: The thread's word for `picture`: emitted there, each listener would get an event of its own, and for a moment
    #: the viewport would show what the status line, the history and the messages know nothing of.
    _drawn = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self._drawn.connect(self.picture)
        self._renderer: Any = None
        self._wake = threading.Condition()
        self._view: ViewRequest | None = None
        self._save: SaveRequest | None = None
        self._cancel_save = False
        self._thumbnails: list[ThumbnailRequest] = []
        #: Whether the still picture of the newest view is finished.
        self._settled = False
        #: The frames of the last still picture.
        self._kept: Refinement | None = None
        self._stills = Stills()
        #: The last picture that the window was told of.
        self._shown: Picture | None = None
        self._stopping = False
        #: The coarsest at first: how quick the device is, is not known, and the first picture must be soon.
        self._rung = len(DRAG_LADDER) - 1
        self._scale = 1.0
        self._thread = threading.Thread(target=self._run, name="sfumato-render", daemon=True)

    # -- called by the window ---------------------------------------------------------------------
    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def show(self, request: ViewRequest) -> None:
        """Ask for a picture; an older wish that has not begun is forgotten."""
        with self._wake:
            self._view = request
            self._wake.notify()

    def save(self, request: SaveRequest) -> None:
        """Ask for a picture to be written."""
        with self._wake:
            self._save, self._cancel_save = request, False
            self._wake.notify()

    def cancel_save(self) -> None:
        """Give up the picture that is being written."""
        self._cancel_save = True

    @property
    def scale(self) -> float:
        """Part of the window's resolution that is drawn."""
        return self._scale

    def set_scale(self, scale: float) -> None:
        """Draw what follows at a part (0 to 1) of the window's resolution: the device has no room for more."""
        self._scale = scale

    def want_thumbnails(self, group: str, requests: list[ThumbnailRequest], first: bool = False) -> None:
        """Ask for small pictures when there is nothing else to do, instead of all others of their group."""
        with self._wake:
            others = [r for r in self._thumbnails if r.group != group]
            self._thumbnails = requests + others if first else others + requests
            self._wake.notify()

    def ask_to_stop(self) -> None:
        """Ask the thread to end after the piece of work that it is in."""
        with self._wake:
            self._stopping = True
            self._wake.notify()

    @property
    def alive(self) -> bool:
        """Whether the thread still runs."""
        return self._thread.is_alive()

    # -- the thread -------------------------------------------------------------------------------
    def _run(self) -> None:
        # Qt adopts this thread for the length of its signals; the window's thread has precedence.
        QThread.currentThread()
        try:
            while not self._stopping:
                self._next_job()
        finally:
            if self._renderer is not None:
                self._forget()
                self._renderer.close()

    def _next_job(self) -> None:
        with self._wake:
            while not (self._stopping or self._view or self._save or self._next_thumbnail):
                self._wake.wait()
            save, self._save = self._save, None
            view = thumbnail = None
            if save is None:
                thumbnail = self._next_thumbnail if self._view is None else None
                view, self._view = self._view, None
                self._settled = self._settled and view is None
        if self._stopping:
            return
        try:
            self._serve_twice(save, view, thumbnail)
        except Exception as error:
            if not self._stopping and save is not None:
                self.save_failed.emit(one_line(error))
            elif not self._stopping:
                self.failed.emit(one_line(error), remedy_of(error))

    def _serve_twice(
        self, save: SaveRequest | None, view: ViewRequest | None, thumbnail: ThumbnailRequest | None
    ) -> None:
        """Do a job; if the context is lost over it, once more with a new renderer."""
        try:
            self._serve(save, view, thumbnail)
        except GpuError as error:
            if error.remedy != "new renderer" or self._stopping:
                raise
            self._drop_renderer()
            try:
                self._serve(save, view, thumbnail)
            except GpuError as again:
                if again.remedy == "new renderer":
                    self._drop_renderer()
                raise

    def _serve(
        self, save: SaveRequest | None, view: ViewRequest | None, thumbnail: ThumbnailRequest | None
    ) -> None:
        renderer = self._ensure_renderer()
        if save is not None:
            self._write(renderer, save)
        elif view is not None:
            self._draw(renderer, view)
        elif thumbnail is not None:
            self._draw_thumbnail(renderer, thumbnail)

    def _drop_renderer(self) -> None:
        """Part with a renderer whose context is lost; the next job makes a new one."""
        lost, self._renderer = self._renderer, None
        self._forget(lost=True)
        # Freeing what is lost may fail in ways of the driver's own; there is nothing left to save.
        with suppress(Exception):
            lost.close()

    def _ensure_renderer(self) -> Any:
        if self._renderer is None:
            from sfumato import Renderer

            self._renderer = Renderer(gpu_budget())
            self.ready.emit(self._renderer.name)
        return self._renderer

    def _draw(self, renderer: Any, request: ViewRequest) -> None:
        """Draw what the window wants; a picture that was finished a moment ago is shown at once."""
        still = self._stills.find(request, self._scaled(STILL))
        if still is not None:
            self._show(still)
        elif not self._draw_frames(renderer, request):
            return
        self.progress.emit(1.0)
        self._settled = not request.interactive

    def _draw_frames(self, renderer: Any, request: ViewRequest) -> bool:
        """Draw what is not there yet, frames that are there and serve first; False if it is given up."""
        kept = self._kept
        if kept is not None and kept.serves(request, self._scaled(STILL)):
            kept.take(request)
            self._show(_picture(kept.accumulation, request, kept.seconds, kept.count))
        else:
            self._forget()
            if request.interactive and not self._draw_once(renderer, request):
                return False
        if request.interactive:
            return True
        if not self._refine(renderer, request):
            return False
        self._stills.keep(request, self._scaled(STILL), self._shown)
        return True

    def _show(self, picture: Picture) -> None:
        self._shown = picture
        self._drawn.emit(picture)

    def _scaled(self, quality: Quality) -> Quality:
        return replace(quality, scale=quality.scale * self._scale)

    def _draw_once(self, renderer: Any, request: ViewRequest) -> bool:
        """Draw a frame of a drag, coarsely; False if it is given up for other data or another technique."""
        quality, audited = self._scaled(DRAG_LADDER[self._rung]), request.audit > 0
        with _accumulation(renderer, request.scene, request.size, quality, audited) as accumulation:
            started = time.perf_counter()
            for done in accumulation.add_frame():
                if self._stopping or self._outdated(request):
                    return False
                if time.perf_counter() - started > SLOW_SECONDS:
                    self.progress.emit(done)
            seconds = time.perf_counter() - started
            self._show(_picture(accumulation, request, seconds, 1))
            self._choose_rung(seconds)
        return True

    def _refine(self, renderer: Any, request: ViewRequest) -> bool:
        """Draw the frames of a still picture that are not there yet; False if something newer is wanted first."""
        work = self._kept = self._kept or Refinement(renderer, request, self._scaled(STILL))
        asked = time.perf_counter()
        try:
            while not work.finished:
                started = time.perf_counter()
                for done in work.accumulation.add_frame():
                    if self._stopping or self._outdated(request):
                        work.note_dropped()
                        return False
                    self.progress.emit((work.drawn + done) / work.count)
                seconds = time.perf_counter() - started
                work.note_frame(seconds)
                self._show(_picture(work.accumulation, request, seconds, work.count))
                if not work.finished:
                    self._lend_to_thumbnails(renderer, seconds, time.perf_counter() - asked)
            work.accumulation.rest()
        except Exception as error:
            self._forget(lost=remedy_of(error) == "new renderer")
            raise
        return True

    def _forget(self, lost: bool = False) -> None:
        """Part with the frames that are kept; in a context that is lost there is nothing to free, and no way to."""
        kept, self._kept = self._kept, None
        if kept is not None and not lost:
            kept.release()

    @property
    def _next_thumbnail(self) -> ThumbnailRequest | None:
        """The thumbnail to draw now, if there is time for one."""
        return self._thumbnails[0] if self._thumbnails and self._settled else None

    def _lend_to_thumbnails(self, renderer: Any, seconds: float, rested: float) -> None:
        """Draw thumbnails between two frames, for about as long as a frame takes.

        Parameters
        ----------
        seconds : float
            What the last frame took.
        rested : float
            Seconds since the picture was asked for: unless a thumbnail is urgent, it is to be at rest for a while.
        """
        began = time.perf_counter()
        self._settled = True
        while not (self._stopping or self._view or self._save):
            thumbnail = self._next_thumbnail
            spent = time.perf_counter() - began
            if thumbnail is None or spent > seconds or not (thumbnail.urgent or rested > IDLE_SECONDS):
                break
            self._draw_thumbnail(renderer, thumbnail)

    def _draw_thumbnail(self, renderer: Any, request: ThumbnailRequest) -> None:
        """Draw a thumbnail; a wish stays open if a view or a save comes in between."""
        try:
            quality = request.quality or THUMBNAIL
            with _accumulation(renderer, request.scene, request.size, quality) as accumulation:
                for _ in range(request.frames or THUMBNAIL_FRAMES):
                    if not self._add_idle_frame(accumulation, request):
                        return
                if request.exposed and not self._expose(renderer, request, quality, accumulation):
                    return
                image = image_of(accumulation)
                image.setText("exposure", f"{accumulation.scene.exposure}" if request.exposed else "")
            if request.timed:
                seconds = self._time_again(renderer, request, quality)
                if seconds is None:
                    return
                image.setText("seconds", f"{seconds:.6f}")
        except Exception:
            # A scene that cannot be drawn says so when it is the picture; here its place stays empty.
            self._drop_thumbnail(request)
            return
        self._drop_thumbnail(request)
        self.thumbnail.emit(request, image)

    def _add_idle_frame(self, accumulation: Any, request: ThumbnailRequest) -> bool:
        """Draw a frame of a thumbnail; False if it was given up for something more urgent."""
        for _ in accumulation.add_frame():
            if self._stopping or self._view or self._save or not self._still_wanted(request):
                return False
        return True

    def _expose(self, renderer: Any, request: ThumbnailRequest, quality: Quality, lit: Any) -> bool:
        """Expose a thumbnail automatically; False if it was given up for something more urgent."""
        plain = request.scene.with_(technique="raycast")
        with _accumulation(renderer, plain, request.size, quality) as unlit:
            if not self._add_idle_frame(unlit, request):
                return False
            stops = exposure_for(lit.foreground(), unlit.foreground())
        lit.scene = lit.scene.with_(exposure=stops)
        return True

    def _time_again(self, renderer: Any, request: ThumbnailRequest, quality: Quality) -> float | None:
        """Return the seconds of the first frame, drawn once more: all that is kept between frames is there."""
        with _accumulation(renderer, request.scene, request.size, quality) as accumulation:
            began = time.perf_counter()
            done = self._add_idle_frame(accumulation, request)
            return time.perf_counter() - began if done else None

    def _still_wanted(self, request: ThumbnailRequest) -> bool:
        return any(r is request for r in self._thumbnails)

    def _drop_thumbnail(self, request: ThumbnailRequest) -> None:
        with self._wake:
            self._thumbnails = [r for r in self._thumbnails if r is not request]

    def _outdated(self, request: ViewRequest) -> bool:
        """Tell whether to drop the work for a request: a drag's frame only for other data or technique."""
        newer = self._view
        if newer is None:
            return False
        if not request.interactive:
            return True
        old, new = request.scene, newer.scene
        return new.volume is not old.volume or type(new.technique) is not type(old.technique)

    def _choose_rung(self, seconds: float) -> None:
        if seconds > DRAG_SECONDS:
            self._rung = min(self._rung + 1, len(DRAG_LADDER) - 1)
        elif seconds < DRAG_SECONDS / 5:
            self._rung = max(self._rung - 1, 0)

    def _write(self, renderer: Any, request: SaveRequest) -> None:
        self._forget()  # a large picture needs the room
        with closing(request.work(renderer, _ViewsFirst(self, renderer))) as pieces:
            for done in pieces:
                if self._stopping or self._cancel_save:
                    self.save_cancelled.emit()
                    return
                self.save_progress.emit(done)
        self.saved.emit(request.done)

    def view_waits(self) -> bool:
        """Tell, on the thread, whether the window wants to see something else."""
        return self._view is not None and not (self._stopping or self._cancel_save)

    def draw_waiting_view(self, renderer: Any) -> None:
        """Draw, on the thread, what the window wants to see, while a file is being drawn."""
        with self._wake:
            view, self._view = self._view, None
            self._settled = False
        if view is None:
            return
        try:
            self._draw(renderer, view)
            self._forget()
        except GpuError as error:
            if error.remedy == "new renderer":
                raise
            self.failed.emit(one_line(error), remedy_of(error))


class _ViewsFirst:
    """Lends the renderer of a file that is being drawn to the window: a hand that moves must see pictures."""

    def __init__(self, worker: RenderWorker, renderer: Any) -> None:
        self._worker, self._renderer = worker, renderer

    def waiting(self) -> bool:
        """Tell whether the window wants to see something else."""
        return self._worker.view_waits()

    def serve(self) -> None:
        """Draw it."""
        self._worker.draw_waiting_view(self._renderer)


@contextmanager
def _accumulation(
    renderer: Any, scene: Scene, size: tuple[int, int], quality: Quality, audited: bool = False
) -> Iterator[Any]:
    accumulation = renderer.begin(scene, size, quality=quality, audited=audited)
    lost = False
    try:
        yield accumulation
    except GpuError as error:
        lost = error.remedy == "new renderer"
        raise
    finally:
        if not lost:  # in a context that is lost there is nothing to free, and no way to
            accumulation.release()
            renderer.device.collect()


def _picture(accumulation: Any, request: ViewRequest, seconds: float, wanted: int) -> Picture:
    audit = accumulation.audit(request.audit) if request.audit else None
    shown = image_of(accumulation) if audit is None else image_from(audit.picture)
    return Picture(
        shown,
        request.scene,
        request.size,
        seconds,
        accumulation.frames,
        request.interactive,
        wanted,
        accumulation.light,
        audit,
    )
