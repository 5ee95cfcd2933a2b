"""Geometry made and read: tracts and surfaces from files, streamlines from fields, tubes from lines.

The only place of the core that may import VTK or PyVista, and only inside functions: a scene without
geometry never pays for them.
"""

from .meshing import mesh_of

__all__ = ["mesh_of"]
