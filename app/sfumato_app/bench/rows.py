"""The rows of the benchmark's table: who draws what. A later one is one more line in `rows`."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import sfumato
from sfumato.renderer import DRAG, FULL, Quality
from sfumato.techniques.local_occlusion.passes import LEAST

from .contender import Contender
from .extinction import Building, Neighbourhood
from .ours import SWING, MovingLight, Ours, Refined, Retouched
from .setting import Setting
from .tubes import TRIANGLES, tubes

if TYPE_CHECKING:
    from .peer_vtk import VtkStage

#: Sides of light caches whose making is timed.
CELLS = (64, 128, 192, 256)


@dataclass
class Stage:
    """What contenders share: our renderer, and VTK's window for each setting, made when first asked for."""

    renderer: sfumato.Renderer = field(default_factory=lambda: sfumato.Renderer())
    windows: dict[Setting, VtkStage] = field(default_factory=dict)

    def window(self, setting: Setting) -> VtkStage:
        """Return VTK's window for a setting; `Unavailable` if there is no VTK."""
        from .peer_vtk import VtkStage

        if setting not in self.windows:
            self.windows[setting] = VtkStage(setting)
        return self.windows[setting]

    @property
    def peer_device(self) -> str:
        """Name of the graphics device that VTK drew on; empty if it did not draw."""
        return next((window.device for window in self.windows.values()), "")

    def close(self) -> None:
        """Free what both sides hold on the GPU."""
        for window in self.windows.values():
            window.close()
        self.windows.clear()
        self.renderer.close()


@dataclass(frozen=True)
class Row:
    """One contender in one setting.

    Parameters
    ----------
    id : str
        Short name, unique; ratios refer to it.
    label : str
        For people.
    peer : bool
        Whether it is somebody else's renderer.
    setting : Setting
        What is drawn.
    make : callable
        Makes the contender on a stage; raises `Unavailable` if it cannot.
    """

    id: str
    label: str
    peer: bool
    setting: Setting
    make: Callable[[Stage, Setting], Contender]


def rows(setting: Setting) -> tuple[Row, ...]:
    """Return all rows for a setting, those to be compared beside each other."""
    table = (
        ("raycast", "ray casting, unlit", _ours("raycast")),
        ("vtk-gpu", "VTK GPU mapper, unshaded", _vtk("gpu_mapper", shade=False)),
        ("vtk-cpu", "VTK fixed point (CPU), unshaded", _vtk("cpu_mapper", shade=False)),
        ("slices", "slices, unlit", _ours("slices")),
        ("raycast-phong", "ray casting, Phong", _ours("raycast-phong")),
        ("vtk-gpu-shaded", "VTK GPU mapper, shaded", _vtk("gpu_mapper", shade=True)),
        ("vtk-cpu-shaded", "VTK fixed point (CPU), shaded", _vtk("cpu_mapper", shade=True)),
        ("half-angle", "half-angle slicing", _ours("half-angle")),
        ("slices-phong", "slices, Phong", _ours("slices-phong")),
        # Light that rests is kept; so lamps tremble. A headlamp has no rotation: there its aperture does.
        ("directional", "directional occlusion", _moving("directional", "aperture", swing=1)),
        ("multidirectional", "multidirectional occlusion", _moving("multidirectional", "rotation", swing=1)),
        (
            "multidirectional-still",
            "... its light kept from the frame before",
            _ours("multidirectional", settling=1),
        ),
        ("multidirectional-turning", "... its light turning", _moving("multidirectional", "rotation")),
        ("multidirectional-tilting", "... its light tilting", _moving("multidirectional", "tilt")),
        (
            "multidirectional-drag",
            "... at drag quality",
            _moving("multidirectional", "rotation", quality=DRAG),
        ),
        ("cone", "cone-accurate shadows, their light trembling", _moving("cone", "rotation", swing=1)),
        ("cone-still", "... its light kept from the frame before", _ours("cone", settling=1)),
        ("cone-turning", "... its light turning", _moving("cone", "rotation")),
        ("cone-drag", "... at drag quality, its light turning", _moving("cone", "rotation", quality=DRAG)),
        # As published: light from all around in place of diffuse shading, so that no gradient is needed.
        ("local-occlusion", "local occlusion, its light kept", _local()),
        ("local-occlusion-diffuse", "... mixed with diffuse shading", _local(lamps="diffuse")),
        ("local-occlusion-retouched", "... the first picture after a change of colours", _local(Retouched)),
        # Slope shading takes a gradient a sample, as Phong does; without it light is one look-up.
        ("extinction", "extinction-based light, slopes shaded, light at rest", _extinction()),
        ("extinction-still", "... without slopes", _extinction(facing=0.0)),
        ("extinction-ambient", "... light from all around alone", _extinction(facing=0.0, lamp=False)),
        ("extinction-moving", "... its lamp moving, 64 cells a side", _moving_extinction()),
        ("extinction-drag", "... its lamp moving, at drag quality", _moving_extinction(DRAG)),
        *((f"extinction-build-{n}", f"... light made anew, {n} cells a side", _building(n)) for n in CELLS),
        ("extinction-shells", "... 3 shells, 64 cells a side", _neighbourhood(explicit=False)),
        ("extinction-explicit", "... each cell within 7, 64 cells a side", _neighbourhood(explicit=True)),
        ("vtk-gpu-shadows", "VTK GPU mapper, volumetric shadows", _vtk("gpu_shadow_mapper", shade=True)),
    )
    return tuple(Row(key, label, key.startswith("vtk-"), setting, make) for key, label, make in table)


def tube_rows(setting: Setting) -> tuple[Row, ...]:
    """Return the rows of the table of tubes: the volume alone, and with ever more triangles."""
    table: list[tuple[str, str, Callable[[Stage, Setting], Contender]]] = [
        ("cone", "the volume alone, its light trembling", _moving("cone", "rotation", swing=1)),
        ("cone-still", "... its light kept", _ours("cone", settling=1)),
    ]
    for name, count in TRIANGLES.items():
        table += [
            (f"combined-{name}", f"with {name} triangles, its light trembling", _tubes(count, moving=True)),
            (f"combined-{name}-still", "... its light kept", _tubes(count, moving=False)),
        ]
    return tuple(Row(key, label, False, setting, make) for key, label, make in table)


def _tubes(triangles: int, *, moving: bool) -> Callable[[Stage, Setting], Contender]:
    def make(stage: Stage, setting: Setting) -> Contender:
        changes: dict[str, Any] = {"geometry": (tubes(triangles),)}
        if moving:
            # The camera rests: once drawn, the surfaces stay.
            return MovingLight(
                stage.renderer, setting, "combined", "rotation", 1, changes=changes, settling=1
            )
        return Refined(stage.renderer, setting, "combined", changes=changes, settling=1)

    return make


def _ours(technique: str, settling: int = 0) -> Callable[[Stage, Setting], Contender]:
    return lambda stage, setting: Ours(stage.renderer, setting, technique, settling=settling)


def _local(kind: type[Ours] = Ours, lamps: str = "off") -> Callable[[Stage, Setting], Contender]:
    changes = {"technique.lamps": lamps, "technique.directions": LEAST}
    quality = replace(FULL, progressive=True)
    return lambda stage, setting: kind(
        stage.renderer, setting, "local-occlusion", quality, changes, settling=1
    )


def _moving(
    technique: str, angle: str, swing: int = SWING, quality: Quality = FULL
) -> Callable[[Stage, Setting], Contender]:
    return lambda stage, setting: MovingLight(stage.renderer, setting, technique, angle, swing, quality)


def _extinction(facing: float | None = None, lamp: bool = True) -> Callable[[Stage, Setting], Contender]:
    changes: dict[str, Any] = {} if facing is None else {"technique.facing": facing}
    if not lamp:
        changes["lights"] = ()
    return lambda stage, setting: Ours(stage.renderer, setting, "extinction", changes=changes, settling=2)


def _moving_extinction(quality: Quality = FULL) -> Callable[[Stage, Setting], Contender]:
    changes = {"technique.facing": 0.0, "technique.resolution": 64}
    return lambda stage, setting: MovingLight(
        stage.renderer, setting, "extinction", "rotation", quality=quality, changes=changes, settling=1
    )


def _building(cells: int) -> Callable[[Stage, Setting], Contender]:
    return lambda stage, setting: Building(stage.renderer, setting, cells)


def _neighbourhood(*, explicit: bool) -> Callable[[Stage, Setting], Contender]:
    return lambda stage, setting: Neighbourhood(stage.renderer, setting, explicit)


def _vtk(mapper: str, *, shade: bool) -> Callable[[Stage, Setting], Contender]:
    return functools.partial(_make_vtk, mapper=mapper, shade=shade)


def _make_vtk(stage: Stage, setting: Setting, *, mapper: str, shade: bool) -> Contender:
    from . import peer_vtk

    return peer_vtk.Vtk(stage.window(setting), getattr(peer_vtk, mapper), shade=shade)
