"""Transfer functions: from a voxel's value to extinction, colour and emission.

Opacity ``alpha`` is given at a *unit distance* u, and extinction per mm is
``tau = -ln(1 - min(alpha, 0.999)) / u``, so that a picture does not depend on the sampling distance.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from ..errors import SceneError
from .params import Param, check
from .region import RGB, Region

#: Largest opacity at unit distance; its extinction, 6.9 per unit distance, is as good as solid.
MAX_OPACITY = 0.999


@dataclass(frozen=True)
class TransferPoint:
    """A point of a piecewise linear function: at ``value``, this colour (linear RGB), opacity and emission."""

    value: float = 0.0
    color: Annotated[RGB, Param("Linear RGB", ge=0, le=1)] = (1.0, 1.0, 1.0)
    opacity: Annotated[float, Param("Opacity at unit distance", ge=0, le=1)] = 0.0
    emission: Annotated[
        RGB, Param("Linear RGB given off per unit distance at full opacity", ge=0, le=1000)
    ] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class TransferFunction:
    """Piecewise linear in value; with `regions`, a function of value and gradient magnitude instead.

    Parameters
    ----------
    points : tuple of TransferPoint
        Sorted by value; values beyond the first and last point clamp to them. Two points at one value
        make a step.
    unit_distance : float, optional
        Distance in mm to which the opacities refer; the volume's geometric mean spacing if not given.
    regions : tuple of Region
        If there are any, they replace the points for classification; one of shape ``curve`` shows them.
    name : str
        For people.
    """

    points: tuple[TransferPoint, ...] = (
        TransferPoint(0.0, (0, 0, 0), 0.0),
        TransferPoint(1.0, (1, 1, 1), 1.0),
    )
    unit_distance: Annotated[float | None, Param("Distance to which opacities refer", unit="mm", gt=0)] = None
    regions: tuple[Region, ...] = ()
    name: str = ""

    def __post_init__(self) -> None:
        check(self)
        if not self.points:
            raise SceneError("points", self.points, "at least one point is needed")
        values = [p.value for p in self.points]
        if any(b < a for a, b in itertools.pairwise(values)):
            object.__setattr__(self, "points", tuple(sorted(self.points, key=lambda p: p.value)))

    @staticmethod
    def from_points(
        points: Iterable[Sequence[Any]], unit_distance: float | None = None, name: str = ""
    ) -> TransferFunction:
        """Make a function from tuples (value, linear rgb, opacity at unit distance[, emission rgb]).

        Raises
        ------
        SceneError
            If a tuple has another form or a number is out of range.
        """
        made = []
        for i, point in enumerate(points):
            try:
                made.append(TransferPoint(*point))
            except TypeError:
                raise SceneError(
                    f"transfer.points.{i}", point, "(value, (r, g, b), opacity[, (r, g, b)]) is needed"
                ) from None
            except SceneError as error:
                raise SceneError(f"transfer.points.{i}.{error.path}", error.value, error.allowed) from None
        return TransferFunction(tuple(made), unit_distance, (), name)

    def rescaled(self, scale: float, offset: float) -> TransferFunction:
        """Return the function with every value v moved to ``scale * v + offset``.

        Regions move along the values as the points do; how steep a boundary is, stays.
        """
        points = tuple(replace(p, value=p.value * scale + offset) for p in self.points)
        return replace(self, points=points, regions=tuple(r.rescaled(scale, offset) for r in self.regions))

    def evaluate(self, values: np.ndarray) -> np.ndarray:
        """Return colour, opacity and emission at the given values; shape (..., 7): r, g, b, alpha, er, eg, eb."""
        x = np.array([p.value for p in self.points])
        y = np.array([(*p.color, p.opacity, *p.emission) for p in self.points])
        return np.stack([np.interp(values, x, y[:, c]) for c in range(7)], axis=-1)

    def most_opaque(self, values: np.ndarray, gradients: int = 33) -> np.ndarray:
        """Return the look of each value (n,) at its most opaque gradient magnitude; shape (n, 7)."""
        if not self.regions:
            return self.evaluate(values)
        top = max(region.extent[1][1] for region in self.regions)
        sampled = self.evaluate_2d(values[:, None], np.linspace(0, max(top, 1e-9), gradients)[None])
        return np.asarray(sampled[np.arange(len(values)), sampled[..., 3].argmax(axis=1)])

    def extinction(self, opacity: np.ndarray, unit_distance: float) -> np.ndarray:
        """Return extinction per mm of an opacity at unit distance (in mm)."""
        return np.asarray(
            -np.log1p(-np.minimum(opacity, MAX_OPACITY)) / (self.unit_distance or unit_distance)
        )

    def opacity_of(self, value: float, gradient: float = 0.0) -> float:
        """Return the opacity of one value and gradient magnitude, 0 to 1, per unit distance."""
        return float(self.evaluate_2d(np.array([value]), np.array([gradient]))[0, 3])

    def evaluate_2d(self, values: np.ndarray, gradients: np.ndarray) -> np.ndarray:
        """Return colour, opacity and emission on a grid of values and gradient magnitudes.

        Regions are laid over each other in their order, colours mixed by opacity. A ``curve`` shows what the
        points show, where it lies.
        """
        result = np.zeros((*np.broadcast_shapes(values.shape, gradients.shape), 7))
        if not self.regions:
            result[...] = self.evaluate(np.broadcast_to(values, result.shape[:-1]))
            return result
        for region in self.regions:
            own = self.evaluate(values) if region.shape == "curve" else region.look
            alpha = region.opacity * region.coverage(values, gradients)[..., None] * own[..., 3:4]
            over = 1 - (1 - alpha) * (1 - result[..., 3:4])
            share = np.divide(alpha, over, out=np.zeros_like(over), where=over > 0)
            result[..., :3] += share * (own[..., :3] - result[..., :3])
            result[..., 4:] += share * (own[..., 4:] - result[..., 4:])
            result[..., 3:4] = over
        return result
