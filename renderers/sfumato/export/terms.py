"""A picture taken apart: each light and each term of the shading by itself, which sum to the whole.

Shading is linear in the lights, in the highlights' strength and in `ambient`. So each term is a picture of
the same scene with all other terms at zero, or the difference of two such pictures; all of them with the
same jitter, the same opacity, and therefore the same weight of every sample.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ..scene import Light, Scene
from ..scene.params import fields_of

Draw = Callable[[Scene], np.ndarray]


def render_terms(scene: Scene, size: tuple[int, int] = (512, 512)) -> dict[str, np.ndarray]:
    """Draw each light and each term of a scene as linear pictures that sum to the whole.

    Parameters
    ----------
    scene : Scene
        What to draw; ``scene.frames`` jittered frames are accumulated.
    size : (int, int)
        Width and height in pixels.

    Returns
    -------
    dict of str to ndarray
        ``alpha``, float32 of shape (height, width), once; all others float32 of shape (height, width, 3),
        linear, premultiplied, before exposure and without the background:

        - ``lights.K.diffuse``, ``lights.K.specular``, ``lights.K.ambient`` of each light K that shines, by
          its place in the scene, as far as the technique has such a term and it is not zero;
        - ``ambient``: light from everywhere that belongs to no lamp (techniques without light: all of it);
        - ``emission``: light that tissue gives off, if the transfer function has any.

        With the background (r, g, b, a) the whole, as from ``render(linear=True)``, is the sum of the terms
        plus (1 - alpha) a (r, g, b).

    Raises
    ------
    SceneError
        If the scene has no volume or the size is not possible.
    GpuError
        If the device cannot do it.
    """
    from ..renderer import render

    bare = scene.with_(background=(0.0, 0.0, 0.0, 0.0))
    drawn: dict[str, np.ndarray] = {}

    def draw(wanted: Scene) -> np.ndarray:
        picture = render(wanted, size, linear=True)
        drawn.setdefault("alpha", picture[..., 3].copy())
        return picture[..., :3]

    terms = dict(_terms(bare, draw))
    if not drawn:
        draw(_with(bare, lights=()))
    return {**terms, **drawn}


def _terms(scene: Scene, draw: Draw) -> Iterator[tuple[str, np.ndarray]]:
    from ..techniques import technique_for

    technique = technique_for(scene.technique)
    if _emits(scene):
        # Not the picture without light: where slices follow the light, that one has other samples.
        dull = scene.with_(transfer=_without_emission(scene.transfer))
        yield "emission", draw(scene) - draw(dull)
        scene = dull
    if not technique.lit:
        # Every sample shows its own colour: light from everywhere.
        yield "ambient", draw(scene)
        return
    if technique.around:
        yield from _beside_light_around(scene, technique.max_lights, draw)
        return
    ambient = float(getattr(scene.technique, "ambient", 0.0))
    if ambient and not technique.ambient_of_lamps:
        yield "ambient", draw(_with(scene, lights=()))
    for index, light in _shining(scene)[: technique.max_lights]:
        share = ambient if technique.ambient_of_lamps else 0.0
        for name, picture in _of_light(_with(scene, lights=(light,)), share, draw):
            yield f"lights.{index}.{name}", picture


def _beside_light_around(scene: Scene, most: int, draw: Draw) -> Iterator[tuple[str, np.ndarray]]:
    """Return the terms where light from all around counts less beside lamps: these stay, black, in each picture."""
    black = tuple(dataclasses.replace(light, color=(0.0, 0.0, 0.0)) for light in scene.lights)
    around = draw(_with(scene, lights=black))
    if around.any():
        yield "ambient", around
    for index, light in _shining(scene)[:most]:
        one = (*black[:index], light, *black[index + 1 :])
        yield f"lights.{index}.diffuse", draw(_with(scene, lights=one)) - around


def _of_light(scene: Scene, share: float, draw: Draw) -> Iterator[tuple[str, np.ndarray]]:
    """Return the terms of a scene with one light, `share` of which is ambient."""
    plain = draw(_with(scene, ambient=0.0, specular=0.0))
    yield "diffuse", plain * np.float32(1 - share)
    if share:
        yield "ambient", draw(_with(scene, ambient=1.0, specular=0.0)) * np.float32(share)
    if getattr(scene.technique, "specular", 0.0):
        yield "specular", draw(_with(scene, ambient=0.0)) - plain


def _with(scene: Scene, lights: tuple[Light, ...] | None = None, **params: float) -> Scene:
    """Return a scene with other lights, and other values of those parameters that its technique has."""
    known = fields_of(type(scene.technique))
    changes: dict[str, Any] = {f"technique.{k}": v for k, v in params.items() if k in known}
    if lights is not None:
        changes["lights"] = lights
    return scene.with_(changes) if changes else scene


def _shining(scene: Scene) -> list[tuple[int, Light]]:
    """Return the active lights with their places in the scene."""
    active = scene.active_lights
    return [(k, light) for k, light in enumerate(scene.lights) if any(light is one for one in active)]


def _emits(scene: Scene) -> bool:
    transfer = scene.transfer
    if transfer is None:
        return False
    return any(any(p.emission) for p in transfer.points) or any(any(r.emission) for r in transfer.regions)


def _without_emission(transfer: Any) -> Any:
    """Return a transfer function that gives off nothing."""
    none = (0.0, 0.0, 0.0)
    return dataclasses.replace(
        transfer,
        points=tuple(dataclasses.replace(p, emission=none) for p in transfer.points),
        regions=tuple(dataclasses.replace(r, emission=none) for r in transfer.regions),
    )


__all__ = ["render_terms"]
