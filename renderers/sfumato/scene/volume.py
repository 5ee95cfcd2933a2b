"""Volumes: voxels with their place in the patient, held by the key of their content."""

from __future__ import annotations

import functools
import hashlib
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..errors import SceneError
from .transfer import TransferFunction

Vec3 = tuple[float, float, float]
IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True)
class VolumeInfo:
    """What a reader knows about a volume besides its voxels; nothing here identifies a patient.

    Parameters
    ----------
    path : str
        Where it was read from, or empty.
    modality : str
        ``CT`` (Hounsfield units), ``MR``, ``US``, or empty when not known.
    orientation_known : bool
        Whether the axes are the patient's (LPS); if not, no letters are shown and no side is called left.
    notices : tuple of str
        What the reader did to the data and the user should know, one sentence each.
    name : str
        Short name for titles and lists.
    transfer : TransferFunction, optional
        How its maker wants it to look at first; samples have one.
    """

    path: str = ""
    modality: str = ""
    orientation_known: bool = False
    notices: tuple[str, ...] = ()
    name: str = ""
    transfer: TransferFunction | None = None


@dataclass(frozen=True, eq=False)
class Volume:
    """A scalar volume in world space (millimetres, LPS, right-handed).

    Parameters
    ----------
    data : ndarray, shape (z, y, x)
        uint8, int8, uint16, int16 or float32 are kept; other numeric types become float32; NaN and
        infinities become the smallest finite value, with a notice. Made read-only.
    spacing : (float, float, float)
        Distance between voxel centres along the array's x, y and z axis in mm.
    origin : (float, float, float), optional
        Centre of voxel 0 in mm. The default, half the spacing, lets the volume span [0, n * spacing].
    direction : 3 x 3, optional
        Columns are the array axes x, y, z in world space, orthonormal (left-handed is allowed: a
        mirrored array is not a mirrored patient).
    info : VolumeInfo, optional
        What else is known.

    Raises
    ------
    SceneError
        If the array is not three-dimensional and numeric, or the geometry is not usable.
    """

    data: np.ndarray
    spacing: Vec3 = (1.0, 1.0, 1.0)
    origin: Vec3 | None = None
    direction: tuple[Vec3, Vec3, Vec3] | None = None
    info: VolumeInfo = field(default_factory=VolumeInfo)

    def __post_init__(self) -> None:
        data, notices = _canonical_voxels(self.data)
        spacing = _vector("volume.spacing", self.spacing)
        if min(spacing) <= 0:
            raise SceneError("volume.spacing", self.spacing, "three lengths > 0 mm")
        origin = (
            tuple(s / 2 for s in spacing) if self.origin is None else _vector("volume.origin", self.origin)
        )
        direction = np.asarray(IDENTITY if self.direction is None else self.direction, dtype=float)
        if direction.shape != (3, 3) or not np.allclose(direction.T @ direction, np.eye(3), atol=1e-3):
            raise SceneError("volume.direction", self.direction, "a 3 x 3 matrix with orthonormal columns")
        object.__setattr__(self, "data", data)
        object.__setattr__(self, "spacing", spacing)
        object.__setattr__(self, "origin", origin)
        object.__setattr__(self, "direction", tuple(tuple(float(c) for c in row) for row in direction))
        if notices:
            object.__setattr__(self, "info", replace(self.info, notices=self.info.notices + notices))

    # -- identity ---------------------------------------------------------------------------------
    @functools.cached_property
    def key(self) -> str:
        """Hash of voxels and geometry: the same content has the same key, wherever it was read from."""
        digest = hashlib.blake2b(digest_size=16)
        digest.update(
            repr((self.data.shape, self.data.dtype.str, self.spacing, self.origin, self.direction)).encode()
        )
        digest.update(np.ascontiguousarray(self.data).data)
        return digest.hexdigest()

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, Volume) and self.key == other.key)

    def __hash__(self) -> int:
        return hash(self.key)

    def __repr__(self) -> str:
        x, y, z = self.dims
        return f"<Volume {x} x {y} x {z} {self.data.dtype} spacing {self.spacing} mm>"

    # -- geometry ---------------------------------------------------------------------------------
    @property
    def dims(self) -> tuple[int, int, int]:
        """Number of voxels along x, y and z."""
        z, y, x = self.data.shape
        return x, y, z

    @property
    def min_spacing(self) -> float:
        """Smallest spacing in mm: the unit in which a scene's ``step`` is given."""
        return min(self.spacing)

    @property
    def unit_distance(self) -> float:
        """Geometric mean of the spacing in mm: the default distance to which opacities refer."""
        return float(np.prod(self.spacing) ** (1 / 3))

    @functools.cached_property
    def texture_from_world(self) -> np.ndarray:
        """Affine 4 x 4 that takes world mm to texture coordinates, where the volume is [0, 1]^3."""
        return np.linalg.inv(self.world_from_texture)

    @functools.cached_property
    def world_from_texture(self) -> np.ndarray:
        """Affine 4 x 4 from texture coordinates to world mm; voxel i's centre lies at (i + 1/2) / n."""
        axes = np.asarray(self.direction) * np.asarray(self.spacing)
        matrix = np.eye(4)
        matrix[:3, :3] = axes * np.asarray(self.dims)
        matrix[:3, 3] = np.asarray(self.origin) - axes @ np.array([0.5, 0.5, 0.5])
        return matrix

    def corners(self, low: Vec3 = (0, 0, 0), high: Vec3 = (1, 1, 1)) -> np.ndarray:
        """Return the eight corners, in world mm, of a box given in texture coordinates; shape (8, 3)."""
        box = np.array(
            [
                [(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]]
                for i in (0, 1)
                for j in (0, 1)
                for k in (0, 1)
            ]
        )
        matrix = self.world_from_texture
        return np.asarray(box @ matrix[:3, :3].T + matrix[:3, 3])

    @property
    def diagonal(self) -> float:
        """Length in mm from the volume's first corner to its last."""
        return float(np.linalg.norm(np.subtract(*self.corners()[[0, -1]])))

    @property
    def center(self) -> Vec3:
        """World position of the middle of the volume in mm."""
        middle = self.corners().mean(axis=0)
        return float(middle[0]), float(middle[1]), float(middle[2])

    # -- values -----------------------------------------------------------------------------------
    @functools.cached_property
    def value_range(self) -> tuple[float, float]:
        """Smallest and largest voxel value."""
        return float(self.data.min()), float(self.data.max())

    @functools.cached_property
    def histogram(self) -> tuple[np.ndarray, np.ndarray]:
        """Counts and bin edges of the values, 512 bins over the value range (256 for 8-bit data)."""
        low, high = self.value_range
        bins = 256 if self.data.dtype.itemsize == 1 else 512
        counts, edges = np.histogram(self.data, bins=bins, range=(low, high if high > low else low + 1))
        return counts, edges


def _vector(path: str, value: Any) -> Vec3:
    try:
        x, y, z = (float(v) for v in value)
    except (TypeError, ValueError):
        raise SceneError(path, value, "three numbers are needed") from None
    if not np.isfinite((x, y, z)).all():
        raise SceneError(path, value, "three finite numbers are needed")
    return x, y, z


_KEPT = {np.dtype(t) for t in ("uint8", "int8", "uint16", "int16", "float32")}


def _canonical_voxels(data: Any) -> tuple[np.ndarray, tuple[str, ...]]:
    array = np.asarray(data)
    if array.dtype == bool:
        array = array.astype(np.uint8)
    if array.ndim != 3 or array.size == 0 or array.dtype.kind not in "uif":
        raise SceneError(
            "volume.data",
            f"array of shape {array.shape} and type {array.dtype}",
            "a non-empty numeric array (z, y, x) is needed",
        )
    notices: tuple[str, ...] = ()
    if not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder("="))
    if array.dtype not in _KEPT:
        array = _narrowed(array)
    if array.dtype.kind == "f":
        bad = ~np.isfinite(array)
        count = int(bad.sum())
        if count:
            if count == array.size:
                raise SceneError("volume.data", "NaN or infinite everywhere", "finite values are needed")
            array = np.where(bad, array[~bad].min(), array).astype(np.float32)
            notices = (f"{count} voxels were NaN or infinite and count as the smallest value.",)
    if array.base is not None or array.flags.writeable:
        array = (
            np.array(array, order="C", copy=True)
            if array is data or array.base is not None
            else np.ascontiguousarray(array)
        )
    array.flags.writeable = False
    return array, notices


def _narrowed(array: np.ndarray) -> np.ndarray:
    """Return wide integers in the narrowest kept type that holds them exactly, everything else as float32."""
    if array.dtype.kind in "ui":
        low, high = int(array.min()), int(array.max())
        for kind in (np.uint8, np.int16, np.uint16):
            limits = np.iinfo(kind)
            if limits.min <= low and high <= limits.max:
                return array.astype(kind)
    with np.errstate(over="ignore"):
        return array.astype(np.float32)
