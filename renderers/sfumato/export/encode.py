"""From linear light to the numbers of a print: exposure, clip, sRGB, straight alpha, 16 bits."""

from __future__ import annotations

import numpy as np

from ..errors import SceneError
from ..scene.white import WHITE, balance_matrix

#: Rows that are computed at a time, so that memory stays bounded.
_ROWS = 256
#: Brightness from which on the soft tone curve bends.
KNEE = 0.6


def srgb(linear: np.ndarray) -> np.ndarray:
    """Return linear light in [0, 1] as sRGB (IEC 61966-2-1), in [0, 1]."""
    return np.where(
        linear > 0.0031308, 1.055 * np.power(np.maximum(linear, 0), 1 / 2.4) - 0.055, 12.92 * linear
    )


def bent(light: np.ndarray) -> np.ndarray:
    """Return linear light whose bright part is bent below 1, as `resolve.frag.glsl` does it."""
    return np.where(
        light > KNEE, 1 - (1 - KNEE) * np.exp(-(np.maximum(light, KNEE) - KNEE) / (1 - KNEE)), light
    )


def encode16(
    linear: np.ndarray, exposure: float = 0.0, white_balance: float = WHITE, tone_curve: str = "clip"
) -> np.ndarray:
    """Return a linear picture as 16-bit sRGB with straight alpha, as `resolve.frag.glsl` does it for 8 bits.

    Parameters
    ----------
    linear : ndarray, shape (height, width, 4), float32
        Premultiplied, before exposure, as from `sfumato.render(linear=True)`.
    exposure, white_balance, tone_curve
        As in `Scene`.

    Returns
    -------
    ndarray, shape (height, width, 4), uint16
    """
    if linear.ndim != 3 or linear.shape[2] != 4:
        raise SceneError("picture", f"array of shape {linear.shape}", "shape (height, width, 4)")
    coded = np.empty(linear.shape, dtype=np.uint16)
    to_white = (2.0**exposure * balance_matrix(white_balance)).T.astype(np.float32)
    for y in range(0, len(linear), _ROWS):
        part = linear[y : y + _ROWS]
        alpha = part[..., 3:]
        straight = part[..., :3] / np.where(alpha > 0, alpha, 1)
        straight = straight @ to_white
        straight = bent(straight) if tone_curve == "soft" else straight
        straight[np.broadcast_to(alpha <= 0, straight.shape)] = 0
        coded[y : y + _ROWS, :, :3] = np.rint(srgb(np.clip(straight, 0, 1)) * 65535)
        coded[y : y + _ROWS, :, 3:] = np.rint(np.clip(alpha, 0, 1) * 65535)
    return coded
