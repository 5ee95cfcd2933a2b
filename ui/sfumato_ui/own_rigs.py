"""Rigs that the user keeps: one file each (`sfumato.scene.rig_files`), which can be shared, and `--rig-file` takes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from sfumato.scene.rig_files import load_rig, write_rig
from sfumato.scene.rigs import Rig

from .own_files import OwnFiles


class OwnRigs(OwnFiles[Rig]):
    """The rigs in a folder, as they are kept: of the size of no volume."""

    folder, noun = "rigs", "rig"

    def read(self, path: Path) -> tuple[str, Rig]:
        """Return the name in a file and its rig."""
        rig = load_rig(path)
        return rig.title, rig

    def write(self, path: Path, name: str, thing: Rig) -> None:
        """Write one under a name."""
        write_rig(path, replace(thing, id=name, title=name))


__all__ = ["OwnRigs"]
