"""Compares where VTK and we see points, in several windows, and prints the largest difference as JSON.

Run as a program of its own: the screen's scale is ``QT_SCALE_FACTOR``, which holds for a whole process.
Besides projected points, a small ball is found in both pictures: by its colour, in each one's own pixels.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from qtpy.QtGui import QImage
from qtpy.QtWidgets import QApplication

from sfumato import Camera, Document, Geometry, Scene, Surface
from sfumato_ui.app import make_application
from sfumato_ui.tools.view import PictureView
from sfumato_ui.window import MainWindow

SIZES = ((1000, 600), (760, 620))
PLACE = (24.0, 12.0, 26.0)


def wait(until: Callable[[], bool], seconds: float = 120) -> None:
    """Go on with events until something is so."""
    end = time.monotonic() + seconds
    while not until():
        if time.monotonic() > end:
            raise SystemExit("it did not come")
        QApplication.processEvents()
        time.sleep(0.005)


def ball() -> Geometry:
    """A ball of 2 mm, red."""
    import pyvista

    mesh = pyvista.Sphere(radius=2, center=PLACE, theta_resolution=24, phi_resolution=24)
    triangles = mesh.faces.reshape(-1, 4)[:, 1:]
    return Geometry(Surface(np.asarray(mesh.points), triangles.astype(np.uint32)), color=(1, 0, 0))


def camera(parallel: bool) -> Camera:
    """A view from the side, its opening shifted."""
    return Camera(
        position=(90, -60, 70), focal_point=(18, 22, 17), view_up=(0.2, 0.1, 1), view_angle=34,
        parallel_projection=parallel, parallel_scale=30, window_center=(0.1, -0.2),
    )  # fmt: skip


def middle(image: QImage) -> np.ndarray:
    """Where the red ball is, in pixels of an image."""
    image = image.convertToFormat(QImage.Format.Format_RGBA8888)
    flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    pixels = flat[:, : 4 * image.width()].reshape(image.height(), image.width(), 4).astype(int)
    red = (pixels[..., 0] > 60) & (pixels[..., 0] > 2 * pixels[..., 1])
    rows, columns = np.nonzero(red)
    return np.array([(columns.min() + columns.max()) / 2, (rows.min() + rows.max()) / 2]) + 0.5


def places_in_vtk(stage: Any, points: np.ndarray) -> np.ndarray:
    """Where VTK projects world points: device pixels from the upper left."""
    from vtkmodules.vtkRenderingCore import vtkCoordinate

    found = []
    for point in points:
        spot = vtkCoordinate()
        spot.SetCoordinateSystemToWorld()
        spot.SetValue(*map(float, point))
        x, y = spot.GetComputedDoubleDisplayValue(stage.view.renderer)
        found.append((x, stage.view.render_window.GetSize()[1] - y))
    return np.array(found)


def compare(window: MainWindow, parallel: bool) -> tuple[float, float]:
    """Return by how many device pixels projected points differ at most, and the balls in the pictures."""
    wanted = camera(parallel)
    window.editor.change("Look", camera=wanted)
    stage = window.vtk.panel.stage  # type: ignore[union-attr]
    assert stage is not None
    ratio, view = stage.view.devicePixelRatioF(), stage.view
    wait(lambda: window.viewport.picture is not None and not window.viewport.picture.interactive
         and window.viewport.picture.scene == window.editor.scene
         and window.viewport.picture.size == window.viewport.pixel_size and not stage.screen.moving)  # fmt: skip
    wait(
        lambda: (
            list(view.render_window.GetSize()) == [round(view.width() * ratio), round(view.height() * ratio)]
        )
    )
    points = np.random.default_rng(0).uniform(0, 40, (20, 3))
    ours = PictureView(wanted, view.width(), view.height()).places(points) * ratio
    projected = float(np.abs(places_in_vtk(stage, points) - ours).max())
    # Both pictures keep the height; their widths differ: distances from the middle, in heights.
    seen = []
    assert window.viewport.picture is not None
    for image in (window.viewport.picture.image, view.grabFramebuffer()):
        seen.append(
            (middle(image) - [image.width() / 2, image.height() / 2]) / image.height() * view.height() * ratio
        )
        shift = wanted.window_center[0] * image.width() / 2 / image.height() * view.height() * ratio
        seen[-1][0] += shift  # the opening is shifted by a part of the width
    return projected, float(np.abs(seen[0] - seen[1]).max())


def main() -> None:
    """Walk through sizes and projections."""
    app = make_application()
    window = MainWindow(Document(Scene(geometry=(ball(),), technique="combined", camera=camera(False))))
    window.show()
    window.strip.vtk.click()
    wait(lambda: window.vtk.panel is not None and window.vtk.panel.stage is not None, 240)
    wait(lambda: not window.vtk.panel.stage.busy)  # type: ignore[union-attr]
    found = []
    for size in SIZES:
        window.resize(*size)
        for parallel in (False, True):
            found.append(compare(window, parallel))
    ratio = window.devicePixelRatioF()
    window.editor.document.mark_saved()
    window.close()
    app.processEvents()
    print(
        json.dumps({"ratio": ratio, "projected": max(f[0] for f in found), "seen": max(f[1] for f in found)})
    )
    sys.stdout.flush()
    os._exit(0)  # VTK's last window must not die under Mesa's display


if __name__ == "__main__":
    main()
