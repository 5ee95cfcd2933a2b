"""The editor of a one-dimensional transfer function: points over the volume's logarithmic histogram.

`canvas` shows it, `plot` lets points be dragged, `editor` puts the typed numbers below it; `scale` maps
values and opacities to pixels, `histogram` and `tissue` say what lies behind, `painting` draws it all. It is
drawn by QPainter rather than by pyqtgraph: the curve carries the tissue's colours, follows both themes, and
a move costs a few milliseconds.
"""

from .editor import TransferEditor

__all__ = ["TransferEditor"]
