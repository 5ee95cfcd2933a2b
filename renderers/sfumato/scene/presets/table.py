"""The scanner's table and head rest: found in Hounsfield units, and cut away by planes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ..clip import ClipPlane
from ..volume import Volume
from .values import hounsfield_zero, remembered, thinned

Vec3 = tuple[float, float, float]

#: Cells along each axis of the grid on which body and table are told apart.
CELLS = 72
#: What is denser than this, in HU, may be body or table.
SOLID = -350.0
#: Sheets and rods thinner than about twice this, in mm, are no body.
THICKNESS = 9.0
#: Limbs are at least this share as thick as the rest.
SLENDER = 0.3
#: What hangs together with the patient is patient this far, in mm, from what is that thick.
REACH = 40.0
#: Planes keep this far, in mm, from the body.
MARGIN = 3.0
#: Not more planes than these: the user wants some too.
MAX_PLANES = 5


@dataclass(frozen=True)
class Scan:
    """Points in world mm on the outside of the patient, and of what is no patient."""

    body: np.ndarray
    other: np.ndarray


def suggest_clip(volume: Volume) -> tuple[ClipPlane, ...]:
    """Return the planes that cut table and head rest away from a CT and leave the patient whole.

    Each plane stands parallel to the array's z axis and keeps its distance from the patient; what lies
    within the patient's outline cannot be cut, and what touches the patient counts as patient.
    """
    scan = _scan(volume)
    if scan is None:
        return ()
    x, y = (np.asarray(volume.direction)[:, i] for i in (0, 1))
    left = scan.other
    planes: list[ClipPlane] = []
    normals = [math.cos(a) * x + math.sin(a) * y for a in np.linspace(0, 2 * math.pi, 48, endpoint=False)]
    bounds = [float((scan.body @ n).max()) + MARGIN for n in normals]
    enough = max(4.0, 0.003 * len(scan.other))
    while len(planes) < MAX_PLANES and len(left) >= enough:
        cut = [int((left @ n > b).sum()) for n, b in zip(normals, bounds, strict=True)]
        best = int(np.argmax(cut))
        if cut[best] < enough:
            break
        normal, bound = normals[best], bounds[best]
        center = np.asarray(volume.center)
        point = center + normal * (bound - float(center @ normal))
        planes.append(ClipPlane(point=_vector(point), normal=_vector(-normal)))
        left = left[left @ normal <= bound]
    return tuple(planes)


def face_side(volume: Volume) -> int:
    """Return towards which end of the array's y axis the patient faces, by the table: -1, 1, or 0 (unknown)."""
    scan = _scan(volume)
    if scan is None or len(scan.other) < 20:
        return 0
    y = np.asarray(volume.direction)[:, 1]
    along = scan.body @ y
    away = float((scan.other @ y).mean() - (along.min() + along.max()) / 2) / max(1e-6, float(np.ptp(along)))
    return 0 if abs(away) < 0.15 else (-1 if away > 0 else 1)


@remembered
def _scan(volume: Volume) -> Scan | None:
    zero = hounsfield_zero(volume)
    if zero is None:
        return None
    solid = thinned(volume, CELLS) > zero + SOLID
    cell = np.array(volume.spacing[::-1]) * np.array(volume.data.shape) / np.array(solid.shape)
    core = _core(solid, cell)
    pieces, _ = ndimage.label(solid)
    patient = np.isin(pieces, np.unique(pieces[core])) & solid
    away = ~_grown(patient, cell, MARGIN)
    # A sheet's edge reaches on to the next cell that was not looked at.
    other = ndimage.binary_dilation(_large(solid & away, cell), np.ones((1, 3, 3))) & away
    # A cable may join a head rest to the patient: that far away, it does not keep the planes off.
    body = patient & _grown(core, cell, REACH)
    if not other.any() or not body.any():
        return None
    return Scan(_world(volume, body & ~ndimage.binary_erosion(body)), _world(volume, other))


def _core(solid: np.ndarray, cell: np.ndarray) -> np.ndarray:
    """Return the inside of what is thicker than a table's shell."""
    # Slice by slice, since a slab of few slices has no thickness along z.
    sampling = cell[1:].tolist()
    depth = np.stack(
        [ndimage.distance_transform_edt(ndimage.binary_fill_holes(s), sampling=sampling) for s in solid]
    )
    # A hand's fingers are thinner than a table: what is thin depends on the patient, too.
    return _large(solid & (depth > min(THICKNESS, SLENDER * float(depth.max()))), cell, 0.005)


def _grown(mask: np.ndarray, cell: np.ndarray, reach: float) -> np.ndarray:
    """Return what lies within a reach, in mm, of a mask."""
    if not mask.any():
        return mask
    return np.asarray(ndimage.distance_transform_edt(~mask, sampling=cell.tolist()) <= reach)


def _large(mask: np.ndarray, cell: np.ndarray, share: float = 0.0) -> np.ndarray:
    """Return the pieces of a mask that hold a share of the largest one, and at least a cubic centimetre."""
    labels, count = ndimage.label(mask, structure=np.ones((3, 3, 3)))
    if not count:
        return mask
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    least = max(share * sizes.max(), 1000.0 / float(np.prod(cell)))
    return np.asarray((sizes >= least)[labels] & mask)


def _world(volume: Volume, mask: np.ndarray) -> np.ndarray:
    steps = np.array([-(-n // m) for n, m in zip(volume.data.shape, mask.shape, strict=True)])
    index = (np.argwhere(mask) * steps)[:, ::-1] * np.asarray(volume.spacing)
    return np.asarray(index @ np.asarray(volume.direction).T + np.asarray(volume.origin))


def _vector(v: np.ndarray) -> Vec3:
    x, y, z = (float(c) for c in v)
    return x, y, z
