"""Local ambient occlusion and emissive tissue (Hernell2007): each point looks only into its neighbourhood.

From every texel rays go out over a short way; each brings the more light the less stands in it (`gather`, Eq. 1-3).
So nothing blacks out a whole organ, and hollows are darker than ridges, whatever the lamps do. Tissue that gives off
light shines on what is near it (Eq. 4). What is gathered does not depend on the camera: it is kept, one direction
after the other is added, and the mean so far is shown.

The volume is cut into blocks of 16^3 voxels (`pyramid`), each as coarse as can be without its looking otherwise
under the transfer function (`levels`), packed into one texture (`packing`). Light is gathered for the packed texels
alone; coarse blocks take longer steps.

Use it for shapes that hide in each other's shadows, noisy data (no gradients are needed), and to see what a bright
fragment lies next to. Lamps shade surfaces, or cast shadows as `cone` or `multidirectional`; both are
multiplied or mixed.

Where we differ from the paper: the directions' weights are the faces' solid angles; what gives off light does so by
its opacity, so that what is not there does not shine; the reverse index has an entry a block (`packing`), so blocks
of all levels can show something, but are not coarser than 4^3 unless asked; rays begin at the surface that is nearest
to a texel (`origins`), and look into the volume itself where it is there; their first step is as long in coarse
blocks as in fine ones, the others lengthen by and by, so that borders of blocks do not show; a preferred direction, a
ray to the lamp alone, and lamps beside it are choices. Values between blocks are not interpolated where a volume is
shown by its blocks alone.

Limits: nothing farther than the radius casts a shadow; light in coarse blocks is as coarse as they are.
"""

from ..registry import Technique
from .params import LocalOcclusionParams

TECHNIQUES = (
    Technique(
        "local-occlusion",
        "Local ambient occlusion",
        "Light from all around that only what is near takes away, and tissue that gives off light",
        LocalOcclusionParams,
        "..techniques.local_occlusion.passes:LocalOcclusionPainter",
        source="Hernell2007",
        around=True,
    ),
)
