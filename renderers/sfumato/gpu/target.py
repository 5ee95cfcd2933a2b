"""Pictures on the GPU: floating-point render targets, and layers of an array to render into."""

from __future__ import annotations

from collections.abc import Sequence
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
        self.device.clear(self.fbo, red, green, blue, alpha)

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
    """Renders into 2D state textures and, beside them, into layers of array or 3D textures.

    moderngl cannot attach a layer; a framebuffer is made with stand-in textures, which `use` replaces.

    Parameters
    ----------
    states : texture
        The 2D textures, if there are any.
    layers : int
        How many layers.
    size : (int, int), optional
        Their size, where there is no state to tell it.
    """

    def __init__(
        self, device: Device, *states: Any, layers: int = 1, size: tuple[int, int] | None = None
    ) -> None:
        self.device = device
        self.states = states
        self.layers = layers
        self.size = size or states[0].size
        self._stand_ins = [device.ctx.texture(self.size, 1, dtype="f2") for _ in range(layers)]
        self.fbo = device.ctx.framebuffer([*states, *self._stand_ins])
        #: The states alone, for copies; where there are none, the stand-ins.
        self.plain = device.ctx.framebuffer(list(states)) if states else self.fbo

    @property
    def state(self) -> Any:
        """The first state texture."""
        return self.states[0]

    def use(self, texture: Any, layer: int) -> None:
        """Bind, with consecutive layers of an array or 3D texture as the last attachments."""
        self.fbo.use()
        for k in range(self.layers):
            self.device.attach_layer(len(self.states) + k, texture, layer + k)

    def use_all(self, textures: Sequence[Any]) -> None:
        """Bind, with all layers of several textures of one size in place of the stand-ins."""
        self.fbo.use()
        for k, texture in enumerate(textures):
            self.device.attach_layers(len(self.states) + k, texture)

    def clear_layer(self, value: float) -> None:
        """Fill the first layer that `use` attached."""
        self.device.clear_attachment(len(self.states), value)

    def release(self) -> None:
        """Free the GPU objects, but not the state textures."""
        if self.plain is not self.fbo:
            self.plain.release()
        self.fbo.release()
        for stand_in in self._stand_ins:
            stand_in.release()
