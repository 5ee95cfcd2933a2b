"""Panels beside the picture: each takes its width from the picture alone."""

from __future__ import annotations

from qtpy.QtWidgets import QSplitter, QWidget


def dock(splitter: QSplitter, panel: QWidget, part: float) -> None:
    """Give a panel of a splitter a part of the picture's width; the picture is first, other panels keep theirs.

    Parameters
    ----------
    panel : QWidget
        In the splitter already, and shown.
    part : float
        0 to 1.
    """
    sizes, at = splitter.sizes(), splitter.indexOf(panel)
    others = sum(size for i, size in enumerate(sizes) if i not in (0, at))
    room = splitter.width() - others
    sizes[0], sizes[at] = round(room * (1 - part)), round(room * part)
    splitter.setSizes(sizes)


__all__ = ["dock"]
