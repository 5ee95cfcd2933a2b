"""What samples there are, and what is known of each without making it."""

from __future__ import annotations

import importlib
import json
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from sfumato import Light, LoadError

Points = tuple[tuple[Any, ...], ...]
DEFAULT = "hand"
LICENCE = "MIT (made by this program)"


@dataclass(frozen=True)
class Entry:
    """A sample of the catalogue.

    Parameters
    ----------
    name : str
        What `load` takes; also the module's name, with ``_`` for ``-``.
    title : str
        For people.
    description : str
        One line.
    dims : (nx, ny, nz)
        Voxels along x, y and z.
    spacing : (x, y, z)
        Distance between voxels in mm.
    unit : str
        Unit of the values.
    modality : str
        As in `sfumato.VolumeInfo`.
    orientation_known : bool
        Whether the axes are those of a patient.
    dtype : str
        Type of the values.
    transfer : tuple
        Points of a suggested transfer function (value, linear rgb, opacity[, emission]); empty: the automatic choice.
    view : str
        A standard view; empty: the automatic choice.
    lights : tuple of Light
        Suggested lights; empty: the default lamp.
    vectors : bool
        Whether `load_vectors` has a field for it.
    licence : str
        Licence of the data.
    """

    name: str
    title: str
    description: str
    dims: tuple[int, int, int]
    spacing: tuple[float, float, float]
    unit: str = ""
    modality: str = ""
    orientation_known: bool = False
    dtype: str = "int16"
    transfer: Points = field(default=(), repr=False)
    view: str = ""
    lights: tuple[Light, ...] = field(default=(), repr=False)
    vectors: bool = False
    licence: str = LICENCE

    @property
    def shape(self) -> tuple[int, int, int]:
        """Shape of the array, (z, y, x)."""
        return self.dims[2], self.dims[1], self.dims[0]

    @property
    def checksum(self) -> str:
        """Hash of the values as made on x86-64 (see `cache.checksum`)."""
        return _checksums()[self.name]

    def module(self) -> Any:
        """Return the module that makes the sample."""
        return importlib.import_module(f"{__package__}.{self.name.replace('-', '_')}")

    def generate(self) -> np.ndarray:
        """Make the sample, past the cache."""
        return np.asarray(self.module().generate())


CHECKSUMS = Path(__file__).with_name("checksums.json")


@cache
def _checksums() -> dict[str, str]:
    return dict(json.loads(CHECKSUMS.read_text(encoding="utf-8")))


def entry(name: str) -> Entry:
    """Return the catalogue's entry of a sample, or raise a LoadError that lists all names."""
    if name not in ENTRIES:
        raise LoadError(f"sample:{name}", "there is no such sample", "choose one of " + ", ".join(ENTRIES))
    return ENTRIES[name]


_HU = {"unit": "HU", "modality": "CT", "orientation_known": True}

ENTRIES: dict[str, Entry] = {
    item.name: item
    for item in (
        Entry(
            "hand", "Hand", "CT of a raised left hand: skin, fat, muscle, tendons, 29 bones with marrow and joints",
            (184, 136, 288), (0.8, 0.8, 0.8), **_HU,
        ),
    )
}
