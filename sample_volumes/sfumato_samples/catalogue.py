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
        Points of a suggested transfer function (value, linear rgb, opacity[, emission]); empty: the automatic
        choice.
    look : str
        Name of that transfer function.
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
    look: str = ""
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


_HU: dict[str, Any] = {"unit": "HU", "modality": "CT", "orientation_known": True}

#: Cut-away colours, linear RGB.
_IVORY, _SKIN, _MUSCLE = (0.558, 0.508, 0.409), (0.496, 0.31, 0.236), (0.384, 0.124, 0.093)
_PALM, _BONE = (0.52, 0.30, 0.20), (0.48, 0.415, 0.30)
_CLAY, _AMBER, _RED = (0.341, 0.322, 0.298), (0.589, 0.341, 0.112), (0.465, 0.074, 0.05)
_WHITE, _BLUE, _STEEL = (0.527, 0.527, 0.527), (0.074, 0.186, 0.465), (0.341, 0.403, 0.496)
_LEAF, _BARK = (0.099, 0.236, 0.062), (0.236, 0.136, 0.074)
#: For scenes inside a box: a steeper key, and a soft fill from the eye.
_INDOORS = (
    Light(tilt=28, aperture=24, intensity=0.8),
    Light(tilt=0, aperture=45, intensity=0.35, name="fill"),
)

ENTRIES: dict[str, Entry] = {
    item.name: item
    for item in (
        Entry(
            "hand",
            "Hand",
            "CT of a raised left hand: skin, fat, muscle, tendons, 29 bones with marrow and joints",
            (160, 120, 284),
            (0.8, 0.8, 0.8),
            **_HU,
            look="Skin",
            # The lit skin shows at first sight what the program is for: the thumb's shadow on the palm.
            transfer=(
                (-420, _PALM, 0.0),
                (-180, _PALM, 0.9),
                (150, _PALM, 0.95),
                (300, _BONE, 0.95),
                (1500, (0.54, 0.485, 0.38), 0.95),
            ),
        ),
        Entry(
            "hand-splinter",
            "Hand with a splinter",
            "The hand with a splinter of metal in the ball of the thumb",
            (160, 120, 284),
            (0.8, 0.8, 0.8),
            **_HU,
            transfer=(
                (-600, _SKIN, 0.0),
                (-350, _SKIN, 0.05),
                (-100, _MUSCLE, 0.02),
                (120, _MUSCLE, 0.03),
                (240, _IVORY, 0.05),
                (500, _IVORY, 0.7),
                (1500, _IVORY, 0.9),
                (1800, _STEEL, 1.0),
                (3000, _STEEL, 1.0),
            ),
        ),
        Entry(
            "shapes",
            "Shapes",
            "Ball, ring, box and cone with layers under their surface, before a wall",
            (128, 80, 128),
            (1.0, 1.0, 1.0),
            "label",
            dtype="uint8",
            view="front",
            transfer=(
                (15, _CLAY, 0.9),
                (40, _CLAY, 0.0),
                (65, _WHITE, 0.0),
                (85, _WHITE, 0.12),
                (115, _WHITE, 0.12),
                (140, _AMBER, 0.18),
                (175, _AMBER, 0.2),
                (195, _RED, 0.9),
                (255, _RED, 1.0),
            ),
        ),
        Entry(
            "buckyball",
            "Bucky ball",
            "Sixty balls and ninety rods in a box that is open to the front",
            (120, 120, 120),
            (1.0, 1.0, 1.0),
            "label",
            dtype="uint8",
            view="front",
            transfer=(
                (15, _CLAY, 0.9),
                (45, _CLAY, 0.0),
                (90, _AMBER, 0.0),
                (140, _AMBER, 0.95),
                (200, _AMBER, 1.0),
            ),
            lights=_INDOORS,
        ),
        Entry(
            "room",
            "Room",
            "White room with a red and a green wall and two blocks, open to the front",
            (112, 112, 112),
            (1.0, 1.0, 1.0),
            "label",
            dtype="uint8",
            view="front",
            transfer=(
                (60, (0.465, 0.031, 0.025), 0.9),
                (85, (0.465, 0.031, 0.025), 0.0),
                (128, _WHITE, 0.0),
                (134, _WHITE, 0.7),
                (136, _WHITE, 0.7),
                (142, _WHITE, 0.0),
                (170, (0.05, 0.341, 0.043), 0.0),
                (200, (0.05, 0.341, 0.043), 0.9),
            ),
            lights=_INDOORS,
        ),
        Entry(
            "heart",
            "Heart, ultrasound",
            "Left ventricle, valve and atrium in a noisy ultrasound sector",
            (120, 76, 112),
            (1.0, 1.0, 1.0),
            "echo",
            "US",
            dtype="uint8",
            view="front",
            transfer=(
                (70, (0.279, 0.099, 0.043), 0.0),
                (110, (0.434, 0.211, 0.112), 0.35),
                (170, (0.546, 0.384, 0.248), 0.7),
                (255, (0.62, 0.577, 0.496), 0.9),
            ),
        ),
        Entry(
            "pipe",
            "Mixing pipe",
            "Hot and cold streams that mix between baffles, with their velocities",
            (144, 56, 56),
            (1.0, 1.0, 1.0),
            "0.4 degC",
            dtype="uint8",
            view="front",
            vectors=True,
            transfer=(
                (12, _CLAY, 0.9),
                (30, _CLAY, 0.0),
                (55, _BLUE, 0.0),
                (85, _BLUE, 0.35),
                (115, _BLUE, 0.25),
                (165, (0.496, 0.465, 0.372), 0.05),
                (215, _AMBER, 0.3),
                (250, _RED, 0.6),
            ),
        ),
        Entry(
            "torso",
            "Torso",
            "CT of a chest: ribs, spine, shoulder blades, lungs with vessels, heart, aorta, liver",
            (168, 112, 176),
            (2.0, 2.0, 2.0),
            **_HU,
            transfer=(
                (150, _RED, 0.0),
                (190, _RED, 0.5),
                (230, _RED, 0.6),
                (300, _IVORY, 0.7),
                (600, _IVORY, 0.95),
                (1500, (0.62, 0.601, 0.558), 1.0),
            ),
        ),
        Entry(
            "skull",
            "Skull",
            "CT of a skull with eye sockets, nose, cheek bones, lower jaw and teeth",
            (116, 156, 144),
            (1.4, 1.4, 1.4),
            **_HU,
            transfer=((200, _IVORY, 0.0), (480, _IVORY, 0.95), (1500, (0.62, 0.601, 0.558), 1.0)),
        ),
        Entry(
            "bonsai",
            "Bonsai",
            "A small tree: roots, crooked trunk, branches with clumps of leaves, in a glazed pot",
            (136, 120, 136),
            (1.0, 1.0, 1.0),
            "label",
            dtype="uint8",
            view="front",
            transfer=(
                (30, (0.062, 0.136, 0.223), 1.0),
                (55, (0.062, 0.136, 0.223), 0.0),
                (94, _BARK, 0.0),
                (102, _BARK, 0.9),
                (108, _BARK, 0.9),
                (116, _BARK, 0.0),
                (120, _LEAF, 0.0),
                (160, _LEAF, 0.9),
                (255, _LEAF, 0.9),
            ),
        ),
        Entry(
            "fish",
            "Fish",
            "CT of a carp-like fish: skull, gill cover, spine with ribs and spines, fins of rays",
            (184, 56, 96),
            (1.5, 1.5, 1.5),
            "HU",
            "CT",
            view="front",
            transfer=(
                (-300, _SKIN, 0.0),
                (-100, _SKIN, 0.015),
                (120, _SKIN, 0.02),
                (250, _IVORY, 0.3),
                (500, _IVORY, 0.9),
                (1500, (0.62, 0.601, 0.558), 1.0),
            ),
        ),
    )
}
