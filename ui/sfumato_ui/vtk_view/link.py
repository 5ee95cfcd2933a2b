"""Our camera is VTK's: the same numbers in both, so that both views see a point in the same place. No Qt."""

from __future__ import annotations

from typing import Any

import numpy as np

from sfumato import Camera


def show_camera(camera: Camera, vtk_camera: Any) -> None:
    """Let a vtkCamera see what ours sees."""
    vtk_camera.SetPosition(*camera.position)
    vtk_camera.SetFocalPoint(*camera.focal_point)
    vtk_camera.SetViewUp(*camera.view_up)
    vtk_camera.SetViewAngle(camera.view_angle)
    vtk_camera.SetParallelProjection(camera.parallel_projection)
    vtk_camera.SetParallelScale(camera.parallel_scale)
    vtk_camera.SetWindowCenter(*camera.window_center)


def camera_of(vtk_camera: Any) -> Camera:
    """Return what a vtkCamera sees as our camera."""
    return Camera(
        position=vtk_camera.GetPosition(),
        focal_point=vtk_camera.GetFocalPoint(),
        view_up=vtk_camera.GetViewUp(),
        view_angle=vtk_camera.GetViewAngle(),
        parallel_projection=bool(vtk_camera.GetParallelProjection()),
        parallel_scale=vtk_camera.GetParallelScale(),
        window_center=vtk_camera.GetWindowCenter(),
    )


def same_view(one: Camera, other: Camera) -> bool:
    """Tell whether two cameras differ by rounding alone."""
    numbers = [
        (*c.position, *c.focal_point, *c.basis().up, c.view_angle, c.parallel_scale, *c.window_center)
        for c in (one, other)
    ]
    close = np.allclose(numbers[0], numbers[1], rtol=1e-9, atol=1e-9 * max(1.0, one.distance))
    return bool(close and one.parallel_projection == other.parallel_projection)
