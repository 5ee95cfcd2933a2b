"""Pictures on the GPU: floating-point render targets, and layers of an array to render into."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np

from .device import Device


class Target:
    """A linear, premultiplied RGBA picture of 32-bit floats.

    Parameters
    ----------
    device : Device
        Owner.
    size : (int, int)
        Width and height in pixels.
    """

    def __init__(self, device: Device, size: tuple[int, int], components: int = 4, dtype: str = "f4") -> None:
        self.device = device
        self.size = size
        with device.checked(f"a picture of {size[0]} x {size[1]} pixels"):
            self.texture = device.ctx.texture(size, components, dtype=dtype)
        self.texture.repeat_x = self.texture.repeat_y = False
        self.texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self.fbo = device.ctx.framebuffer([self.texture])
        self.clear()

    def clear(self, red: float = 0.0, green: float = 0.0, blue: float = 0.0, alpha: float = 0.0) -> None:
        """Fill with one value."""
        self.fbo.clear(red, green, blue, alpha)

    def write(self, pixels: np.ndarray) -> None:
        """Upload a picture; float32, shape (height, width, 4), row 0 on top."""
        self.texture.write(np.ascontiguousarray(pixels[::-1], dtype=np.float32).tobytes())

    def read(self) -> np.ndarray:
        """Download the picture; float32, shape (height, width, components), row 0 on top."""
        width, height = self.size
        self.device.wait()
        data = np.frombuffer(self.fbo.read(components=self.texture.components, dtype="f4"), dtype=np.float32)
        return data.reshape(height, width, -1)[::-1].copy()

    def release(self) -> None:
        """Free the GPU objects."""
        self.fbo.release()
        self.texture.release()


class LayerTarget:
    """Renders into 2D state textures and, beside them, into one layer of an array or 3D texture.

    moderngl cannot attach a layer; a framebuffer is made with a stand-in texture, which `use` replaces.
    """

    def __init__(self, device: Device, *states: Any) -> None:
        self.device = device
        self.states = states
        self._stand_in = device.ctx.texture(states[0].size, 1, dtype="f2")
        self.fbo = device.ctx.framebuffer([*states, self._stand_in])
        #: The states alone, for copies.
        self.plain = device.ctx.framebuffer(list(states))

    @property
    def state(self) -> Any:
        """The first state texture."""
        return self.states[0]

    def use(self, texture: Any, layer: int) -> None:
        """Bind, with a layer of an array or 3D texture as the last attachment."""
        self.fbo.use()
        self.device.attach_layer(len(self.states), texture, layer)

    def clear_layer(self, value: float) -> None:
        """Fill the layer that `use` attached."""
        self.device.clear_attachment(len(self.states), value)

    def release(self) -> None:
        """Free the GPU objects, but not the state textures."""
        self.fbo.release()
        self.plain.release()
        self._stand_in.release()
