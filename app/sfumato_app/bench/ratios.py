"""The ratios between rows, and what we want of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from .measure import Result, Spread


@dataclass(frozen=True)
class Goal:
    """A bound on a ratio's median: at most `limit`, or with `at_least` no less; on a GPU only with `gpu`."""

    limit: float
    at_least: bool = False
    gpu: bool = False

    def met(self, median: float) -> bool:
        """Tell whether a median is good enough."""
        return median >= self.limit if self.at_least else median <= self.limit

    def __str__(self) -> str:
        return f"{'>=' if self.at_least else '<='} {self.limit:g}{' (GPU)' if self.gpu else ''}"


@dataclass(frozen=True)
class Ratio:
    """How many times as long one row takes as another."""

    label: str
    above: str
    below: str
    goal: Goal | None = None

    @property
    def id(self) -> str:
        """Name in the report."""
        return f"{self.above} / {self.below}"


#: The project's goals; the 1.39 is the paper's own, for its gecko on a GPU (Soltesova2010, section 5.2).
RATIOS = (
    Ratio("any light / headlamp", "multidirectional", "directional", Goal(1.05)),
    Ratio("light turning / at rest", "multidirectional-turning", "multidirectional", Goal(1.02)),
    Ratio("light tilting / at rest", "multidirectional-tilting", "multidirectional", Goal(1.02)),
    Ratio("shadows / local shading", "multidirectional", "slices-phong", Goal(1.39, gpu=True)),
    Ratio("VTK unshaded / ours", "vtk-gpu", "raycast", Goal(4.0, at_least=True)),
    Ratio("VTK shaded / ours", "vtk-gpu-shaded", "raycast-phong"),
    Ratio("VTK shadows / ours", "vtk-gpu-shadows", "multidirectional", Goal(14.0, at_least=True)),
    Ratio("VTK shadows / cone", "vtk-gpu-shadows", "cone-turning", Goal(10.0, at_least=True)),
    Ratio("cone / the published footprint", "cone-turning", "multidirectional-turning", Goal(1.5)),
    Ratio("a drag's frame / ray casting", "cone-drag", "raycast", Goal(1.2)),
    Ratio("a drag's frame / ray casting", "multidirectional-drag", "raycast"),
    Ratio("light kept / light moved", "cone-still", "cone"),
    # Hernell2007, Fig. 3: diffuse shading 26.4 frames/s, light from all around in its place 27.2.
    Ratio("local occlusion / diffuse", "local-occlusion", "raycast-phong", Goal(1.05)),
    Ratio("local occlusion beside diffuse / diffuse", "local-occlusion-diffuse", "raycast-phong"),
    Ratio("after a change / its light kept", "local-occlusion-retouched", "local-occlusion"),
    # Schlegel2011, Table 1: 1.13 to 1.86, its engine with a moving light 2.3, light from all around alone 1.29.
    Ratio("extinction, light at rest / ray casting", "extinction-still", "raycast", Goal(1.3)),
    Ratio("extinction, light at rest / ray casting", "extinction-still", "raycast", Goal(1.15, gpu=True)),
    Ratio("extinction, light moving / ray casting", "extinction-moving", "raycast", Goal(1.8)),
    Ratio("extinction, a drag's frame / ray casting", "extinction-drag", "raycast"),
    Ratio("extinction, ambient alone / ray casting", "extinction-ambient", "raycast", Goal(1.8)),
    Ratio("extinction with slopes / Phong", "extinction", "raycast-phong"),
    *(
        Ratio(f"light of {n}^3 / ray casting", f"extinction-build-{n}", "raycast")
        for n in (64, 128, 192, 256)
    ),
    # The paper: 0.0307 s against 3.08 s at 256^3 (Table 2).
    Ratio(
        "explicit sampling / shells", "extinction-explicit", "extinction-shells", Goal(45.0, at_least=True)
    ),
    Ratio("VTK on the CPU / ours", "vtk-cpu", "raycast"),
    # Schott2012, Table 1: 1.43, 1.16 and 1.45 with 137k, 720k and 7.9M triangles.
    *(
        Ratio(f"with {n} triangles / the volume alone{how}", f"combined-{n}{kept}", f"cone{kept}", goal)
        for n, goal in (("130k", Goal(1.25)), ("720k", Goal(1.25)), ("2M", None), ("8M", None))
        for kept, how in (("", ""), ("-still", ", light kept"))
    ),
)


@dataclass(frozen=True)
class Outcome:
    """A ratio as measured, by the clock that counts and by the other."""

    ratio: Ratio
    cpu: Spread
    wall: Spread
    verdict: str


def outcomes(results: Sequence[Result], clock: str, on_gpu: bool) -> list[Outcome]:
    """Return all ratios whose two rows were measured.

    Parameters
    ----------
    clock : str
        ``cpu`` or ``wall``: the time by which goals are judged.
    on_gpu : bool
        Whether goals that are meant for a GPU count.
    """
    by_id = {result.row.id: result for result in results if not result.missing}
    measured = [ratio for ratio in RATIOS if ratio.above in by_id and ratio.below in by_id]
    return [_outcome(ratio, by_id, clock, on_gpu) for ratio in measured]


def _outcome(ratio: Ratio, by_id: Mapping[str, Result], clock: str, on_gpu: bool) -> Outcome:
    above, below = by_id[ratio.above], by_id[ratio.below]
    spreads = {"cpu": _divided(above.cpu, below.cpu), "wall": _divided(above.wall, below.wall)}
    goal, verdict = ratio.goal, "-"
    if goal is not None and (on_gpu or not goal.gpu):
        verdict = "pass" if goal.met(spreads[clock].median) else "short"
    return Outcome(ratio, spreads["cpu"], spreads["wall"], verdict)


def _divided(above: Sequence[float], below: Sequence[float]) -> Spread:
    """Return the spread of the ratios of each round; a clock too coarse to tell counts as a nanosecond."""
    return Spread.of([a / max(b, 1e-6) for a, b in zip(above, below, strict=True)])
