"""Colours of the window: two neutral themes with one warm accent, and the style that draws them.

All greys are neutral, so that they do not tint how the picture's colours are seen, and the picture's own
surround is the same grey in both themes. `setColorScheme` has no effect on some platforms; Fusion with an
own palette works everywhere.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from string import Template

from qtpy.QtGui import QColor, QPalette
from qtpy.QtWidgets import QApplication

#: Surround of the picture, sRGB 78: white text on it has contrast 8 : 1.
PICTURE_GREY = "#4e4e4e"
#: Least height and width of anything to click, in pixels.
TARGET = 24
_ASSETS = Path(__file__).parent / "assets"


@dataclass(frozen=True)
class Theme:
    """One set of colours; text reaches 4.5 : 1 and borders, icons and focus rings 3 : 1 on every ground."""

    name: str
    window: str
    panel: str
    base: str
    hover: str
    text: str
    muted: str
    border: str
    separator: str
    accent: str
    on_accent: str
    error: str
    on_error: str


DARK = Theme(
    name="dark",
    window="#222222",
    panel="#2a2a2a",
    base="#1b1b1b",
    hover="#3a3a3a",
    text="#ececec",
    muted="#b4b4b4",
    border="#828282",
    separator="#3c3c3c",
    accent="#f2b34c",
    on_accent="#1b1b1b",
    error="#b3372e",
    on_error="#ffffff",
)
LIGHT = Theme(
    name="light",
    window="#e6e6e6",
    panel="#f3f3f3",
    base="#ffffff",
    hover="#dcdcdc",
    text="#1b1b1b",
    muted="#545454",
    border="#828282",
    separator="#cfcfcf",
    accent="#8f5600",
    on_accent="#ffffff",
    error="#b3261e",
    on_error="#ffffff",
)
THEMES = {theme.name: theme for theme in (DARK, LIGHT)}


def current_theme() -> Theme:
    """Return the theme that the application shows."""
    app = QApplication.instance()
    return THEMES.get(str(app.property("sfumato_theme")), DARK) if app is not None else DARK


def apply_theme(app: QApplication, name: str) -> Theme:
    """Give the application a theme by name; an unknown name counts as dark."""
    theme = THEMES.get(name, DARK)
    app.setProperty("sfumato_theme", theme.name)
    if app.style().objectName() != "fusion":
        app.setStyle("Fusion")
    app.setPalette(_palette(theme))
    app.setStyleSheet(_style_sheet(theme))
    return theme


def _palette(theme: Theme) -> QPalette:
    role = QPalette.ColorRole
    palette = QPalette()
    for which, colour in {
        role.Window: theme.panel,
        role.WindowText: theme.text,
        role.Base: theme.base,
        role.AlternateBase: theme.window,
        role.Text: theme.text,
        role.Button: theme.panel,
        role.ButtonText: theme.text,
        role.BrightText: theme.on_error,
        role.Highlight: theme.accent,
        role.HighlightedText: theme.on_accent,
        role.ToolTipBase: theme.base,
        role.ToolTipText: theme.text,
        role.PlaceholderText: theme.muted,
        role.Link: theme.accent,
        role.Accent: theme.accent,
        role.Mid: theme.border,
        role.Midlight: theme.hover,
        role.Dark: theme.separator,
        role.Light: theme.hover,
    }.items():
        palette.setColor(which, QColor(colour))
    for which in (role.WindowText, role.Text, role.ButtonText):
        palette.setColor(QPalette.ColorGroup.Disabled, which, QColor(theme.border))
    return palette


def _style_sheet(theme: Theme) -> str:
    names = {f"target_less_{n}": str(TARGET - n) for n in (4, 6, 8, 12)}
    text = (_ASSETS / "window.qss").read_text(encoding="utf-8")
    return Template(text).substitute(asdict(theme), target=TARGET, assets=_ASSETS.as_posix(), **names)
