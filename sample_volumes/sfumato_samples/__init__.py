"""Sample volumes made by code: nothing to download, nothing to license, the same on every machine.

One module a sample (``hand``, ``shapes``, ...), each with ``generate() -> ndarray``; `catalogue` says what
there is; `cache` keeps what was made. The bodies are signed distances (`sdf`) on a `grid`, turned into values
with edges as soft as a scanner's.

>>> import sfumato_samples
>>> volume = sfumato_samples.load("hand")  # doctest: +SKIP
"""

from __future__ import annotations

import numpy as np

import sfumato

from .cache import cached
from .catalogue import DEFAULT, ENTRIES, Entry, entry

__all__ = ["DEFAULT", "Entry", "catalogue", "load", "load_vectors", "names", "scene"]


def names() -> tuple[str, ...]:
    """Return the names of all samples, the default first."""
    return tuple(ENTRIES)


def catalogue() -> tuple[Entry, ...]:
    """Return what is known of all samples, in the order of `names`."""
    return tuple(ENTRIES.values())


def load(name: str = DEFAULT) -> sfumato.Volume:
    """Return a sample, from the cache or made anew.

    Parameters
    ----------
    name : str
        One of `names`.

    Raises
    ------
    LoadError
        If there is no such sample.
    """
    item = entry(name)
    info = sfumato.VolumeInfo(
        path=f"sample:{name}",
        modality=item.modality,
        orientation_known=item.orientation_known,
        name=item.title,
        transfer=sfumato.TransferFunction.from_points(item.transfer, name=item.look)
        if item.transfer
        else None,
    )
    return sfumato.Volume(cached(item), spacing=item.spacing, info=info)


def load_vectors(name: str) -> np.ndarray:
    """Return the velocities that belong to a sample.

    Returns
    -------
    ndarray, shape (z, y, x, 3), float32
        x, y and z components in mm/s on the sample's voxels.

    Raises
    ------
    LoadError
        If there is no such sample or it has no vectors.
    """
    item = entry(name)
    if not item.vectors:
        having = ", ".join(e.name for e in ENTRIES.values() if e.vectors)
        raise sfumato.LoadError(f"sample:{name}", "this sample has no vectors", f"one of {having} has")
    return np.asarray(item.module().vectors())


def scene(name: str = DEFAULT) -> sfumato.Scene:
    """Return a sample with the transfer function, view and lights that suit it.

    Raises
    ------
    LoadError
        If there is no such sample.
    """
    item, volume = entry(name), load(name)
    camera = sfumato.Camera.standard(volume, item.view) if item.view else None
    if not item.lights:
        return sfumato.Scene(volume=volume, camera=camera)
    return sfumato.Scene(volume=volume, camera=camera, lights=item.lights)
