"""The gallery's page, in Markdown."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import date
from pathlib import Path

from sfumato import SfumatoError

from .figure import Cuts, Difference, Explicit, Figure, Panel

COMMAND = "sfumato gallery"
#: Techniques to which a lamp has a direction but no aperture.
GRADIENT_SHADED = ("raycast-phong", "slices-phong")
_HEAD = """# Gallery

The figures of [Soltesova2010](https://doi.org/10.1111/j.1467-8659.2009.01695.x), *A Multidirectional Occlusion
Shading Model for Direct Volume Rendering*, made again. The paper's data sets are not free; these are our
own samples, made by code, so that `{command}` draws this page anywhere. The lamp's angles stand below each
figure; the aperture is the half angle of its cone.

Drawn on {day} with {renderer}.
"""
_PAPERS = {
    "Soltesova2010": "",
    "Hernell2007": """
# Local ambient occlusion and emissive tissue

Figures of Hernell2007, *Efficient Ambient and Emissive Tissue Illumination using Local Occlusion in Multiresolution
Volume Rendering*, made again with our samples by `local-occlusion`.
""",
    "Schott2012": """
# Geometry and volume under one light

Figures of [Schott2012](https://doi.org/10.1109/PacificVis.2012.6183588), *Combined Surface and Volumetric Occlusion
Shading*, made again by `combined`: the mixing pipe is our own sample; fibre tracts (Stanford HARDI) and blood flow are
real data where they lie beside the project, and the pipe takes their place elsewhere.
""",
    "Schlegel2011": """
# Extinction-based shading

The figures of [Schlegel2011](https://doi.org/10.1109/TVCG.2011.198), *Extinction-based Shading and Illumination in
GPU Volume Ray-Casting*, made again with our samples by `extinction`. Lamps stand where the captions say; the cone's
half angle stands below each figure where it is not the lamp's own.
""",
}
_FIGURE = """
## Figure {number}: {title}

![{alt}]({picture})

{caption}

{notes}
"""


def write_page(path: Path, figures: Mapping[Figure, Path], renderer: str, day: date) -> None:
    """Write the page.

    Parameters
    ----------
    figures : mapping of Figure to Path
        Where each one's picture lies; in the page's order.
    renderer : str
        Name of the graphics device.
    day : date
        When the pictures were drawn.

    Raises
    ------
    SfumatoError
        If it cannot be written.
    """
    parts = [_HEAD.format(command=COMMAND, renderer=renderer, day=day.isoformat())]
    papers = [figure.paper for figure in figures]
    for (figure, picture), before in zip(figures.items(), ["", *papers], strict=False):
        if figure.paper != before:
            parts.append(_PAPERS[figure.paper])
        parts.append(_section(figure, _relative(picture, path.parent)))
    try:
        path.write_text("".join(parts), encoding="utf-8")
    except OSError as error:
        raise SfumatoError(f"{path}: the page could not be written: {error.strerror or error}") from None


def _section(figure: Figure, picture: str) -> str:
    notes = "; ".join(f"**({panel.label})** {panel.note}{_angles(panel)}" for panel in figure.panels)
    return _FIGURE.format(
        number=figure.number,
        title=figure.title,
        alt=f"Figure {figure.number}: {figure.title}",
        picture=picture,
        caption=figure.caption,
        notes=f"{notes}.  \n`{COMMAND} --only {figure.id}`",
    )


def _angles(panel: Panel) -> str:
    """Return the lamp's angles where they matter and the note does not tell them."""
    if (
        isinstance(panel.picture, Cuts | Difference | Explicit)
        or "tilt" in panel.note
        or panel.picture.technique_id in (*GRADIENT_SHADED, "extinction", "local-occlusion")
    ):
        return ""
    (lamp,) = panel.picture.active_lights
    tilt = 0 if panel.picture.technique_id == "directional" else lamp.tilt
    return f" (tilt {tilt:g}°, aperture {lamp.aperture:g}°)"


def _relative(picture: Path, folder: Path) -> str:
    """Return the picture's path as the page names it."""
    try:
        return picture.resolve().relative_to(folder.resolve()).as_posix()
    except ValueError:
        return picture.resolve().as_posix()
