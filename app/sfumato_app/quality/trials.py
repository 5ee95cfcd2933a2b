"""The scenes in which shadows are measured."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

import sfumato_samples
from sfumato import Light, Scene, Volume, load

from .staging import Placing, Rgb, Stage, resampled, staged

#: Real data sets, which are no part of the project, lie beside the repository.
DATA = Path(os.environ.get("SFUMATO_DATA", Path(__file__).resolve().parents[4] / "shared" / "data"))
IVORY, SKIN, LEAF, RED, CLAY, STEEL = (
    (0.56, 0.5, 0.4), (0.5, 0.31, 0.24), (0.1, 0.24, 0.06), (0.46, 0.07, 0.05), (0.34, 0.32, 0.3), (0.34, 0.4, 0.5),
)  # fmt: skip
Points = tuple[tuple[float, Rgb, float], ...]


def solid(color: Rgb, at: float = 0.5, soft: float = 0.1) -> Points:
    """Return the look of something opaque from a value on."""
    return ((at - soft, color, 0.0), (at + soft, color, 0.99), (1.0, color, 0.99))


@dataclass(frozen=True)
class Trial:
    """One scene.

    Parameters
    ----------
    id : str
        Short name, unique.
    source : str
        A sample's name, or a path below the folder of real data.
    window : (low, high)
        Values that become 0 (air) and 1.
    points : tuple
        Look of the occluders; see `staging.transfer_function`.
    placing : Placing
        Where things stand.
    lights : tuple of Light
        Seen from the camera.
    middle : float, optional
        The air's value, where occluders lie on both sides of it; windowed is the distance from it.
    """

    id: str
    source: str
    window: tuple[float, float]
    points: Points
    placing: Placing
    lights: tuple[Light, ...]
    middle: float | None = None

    @property
    def real(self) -> bool:
        """Whether it needs the real data sets."""
        return "/" in self.source

    @property
    def available(self) -> bool:
        """Whether its data are here."""
        return not self.real or (DATA / self.source).exists()

    @property
    def angles(self) -> str:
        """Tilt/aperture of each lamp."""
        return " + ".join(f"{lamp.tilt:g}/{lamp.aperture:g}" for lamp in self.lights)

    def stage(self) -> Stage:
        """Build the stage; LoadError if the data cannot be read."""
        return _stage(self)

    def scene(self, *, bare: bool = False) -> Scene:
        """Return the scene; with ``bare`` that of the wall alone."""
        stage = self.stage()
        return Scene(
            volume=stage.bare if bare else stage.volume,
            transfer=stage.transfer,
            camera=stage.camera,
            lights=self.lights,
        )


@cache
def _stage(trial: Trial) -> Stage:
    volume = load(DATA / trial.source) if trial.real else sfumato_samples.load(trial.source)
    values = _upright(volume).astype(np.float32)
    if trial.middle is not None:
        values = np.abs(values - trial.middle)
    low, high = trial.window
    occluders = np.clip((values - low) / (high - low), 0, 1)
    return staged(resampled(occluders, volume.spacing, trial.placing.side), trial.points, trial.placing)


def _upright(volume: Volume) -> np.ndarray:
    """Return the voxels with axes turned about that run against the world's."""
    direction = np.asarray(volume.direction)
    backwards = tuple(2 - axis for axis in range(3) if direction[axis, axis] < -0.5)
    return np.flip(volume.data, axis=backwards)


def lamp(tilt: float, aperture: float, rotation: float = 135.0, color: Rgb = (1, 1, 1)) -> Light:
    """Return a lamp seen from the camera."""
    return Light(tilt=tilt, aperture=aperture, rotation=rotation, color=color)


#: All scenes; tilt + aperture stays within 80 degrees.
TRIALS: dict[str, Trial] = {
    trial.id: trial
    for trial in (
        Trial("shapes", "shapes", (10, 170), solid(STEEL), Placing(gap=8), (lamp(0, 30),), middle=50),
        Trial(
            "hand", "hand", (-300, 900),
            ((0.1, SKIN, 0.0), (0.2, SKIN, 0.03), (0.38, SKIN, 0.04), (0.5, IVORY, 0.7), (1, IVORY, 0.95)),
            Placing(side=72, gap=5, shift=(-10, 6)), (lamp(35, 15),),
        ),
        Trial("bonsai", "bonsai", (0, 185), solid(LEAF, 0.35, 0.12),
              Placing(side=50, gap=2, shift=(-16, 18)), (lamp(50, 25),), middle=70),
        Trial("fish", "fish", (-200, 600),
              ((0.1, SKIN, 0.0), (0.2, SKIN, 0.08), (0.5, IVORY, 0.2), (0.8, IVORY, 0.9)),
              Placing(side=64, gap=2, shift=(0, 22)), (lamp(70, 10, 90),)),
        Trial("skull", "skull", (-100, 900), solid(IVORY, 0.45, 0.2),
              Placing(side=52, gap=2, shift=(-18, 6), perspective=True), (lamp(60, 10, 160),)),
        Trial("buckyball", "buckyball", (65, 200),
              ((0.1, CLAY, 0.0), (0.3, CLAY, 0.08), (0.9, RED, 0.3)),
              Placing(side=64, gap=12, shift=(-6, 6)), (lamp(20, 5),)),
        Trial("torso-floor", "torso", (0, 800), solid(IVORY, 0.4, 0.15),
              Placing(side=56, gap=2, elevation=55, perspective=True), (lamp(35, 15),)),
        Trial("electrodes", "mr_head_electrodes/MR.nii.gz", (60, 300), solid(SKIN, 0.3, 0.2),
              Placing(side=56, gap=6, shift=(-14, 10)), (lamp(35, 15, 120),)),
        Trial("aneurism", "aneurism/aneurism.vti", (0, 120), solid(RED, 0.2, 0.1),
              Placing(side=60, gap=6), (lamp(50, 25, 45),)),
        Trial("tooth", "tooth/tooth.nrrd", (85, 255),
              ((0.1, CLAY, 0.0), (0.3, IVORY, 0.06), (0.7, IVORY, 0.12), (1, IVORY, 0.5)),
              Placing(side=64, gap=8, perspective=True),
              (lamp(35, 15, 160, (1, 0.6, 0.3)), lamp(50, 25, 20, (0.2, 0.4, 0.9)))),
    )
}  # fmt: skip
