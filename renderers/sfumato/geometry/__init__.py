"""Geometry made and read: tracts and surfaces from files, streamlines from fields, tubes from lines.

=================  ==============================================================================
`load`             `load_geometry`: the file formats, by name
`tractograms`      TRK and TCK (nibabel);  `trx`: TRX;  `polydata`: VTP, VTK, STL, PLY, OBJ (VTK)
`cleaning`         what a file holds becomes a shape: bad lines are left out and counted
`field`            vector fields;  `directions`: of tensors;  `seeding`: seeds;  `streamlines`: vtkStreamTracer
`polyline`         filters, B-spline, thinning out: all lines at once
`detail`           level of detail by count
`tubes`            the sweep;  `color`: colours of points;  `meshing`: all of it, kept
`known`            what a scene names;  `color_bar`: what a picture needs to draw one
=================  ==============================================================================

The only place of the core that may import VTK or PyVista, and only inside functions: a scene without
geometry never pays for them.
"""

from .color_bar import ColorBar, color_bar, color_bars
from .field import VectorField, has_vectors, load_field
from .known import load_known
from .load import SUFFIXES, is_geometry, load_geometry, outside_notice
from .meshing import build, known_mesh, mesh_of
from .polyline import kept_lines
from .seeding import suggest_seeds
from .streamlines import trace

__all__ = [
    "SUFFIXES",
    "ColorBar",
    "VectorField",
    "build",
    "color_bar",
    "color_bars",
    "has_vectors",
    "is_geometry",
    "kept_lines",
    "known_mesh",
    "load_field",
    "load_geometry",
    "load_known",
    "mesh_of",
    "outside_notice",
    "suggest_seeds",
    "trace",
]
