"""A walk through every panel in both themes: reachable by Tab, named, large enough, legible."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import Qt
from qtpy.QtGui import QColor
from qtpy.QtWidgets import QAbstractButton, QAbstractSlider, QApplication, QLabel, QWidget

import sfumato_ui
from sfumato import Scene
from sfumato.scene import ClipPlane
from sfumato_ui.section import Section
from sfumato_ui.tab_order import in_visual_order, widgets_of
from sfumato_ui.theme import PICTURE_GREY, TARGET, THEMES, Theme
from sfumato_ui.window import MainWindow


@pytest.fixture(params=sorted(THEMES))
def walked(request: pytest.FixtureRequest, make_window: object, ball_scene: Scene) -> MainWindow:
    """A window in each theme, with all sections open."""
    window: MainWindow = make_window(ball_scene.with_(clip=(ClipPlane((20, 20, 20)),)), size=(1280, 720))  # type: ignore[operator]
    window.set_theme(request.param)
    for section in (
        window.light_page.own,
        window.light_page.more,
        window.material_page.more,
        window.view_page.more,
    ):
        section.set_open(True)
    return window


def controls_of(window: MainWindow, tab: int) -> list[QWidget]:
    """Return what Tab must reach with a tab in front, in visual order."""
    window.panel.setCurrentIndex(tab)
    QApplication.processEvents()
    return [w for w in in_visual_order(window.centralWidget()) if w.isVisible() and w.isEnabled()]


@pytest.mark.parametrize("tab", [0, 1, 2])
def test_tab_reaches_each_control_once_in_visual_order(walked: MainWindow, qtbot: QtBot, tab: int) -> None:
    expected = controls_of(walked, tab)
    assert len(expected) > 8
    expected[0].setFocus()
    reached = []
    for _ in expected:
        reached.append(QApplication.focusWidget())
        qtbot.keyClick(reached[-1], Qt.Key.Key_Tab)
    names = [(type(w).__name__, w.accessibleName()) for w in reached]
    assert names == [(type(w).__name__, w.accessibleName()) for w in expected]


@pytest.mark.parametrize("tab", [0, 1, 2])
def test_controls_have_names_and_are_large_enough(walked: MainWindow, tab: int) -> None:
    for control in controls_of(walked, tab):
        label = control.accessibleName() or (control.text() if isinstance(control, QAbstractButton) else "")
        assert label, f"{control} has no name"
        assert control.height() >= TARGET, f"{label} is {control.height()} pixels high"
        assert control.width() >= TARGET, f"{label} is {control.width()} pixels wide"
        if isinstance(control, QAbstractSlider):
            assert any(c.isdigit() for c in control.accessibleDescription()), f"{label} tells no value"


@pytest.mark.parametrize("tab", [0, 1, 2])
def test_no_label_is_narrower_than_its_text(walked: MainWindow, tab: int) -> None:
    controls_of(walked, tab)
    for label in walked.centralWidget().findChildren(QLabel):
        if label.isVisible() and label.text() and not label.wordWrap():
            # A text that came this moment has its room after the next layout.
            label.parentWidget().layout().activate()
            assert label.width() >= label.fontMetrics().horizontalAdvance(label.text()), label.text()
    page = walked.panel.widget(tab)
    assert page.widget().width() <= page.viewport().width(), "the panel is cut off at its right edge"


def luminance(color: str) -> float:
    """Return relative luminance (WCAG 2)."""
    channels = [
        c / 12.92 if c <= 0.03928 else ((c + 0.055) / 1.055) ** 2.4 for c in QColor(color).getRgbF()[:3]
    ]
    return 0.2126 * channels[0] + 0.7152 * channels[1] + 0.0722 * channels[2]


def contrast(a: str, b: str) -> float:
    """Return the contrast ratio of two colours (WCAG 2)."""
    high, low = sorted((luminance(a), luminance(b)), reverse=True)
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("theme", THEMES.values(), ids=THEMES)
def test_contrast(theme: Theme) -> None:
    for ground in (theme.window, theme.panel, theme.base, theme.hover):
        assert contrast(theme.text, ground) >= 4.5
        assert contrast(theme.accent, ground) >= 3
    for ground in (theme.window, theme.panel, theme.base):
        assert contrast(theme.muted, ground) >= 4.5
        assert contrast(theme.border, ground) >= 3
    assert contrast(theme.on_accent, theme.accent) >= 4.5
    assert contrast(theme.on_error, theme.error) >= 4.5
    assert contrast("#ffffff", PICTURE_GREY) >= 4.5


@pytest.mark.parametrize(
    ("scale", "font"),
    [
        (1.0, 1.25),
        *(pytest.param(*case, marks=pytest.mark.slow) for case in ((1.0, 1.0), (1.5, 1.0), (2.0, 1.0))),
    ],
)
def test_the_walk_finds_nothing_wrong(scale: float, font: float, tmp_path: Path) -> None:
    """All tabs and dialogs in both themes; what is looked at is told in `panel_walk`."""
    env = {**os.environ, "QT_SCALE_FACTOR": str(scale), "SFUMATO_SETTINGS": str(tmp_path)}
    run = subprocess.run(
        [sys.executable, str(Path(__file__).with_name("panel_walk.py")), str(font), str(tmp_path)],
        env=env, capture_output=True, text=True, timeout=240, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout.splitlines()[-1])
    assert found["ratio"] == scale
    assert found["wrong"] == []
    if font == 1.0:
        assert found["picture"] >= 0.62, "the picture keeps its part of 1280 x 720"


def test_each_tab_has_at_most_seven_essentials(make_window: object) -> None:
    """What a tab shows while its sections are closed; a heading's group counts as one."""
    window: MainWindow = make_window()  # type: ignore[operator]
    for page in (window.light_page, window.material_page, window.view_page):
        shown = widgets_of(page.column)
        rows = [w for w in shown if not isinstance(w, QLabel | Section)]
        groups = [w for w in rows if any(in_visual_order(w))]
        assert 0 < len(groups) <= 7, [type(w).__name__ for w in groups]


def test_nobody_asks_layouts_for_their_items() -> None:
    """After hours of use PySide took a VTK surface, and a table's header, for a layout's item (see `tab_order`)."""
    for file in Path(sfumato_ui.__file__).parent.rglob("*.py"):
        asked = re.search(r"\.(itemAt|takeAt)\(", file.read_text(encoding="utf-8"))
        assert asked is None, file
