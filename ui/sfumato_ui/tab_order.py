"""Tab goes through the controls as the eye does: in the order of the layouts.

Layouts are asked for the places of what is in them, never for their items (`itemAt`, `takeAt`): Qt frees an item
with its widget, PySide6 6.9 does not notice, and takes what comes to stand at the same address for that item.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QAbstractSpinBox, QComboBox, QLayout, QScrollArea, QSplitter, QTabWidget, QWidget


def in_visual_order(root: QWidget) -> Iterator[QWidget]:
    """Yield every widget that Tab can reach below a widget, in the order of its layouts."""
    if root.focusPolicy() & Qt.FocusPolicy.TabFocus and root.focusProxy() is None:
        yield root
    if isinstance(root, QAbstractSpinBox | QComboBox):
        return
    for over in getattr(root, "controls_over", ()):
        yield from in_visual_order(over)
    if isinstance(root, QTabWidget):
        yield root.tabBar()
        for i in range(root.count()):
            yield from in_visual_order(root.widget(i))
    elif isinstance(root, QSplitter):
        for i in range(root.count()):
            yield from in_visual_order(root.widget(i))
    elif isinstance(root, QScrollArea):
        yield from in_visual_order(root.widget())
    else:
        layout = root.layout()
        if layout is not None:
            yield from _in_layout(layout)


def widgets_of(layout: QLayout) -> list[QWidget]:
    """Return the widgets that stand in a layout itself, in its order."""
    parent = layout.parentWidget()
    children = parent.children() if parent is not None else ()
    inside = [c for c in children if isinstance(c, QWidget) and layout.indexOf(c) >= 0]
    return sorted(inside, key=layout.indexOf)


def _in_layout(layout: QLayout) -> Iterator[QWidget]:
    """Yield what Tab can reach in a layout, and in the layouts within it."""
    inside: list[QWidget | QLayout] = [*widgets_of(layout)]
    inside += [child for child in layout.children() if isinstance(child, QLayout)]
    for thing in sorted(inside, key=layout.indexOf):
        if isinstance(thing, QLayout):
            yield from _in_layout(thing)
        else:
            yield from in_visual_order(thing)


def set_tab_order(root: QWidget) -> None:
    """Chain all widgets below a widget in visual order."""
    chain = list(in_visual_order(root))
    for before, after in pairwise(chain):
        QWidget.setTabOrder(before, after)
