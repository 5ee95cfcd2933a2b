"""Slice views beside the picture: axial, coronal and sagittal, linked by a cross-hair, with the light in them.

`state`: cross-hair, zoom, window and level; the window's own, no part of the scene (a scene with another
cross-hair would be another scene to every cache).  `slicer`: makes the slices; `lighter`: how much light reaches
them; each in a thread of its own (`newest`).  `canvas`, `painting`: one view as it is seen.  `pane`: what mouse and
keys do in it; `lamps`: the lamps there.  `panel`: three views with their bar (`window_row`, `values`).  `layout`:
beside the picture, or closed.
"""
