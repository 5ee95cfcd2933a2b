"""What a technique is, and the table of all of them."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Generator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

from ..errors import SceneError
from ..scene.params import from_json
from ..scene.scene import TechniqueParams

if TYPE_CHECKING:
    from .frame import Frame


class Painter(Protocol):
    """Draws one frame of one technique on a device and keeps what can be used again."""

    def paint(self, frame: Frame) -> Generator[float, None, None]:
        """Draw into ``frame.target``, yielding progress (0 to 1) after each bounded piece of GPU work."""
        ...

    def release(self) -> None:
        """Free the GPU objects."""
        ...


@dataclass(frozen=True)
class Technique:
    """One way of lighting a volume.

    Parameters
    ----------
    id : str
        The word used in scenes and on the command line.
    title, summary : str
        For people: a name, and one line on what it does and when to use it.
    params : type
        Frozen dataclass of its own parameters, each declared with `Param`.
    painter : str
        ``module:Class`` of its `Painter`, imported when first used.
    source : str
        Key in ``references.bib``.
    lit : bool
        Whether the scene's lights have an effect.
    orbit_pops : bool
        Whether a full orbit of the light may change the picture abruptly (half-angle slicing's fault).
    max_lights : int
        How many of the active lights it uses, the first ones.
    kinds : tuple of str
        Kinds of lamps that it lights as what they are; others it takes for parallel light from their place.
    ambient_of_lamps : bool
        Whether its parameter ``ambient`` is a share of each lamp, instead of a light of its own.
    around : bool
        Whether it has light from all around, whose share depends on whether there are lamps.
    shadows : bool
        Whether something can be in the way of light; those keep to the scene's ``shadow_floor``.
    geometry : bool
        Whether it draws the scene's geometry.
    options : dict
        Constants for the painter, where one painter serves several techniques.
    """

    id: str
    title: str
    summary: str
    params: type[TechniqueParams]
    painter: str
    source: str = ""
    lit: bool = True
    orbit_pops: bool = False
    max_lights: int = 4
    kinds: tuple[str, ...] = ("directional",)
    ambient_of_lamps: bool = False
    around: bool = False
    shadows: bool = True
    geometry: bool = False
    options: dict[str, Any] = field(default_factory=dict, compare=False)

    def make_painter(self, device: Any) -> Painter:
        """Import the painter's class and make one for a device."""
        module, name = self.painter.split(":")
        return getattr(importlib.import_module(module, __package__), name)(device, **self.options)  # type: ignore[no-any-return]


#: One line a folder; the order is that of menus and tables.
FOLDERS = (
    "cone",
    "combined",
    "multidirectional",
    "extinction",
    "local_occlusion",
    "raycast",
    "slices",
    "half_angle",
    "reference",
)


@functools.cache
def techniques() -> dict[str, Technique]:
    """Return all techniques by id."""
    found: dict[str, Technique] = {}
    for folder in FOLDERS:
        for technique in importlib.import_module(f".{folder}", __package__).TECHNIQUES:
            found[technique.id] = technique
    return found


def technique_with_geometry() -> str:
    """Return the id of the first technique that draws geometry, or nothing."""
    return next((t.id for t in techniques().values() if t.geometry), "")


def technique_for(params: TechniqueParams) -> Technique:
    """Return the technique that a parameter object belongs to."""
    for technique in techniques().values():
        if technique.params is type(params):
            return technique
    raise SceneError("technique", params, "one of " + ", ".join(techniques()))


def id_of(params: TechniqueParams) -> str:
    """Return the id of the technique that a parameter object belongs to."""
    return technique_for(params).id


def params_of(technique: str | TechniqueParams) -> TechniqueParams:
    """Return a parameter object as it is, or the defaults of the technique with an id."""
    if isinstance(technique, str):
        if technique not in techniques():
            raise SceneError("technique", technique, "one of " + ", ".join(techniques()))
        return techniques()[technique].params()
    technique_for(technique)
    return technique


def params_from_json(data: Any) -> TechniqueParams:
    """Build a technique's parameters from an id or from JSON data with an ``id``."""
    if isinstance(data, str):
        return params_of(data)
    if not isinstance(data, dict) or data.get("id") not in techniques():
        raise SceneError(
            "technique", data, "an id, or an object with an id: one of " + ", ".join(techniques())
        )
    rest = {k: v for k, v in data.items() if k != "id"}
    return from_json(techniques()[data["id"]].params, rest, "technique")
