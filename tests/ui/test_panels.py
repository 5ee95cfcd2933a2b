"""A walk through every panel in both themes: reachable by Tab, named, large enough, legible."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot
from qtpy.QtCore import Qt
from qtpy.QtGui import QColor
from qtpy.QtWidgets import QAbstractButton, QAbstractSlider, QApplication, QLabel, QWidget

from sfumato import Scene
from sfumato.scene import ClipPlane
from sfumato_ui.tab_order import in_visual_order
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
