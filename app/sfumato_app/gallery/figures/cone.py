"""Figure 8: what aperture and tilt do."""

from __future__ import annotations

from sfumato import Light, Scene, TransferFunction

from ..figure import Figure, panels
from ..setting import lit, look, still
from ..staging import CLOTH_POINTS, before_cloth

BONE = (0.60, 0.53, 0.39)


def figure_8() -> Figure:
    """Two apertures and two tilts."""
    transfer = TransferFunction.from_points(
        [*CLOTH_POINTS, (180, BONE, 0.0), (360, BONE, 0.9), (1500, (0.66, 0.61, 0.50), 0.95)]
    )
    volume = before_cloth("hand", -6, 44, 6.0)
    bones = still(Scene(volume=volume, transfer=transfer, camera=look((64.0, 48.0, 128.0), 214)))
    cones = ((10, 37), (40, 37), (40, 5))
    return Figure(
        8,
        "Aperture and tilt of the cone of light",
        "The paper shows a gecko; here are the bones of the hand, with the lamp to the right as there. A narrow "
        "cone gives shadows with edges, a wide one soft shadows that fade with distance; with hardly any "
        "tilt they gather around what casts them.",
        panels(
            *(
                (
                    lit(bones, Light(aperture=theta, tilt=alpha, rotation=0)),
                    f"aperture {theta}°, tilt {alpha}°",
                )
                for theta, alpha in cones
            )
        ),
        (448, 512),
    )
