"""How near shadows are to the truth: techniques against the ray-traced cone on plain receivers.

::

    staging     occluders and a pale wall or floor in one volume; the camera before it
    trials      the scenes: samples and real data, lights of several tilts and apertures
    truth       float64: which pixels show bare wall, how bright each should be; kept on disk
    contestants what is measured: techniques with their parameters, qualities
    measure     one picture: its error, its copies of shadows, its cost; slices more and fewer
    report, plot, sheet, page   what is told about it

*Brightness* is the wall's luminance over that of the same wall with nothing before it: 1 is unshadowed. The
error is the root mean square of a picture's brightness minus the truth's, over all pixels that show bare wall.
What is only to be seen through tissue is left out: there, colour would be compared, not shadow.

To add a scene, add an entry to `trials.TRIALS`; a new technique takes part by its place in
`contestants.PREFERRED`.
"""

from .command import main

__all__ = ["main"]
