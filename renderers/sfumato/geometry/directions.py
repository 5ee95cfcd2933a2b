"""Main directions of diffusion tensors (V1 of FSL's dtifit and its like) as a field to trace in.

A main direction has no sign: of two neighbours one may point forwards, the other backwards, and halfway between
them there would be nothing. So signs are made to agree, from neighbour to neighbour, along the tree that joins
those that are most alike (and where there is most anisotropy) first.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from ..io.reading import Task, check_claim, need
from ..scene.vectors import vec3
from ..scene.volume import Volume

#: Anisotropy, as a part of the field's largest, below which streamlines end by default.
LEAST_ANISOTROPY = 0.2
#: Value of ``Tracing.array`` for components along the world's axes (RAS) instead of the voxels'.
WORLD = "world"
_SUFFIXES = (".nii", ".nii.gz")
#: NIfTI's intent codes of vectors.
_VECTORS = (1006, 1007)
_RGB_VECTOR = 2003
_PART = re.compile(r"(?<![A-Za-z])(FA|V1)(?![A-Za-z0-9])")


def direction_file(path: Path) -> Path | None:
    """Return the NIfTI file of main directions that belongs to a path: itself, or V1 beside FA."""
    if not path.name.lower().endswith(_SUFFIXES) or not path.is_file():
        return None
    for candidate in (path, _sibling(path, "V1")):
        if candidate is not None and candidate.is_file() and _has_directions(candidate):
            return candidate
    return None


def _sibling(path: Path, part: str) -> Path | None:
    name = _PART.sub(part, path.name)
    return path.with_name(name) if name != path.name else None


def _has_directions(path: Path) -> bool:
    """Tell by its header whether a file holds three numbers for each voxel that are meant as a vector."""
    try:
        header = _image(path, Task(path)).header
    except Exception:  # whatever it is, it is not that
        return False
    dims, intent = [int(d) for d in header["dim"]], int(header["intent_code"])
    three = (dims[0] == 4 and dims[4] == 3) or (dims[0] == 5 and dims[4] == 1 and dims[5] == 3)
    return three and (intent in (*_VECTORS, _RGB_VECTOR) or _PART.search(path.name) is not None)


def _image(path: Path, task: Task) -> Any:
    return need("nibabel", task).load(path)


def read_directions(path: Path, task: Task, array: str = "") -> tuple[np.ndarray, Volume, list[str]]:
    """Read main directions; as long as the anisotropy beside them says.

    Returns
    -------
    vectors : ndarray, shape (z, y, x, 3), float32
        World LPS components.
    grid : Volume
        The anisotropy, or the directions' length.
    notices : list of str
    """
    image = _image(path, task)
    shape = tuple(int(d) for d in image.shape[:3])
    check_claim(task, int(np.prod(shape)) * 12, path.stat().st_size, compressed=path.name.endswith(".gz"))
    vectors = np.asarray(image.dataobj, dtype=np.float32).reshape(*shape, 3)
    affine = np.asarray(image.affine, dtype=float)
    axes = affine[:3, :3] / np.linalg.norm(affine[:3, :3], axis=0)
    if array != WORLD:
        # FSL: along the voxels' axes, the first one turned round where they are right-handed.
        flip = np.diag([-1.0 if np.linalg.det(axes) > 0 else 1.0, 1, 1])
        vectors = vectors @ (axes @ flip).T.astype(np.float32)
    vectors = vectors * np.array([-1, -1, 1], np.float32)
    notices = (
        ["The directions are taken along the voxels' axes, as FSL writes them."] if array != WORLD else []
    )
    anisotropy = _anisotropy(path, shape)
    if anisotropy is not None:
        vectors *= np.nan_to_num(anisotropy)[..., None]
    vectors = aligned(np.nan_to_num(np.ascontiguousarray(vectors.transpose(2, 1, 0, 3))))
    length = np.linalg.norm(vectors, axis=-1)
    lps = np.diag([-1.0, -1.0, 1.0])
    first, second, third = (vec3(row) for row in lps @ axes)
    grid = Volume(
        length.astype(np.float32), vec3(np.linalg.norm(affine[:3, :3], axis=0)), vec3(lps @ affine[:3, 3]),
        (first, second, third),
    )  # fmt: skip
    return vectors, grid, notices


def _anisotropy(path: Path, shape: tuple[int, ...]) -> np.ndarray | None:
    """Return the anisotropy beside a file of directions, on the same voxels, (x, y, z); None if there is none."""
    beside = _sibling(path, "FA")
    if beside is None or not beside.is_file():
        return None
    values = np.asarray(_image(beside, Task(beside)).dataobj, dtype=np.float32)
    return values if values.shape == shape else None


def aligned(vectors: np.ndarray) -> np.ndarray:
    """Return vectors, shape (z, y, x, 3), whose signs agree with their neighbours' as far as they can."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree

    shape = vectors.shape[:3]
    number = np.arange(int(np.prod(shape))).reshape(shape)
    here, there = [], []
    for axis in range(3):
        low, high = [slice(None)] * 3, [slice(None)] * 3
        low[axis], high[axis] = slice(None, -1), slice(1, None)
        here.append(number[tuple(low)].ravel())
        there.append(number[tuple(high)].ravel())
    a, b = np.concatenate(here), np.concatenate(there)
    flat = vectors.reshape(-1, 3)
    dot = np.einsum("ij,ij->i", flat[a], flat[b])
    # A root joins what is not joined otherwise, as the last resort. Weights must not be 0: that is no edge.
    root = len(flat)
    most = float(np.abs(dot).max(initial=0.0)) + 1e-6
    weights = np.concatenate([2 * most - np.abs(dot), np.full(root, 4 * most)])
    rows, columns = np.concatenate([a, np.full(root, root)]), np.concatenate([b, np.arange(root)])
    graph = coo_matrix((weights, (rows, columns)), shape=(root + 1, root + 1)).tocsr()
    _, before = breadth_first_order(minimum_spanning_tree(graph), root, directed=False)
    before[root] = root
    parent = before.astype(np.int64)
    extended = np.concatenate([flat, np.zeros((1, 3), np.float32)])
    sign = np.where(np.einsum("ij,ij->i", extended, extended[parent]) < 0, -1.0, 1.0).astype(np.float32)
    while True:  # the product along the way to the root, in steps twice as long each time
        further = parent[parent]
        if np.array_equal(further, parent):
            return np.asarray(vectors * sign[:root].reshape(*shape, 1))
        sign = sign * sign[parent]
        parent = further
