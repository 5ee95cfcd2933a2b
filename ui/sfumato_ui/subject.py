"""What a scene shows, whatever it is: a volume, geometry, or both. No Qt."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sfumato import Scene
from sfumato.scene import TechniqueParams
from sfumato.scene.vectors import box_corners
from sfumato.techniques import technique_for, technique_with_geometry


def is_open(scene: Scene) -> bool:
    """Tell whether the scene holds anything."""
    return scene.volume is not None or bool(scene.geometry)


def is_drawable(scene: Scene) -> bool:
    """Tell whether its technique has something to draw: without a volume, one that draws geometry."""
    drawn = bool(scene.geometry) and technique_for(scene.technique).geometry
    return scene.camera is not None and (scene.volume is not None or drawn)


def bounds_of(scene: Scene) -> np.ndarray | None:
    """Return the corners of what is shown in world mm, shape (n, 3); nothing if nothing is."""
    if scene.volume is not None:
        return scene.volume.corners()
    if not scene.geometry:
        return None
    ends = np.concatenate([g.bounds for g in scene.geometry])
    return box_corners(np.stack([ends.min(axis=0), ends.max(axis=0)]))


def size_of(scene: Scene) -> float:
    """Return the diameter of what is shown in mm; 0 if nothing is."""
    corners = bounds_of(scene)
    return float(np.linalg.norm(np.ptp(corners, axis=0))) if corners is not None else 0.0


def name_of(scene: Scene) -> str:
    """Return a short name of what is shown."""
    if scene.volume is not None:
        info = scene.volume.info
        return info.name or Path(info.path).name or "volume"
    return (scene.geometry[0].name or scene.geometry[0].kind) if scene.geometry else ""


def technique_drawing_geometry(scene: Scene) -> TechniqueParams | str:
    """Return the technique that the scene should take to show geometry: its own, if that does."""
    return (
        scene.technique
        if technique_for(scene.technique).geometry
        else technique_with_geometry() or scene.technique
    )
