"""Words about the shadow floor: what is said on the picture, and why a technique has none."""

from __future__ import annotations

from sfumato import Scene
from sfumato.techniques import technique_for


def no_floor(scene: Scene) -> str:
    """Return why a floor has no effect on a scene, or nothing."""
    return "" if technique_for(scene.technique).shadows else "This technique casts no shadows to lift."


def badge_of(scene: Scene) -> str:
    """Return what the picture must say of its shadows, or nothing: a floor is never silent."""
    if scene.shadow_floor <= 0 or no_floor(scene):
        return ""
    return f"Shadow floor {100 * scene.shadow_floor:.0f} %"
