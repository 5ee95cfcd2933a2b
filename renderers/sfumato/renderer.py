"""From a scene and a size to a picture, at once or in pieces that can be cancelled."""

from __future__ import annotations

import threading
from collections.abc import Generator
from typing import Any

import moderngl
import numpy as np

from .audit import Audit, audited
from .errors import SceneError
from .gpu import Device, GpuObject, Program, ShaderSource, Target, gpu_objects
from .scene import Scene
from .scene.white import balance_matrix
from .techniques import Painter, technique_for
from .techniques.frame import DRAG, FULL, Frame, Quality

__all__ = ["DRAG", "FULL", "Accumulation", "Quality", "Renderer", "render"]

#: Largest side of a picture in pixels that is drawn in one go.
MAX_SIDE = 16384
#: Fields of a scene on which no frame depends: what `Renderer.resolve` makes of frames, their number, kept views.
#: (Where there is a shadow floor, each frame is drawn without shadows, too: `Accumulation.measured`.)
AFTERWARDS = ("background", "exposure", "white_balance", "tone_curve", "shadow_floor", "frames", "bookmarks")


class Renderer:
    """Draws scenes on a device of its own; to be used on the thread that made it.

    Parameters
    ----------
    budget : int, optional
        Bytes of GPU memory for what is kept for frames to come; if not given, ``SFUMATO_GPU_BUDGET_MB``
        (MiB), or 2 GiB. What the present frame needs is kept in any case.

    Raises
    ------
    GpuError
        If there is no OpenGL 3.3, or the variable is not a number.
    """

    def __init__(self, budget: int | None = None) -> None:
        self.device = Device()
        if budget is not None:
            self.device.store.budget = budget
        self._painters: dict[tuple[str, ...], Painter] = {}
        self._names: dict[tuple[str, ...], str] = {}
        self._add = Program(self.device, ShaderSource("shaders/add.frag.glsl"))
        self._resolve = Program(self.device, ShaderSource("shaders/resolve.frag.glsl"))

    @property
    def name(self) -> str:
        """Name of the graphics device, as OpenGL gives it."""
        return self.device.name

    @property
    def version(self) -> str:
        """Version of OpenGL."""
        return self.device.version

    def begin(
        self,
        scene: Scene,
        size: tuple[int, int],
        quality: Quality = FULL,
        part: tuple[int, int, int, int] | None = None,
        audited: bool = False,
    ) -> Accumulation:
        """Start a picture; add frames to it until it is good enough.

        Parameters
        ----------
        scene : Scene
            What to draw; it needs a volume, or geometry and a technique that draws it.
        size : (int, int)
            Width and height in pixels, before the quality's scale.
        part : (int, int, int, int), optional
            Draw only this part of the picture, at full scale: x and y of its corner from the left and the top,
            width and height, in pixels.
        audited : bool
            Draw beside each frame what it would be without shadows, for `Accumulation.audit`.

        Raises
        ------
        SceneError
            If there is nothing to draw or the size is not possible.
        """
        if scene.volume is None and not (scene.geometry and technique_for(scene.technique).geometry):
            needed = "a volume" if not scene.geometry else "a volume, or the technique combined,"
            raise SceneError("volume", None, f"a scene needs {needed} to be drawn")
        width, height = (int(v) for v in (part[2:] if part else size))
        limit = min(MAX_SIDE, self.device.max_texture_2d)
        if not (1 <= width <= limit and 1 <= height <= limit):
            raise SceneError("size", size, f"1 to {limit} pixels on a side")
        self.device.make_current()
        if part is not None:
            corner = part[0], size[1] - part[1] - part[3]
            return Accumulation(self, scene, (width, height), quality, corner, size, audited)
        scaled = max(1, round(width * quality.scale)), max(1, round(height * quality.scale))
        return Accumulation(self, scene, scaled, quality, audited=audited)

    def painter(self, scene: Scene) -> Painter:
        """Return the painter of a scene's technique, making it when first asked for."""
        technique = technique_for(scene.technique)
        key = (technique.painter, *map(str, sorted(technique.options.items())))
        if key not in self._painters:
            self._painters[key] = technique.make_painter(self.device)
            self._names[key] = technique.id
        return self._painters[key]

    def add(self, frame: Target, total: Target) -> None:
        """Add a frame to a sum."""
        ctx = self.device.ctx
        total.fbo.use()
        self._add.bind(u_frame=frame.texture)
        ctx.enable(moderngl.BLEND)
        ctx.blend_func = moderngl.ONE, moderngl.ONE
        self._add.draw()
        ctx.disable(moderngl.BLEND)

    def resolve(
        self, total: Target, frames: int, scene: Scene, unshadowed: Target | None = None
    ) -> np.ndarray:
        """Return a sum of frames as sRGB bytes, shape (height, width, 4), straight alpha, row 0 on top.

        With the sum of the same frames without shadows, these keep to the scene's floor.
        """
        width, height = total.size
        texture = self.device.ctx.texture(total.size, 4)
        fbo = self.device.ctx.framebuffer([texture])
        fbo.use()
        self._resolve.bind(u_sum=total.texture, u_unshadowed=(unshadowed or total).texture)
        self._resolve.set(
            u_floor=scene.shadow_floor if unshadowed is not None else 0.0,
            u_scale=1 / frames,
            u_background=_premultiplied(scene),
            u_soft=scene.tone_curve == "soft",
            # Column by column, as GLSL has matrices.
            u_to_white=tuple((2.0**scene.exposure * balance_matrix(scene.white_balance)).T.ravel().tolist()),
        )
        self._resolve.draw()
        self.device.wait()
        pixels = np.empty((height, width, 4), dtype=np.uint8)
        fbo.read_into(pixels, components=4, alignment=1)
        fbo.release()
        texture.release()
        return pixels

    def gpu_objects(self, *pictures: Accumulation) -> list[GpuObject]:
        """Return what is on the GPU, the largest first: what is kept, each technique's own, and pictures'."""
        owners: dict[str, Any] = {}
        for number, (name, thing) in enumerate(self.device.store.things()):
            owners[name if name not in owners else f"{name} {number}"] = thing
        owners |= {self._names[key]: painter for key, painter in self._painters.items()}
        owners |= {f"picture {k}" if k else "picture": picture for k, picture in enumerate(pictures)}
        return gpu_objects(owners)

    def close(self) -> None:
        """Free everything."""
        self.device.make_current()
        for painter in self._painters.values():
            painter.release()
        self._add.release()
        self._resolve.release()
        self.device.close()


class Accumulation:
    """A picture that grows better with each jittered frame.

    Attributes
    ----------
    size : (int, int)
        Pixels drawn: the size asked for times the quality's scale.
    frames : int
        Frames so far. Those before the light has settled (``Quality.progressive``) take each other's place.
    light : float
        How much (0 to 1) of the light that comes by and by the frames so far have.
    """

    def __init__(
        self,
        renderer: Renderer,
        scene: Scene,
        size: tuple[int, int],
        quality: Quality,
        corner: tuple[int, int] = (0, 0),
        whole: tuple[int, int] | None = None,
        audited: bool = False,
    ) -> None:
        self.renderer = renderer
        self.scene = scene
        self.size = size
        self.quality = quality
        self._corner, self._whole = corner, whole
        self.frames = 0
        self.light = 1.0
        self._total: Target | None = None
        self._latest: Target | None = None
        #: The sum of the same frames without shadows, where it is needed.
        self._unshadowed: Target | None = None
        #: Whether each frame is drawn without shadows, too.
        self.measured = technique_for(scene.technique).shadows and (audited or scene.shadow_floor > 0)

    @property
    def settled(self) -> bool:
        """Whether the light of the frames so far is as good as it gets."""
        return self.light >= 1

    def add_frame(self) -> Generator[float, None, None]:
        """Draw one more frame in bounded pieces, yielding progress (0 to 1); stop iterating to cancel it.

        Raises
        ------
        GpuError
            If the device fails; frames added before stay good.
        """
        number = self.frames if self.settled else 0
        share = 0.5 if self.measured else 1.0
        self.renderer.device.make_current()
        self._make_targets()
        frame = yield from self._draw(number, False, 0.0, share)
        if self.measured:
            yield from self._draw(number, True, share, share)
        self.renderer.device.wait()
        self.frames, self.light = number + 1, frame.light

    def _make_targets(self) -> None:
        device = self.renderer.device
        if self._latest is None:
            self._latest = Target(device, self.size)
        if self._total is None:
            self._total = Target(device, self.size)
            self._unshadowed = Target(device, self.size) if self.measured else None

    def _draw(
        self, number: int, unshadowed: bool, start: float, share: float
    ) -> Generator[float, None, Frame]:
        """Draw a frame and add it to its sum, yielding progress from `start` on."""
        device, total = self.renderer.device, self._unshadowed if unshadowed else self._total
        assert self._latest is not None
        assert total is not None
        frame = Frame(
            device, self.scene, self.size, self._latest, self.quality, number, self._corner, self._whole,
            unshadowed=unshadowed,
        )  # fmt: skip
        pieces = self.renderer.painter(self.scene).paint(frame)
        with device.store.frame():
            try:
                for progress in pieces:
                    yield start + share * progress
                    device.make_current()
            finally:
                # A frame that was given up frees what it made: in its own context, whichever is current by then.
                if device.usable:
                    device.make_current()
                pieces.close()
        if number == 0:
            total.clear()
        self.renderer.add(self._latest, total)
        return frame

    def picture(self) -> np.ndarray:
        """Return the picture so far: uint8 sRGB, straight alpha, shape (height, width, 4), row 0 on top."""
        self.renderer.device.make_current()
        return self.renderer.resolve(self._sum(), self.frames, self.scene, self._unshadowed)

    def linear(self) -> np.ndarray:
        """Return linear light so far: float32, premultiplied, before exposure; shape (height, width, 4)."""
        self.renderer.device.make_current()
        light = self.foreground()
        return np.asarray(
            light + (1 - light[..., 3:]) * np.asarray(_premultiplied(self.scene), dtype=np.float32)
        )

    def audit(self, threshold: float) -> Audit:
        """Return what the shadows darken below a share of its brightness without them, 0 to 1.

        Raises
        ------
        SceneError
            If the picture was not begun as an ``audited`` one, or has no frame yet.
        """
        self.renderer.device.make_current()
        light = self.foreground()
        if technique_for(self.scene.technique).shadows and self._unshadowed is None:
            raise SceneError("audited", False, "begin the picture with audited=True")
        full = light if self._unshadowed is None else self._mean(self._unshadowed)
        return audited(light, full, self.picture(), threshold)

    def _mean(self, total: Target) -> np.ndarray:
        return total.read() / np.float32(self.frames)

    def foreground(self) -> np.ndarray:
        """Return linear light so far as `linear` does, but without the background."""
        self.renderer.device.make_current()
        light = self._mean(self._sum())
        if self._unshadowed is not None and self.scene.shadow_floor > 0:
            floor = np.float32(self.scene.shadow_floor)
            light[..., :3] = np.maximum(light[..., :3], floor * self._mean(self._unshadowed)[..., :3])
        return light

    def _sum(self) -> Target:
        if self._total is None or self.frames == 0:
            raise SceneError("frames", self.frames, "draw a frame first")
        return self._total

    def rest(self) -> None:
        """Free what only drawing needs; the next frame makes it anew."""
        self.renderer.device.make_current()
        if self._latest is not None:
            self._latest.release()
        self._latest = None

    def release(self) -> None:
        """Free the GPU objects."""
        self.renderer.device.make_current()
        for target in (self._latest, self._total, self._unshadowed):
            if target is not None:
                target.release()
        self._latest = self._total = self._unshadowed = None


def _premultiplied(scene: Scene) -> tuple[float, float, float, float]:
    r, g, b, a = scene.background
    return r * a, g * a, b * a, a


_own = threading.local()


def renderer_of_this_thread() -> Renderer:
    """Return the calling thread's own renderer, which `render` uses too."""
    if not hasattr(_own, "renderer"):
        _own.renderer = Renderer()
    return _own.renderer  # type: ignore[no-any-return]


def render(scene: Scene, size: tuple[int, int] = (512, 512), *, linear: bool = False) -> np.ndarray:
    """Draw a scene.

    Parameters
    ----------
    scene : Scene
        What to draw; ``scene.frames`` jittered frames are accumulated.
    size : (int, int)
        Width and height in pixels.
    linear : bool
        Return linear light instead of a finished picture.

    Returns
    -------
    ndarray
        uint8 sRGB with straight alpha, shape (height, width, 4), row 0 on top; or float32 linear,
        premultiplied, before exposure and tone mapping.

    Raises
    ------
    SceneError
        If the scene has nothing to draw or the size is not possible.
    GpuError
        If the device cannot do it.
    """
    renderer = renderer_of_this_thread()
    job: Any = renderer.begin(scene, size)
    try:
        for _ in range(scene.frames):
            for _ in job.add_frame():
                pass
        return np.asarray(job.linear() if linear else job.picture())
    finally:
        job.release()
        renderer.device.collect()
