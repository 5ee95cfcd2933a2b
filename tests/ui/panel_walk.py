"""Walks the window at one scale and font size, and prints what is wrong as JSON; run as a program of its own.

Arguments: factor of the font, a folder to write in. The screen's scale is ``QT_SCALE_FACTOR``.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from qtpy.QtCore import QPoint, QRect, Qt
from qtpy.QtGui import QImage
from qtpy.QtTest import QTest
from qtpy.QtWidgets import (
    QAbstractButton,
    QAbstractSlider,
    QAbstractSpinBox,
    QApplication,
    QCheckBox,
    QComboBox,
    QDialog,
    QLabel,
    QLineEdit,
    QPushButton,
    QTabBar,
    QToolButton,
    QWidget,
)

from sfumato import Document, Scene, TransferFunction, Volume, VolumeInfo
from sfumato.io import RawGuess, SeriesInfo
from sfumato.scene import ClipPlane
from sfumato_ui.app import make_application
from sfumato_ui.export_dialog import ExportDialog
from sfumato_ui.keyboard_dialog import KeyboardDialog
from sfumato_ui.palette import CommandPalette
from sfumato_ui.preset_gallery import PresetGallery
from sfumato_ui.raw_dialog import RawDialog
from sfumato_ui.rigs_row import RigButton
from sfumato_ui.series_dialog import SeriesDialog
from sfumato_ui.tab_order import in_visual_order
from sfumato_ui.theme import TARGET, THEMES
from sfumato_ui.window import MainWindow

TEXT, RING = 4.5, 3.0
#: Pixels around a control in which its focus ring may lie.
AROUND = 3


def pause(seconds: float = 0.02) -> None:
    """Go on with events."""
    until = time.monotonic() + seconds
    while True:
        QApplication.processEvents()
        if time.monotonic() >= until:
            return
        time.sleep(0.001)


def scene() -> Scene:
    """Return a ball with the usual range of values of CT, so that all labels are there."""
    z, y, x = np.mgrid[0:24, 0:24, 0:24] / 11.5 - 1
    data = np.clip((0.7 - np.sqrt(x * x + y * y + z * z)) * 4000 - 1000, -1000, 1500).astype(np.int16)
    info = VolumeInfo(path="ball.npy", orientation_known=True, name="ball", modality="CT")
    transfer = TransferFunction.from_points([(-300, (0.9, 0.8, 0.7), 0.0), (400, (0.9, 0.8, 0.7), 0.9)])
    return Scene(volume=Volume(data, info=info), transfer=transfer, clip=(ClipPlane((12, 12, 12)),))


class Walk:
    """Looks at one window or dialog and collects complaints."""

    def __init__(self, top: QWidget, root: QWidget, where: str) -> None:
        self.top, self.root, self.where = top, root, where
        self.wrong: list[str] = []

    def check(self) -> list[str]:
        """Return all that is wrong."""
        pause(0.05)
        order = [w for w in in_visual_order(self.root) if w.isVisible() and w.isEnabled()]
        if len(order) < 3:
            self.say(self.root, f"only {len(order)} controls were found")
        self._tab_through(order)
        for control in order:
            self._check_control(control)
        for widget in self.root.findChildren(QWidget):
            if widget.isVisible() and not widget.visibleRegion().isEmpty():
                self._check_text(widget)
        return self.wrong

    def say(self, widget: QWidget, what: str) -> None:
        """Note a complaint."""
        name = widget.accessibleName() or getattr(widget, "text", lambda: "")() or type(widget).__name__
        self.wrong.append(f"{self.where}: {type(widget).__name__} '{name}': {what}")

    # -- Tab and focus ----------------------------------------------------------------------------
    def _tab_through(self, order: list[QWidget]) -> None:
        order[0].setFocus(Qt.FocusReason.TabFocusReason)
        for i, control in enumerate(order):
            reached = QApplication.focusWidget()
            if reached is not control:
                self.say(control, f"Tab reached {type(reached).__name__} instead")
                return
            pause(0)
            focused, box = self._seen_around(control)
            if control.visibleRegion().isEmpty():
                self.say(control, "has the focus out of sight")
            QTest.keyClick(control, Qt.Key.Key_Tab)
            pause(0)
            if QApplication.focusWidget() is control:
                self.say(control, "Tab stays here")
                return
            if i == len(order) - 1:
                return
            after, box_after = self._seen_around(control)
            if box == box_after:  # else the panel has scrolled: the next one's is seen then
                self._check_ring(control, focused, after)

    def _seen_around(self, control: QWidget) -> tuple[np.ndarray, QRect]:
        corner = control.mapTo(self.top, QPoint())
        box = QRect(corner, control.size()).adjusted(-AROUND, -AROUND, AROUND, AROUND)
        box = box.intersected(self.top.rect())
        if box.isEmpty():
            return np.zeros((0, 0)), box
        return luminance(self.top.grab(box).toImage()), box

    def _check_ring(self, control: QWidget, focused: np.ndarray, after: np.ndarray) -> None:
        if focused.shape != after.shape:
            return
        high, low = np.maximum(focused, after) + 0.05, np.minimum(focused, after) + 0.05
        if np.count_nonzero(high / low >= RING) < 2 * TARGET:
            self.say(control, "no focus ring is seen")

    # -- single controls --------------------------------------------------------------------------
    def _check_control(self, control: QWidget) -> None:
        if not (control.accessibleName() or (isinstance(control, QAbstractButton) and control.text())):
            self.say(control, "no accessible name")
        if min(control.width(), control.height()) < TARGET:
            self.say(control, f"only {control.width()} x {control.height()} pixels")
        told = " "
        if isinstance(control, QAbstractSlider):
            told = control.accessibleDescription()
        elif isinstance(control, QComboBox):
            told = control.currentText()
        elif isinstance(control, QAbstractSpinBox):
            unit = "".join(c for c in control.text() if not (c.isdigit() or c in "-+., "))
            named = any(word in control.accessibleName() for word in (" in ", "Voxels"))
            told = control.text() if unit or named else ""
        if not told:
            self.say(control, "no value, or no unit")

    # -- text -------------------------------------------------------------------------------------
    def _check_text(self, widget: QWidget) -> None:
        text, room = text_and_room(widget)
        if not text:
            return
        longest = max(text.split("\n"), key=len)
        if widget.fontMetrics().horizontalAdvance(longest) > room:
            self.say(widget, f"'{longest}' needs {widget.fontMetrics().horizontalAdvance(longest)} of {room}")
        if (
            isinstance(widget, QLabel)
            and widget.wordWrap()
            and widget.heightForWidth(widget.width()) > widget.height()
        ):
            self.say(widget, f"'{text}' is cut off below")
        if widget.height() < widget.fontMetrics().ascent():
            self.say(widget, f"only {widget.height()} pixels high")
        if widget.isEnabled() and isinstance(widget, QLabel | QAbstractButton):
            self._check_contrast(widget)

    def _check_contrast(self, widget: QWidget) -> None:
        if widget.visibleRegion().boundingRect() != widget.rect():
            return
        corner = widget.mapTo(self.top, QPoint())
        seen = luminance(self.top.grab(QRect(corner, widget.size())).toImage())
        ratio = (seen.max() + 0.05) / (seen.min() + 0.05)
        if ratio < TEXT:
            self.say(widget, f"contrast {ratio:.1f}")


def text_and_room(widget: QWidget) -> tuple[str, float]:
    """Return what a widget says on one line and the width that it has for that; nothing, if it says nothing."""
    if isinstance(widget, QLabel):
        return widget.text() if widget.text()[:1] != "<" else "", 1e9 if widget.wordWrap() else widget.width()
    if isinstance(widget, RigButton):
        return widget.text(), widget.width()
    if isinstance(widget, QToolButton):
        beside = widget.toolButtonStyle() == Qt.ToolButtonStyle.ToolButtonTextBesideIcon
        icon = widget.iconSize().width() + 4
        return (widget.text(), widget.width() - icon - 12) if beside else ("", 0)
    if isinstance(widget, QCheckBox):
        return widget.text(), widget.width() - 16 - 8 - 4
    if isinstance(widget, QPushButton):
        return widget.text(), widget.width() - 6
    if isinstance(widget, QComboBox):
        return max(
            (widget.itemText(i) for i in range(widget.count())), key=len, default=""
        ), widget.width() - 36
    if isinstance(widget, QLineEdit):
        return widget.text(), widget.width() - 2
    return "", 0


def luminance(image: QImage) -> np.ndarray:
    """Return relative luminance (WCAG 2), shape (height, width)."""
    image = image.convertToFormat(QImage.Format.Format_RGBA8888)
    flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    rgb = flat[:, : 4 * image.width()].reshape(image.height(), image.width(), 4)[..., :3] / 255
    linear = np.where(rgb <= 0.03928, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return linear @ np.array([0.2126, 0.7152, 0.0722])


# -- lists and tabs ----------------------------------------------------------------------------------
def check_tabs(bar: QTabBar, where: str) -> Iterator[str]:
    """Yield the tabs whose names do not fit."""
    font = bar.font()
    font.setBold(True)
    for i in range(bar.count()):
        need = QLabel(bar.tabText(i))
        need.setFont(font)
        if need.fontMetrics().horizontalAdvance(bar.tabText(i)) > bar.tabRect(i).width():
            yield f"{where}: tab '{bar.tabText(i)}' is too narrow"


def check_gallery(gallery: PresetGallery, where: str) -> Iterator[str]:
    """Yield the presets whose names do not fit."""
    for i in range(gallery.count()):
        name = gallery.item(i).text()
        if gallery.fontMetrics().horizontalAdvance(name) > gallery.gridSize().width():
            yield f"{where}: preset '{name}' is too narrow"


def walk_window(window: MainWindow, theme: str) -> list[str]:
    """Walk all tabs."""
    wrong = list(check_tabs(window.panel.tabBar(), theme))
    for tab in range(window.panel.count()):
        window.panel.setCurrentIndex(tab)
        where = f"{theme}, {window.panel.tabText(tab)}"
        wrong += Walk(window, window.centralWidget(), where).check()
        page = window.panel.widget(tab)
        if page.widget().width() > page.viewport().width():
            wrong.append(f"{where}: the panel is cut off at its right edge")
    wrong += check_gallery(window.material_page.presets, theme)
    return wrong + walk_shapes(window, theme)


def walk_shapes(window: MainWindow, theme: str) -> list[str]:
    """Walk the Material tab with a function of two dimensions."""
    window.panel.setCurrentWidget(window.material_page)
    transfer = window.material_page.transfer
    transfer.dimensions.buttons[1].click()
    transfer.shapes.plot.add_shape("trapezoid")
    wrong = Walk(window, window.centralWidget(), f"{theme}, Material in 2D").check()
    transfer.dimensions.buttons[0].click()
    return wrong


def walk_slices(window: MainWindow, theme: str) -> list[str]:
    """Walk the slice views: all three, and one enlarged with a window of its own."""
    window.slices.set_open(True)
    panel = window.slices.panel
    assert panel is not None
    pause(0.3)
    wrong = Walk(window, panel, f"{theme}, slices").check()
    panel.enlarge(panel.panes[1])
    QTest.keyClick(panel.panes[1], Qt.Key.Key_Right, Qt.KeyboardModifier.AltModifier)
    QTest.keyClick(panel.panes[1], Qt.Key.Key_Plus)
    wrong += Walk(window, panel, f"{theme}, one slice").check()
    panel.enlarge(None)
    panel.state.reset_window()
    window.slices.set_open(False)
    return wrong


def dialogs(window: MainWindow, folder: Path) -> Iterator[QDialog]:
    """Yield the dialogs with typical contents."""
    raw = folder / "ball.raw"
    raw.write_bytes(bytes(24**3))
    series = [
        SeriesInfo(f"k{i}", "CT", f"Head {i}", n, (512, 512, n), (0.488, 0.488, 1.25))
        for i, n in enumerate((3, 90))
    ]
    yield ExportDialog((900, 660), False, lambda size, frames: 12.0, window)
    yield ExportDialog((900, 660), True, lambda size, frames: 12.0, window)
    yield CommandPalette(window.commands.possible(), window)
    yield KeyboardDialog(list(window.commands.actions), window)
    yield RawDialog(str(raw), [RawGuess((24, 24, 24), "uint8", (1.0, 1.0, 1.0), 0)], window)
    yield SeriesDialog(str(folder), series, window)


def walk_dialog(dialog: QDialog, theme: str) -> list[str]:
    """Walk one dialog."""
    dialog.open()
    dialog.activateWindow()
    pause(0.1)
    wrong = Walk(dialog, dialog, f"{theme}, {type(dialog).__name__}").check()
    dialog.reject()
    pause()
    dialog.deleteLater()
    return wrong


def main(font_factor: float, folder: Path) -> None:
    """Walk everything and print what is wrong."""
    app = make_application()
    font = app.font()
    font.setPointSizeF(font.pointSizeF() * font_factor)
    app.setFont(font)
    window = MainWindow(Document(scene()))
    window.resize(1280, 720)
    window.show()
    window.activateWindow()
    pause(0.05)
    picture = window.viewport.width() * window.viewport.height() / (window.width() * window.height())
    for exposure in (0.1, 0.2, 0.3):
        window.editor.change("Change the exposure", exposure=exposure)
    window.editor.undo()
    window.drawer.open("history")
    pages = window.light_page, window.material_page, window.view_page
    for section in (window.light_page.own, *(page.more for page in pages)):
        section.set_open(True)
    wrong: list[str] = []
    for theme in THEMES:
        window.set_theme(theme)
        pause(0.3)
        if len(sys.argv) > 3:
            for tab in range(3):
                window.panel.setCurrentIndex(tab)
                pause(0.3)
                window.grab().save(f"{sys.argv[3]}/{theme}-{tab}.png")
        window.activateWindow()
        wrong += walk_window(window, theme)
        window.panel.setCurrentIndex(0)
        window.drawer.open("compare")
        for mode in ("wipe", "techniques", "rigs"):
            window.compare.set_mode(mode)
            wrong += Walk(window, window.centralWidget(), f"{theme}, compare by {mode}").check()
        window.drawer.open("")
        wrong += walk_slices(window, theme)
        window.drawer.open("history")
        for dialog in dialogs(window, folder):
            wrong += walk_dialog(dialog, theme)
    window.editor.document.mark_saved()
    window.close()
    print(json.dumps({"wrong": wrong, "ratio": window.devicePixelRatioF(), "picture": picture}))


if __name__ == "__main__":
    main(float(sys.argv[1]), Path(sys.argv[2]))
