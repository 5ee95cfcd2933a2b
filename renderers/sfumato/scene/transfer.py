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

RGB = tuple[float, float, float]

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
class Region:
    """A shape in the plane of value and gradient magnitude, for two-dimensional functions.

    Parameters
    ----------
    shape : str
        ``rectangle``, ``ellipse``, ``trapezoid`` (narrow at its low-gradient end) or ``polygon``.
    value, gradient : (float, float)
        Extent along value and along gradient magnitude (value per mm).
    points : tuple of (value, gradient)
        Corners of a polygon.
    feather : float
        Fraction of the shape over which opacity fades to nothing at its edge, 0 to 1.
    """

    shape: Annotated[str, Param("Shape", choices=("rectangle", "ellipse", "trapezoid", "polygon"))] = (
        "rectangle"
    )
    value: tuple[float, float] = (0.0, 1.0)
    gradient: tuple[float, float] = (0.0, 1.0)
    points: tuple[tuple[float, float], ...] = ()
    color: Annotated[RGB, Param("Linear RGB", ge=0, le=1)] = (1.0, 1.0, 1.0)
    opacity: Annotated[float, Param("Opacity at unit distance", ge=0, le=1)] = 0.5
    emission: Annotated[RGB, Param("Linear RGB given off", ge=0, le=1000)] = (0.0, 0.0, 0.0)
    feather: Annotated[float, Param("Soft edge", ge=0, le=1)] = 0.2

    def __post_init__(self) -> None:
        check(self)
        if self.shape == "polygon" and len(self.points) < 3:
            raise SceneError("points", self.points, "a polygon needs at least three corners")
        if self.shape != "polygon" and not (
            self.value[0] < self.value[1] and self.gradient[0] < self.gradient[1]
        ):
            raise SceneError("value", (self.value, self.gradient), "each extent needs low < high")

    def coverage(self, value: np.ndarray, gradient: np.ndarray) -> np.ndarray:
        """Return how much of the region's opacity holds at each (value, gradient), 0 to 1."""
        if self.shape == "polygon":
            return _inside_polygon(value, gradient, np.asarray(self.points, dtype=float)).astype(float)
        u = 2 * (value - self.value[0]) / (self.value[1] - self.value[0]) - 1
        v = (gradient - self.gradient[0]) / (self.gradient[1] - self.gradient[0])
        if self.shape == "ellipse":
            depth = 1 - np.hypot(u, 2 * v - 1)
        else:
            # A trapezoid's half width grows from a tenth at its low end to the whole at its high end.
            width = 1.0 if self.shape == "rectangle" else np.clip(0.1 + 0.9 * v, 1e-6, None)
            depth = np.minimum(1 - np.abs(u) / width, 1 - np.abs(2 * v - 1))
        return np.clip(depth / max(self.feather, 1e-6), 0, 1)


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
        If there are any, they replace the points for classification.
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
        """Return the function with every value v moved to ``scale * v + offset``."""
        return replace(self, points=tuple(replace(p, value=p.value * scale + offset) for p in self.points))

    def evaluate(self, values: np.ndarray) -> np.ndarray:
        """Return colour, opacity and emission at the given values; shape (..., 7): r, g, b, alpha, er, eg, eb."""
        x = np.array([p.value for p in self.points])
        y = np.array([(*p.color, p.opacity, *p.emission) for p in self.points])
        return np.stack([np.interp(values, x, y[:, c]) for c in range(7)], axis=-1)

    def extinction(self, opacity: np.ndarray, unit_distance: float) -> np.ndarray:
        """Return extinction per mm of an opacity at unit distance (in mm)."""
        return np.asarray(
            -np.log1p(-np.minimum(opacity, MAX_OPACITY)) / (self.unit_distance or unit_distance)
        )

    def evaluate_2d(self, values: np.ndarray, gradients: np.ndarray) -> np.ndarray:
        """Return colour, opacity and emission on a grid of values and gradient magnitudes.

        Regions are laid over each other in their order, colours mixed by opacity.
        """
        result = np.zeros((*np.broadcast_shapes(values.shape, gradients.shape), 7))
        if not self.regions:
            result[...] = self.evaluate(np.broadcast_to(values, result.shape[:-1]))
            return result
        for region in self.regions:
            alpha = region.opacity * region.coverage(values, gradients)[..., None]
            over = 1 - (1 - alpha) * (1 - result[..., 3:4])
            share = np.divide(alpha, over, out=np.zeros_like(over), where=over > 0)
            result[..., :3] += share * (np.asarray(region.color) - result[..., :3])
            result[..., 4:] += share * (np.asarray(region.emission) - result[..., 4:])
            result[..., 3:4] = over
        return result


def _inside_polygon(x: np.ndarray, y: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Even-odd rule."""
    x, y = np.broadcast_arrays(x, y)
    inside = np.zeros(x.shape, dtype=bool)
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        crosses = (y0 > y) != (y1 > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            inside ^= crosses & (x < (x1 - x0) * (y - y0) / (y1 - y0) + x0)
    return inside
