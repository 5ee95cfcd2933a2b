"""Sheared and uneven grids onto straight ones, by linear interpolation in bounded pieces."""

from __future__ import annotations

import numpy as np

from .reading import Task


def straighten(
    data: np.ndarray, axes: np.ndarray, origin: np.ndarray, task: Task
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Resample voxels with oblique axes onto the nearest right-angled grid that holds all of them.

    Parameters
    ----------
    data : ndarray, shape (z, y, x)
        Voxels.
    axes : ndarray, shape (3, 3)
        Columns: step in mm along x, y, z; not at right angles.
    origin : ndarray, shape (3,)
        Centre of voxel 0 in mm.

    Returns
    -------
    data, spacing, direction, origin
        What lies outside the old grid holds the smallest value.
    """
    from scipy.ndimage import affine_transform

    spacing = np.linalg.norm(axes, axis=0)
    u, _, vt = np.linalg.svd(axes / spacing)
    direction = u @ vt  # polar decomposition: the rotation nearest to the given axes
    dims = np.array(data.shape[::-1])
    low, high = _bounds(direction.T @ axes, dims)
    size = np.floor((high - low) / spacing + 1e-6).astype(int) + 1
    while float(np.prod(size.astype(float))) * data.itemsize > 1.5 * task.budget_bytes:
        spacing = spacing * 1.26
        size = np.floor((high - low) / spacing + 1e-6).astype(int) + 1
    # index_old = inverse(axes) @ direction @ (low + spacing * index_new), written for arrays (z, y, x)
    step = np.linalg.inv(axes) @ direction
    matrix, shift = (step * spacing)[::-1, ::-1], (step @ low)[::-1]
    out = np.empty(size[::-1], dtype=data.dtype)
    fill = float(data.min())
    planes = max(1, (4 << 20) // int(size[0] * size[1]))
    for z0 in range(0, out.shape[0], planes):
        task.step(z0 / out.shape[0], "Straightening")
        z1 = min(out.shape[0], z0 + planes)
        offset = shift + matrix @ np.array([z0, 0.0, 0.0])
        part = affine_transform(
            data,
            matrix,
            offset,
            (z1 - z0, *out.shape[1:]),
            output=np.float32,
            order=1,
            mode="constant",
            cval=fill,
        )
        out[z0:z1] = np.rint(part) if data.dtype.kind in "iu" else part
    return out, spacing, direction, origin + direction @ low


def _bounds(axes: np.ndarray, dims: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    ends = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)]) * (dims - 1)
    points = ends @ axes.T
    return points.min(axis=0), points.max(axis=0)


def shift_plane(plane: np.ndarray, right: float, down: float, shape: tuple[int, int]) -> np.ndarray:
    """Return a plane (y, x) moved by a fraction of pixels into a plane of another shape.

    Interpolates linearly; the outside holds the plane's smallest value.
    """
    out = np.full(shape, plane.min(), dtype=np.float32)
    i, j = int(np.floor(down)), int(np.floor(right))
    fy, fx = down - i, right - j
    padded = np.pad(plane.astype(np.float32), 1, mode="edge")
    height, width = plane.shape
    rows = padded[1:] * (1 - fy) + padded[:-1] * fy  # rows[k] is the value at old row k - fy
    both = rows[:, 1:] * (1 - fx) + rows[:, :-1] * fx
    h, w = min(height + (fy > 0), shape[0] - i), min(width + (fx > 0), shape[1] - j)
    out[i : i + h, j : j + w] = both[:h, :w]
    return out


def even(positions: np.ndarray) -> tuple[float, list[tuple[int, int, float]], str]:
    """Plan evenly spaced planes from planes at growing positions.

    Parameters
    ----------
    positions : ndarray, shape (n,)
        Strictly growing, in mm, n >= 2.

    Returns
    -------
    distance : float
        Between the new planes in mm.
    planes : list of (i, j, weight)
        New plane k is ``(1 - weight) * old[i] + weight * old[j]``.
    notice : str
        What was done, or empty if the planes were evenly spaced already (to a tenth of their distance,
        as positions are often rounded).
    """
    gaps = np.diff(positions)
    n, extent = len(positions), float(positions[-1] - positions[0])
    mean, median = extent / (n - 1), float(np.median(gaps))
    off_line = positions - mean * np.arange(n)
    if np.ptp(off_line) <= 0.2 * mean:
        return mean, [(i, i, 0.0) for i in range(n)], ""
    ratio = gaps / median
    whole = np.rint(ratio)
    if np.abs(ratio - whole).max() <= 0.1 and whole.min() >= 1 and whole.sum() <= 4 * n:
        missing = int(whole.sum()) - (n - 1)
        distance = extent / float(whole.sum())
        verb = "is" if missing == 1 else "are"
        notice = f"{missing} of {n + missing} slices {verb} missing: filled by interpolation."
    else:
        wanted = max(float(np.quantile(gaps, 0.25)), extent / (4 * n))
        distance = extent / max(1, round(extent / wanted))
        span = f"{gaps.min():.3g} to {gaps.max():.3g} mm"
        notice = f"Slice distances vary from {span}: resampled to {distance:.3g} mm."
    return distance, _between(positions, distance), notice


def _between(positions: np.ndarray, distance: float) -> list[tuple[int, int, float]]:
    count = round(float(positions[-1] - positions[0]) / distance) + 1
    planes = []
    for target in positions[0] + distance * np.arange(count):
        j = int(np.clip(np.searchsorted(positions, target), 1, len(positions) - 1))
        weight = float(np.clip((target - positions[j - 1]) / (positions[j] - positions[j - 1]), 0, 1))
        nearest = j if weight > 0.5 else j - 1
        planes.append((nearest, nearest, 0.0) if min(weight, 1 - weight) < 0.05 else (j - 1, j, weight))
    return planes
