"""The editor of transfer functions: points over the volume's histogram, or shapes over that of value and gradient.

Of one dimension: `canvas` shows the function, `plot` lets points be dragged, `scale` maps values and opacities
to pixels, `histogram` and `tissue` say what lies behind, `painting` draws it.

Of two: `region_canvas` shows the function over the joint histogram (counted by `joint_count` on its own thread),
`region_edits` changes shapes, `region_plot` lets them be dragged and drawn, `plane` maps values and gradients to
pixels, `region_hits` tells what lies under the pointer, `new_shapes` where a new one goes, `region_painting` draws
it; `region_editor` and `extents` put the list of shapes and the typed numbers below it.

`editor` holds both, with the switch between them in `dimensions`. All is drawn by QPainter rather than by
pyqtgraph: curve and shapes carry the tissue's colours, follow both themes, and a move costs a few milliseconds.
"""

from .editor import TransferEditor

__all__ = ["TransferEditor"]
