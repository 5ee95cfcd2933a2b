"""Colours of the window: two neutral themes with one warm accent, and the style that draws them.

All greys are neutral, so that they do not tint how the picture's colours are seen, and the picture's own
surround is the same grey in both themes. `setColorScheme` has no effect on some platforms; Fusion with an
own palette works everywhere.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from qtpy.QtGui import QColor, QPalette
from qtpy.QtWidgets import QApplication

#: Surround of the picture, sRGB 78: white text on it has contrast 8 : 1.
PICTURE_GREY = "#4e4e4e"
#: Least height and width of anything to click, in pixels.
TARGET = 24
_ASSETS = (Path(__file__).parent / "assets").as_posix()


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
    name="dark", window="#222222", panel="#2a2a2a", base="#1b1b1b", hover="#3a3a3a", text="#ececec", muted="#b4b4b4",
    border="#828282", separator="#3c3c3c", accent="#f2b34c", on_accent="#1b1b1b", error="#b3372e", on_error="#ffffff",
)  # fmt: skip
LIGHT = Theme(
    name="light", window="#e6e6e6", panel="#f3f3f3", base="#ffffff", hover="#dcdcdc", text="#1b1b1b", muted="#545454",
    border="#828282", separator="#cfcfcf", accent="#8f5600", on_accent="#ffffff", error="#b3261e", on_error="#ffffff",
)  # fmt: skip
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
        role.Window: theme.panel, role.WindowText: theme.text, role.Base: theme.base, role.AlternateBase: theme.window,
        role.Text: theme.text, role.Button: theme.panel, role.ButtonText: theme.text, role.BrightText: theme.on_error,
        role.Highlight: theme.accent, role.HighlightedText: theme.on_accent, role.ToolTipBase: theme.base,
        role.ToolTipText: theme.text, role.PlaceholderText: theme.muted, role.Link: theme.accent, role.Accent: theme.accent,
        role.Mid: theme.border, role.Midlight: theme.hover, role.Dark: theme.separator, role.Light: theme.hover,
    }.items():  # fmt: skip
        palette.setColor(which, QColor(colour))
    for which in (role.WindowText, role.Text, role.ButtonText):
        palette.setColor(QPalette.ColorGroup.Disabled, which, QColor(theme.border))
    return palette


def _style_sheet(theme: Theme) -> str:
    t = theme
    return f"""
    #TopBar, #Strip, #StatusLine {{ background: {t.window}; }}
    #TopBar {{ border-bottom: 1px solid {t.separator}; }}
    #StatusLine {{ border-top: 1px solid {t.separator}; }}
    #StatusLine QLabel {{ color: {t.muted}; }}
    #Strip {{ border-right: 1px solid {t.separator}; }}
    #Panel, #Panel QScrollArea, #PanelPage {{ background: {t.panel}; border: none; }}
    QLabel[muted="true"] {{ color: {t.muted}; }}
    QLabel[heading="true"] {{ font-weight: 600; }}

    QToolButton {{ border: 2px solid transparent; border-radius: 5px; padding: 3px 6px; min-width: {TARGET - 12}px;
                   min-height: {TARGET - 6}px; color: {t.text}; background: transparent; }}
    QToolButton:hover {{ background: {t.hover}; }}
    QToolButton:pressed {{ background: {t.separator}; }}
    QToolButton[section="true"] {{ text-align: left; font-weight: 600; padding: 3px 0px; }}
    QToolButton[section="true"]:checked {{ background: transparent; color: {t.text}; }}
    QToolButton[section="true"]:checked:hover {{ background: {t.hover}; }}
    QToolButton[section="true"]:checked:focus {{ border-color: {t.accent}; }}
    QToolButton:checked {{ background: {t.accent}; color: {t.on_accent}; }}
    QToolButton:focus {{ border-color: {t.accent}; }}
    QToolButton:checked:focus {{ border-color: {t.text}; }}
    QToolButton:disabled {{ color: {t.border}; }}

    QPushButton {{ border: 1px solid {t.border}; border-radius: 5px; padding: 4px 12px; min-height: {TARGET - 8}px;
                   background: {t.base}; color: {t.text}; }}
    QPushButton[compact="true"] {{ padding: 4px 2px; }}
    QPushButton[compact="true"]:focus {{ padding: 3px 1px; }}
    QPushButton:hover {{ background: {t.hover}; }}
    QPushButton:focus {{ border: 2px solid {t.accent}; padding: 3px 11px; }}
    QPushButton:checked, QPushButton:default {{ background: {t.accent}; color: {t.on_accent}; border-color: {t.accent}; }}
    QPushButton:default:focus, QPushButton:checked:focus {{ border-color: {t.text}; }}
    QPushButton:disabled {{ color: {t.border}; border-color: {t.separator}; }}

    QDoubleSpinBox, QSpinBox, QComboBox, QLineEdit {{ border: 1px solid {t.border}; border-radius: 4px; background: {t.base};
                   color: {t.text}; min-height: {TARGET - 4}px; padding: 1px 6px; selection-background-color: {t.accent};
                   selection-color: {t.on_accent}; }}
    QDoubleSpinBox:focus, QSpinBox:focus, QComboBox:focus, QLineEdit:focus {{ border: 2px solid {t.accent}; padding: 0px 5px; }}
    QComboBox QAbstractItemView {{ background: {t.base}; color: {t.text}; border: 1px solid {t.border};
                   selection-background-color: {t.accent}; selection-color: {t.on_accent}; outline: none; }}
    QComboBox QAbstractItemView::item {{ min-height: {TARGET}px; }}

    QTabWidget::pane {{ border: none; border-top: 1px solid {t.separator}; }}
    QTabBar {{ background: {t.panel}; }}
    QTabBar::tab {{ background: transparent; color: {t.muted}; padding: 8px 0px 6px 0px; width: 106px; min-height: 20px;
                    border: none; border-bottom: 3px solid transparent; }}
    QTabBar::tab:hover {{ color: {t.text}; }}
    QTabBar::tab:selected {{ color: {t.text}; border-bottom-color: {t.accent}; font-weight: 600; }}
    QTabBar::tab:focus {{ color: {t.text}; background: {t.hover}; }}

    QListWidget {{ background: {t.base}; border: 1px solid {t.border}; border-radius: 5px; outline: none; }}
    QListWidget:focus {{ border: 2px solid {t.accent}; }}
    QListWidget::item {{ padding: 4px 6px; min-height: {TARGET}px; color: {t.text}; }}
    QListWidget::item:hover {{ background: {t.hover}; }}
    QListWidget::item:selected {{ background: {t.accent}; color: {t.on_accent}; }}

    QComboBox::drop-down {{ border: none; width: 22px; }}
    QComboBox::down-arrow {{ image: url({_ASSETS}/arrow-{t.name}.svg); width: 12px; height: 12px; }}
    QComboBox:disabled, QDoubleSpinBox:disabled, QSpinBox:disabled {{ color: {t.border}; border-color: {t.separator}; }}
    QCheckBox::indicator {{ width: 16px; height: 16px; border: 1px solid {t.border}; border-radius: 4px; background: {t.base}; }}
    QCheckBox::indicator:checked {{ background: {t.accent}; border-color: {t.accent};
                    image: url({_ASSETS}/check-{"dark" if t.name == "dark" else "light"}.svg); }}
    QCheckBox {{ min-height: {TARGET}px; spacing: 8px; border: 2px solid transparent; border-radius: 4px; }}
    QCheckBox:focus {{ border-color: {t.accent}; }}

    QProgressBar {{ border: none; border-radius: 3px; background: {t.separator}; max-height: 6px; min-height: 6px; }}
    QProgressBar::chunk {{ background: {t.accent}; border-radius: 3px; }}
    QToolTip {{ background: {t.base}; color: {t.text}; border: 1px solid {t.border}; padding: 4px 6px; }}

    QScrollBar:vertical {{ background: transparent; width: 10px; margin: 0; }}
    QScrollBar::handle:vertical {{ background: {t.border}; border-radius: 3px; min-height: 32px; margin: 2px; }}
    QScrollBar::add-line, QScrollBar::sub-line, QScrollBar::add-page, QScrollBar::sub-page {{ height: 0; background: none; }}
    """
