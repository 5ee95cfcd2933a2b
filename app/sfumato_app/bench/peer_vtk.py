"""VTK's volume mappers as contenders, off-screen, in this process and on this thread.

The same voxels, transfer function, view, light and sampling distance as ours, with everything that VTK
would decide by itself (sampling distances, jitter, lights) switched off. VTK knows no colour spaces: it is
given linear colours, and what it returns is taken for linear light.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np

import sfumato
from sfumato.techniques import params_of

from .contender import Unavailable
from .setting import Setting


class VtkStage:
    """Window, renderer and light of all VTK's contenders of a setting; one volume shows at a time."""

    def __init__(self, setting: Setting) -> None:
        try:
            import vtkmodules.vtkRenderingOpenGL2 as opengl  # noqa: N813
            import vtkmodules.vtkRenderingVolumeOpenGL2  # noqa: F401 - registers the mappers
            from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow
        except ImportError as error:
            raise Unavailable(f"VTK is not installed ({error})") from None
        self.scene = setting.scene("raycast-phong")
        # Not asked for EGL by name, VTK tries for an X server first, and complains where there is none.
        window_class = getattr(opengl, "vtkEGLRenderWindow", vtkRenderWindow)
        _keep_display(window_class)
        self.window = window_class()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*setting.picture_size)
        self.renderer = vtkRenderer()
        self.renderer.SetBackground(0, 0, 0)
        self.window.AddRenderer(self.renderer)
        _set_camera(self.renderer.GetActiveCamera(), self.scene)
        _add_light(self.renderer, self.scene)
        self.image = _image(self.scene)
        self._volumes: list[Any] = []

    @property
    def device(self) -> str:
        """Name of the graphics device, as OpenGL gives it to VTK."""
        for line in self.window.ReportCapabilities().splitlines():
            if line.lower().startswith("opengl renderer string"):
                return str(line.split(":", 1)[1].strip())
        return "unknown"

    def add(self, mapper: Any, *, shade: bool) -> Any:
        """Add a volume that a mapper draws; it is shown by `show`."""
        from vtkmodules.vtkRenderingCore import vtkVolume

        mapper.SetInputData(self.image)
        mapper.SetSampleDistance(self.scene.step * self.scene.volume.min_spacing)  # type: ignore[union-attr]
        mapper.SetAutoAdjustSampleDistances(0)
        mapper.SetLockSampleDistanceToInputSpacing(0)
        volume = vtkVolume()
        volume.SetMapper(mapper)
        _set_property(volume.GetProperty(), self.scene, shade)
        self.renderer.AddVolume(volume)
        self.renderer.ResetCameraClippingRange()
        self._volumes.append(volume)
        return volume

    def show(self, volume: Any) -> None:
        """Draw one of the volumes and wait until it is finished."""
        for other in self._volumes:
            other.SetVisibility(other is volume)
        self.window.MakeCurrent()
        self.window.Render()
        self.window.WaitForCompletion()

    def pixels(self) -> np.ndarray:
        """Return the window's picture: uint8, shape (height, width, 3), row 0 on top."""
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

        grab = vtkWindowToImageFilter()
        grab.SetInput(self.window)
        grab.ReadFrontBufferOff()
        grab.ShouldRerenderOff()
        grab.Update()
        width, height, _ = grab.GetOutput().GetDimensions()
        flat = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars())  # type: ignore[no-untyped-call]
        return np.asarray(flat.reshape(height, width, -1)[::-1, :, :3])

    def close(self) -> None:
        """Give VTK's context back now, not whenever the garbage collector comes by in the middle of a frame."""
        for volume in self._volumes:
            self.renderer.RemoveVolume(volume)
        self._volumes.clear()
        self.window.RemoveRenderer(self.renderer)
        self.window.Finalize()


@functools.cache
def _keep_display(window_class: Any) -> Any:
    """Return a window that is never closed.

    With its last window VTK terminates the EGL display, which is the process's own and not VTK's: all our
    contexts would be lost with it.
    """
    keeper = window_class()
    keeper.SetOffScreenRendering(1)
    keeper.SetSize(1, 1)
    keeper.Initialize()
    return keeper


class Vtk:
    """One of VTK's mappers, in one way of shading."""

    def __init__(self, stage: VtkStage, mapper: Callable[[], Any], *, shade: bool) -> None:
        self._stage = stage
        self._volume = stage.add(mapper(), shade=shade)

    def settle(self) -> None:
        """Nothing is kept that others could push out."""

    def draw(self) -> None:
        """Draw one frame."""
        self._stage.show(self._volume)

    def light(self) -> np.ndarray:
        """Draw once more and return what VTK shows, taken for linear light."""
        self.draw()
        return np.asarray(self._stage.pixels() / np.float32(255))


def gpu_mapper() -> Any:
    """Return VTK's ray caster on the GPU, samples at equal distances from the volume's surface."""
    from vtkmodules.vtkRenderingVolumeOpenGL2 import vtkOpenGLGPUVolumeRayCastMapper

    mapper = vtkOpenGLGPUVolumeRayCastMapper()
    mapper.SetUseJittering(0)
    return mapper


def gpu_shadow_mapper() -> Any:
    """Return the same with volumetric shadows through the whole volume and no shading by the gradient."""
    mapper = gpu_mapper()
    mapper.SetGlobalIlluminationReach(1)
    mapper.SetVolumetricScatteringBlending(2)
    return mapper


def cpu_mapper() -> Any:
    """Return VTK's fixed-point ray caster on the CPU."""
    from vtkmodules.vtkRenderingVolume import vtkFixedPointVolumeRayCastMapper

    mapper = vtkFixedPointVolumeRayCastMapper()
    mapper.IntermixIntersectingGeometryOff()
    return mapper


def _set_camera(camera: Any, scene: sfumato.Scene) -> None:
    ours = scene.camera
    assert ours is not None
    camera.SetPosition(*ours.position)
    camera.SetFocalPoint(*ours.focal_point)
    camera.SetViewUp(*ours.view_up)
    camera.SetViewAngle(ours.view_angle)


def _add_light(renderer: Any, scene: sfumato.Scene) -> None:
    from vtkmodules.vtkRenderingCore import vtkLight

    assert scene.camera is not None
    assert scene.volume is not None
    center = np.asarray(scene.volume.center)
    towards = scene.lights[0].towards(scene.camera.basis(), scene.volume.center)
    light = vtkLight()
    light.SetLightTypeToSceneLight()
    light.PositionalOff()
    light.SetFocalPoint(*center)
    light.SetPosition(*(center + 1000 * towards))
    renderer.AutomaticLightCreationOff()
    renderer.AddLight(light)


def _set_property(look: Any, scene: sfumato.Scene, shade: bool) -> None:
    from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
    from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

    assert scene.transfer is not None
    assert scene.volume is not None
    color, opacity = vtkColorTransferFunction(), vtkPiecewiseFunction()
    for point in scene.transfer.points:
        color.AddRGBPoint(point.value, *point.color)
        opacity.AddPoint(point.value, point.opacity)
    look.SetColor(color)
    look.SetScalarOpacity(opacity)
    look.SetScalarOpacityUnitDistance(scene.transfer.unit_distance or scene.volume.unit_distance)
    look.SetInterpolationTypeToLinear()
    look.SetShade(shade)
    phong: Any = params_of("raycast-phong")
    look.SetAmbient(phong.ambient)
    look.SetDiffuse(phong.diffuse)
    look.SetSpecular(phong.specular)
    look.SetSpecularPower(phong.shininess)


def _image(scene: sfumato.Scene) -> Any:
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData

    volume = scene.volume
    assert volume is not None
    image = vtkImageData()
    image.SetDimensions(*volume.dims)
    image.SetSpacing(*volume.spacing)
    image.SetOrigin(*(volume.origin or (0, 0, 0)))
    voxels = numpy_to_vtk(volume.data.ravel(), deep=True)  # type: ignore[no-untyped-call]
    image.GetPointData().SetScalars(voxels)
    return image
