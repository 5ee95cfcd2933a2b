"""Tab goes through the controls as the eye does: in the order of the layouts."""

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
        yield from _in_layout(root.layout())


def _in_layout(layout: QLayout | None) -> Iterator[QWidget]:
    for i in range(layout.count() if layout is not None else 0):
        item = layout.itemAt(i) if layout is not None else None
        if item is not None and item.widget() is not None:
            yield from in_visual_order(item.widget())
        elif item is not None:
            yield from _in_layout(item.layout())


def set_tab_order(root: QWidget) -> None:
    """Chain all widgets below a widget in visual order."""
    chain = list(in_visual_order(root))
    for before, after in pairwise(chain):
        QWidget.setTabOrder(before, after)
