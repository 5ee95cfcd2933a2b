"""VTK's own view of the geometry, beside the lit picture: to look, to pick lines, to place seeds and regions.

`link`: our camera and VTK's.  `stage`: what VTK shows (QtInteractor of pyvistaqt, made when first wanted).
`tools`: seeds and regions by VTK's widgets.  `panel`: the stage with its bar.  `layout`: beside the picture,
undocked, or hidden.
"""
