"""How streamlines are traced: the seeds, and the integrator's settings."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

import numpy as np

from ..errors import SceneError
from .params import Param, check

Vec3 = tuple[float, float, float]
MAX_SEEDS = 200_000


@dataclass(frozen=True)
class Seeds:
    """Where streamlines begin.

    Parameters
    ----------
    kind : str
        ``sphere`` (``center``, ``radius``: random places inside), ``line`` (``start`` to ``end``), ``plane``
        (a rectangle around ``center`` with the edges ``edge_u`` and ``edge_v``), ``points`` (``places``), or
        ``surface`` (random places on the surface mesh in the file ``path``).
    count : int
        How many; ``points`` has its own number.
    """

    kind: Annotated[
        str, Param("Shape of the seeds", choices=("sphere", "line", "plane", "points", "surface"))
    ] = "sphere"
    center: Annotated[Vec3, Param("Middle of the sphere or plane", unit="mm")] = (0.0, 0.0, 0.0)
    radius: Annotated[float, Param("Radius of the sphere", unit="mm", gt=0)] = 10.0
    start: Annotated[Vec3, Param("One end of the line", unit="mm")] = (0.0, 0.0, 0.0)
    end: Annotated[Vec3, Param("Other end of the line", unit="mm")] = (10.0, 0.0, 0.0)
    edge_u: Annotated[Vec3, Param("One edge of the plane's rectangle", unit="mm")] = (10.0, 0.0, 0.0)
    edge_v: Annotated[Vec3, Param("Other edge of the plane's rectangle", unit="mm")] = (0.0, 10.0, 0.0)
    places: tuple[Vec3, ...] = ()
    path: str = ""
    count: Annotated[int, Param("Number of seeds", label="Seeds", ge=1, le=MAX_SEEDS, soft=(10, 5000))] = 200
    seed: Annotated[int, Param("Start of the random numbers", ge=0, le=2**31 - 1)] = 0

    def __post_init__(self) -> None:
        check(self)
        if self.kind == "points" and not self.places:
            raise SceneError("places", self.places, "at least one point is needed")
        if self.kind == "surface" and not self.path:
            raise SceneError("path", self.path, "the file of a surface is needed")
        if self.kind == "plane" and not np.linalg.norm(np.cross(self.edge_u, self.edge_v)) > 0:
            raise SceneError("edge_v", self.edge_v, "the plane's edges must not be zero or parallel")


@dataclass(frozen=True)
class Tracing:
    """What streamlines are traced from, and how (vtkStreamTracer).

    Parameters
    ----------
    path : str
        The file of the vector volume (VTI, legacy VTK), or ``sample:name``.
    hash : str
        Key of the vector field's content; empty if it does not matter.
    array : str
        Name of the vector array; empty for the file's own choice.
    """

    path: str = ""
    hash: str = ""
    array: str = ""
    seeds: Seeds = field(default_factory=Seeds)
    length: Annotated[
        float,
        Param("Longest streamline; 0: ten times the field's longest edge", label="Length", unit="mm", ge=0),
    ] = 0.0
    step: Annotated[
        float,
        Param("Longest step of the integration", label="Step", unit="voxel", ge=0.01, le=10, soft=(0.05, 2)),
    ] = 0.5
    direction: Annotated[
        str, Param("Which way from the seeds", label="Direction", choices=("both", "forward", "backward"))
    ] = "both"
    min_speed: Annotated[
        float,
        Param(
            "Streamlines end where the field is weaker than this part of its strongest",
            label="End below",
            ge=0,
            le=1,
        ),
    ] = 1e-4
    max_steps: Annotated[int, Param("Most steps of a streamline", ge=1, le=1_000_000)] = 5000
    integrator: Annotated[str, Param("Runge-Kutta scheme", choices=("rk2", "rk4", "rk45"))] = "rk45"

    def __post_init__(self) -> None:
        check(self)
