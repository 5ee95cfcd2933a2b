"""Slice views beside the picture: axial, coronal and sagittal, linked by a cross-hair, with the lamps in them.

`state`: cross-hair, zoom, window and level; the window's own, no part of the scene (a scene with another
cross-hair would be another scene to every cache).  `slicer`: the thread that slices.  `pane`: one view, and what
mouse and keys do there (`hand`, `lamps`).  `painting`: how it looks.  `panel`: three panes with their bar.
`layout`: beside the picture, or closed.
"""
