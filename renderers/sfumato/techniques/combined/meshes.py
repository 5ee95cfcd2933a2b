"""Geometry on the GPU: each shown geometry's mesh in buffers that the device's store keeps."""

from __future__ import annotations

from collections.abc import Generator, Hashable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...gpu import Device
from ...scene import Geometry
from ...scene.shapes import Lines, Mesh
from ..frame import Frame

#: A vertex: place (mm, from the mesh's middle), unit normal, linear RGB. 28 bytes.
VERTEX = np.dtype([("p", "<f4", 3), ("n", "<f2", 4), ("c", "<f2", 4)])
LAYOUT = "3f4 4f2 4f2"
#: Vertices that are packed between two looks at whether a newer scene is there.
CHUNK = 1 << 19


@dataclass
class MeshBuffers:
    """A mesh on the GPU.

    Attributes
    ----------
    middle : ndarray, shape (3,)
        World mm; the buffer's places are relative to it, so that large coordinates cost no precision.
    count : int
        Indices: three a triangle.
    """

    vertices: Any
    indices: Any
    middle: np.ndarray
    bounds: np.ndarray
    count: int

    @property
    def size(self) -> int:
        """Bytes on the GPU."""
        return int(self.vertices.size + self.indices.size)

    def release(self) -> None:
        """Free the buffers."""
        self.vertices.release()
        self.indices.release()


@dataclass(frozen=True)
class Shown:
    """A geometry that is drawn.

    Attributes
    ----------
    mesh : Mesh
        What casts shadows.
    clipped : bool
        Whether clip planes or a crop box cut it.
    rough : bool
        Whether its coarse mesh is drawn, since something moves.
    """

    geometry: Geometry
    mesh: Mesh
    clipped: bool
    rough: bool = False

    @property
    def drawn(self) -> Mesh:
        """The mesh that is drawn."""
        return self.mesh.coarse if self.rough and self.mesh.coarse is not None else self.mesh

    @property
    def key(self) -> Hashable:
        """Equal for what is drawn alike in one scene."""
        return self.geometry.mesh_key, self.clipped

    @property
    def tubes(self) -> bool:
        """Whether its surface was swept along lines, and so is closed."""
        return isinstance(self.geometry.shape, Lines)


def shown_geometry(frame: Frame) -> Generator[float, None, tuple[Shown, ...]]:
    """Return what is to be drawn of a scene's geometry, with its meshes; what has no triangle is left out.

    Meshes that nobody has built yet are built here, in pieces.
    """
    from ...geometry import build, known_mesh

    scene, shown = frame.scene, []
    for geometry in scene.geometry:
        if not geometry.visible:
            continue
        mesh = known_mesh(geometry)
        if mesh is None:
            mesh = yield from build(geometry)
        if len(mesh.triangles):
            shown.append(Shown(geometry, mesh, scene.is_cut and geometry.clipped, frame.quality.rough))
    return tuple(shown)


def upload_meshes(frame: Frame, shown: tuple[Shown, ...]) -> Generator[float, None, tuple[MeshBuffers, ...]]:
    """Return the buffers of what is drawn, uploading what is not there yet."""
    store, device, buffers = frame.device.store, frame.device, []
    for item in shown:
        key = ("geometry", item.geometry.mesh_key, item.drawn is item.mesh)
        packed = {}
        if not store.holds(key):
            packed["data"] = yield from _pack(item.drawn)
        buffers.append(
            store.get(key, lambda m=item.drawn, p=packed: _upload(device, m, p["data"]), lambda b: b.size)  # type: ignore[misc]
        )
    return tuple(buffers)


def _pack(mesh: Mesh) -> Generator[float, None, np.ndarray]:
    """Interleave a mesh's arrays."""
    data, middle = np.zeros(len(mesh.points), VERTEX), mesh.bounds.mean(axis=0)
    for first in range(0, len(data), CHUNK):
        part = slice(first, first + CHUNK)
        data["p"][part] = mesh.points[part] - middle
        data["n"][part, :3] = mesh.normals[part]
        data["c"][part, :3] = mesh.colors[part]
        yield 0.0
    return data


def _upload(device: Device, mesh: Mesh, data: np.ndarray) -> MeshBuffers:
    with device.checked(f"a mesh of {len(mesh.triangles)} triangles"):
        vertices = device.ctx.buffer(data)
        indices = device.ctx.buffer(np.ascontiguousarray(mesh.triangles, dtype=np.uint32))
    return MeshBuffers(vertices, indices, mesh.bounds.mean(axis=0), mesh.bounds, mesh.triangles.size)
