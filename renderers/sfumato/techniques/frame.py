"""What a technique is given to draw one frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..scene import Camera, Scene, TransferFunction, Volume

if TYPE_CHECKING:
    from ..gpu import Device, Target


@dataclass(frozen=True)
class Quality:
    """How much of the full quality is spent on a frame: the same shading at lower resolution.

    Parameters
    ----------
    scale : float
        Resolution of the picture, relative to its size.
    step : float
        Factor on the scene's sampling distance.
    light : float
        Factor on the size of the light's texels.
    progressive : bool
        Whether light that takes long may come by and by, frame after frame; otherwise it is waited for.
    """

    scale: float = 1.0
    step: float = 1.0
    light: float = 1.0
    progressive: bool = False

    @property
    def rough(self) -> bool:
        """Whether the picture is a passing one, while something moves."""
        return self.step > 1


#: Everything that was asked for.
FULL = Quality()
#: While the user drags.
DRAG = Quality(scale=0.5, step=2.0, light=2.25, progressive=True)


@dataclass
class Frame:
    """One frame to draw: scene, size in pixels, quality, which jitter, and where to.

    ``jitter`` is the offset of the slices or samples in units of the sampling distance, in [0, 1);
    ``pixel_jitter`` the offset of the rays in pixels, each in [-0.5, 0.5]. A frame may be a part of a ``whole``
    larger picture: then ``corner`` is its lower left pixel, counted from the whole's lower left. A painter tells
    by ``light`` how much (0 to 1) of the light that comes by and by is there; before it is ``settled``, the next
    frame takes this one's place. An ``unshadowed`` frame shows every sample in all the light that would reach it if
    nothing were in the way, and only then an opaque surface in front of a lamp of intensity 1 has its own colour: it
    is what shadows are measured by.
    """

    device: Device
    scene: Scene
    size: tuple[int, int]
    target: Target
    quality: Quality = FULL
    index: int = 0
    corner: tuple[int, int] = (0, 0)
    whole: tuple[int, int] | None = None
    light: float = 1.0
    unshadowed: bool = False

    @property
    def settled(self) -> bool:
        """Whether the light is as good as it gets."""
        return self.light >= 1

    @property
    def whole_size(self) -> tuple[int, int]:
        """Size in pixels of the picture that the camera sees, of which this frame may be a part."""
        return self.whole or self.size

    @property
    def volume(self) -> Volume:
        """The scene's volume."""
        assert self.scene.volume is not None
        return self.scene.volume

    @property
    def camera(self) -> Camera:
        """The scene's camera."""
        assert self.scene.camera is not None
        return self.scene.camera

    @property
    def part_camera(self) -> Camera:
        """The camera whose whole picture is this frame."""
        if self.size == self.whole_size:
            return self.camera
        (x, y), (width, height), whole = self.corner, self.size, self.whole_size
        return self.camera.cropped(
            x / whole[0], y / whole[1], (x + width) / whole[0], (y + height) / whole[1]
        )

    @property
    def transfer(self) -> TransferFunction:
        """The scene's transfer function."""
        assert self.scene.transfer is not None
        return self.scene.transfer

    @property
    def params(self) -> Any:
        """The technique's own parameters."""
        return self.scene.technique

    @property
    def nominal_step(self) -> float:
        """Sampling distance in mm at full quality."""
        return self.scene.step * self.volume.min_spacing

    @property
    def step(self) -> float:
        """Sampling distance in mm of this frame."""
        return self.nominal_step * self.quality.step

    @property
    def jitter(self) -> float:
        """Offset of the samples along the view, a low-discrepancy sequence that starts in the middle."""
        return (0.5 + self.index * 0.6180339887498949) % 1.0

    @property
    def pixel_jitter(self) -> tuple[float, float]:
        """Offset of the rays in pixels: R2 sequence, (0, 0) first."""
        return _r2(self.index)

    @property
    def lattice_jitter(self) -> tuple[float, float]:
        """Offset of the occlusion buffers' grid in texels, in another order than the rays'."""
        return _r2(self.index * 7)


def _r2(index: int) -> tuple[float, float]:
    """Return a point of the R2 low-discrepancy sequence in [-0.5, 0.5)^2; (0, 0) is the first."""
    g = 1.32471795724474602596
    return (0.5 + index / g) % 1.0 - 0.5, (0.5 + index / (g * g)) % 1.0 - 0.5
