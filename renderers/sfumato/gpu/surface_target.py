"""What rasterised surfaces leave behind at each pixel: a G-buffer (Saito & Takahashi 1990)."""

from __future__ import annotations

from typing import Any

import moderngl

from .device import Device

#: Depth where there is no surface; mm.
NOTHING = 1e30


class SurfaceTarget:
    """Colour, and normal with linear depth, of the nearest surface at each pixel.

    Parameters
    ----------
    size : (int, int)
        Pixels.

    Attributes
    ----------
    color : texture
        Linear RGB, and 1 where there is a surface.
    shape : texture
        Unit normal in world space, turned to the viewer; depth along the view axis in mm, or `NOTHING`.
    """

    def __init__(self, device: Device, size: tuple[int, int]) -> None:
        self.device = device
        self.size = size
        with device.checked(f"a surface picture of {size[0]} x {size[1]} pixels"):
            self.color = _picture(device, size, "f2")
            self.shape = _picture(device, size, "f4")
            self.depth = device.ctx.depth_renderbuffer(size)
        # Outside: moderngl leaves an error behind when it makes a framebuffer.
        self.fbo = device.ctx.framebuffer([self.color, self.shape], self.depth)

    def clear(self) -> None:
        """Empty it."""
        self.fbo.use()
        self.fbo.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
        self.device.clear_attachment(1, NOTHING)

    def begin(self) -> None:
        """Draw to it, nearest surfaces first."""
        self.fbo.use()
        self.device.ctx.enable(moderngl.DEPTH_TEST)

    def end(self) -> None:
        """Stop comparing depths."""
        self.device.ctx.disable(moderngl.DEPTH_TEST)

    def release(self) -> None:
        """Free the GPU objects."""
        for part in (self.fbo, self.color, self.shape, self.depth):
            part.release()


def _picture(device: Device, size: tuple[int, int], dtype: str) -> Any:
    texture = device.ctx.texture(size, 4, dtype=dtype)
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    texture.repeat_x = texture.repeat_y = False
    return texture


__all__ = ["NOTHING", "SurfaceTarget"]
