"""The walk: what a user does in the first minutes, step by step."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from qtpy.QtCore import QPoint, QPointF, Qt
from qtpy.QtTest import QTest
from qtpy.QtWidgets import (
    QApplication,
    QColorDialog,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QLineEdit,
    QMenu,
    QPushButton,
    QWidget,
)

from sfumato_ui.export_dialog import ExportDialog
from sfumato_ui.tools import HandleTool

from .hand import CTRL, SHIFT, Hand, pause

#: Name of a step's screenshot, what it shows, and how to get there from the step before.
Step = tuple[str, str, Callable[[Hand], None]]


#: Where the hand lets the lamp go, as fractions of the picture.
LET_GO = (0.52, 0.36)
#: Of the exported picture in pixels, whatever the window's: llvmpipe takes half a minute for it.
EXPORT_WIDTH = "900"


def _nothing(hand: Hand) -> None:
    """Only look."""


# -- the picture -----------------------------------------------------------------------------------
def _at(hand: Hand, x: float, y: float) -> QPointF:
    """Return a place in the picture by fractions of its width and height."""
    return QPointF(hand.window.viewport.width() * x, hand.window.viewport.height() * y)


def _orbit(hand: Hand) -> None:
    hand.drag(hand.window.viewport, _at(hand, 0.5, 0.5), _at(hand, 0.56, 0.46))
    hand.rest()


def _move_light(hand: Hand) -> None:
    """Stop before the mouse is released: the lamp's guide is seen."""
    start, end = _at(hand, 0.3, 0.4), _at(hand, *LET_GO)
    hand.drag(hand.window.viewport, start, end, SHIFT, let_go=False)
    hand.rest()


def _let_light_go(hand: Hand) -> None:
    hand.release(hand.window.viewport, _at(hand, *LET_GO), SHIFT)
    _undo(hand)


def _unlit(hand: Hand) -> None:
    QTest.keyPress(hand.window, Qt.Key.Key_B)
    hand.rest()


def _lit_again(hand: Hand) -> None:
    QTest.keyRelease(hand.window, Qt.Key.Key_B)
    hand.rest()


def _undo(hand: Hand) -> None:
    hand.click(hand.window.top.undo)
    hand.rest()


def _redo(hand: Hand) -> None:
    hand.click(hand.window.top.redo)
    hand.rest()


# -- Light -----------------------------------------------------------------------------------------
def _rig(hand: Hand) -> None:
    _lit_again(hand)
    hand.click(hand.window.light_page.rigs.buttons["rim"])
    hand.rest()


def _second_lamp(hand: Hand) -> None:
    _undo(hand)
    hand.click(hand.window.light_page.lamps.add)
    hand.press(Qt.Key.Key_L)
    hand.rest()


def _lamp_colour(hand: Hand) -> None:
    hand.click(hand.window.light_page.tools.color)
    hand.wait_until(lambda: _dialog(QColorDialog) is not None, "colour dialog")
    _type_into(_field(_dialog(QColorDialog), "#"), "#ff9a4d")
    hand.rest()


def _solo(hand: Hand) -> None:
    _accept(hand, QColorDialog)
    hand.click(hand.window.light_page.tools.solo)
    hand.rest()


def _soft(hand: Hand) -> None:
    hand.click(hand.window.light_page.tools.solo)
    hand.press(Qt.Key.Key_Escape)
    hand.click(hand.window.light_page.rigs.buttons["top-left"])
    slider = hand.window.light_page.aperture.slider
    y = slider.height() / 2
    hand.drag(slider, QPointF(0.4 * slider.width(), y), QPointF(0.5 * slider.width(), y))
    hand.rest()


def _technique(hand: Hand) -> None:
    """Open the technique's own section and More, and look at the lower end of the panel."""
    page = hand.window.light_page
    for section in (page.own, page.more):
        page.ensureWidgetVisible(section.header)
        hand.click(section.header)
    pause(100)
    _scroll_down(hand, page)
    hand.rest()


def _scroll_down(hand: Hand, page: QWidget) -> None:
    pause(100)
    bar = page.verticalScrollBar()  # type: ignore[attr-defined]
    bar.setValue(bar.maximum())
    pause(100)


def _own_rig(hand: Hand) -> None:
    """Keep the lamps under a name."""
    page = hand.window.light_page
    own = page.own_rigs
    page.ensureWidgetVisible(own)
    hand.click(own.save)
    _type_into(own.ask.text, "Soft left")
    QTest.keyClick(own.ask.text, Qt.Key.Key_Return)
    hand.rest()
    buttons = own.row.buttons.values()
    hand.wait_until(lambda: all(not b.image.isNull() for b in buttons), "picture of the own rig")
    page.ensureWidgetVisible(own)
    pause(100)


def _audit(hand: Hand) -> None:
    audit = hand.window.light_page.audit
    hand.window.light_page.ensureWidgetVisible(audit)
    hand.click(audit.on, QPoint(10, audit.on.height() // 2))
    hand.rest()


# -- Compare ---------------------------------------------------------------------------------------
def _wipe(hand: Hand) -> None:
    """Hold the picture against the unlit one."""
    page = hand.window.light_page
    hand.click(page.audit.on, QPoint(10, page.audit.on.height() // 2))
    for section in (page.more, page.own):
        page.ensureWidgetVisible(section.header)
        hand.click(section.header)
    compare = hand.window.compare
    hand.click(hand.window.drawer.toggles["compare"])
    hand.click(compare.wipe)
    hand.wait_until(lambda: compare.layer.image is not None, "other picture")
    hand.rest()


def _rig_grid(hand: Hand) -> None:
    compare = hand.window.compare
    hand.click(compare.rigs)
    cells = compare.grids["rigs"].cells.values()
    hand.wait_until(lambda: all(not cell.image.isNull() for cell in cells), "pictures of the grid")
    pause(100)


# -- Material --------------------------------------------------------------------------------------
def _material(hand: Hand) -> None:
    hand.click(hand.window.drawer.toggles["compare"])
    hand.click(hand.window.light_page.rigs.buttons["three-point"])
    hand.choose_tab(1)
    hand.rest()


def _preset(hand: Hand) -> None:
    gallery = hand.window.material_page.presets
    place = gallery.visualItemRect(gallery.item(min(2, gallery.count() - 1))).center()
    hand.click(gallery.viewport(), place)
    hand.rest()


def _drag_point(hand: Hand) -> None:
    plot, transfer = hand.window.material_page.transfer.plot, hand.window.editor.scene.transfer
    if plot.transfer is None or transfer is None:  # a function of regions has no points
        hand.click(hand.window.material_page.presets.viewport(), QPoint(30, 30))
        transfer = hand.window.editor.scene.transfer
    assert transfer is not None
    point = max(transfer.points, key=lambda p: p.opacity)
    at = plot.scale.at(point.value, point.opacity)
    hand.drag(plot, at, at + QPointF(14, 18))
    hand.rest()


def _pick(hand: Hand) -> None:
    viewport = hand.window.viewport
    hand.press(Qt.Key.Key_P)
    hand.click(viewport, viewport.rect().center() + QPoint(0, 20))
    hand.rest()


def _shapes(hand: Hand) -> None:
    """Choose a function of two dimensions if there is one, else make it one; cut it to steeper gradients."""
    page = hand.window.material_page
    gallery, transfer = page.presets, page.transfer
    page.ensureWidgetVisible(page.bar)
    if not page.bar.unfolded:
        hand.click(page.bar.unfold)
        pause(60)
    page.ensureWidgetVisible(gallery)
    glass = next((i for i in map(gallery.item, range(gallery.count())) if i.text() == "Glass skin"), None)
    if glass is not None:
        hand.click(gallery.viewport(), gallery.visualItemRect(glass).center())
    else:
        hand.click(transfer.dimensions.buttons[1])
    pause(100)
    page.ensureWidgetVisible(transfer.shapes)
    start = transfer.shapes.plot.handle_places()["lower"]
    hand.drag(transfer.shapes.plot, start, start - QPointF(0, 8))
    hand.rest()


# -- View ------------------------------------------------------------------------------------------
def _view(hand: Hand) -> None:
    hand.window.viewport.setFocus()
    hand.press(Qt.Key.Key_Escape)
    _undo(hand)
    _undo(hand)
    hand.choose_tab(2)
    hand.click(hand.window.view_page.parallel, QPoint(12, hand.window.view_page.parallel.height() // 2))
    hand.rest()


def _tool(hand: Hand, name: str) -> HandleTool:
    return hand.window.viewport.tools[name]


def _drag_handle(hand: Hand, part: str, by: QPointF) -> None:
    view = hand.window.viewport.view
    assert view is not None
    handle = next(h for h in _tool(hand, "clip").handles(view) if h.key.endswith(part))
    at = QPointF(*handle.at)
    hand.drag(hand.window.viewport, at, at + by)


def _clip_plane(hand: Hand) -> None:
    hand.click(hand.window.view_page.clip.add)
    hand.rest()
    _drag_handle(hand, "move", QPointF(30, 10))
    hand.rest()


def _solid(hand: Hand) -> None:
    """Turn the plane towards the eye and make its face solid."""
    page = hand.window.view_page
    hand.click(next(button for button in page.clip.cuts if button.text() == "Coronal"))
    hand.click(page.solid, QPoint(12, page.solid.height() // 2))
    hand.rest()


def _crop(hand: Hand) -> None:
    hand.click(hand.window.view_page.clip.remove)
    tool, view = _tool(hand, "clip"), hand.window.viewport.view
    assert view is not None
    top = min(tool.handles(view), key=lambda handle: handle.at[1])
    _drag_handle(hand, top.key, QPointF(0, 0.2 * hand.window.viewport.height()))
    hand.rest()


def _view_more(hand: Hand) -> None:
    hand.press(Qt.Key.Key_Escape)
    page = hand.window.view_page
    page.ensureWidgetVisible(page.more.header)
    pause(60)
    hand.click(page.more.header)
    _scroll_down(hand, page)
    hand.click(page.cube, QPoint(12, page.cube.height() // 2))
    hand.rest()


def _slices(hand: Hand) -> None:
    """Show the slices and move the cross-hair in the axial one."""
    hand.choose_tab(0)
    hand.window.viewport.setFocus()
    hand.press(Qt.Key.Key_M)
    panel = hand.window.slices.panel
    assert panel is not None
    hand.wait_until(lambda: all(pane.made is not None for pane in panel.panes), "slices")
    pane = panel.panes[0]
    hand.click(pane, QPoint(round(0.53 * pane.width()), round(0.56 * pane.height())))
    hand.rest()
    hand.wait_until(lambda: panel.slicer.idle, "slices")


# -- files -----------------------------------------------------------------------------------------
def _open_menu(hand: Hand) -> None:
    """Open the menu; its own loop of events must not keep us."""
    hand.click(hand.window.strip.slices)
    hand.rest()
    menu = hand.window.top.open.menu()
    menu.popup(hand.window.top.open.mapToGlobal(hand.window.top.open.rect().bottomLeft()))
    hand.wait_until(menu.isVisible, "menu")


def _export(hand: Hand) -> None:
    menu: QMenu = hand.window.top.open.menu()
    menu.close()
    hand.press(Qt.Key.Key_E, CTRL)
    hand.wait_until(lambda: _dialog(ExportDialog) is not None, "export dialog")
    dialog = _dialog(ExportDialog)
    assert isinstance(dialog, ExportDialog)


def _exporting(hand: Hand) -> None:
    """Type a width, answer both dialogs, and look while the file is drawn."""
    dialog = _dialog(ExportDialog)
    assert isinstance(dialog, ExportDialog)
    _type_into(dialog.pixels[0].lineEdit(), EXPORT_WIDTH)
    QTest.keyClick(dialog.pixels[0], Qt.Key.Key_Tab)
    hand.click(dialog.go)
    _answer_file(hand, hand.folder / "walk.png")
    hand.wait_until(lambda: hand.window.messages.kind == "progress", "progress of the export")
    pause(1500)


def _exported(hand: Hand) -> None:
    hand.wait_until(lambda: hand.window.messages.kind == "notice", "end of the export")
    (hand.folder / "walk.png").unlink()


def _save(hand: Hand) -> None:
    hand.press(Qt.Key.Key_S, CTRL)
    _answer_file(hand, hand.folder / "walk.sfumato")
    hand.wait_until(lambda: "walk.sfumato" in hand.window.messages.text, "notice of the saved scene")
    (hand.folder / "walk.sfumato").unlink()


def _recover(hand: Hand) -> None:
    button = next(b for b in hand.window.messages.findChildren(QPushButton) if b.text() == "Recover")
    hand.click(button)
    hand.wait_until(lambda: hand.window.editor.scene.lights[0].tilt == 55.0, "recovered scene")
    hand.rest()


def _dialog(kind: type[QDialog]) -> QDialog | None:
    return next((w for w in QApplication.topLevelWidgets() if isinstance(w, kind) and w.isVisible()), None)


def _field(dialog: QWidget | None, begin: str) -> QLineEdit:
    assert dialog is not None
    return next(line for line in dialog.findChildren(QLineEdit) if line.text().startswith(begin))


def _type_into(line: QLineEdit, text: str) -> None:
    line.setFocus()
    line.selectAll()
    QTest.keyClicks(line, text)


def _accept(hand: Hand, kind: type[QDialog]) -> None:
    dialog = _dialog(kind)
    assert dialog is not None
    QTest.keyClick(dialog, Qt.Key.Key_Return)
    hand.wait_until(lambda: _dialog(kind) is None, "end of the dialog")


def _answer_file(hand: Hand, path: Path) -> None:
    """Name a file in the file dialog and press Save."""
    hand.wait_until(lambda: _dialog(QFileDialog) is not None, "file dialog")
    dialog = _dialog(QFileDialog)
    assert dialog is not None
    path.unlink(missing_ok=True)
    assert isinstance(dialog, QFileDialog)
    # Not typed: the list of completions would take the click.
    dialog.selectFile(str(path.resolve()))
    buttons = dialog.findChild(QDialogButtonBox)
    assert isinstance(buttons, QDialogButtonBox)
    hand.click(buttons.button(QDialogButtonBox.StandardButton.Save))
    hand.wait_until(lambda: _dialog(QFileDialog) is None, "end of the file dialog")


#: In one window on the sample hand.
WALK: tuple[Step, ...] = (
    ("first-picture", "The window as it opens on a sample", _nothing),
    ("orbit", "A drag turns the subject", _orbit),
    ("move-light", "Shift-drag moves the lamp; its guide shows where it is", _move_light),
    ("undo", "Undo takes it back", _let_light_go),
    ("redo", "Redo brings it again", _redo),
    ("unlit", "Hold B: the picture without light", _unlit),
    ("rig", "A rig lights the volume by one click", _rig),
    ("second-lamp", "A second lamp, and the Light tool's handles", _second_lamp),
    ("lamp-colour", "The lamp's colour", _lamp_colour),
    ("solo", "Solo: the other lamp is dark", _solo),
    ("soft", "A larger lamp: softer shadows", _soft),
    ("technique", "The technique's own section, and More", _technique),
    ("own-rig", "The lamps are kept as a rig of one's own", _own_rig),
    ("audit", "Shadow audit: what shadows darken below a quarter of its light", _audit),
    ("wipe", "Compare: a wipe between the lit and the unlit picture", _wipe),
    ("rig-grid", "Compare: the same view under each rig, with the time of a frame", _rig_grid),
    ("material", "Material: function over the histogram, presets", _material),
    ("preset", "Another preset", _preset),
    ("point", "A point of the function is dragged", _drag_point),
    ("pick", "Pick: what lies under the pointer, found in the function", _pick),
    (
        "shapes",
        "A function of value and gradient: only where values change steeply is anything seen",
        _shapes,
    ),
    ("view", "View: orthographic", _view),
    ("clip-plane", "A clip plane, moved by its handle", _clip_plane),
    ("solid-cut", "The plane towards the eye, its cut face solid", _solid),
    ("crop", "The crop box, moved by its handle", _crop),
    ("view-more", "Quality, sampling and theme; the orientation cube", _view_more),
    ("slices", "Slice views beside the picture, with the lamps in them", _slices),
    ("open-menu", "Open: files, folders, recent ones, samples", _open_menu),
    ("export", "Export for print", _export),
    ("exporting", "The export tells how far it is", _exporting),
    ("exported", "The export is done", _exported),
    ("saved", "The scene is saved", _save),
)

#: In a new window after a crash.
AFTER_CRASH: tuple[Step, ...] = (
    ("recovery", "After a crash: unsaved work is offered", _nothing),
    ("recovered", "It is as it was", _recover),
)


def numbered() -> Iterator[tuple[str, Step]]:
    """Yield all steps with the names of their screenshots."""
    for i, step in enumerate((*WALK, *AFTER_CRASH), 1):
        yield f"{i:02d}-{step[0]}", step
