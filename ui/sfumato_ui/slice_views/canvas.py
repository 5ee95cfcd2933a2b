"""A slice view as it is seen: asks for its slice, shows the newest one, draws all that lies over it."""

from __future__ import annotations

import math

import numpy as np
from qtpy.QtCore import QSize, Qt, QTimer
from qtpy.QtGui import QColor, QImage, QPainter, QPaintEvent, QResizeEvent, QShowEvent
from qtpy.QtWidgets import QSizePolicy, QWidget

from sfumato.scene.vectors import vec3
from sfumato.slicing import Cut, Frame

from .. import overlay
from ..editing import Editor
from ..theme import PICTURE_GREY
from ..tools import PictureView
from . import painting
from .lamps import SliceLamps
from .lighter import PLACES, Lighter, LightImages, LightRequest
from .slicer import SliceImage, Slicer, SliceRequest
from .state import SliceState

#: A slice has no more pixels than this, which takes about 60 ms; a larger view shows it enlarged.
MOST_PIXELS = 700_000
#: Free pixels beside the volume when the whole of it is seen.
MARGIN = 5
#: Least time in milliseconds between two questions for the light.
LIGHT_MS = 60
NOTHING = "No volume to slice"


class SliceCanvas(QWidget):
    """Shows one cut.

    Parameters
    ----------
    index : int
        Which of the state's cuts.
    """

    def __init__(
        self, editor: Editor, state: SliceState, slicer: Slicer, lighter: Lighter, index: int
    ) -> None:
        super().__init__()
        self._lighter = lighter
        self._editor, self._state, self._slicer, self._index = editor, state, slicer, index
        self.lamps = SliceLamps(editor, state, index)
        self.made: SliceImage | None = None
        self._wanted: SliceRequest | None = None
        self.light: LightImages | None = None
        self._light_wanted: LightRequest | None = None
        self._lit_image: tuple[SliceImage, LightImages, QImage] | None = None
        #: Whether the light is shown.
        self._lit = False
        self._light_timer = QTimer(self)
        self._light_timer.setSingleShot(True)
        self._light_timer.timeout.connect(self._want_light)
        #: Whether it has the bar of true length; one view is enough, since all have the same scale.
        self.scale_bar = False
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(120, 100)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setMouseTracking(True)
        state.moved.connect(self.refresh)
        state.windowed.connect(self.want)
        state.replaced.connect(self._on_replaced)
        slicer.sliced.connect(self._on_sliced)
        lighter.lit.connect(self._on_lit)
        editor.changed.connect(lambda old, new: self._on_changed())
        editor.light_selected.connect(lambda index: self.update())

    def sizeHint(self) -> QSize:
        """Take what is there."""
        return QSize(300, 180)

    @property
    def cut(self) -> Cut:
        """What it shows."""
        return self._state.cuts[self._index]

    @property
    def view(self) -> PictureView:
        """From world to widget pixels and back."""
        frame = self._frame(1.0)
        return PictureView(frame.camera, frame.width, frame.height)

    @property
    def room(self) -> tuple[Cut, float, float]:
        """What it shows, and the width and height in pixels that a whole volume has."""
        return self.cut, self.width() - 2.0 * MARGIN, self.height() - 2.0 * MARGIN

    def _frame(self, ratio: float) -> Frame:
        """Return what is seen, with so many pixels to a pixel of the widget."""
        state = self._state
        width, height = max(1, round(self.width() * ratio)), max(1, round(self.height() * ratio))
        scale = state.mm_per_pixel * self.height() / height
        return Frame(self.cut, vec3(state.middle_of(self.cut)), scale, width, height)

    # -- the slice --------------------------------------------------------------------------------
    def refresh(self) -> None:
        """Cross-hair or part are others."""
        self._describe()
        self.update()
        self.want()

    def want(self) -> None:
        """Ask for the slice, unless nobody sees it or it was asked for already."""
        state = self._state
        if state.volume is None or state.window is None or not self.isVisible():
            return
        most = math.sqrt(MOST_PIXELS / max(1, self.width() * self.height()))
        request = SliceRequest(state.volume, self._frame(min(self.devicePixelRatioF(), most)), state.window)
        before = self._wanted
        if before is None or (before.volume, before.frame, before.window) != (
            request.volume, request.frame, request.window,
        ):  # fmt: skip
            self._wanted = request
            self._slicer.want(request)
        self._ask_for_light()

    def _on_sliced(self, made: SliceImage) -> None:
        request = made.request
        if request.frame.cut.id == self.cut.id and request.volume is self._state.volume:
            self.made = made
            self.update()

    def _on_replaced(self) -> None:
        """Forget what belongs to another volume."""
        self.made = self._wanted = self.light = self._light_wanted = None
        name = f"{self.cut.title} slice"
        self.setAccessibleName(name)
        self._describe()
        self.update()

    @property
    def place(self) -> str:
        """Where the slice lies, in words."""
        volume = self._state.volume
        return painting.slice_place(volume, self.cut, self._state.cross) if volume is not None else ""

    def _describe(self) -> None:
        self.setAccessibleDescription(self.place or NOTHING)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Ask for another size."""
        super().resizeEvent(event)
        self.want()

    def showEvent(self, event: QShowEvent) -> None:
        """Ask for what nobody has seen yet."""
        super().showEvent(event)
        self.want()

    def forget(self) -> None:
        """Ask anew when it is shown again."""
        self._wanted = self._light_wanted = None

    # -- the light --------------------------------------------------------------------------------
    def set_lit(self, on: bool) -> None:
        """Show how much light reaches the slice, or not."""
        self._lit = on
        self.light = self._light_wanted = None
        self._ask_for_light()
        self.update()

    def _on_changed(self) -> None:
        self._ask_for_light()
        self.update()

    def _ask_for_light(self) -> None:
        """Ask for the light soon, with all that changes until then."""
        if self._lit and not self._light_timer.isActive():
            self._light_timer.start(LIGHT_MS)

    def _want_light(self) -> None:
        scene = self._editor.scene
        if not self._lit or not self.isVisible() or scene.volume is not self._state.volume:
            return
        if scene.volume is None or scene.camera is None or scene.transfer is None:
            return
        request = LightRequest(scene, self._frame(math.sqrt(PLACES / max(1, self.width() * self.height()))))
        if self._light_wanted is None or self._light_wanted.causes != request.causes:
            self._light_wanted = request
            self._lighter.want(request)

    def _on_lit(self, light: LightImages) -> None:
        request = light.request
        if self._lit and request.frame.cut.id == self.cut.id and request.scene.volume is self._state.volume:
            self.light = light
            self.update()

    def _image(self, made: SliceImage) -> QImage:
        """Return the slice's picture, with the light on it if that of the same slice is known; it is made once."""
        if self.light is None or not _same_slice(made, self.light):
            return made.image
        if self._lit_image is None or self._lit_image[0] is not made or self._lit_image[1] is not self.light:
            self._lit_image = made, self.light, painting.lit_image(made, self.light)
        return self._lit_image[2]

    # -- looks ------------------------------------------------------------------------------------
    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the slice and all that lies over it."""
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(PICTURE_GREY))
        if self._state.volume is None:
            overlay.draw_centred(painter, self.rect(), NOTHING)
        else:
            self._paint_slice(painter)
        if self.hasFocus():
            painting.draw_focus(painter, self.rect())

    def _paint_slice(self, painter: QPainter) -> None:
        view, scene, cross = self.view, self._editor.scene, self._state.cross
        painter.setFont(painting.small(self.font()))
        if self.made is not None:
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            painting.draw_on_slice(painter, view, self.made.request.frame, self._image(self.made))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if scene.volume is not None:
            painting.draw_cuts(painter, view, scene, self.cut, np.asarray(cross))
        painting.draw_cross(painter, view, cross)
        self.lamps.paint(painter, view)
        painting.draw_names(painter, self.rect(), self.cut, self.place)
        if self.scale_bar:
            overlay.draw_scale_bar(painter, self.rect(), view.camera)


def _same_slice(made: SliceImage, light: LightImages) -> bool:
    """Tell whether a light is that on a slice, whatever part of it."""
    frame = made.request.frame
    away = np.asarray(light.request.frame.middle) - np.asarray(frame.middle)
    return abs(float(frame.cut.back @ away)) < 1e-6


__all__ = ["SliceCanvas"]
