"""Transfer functions that the user keeps: one JSON file each, in the folder of what the user makes.

The file is the transfer function's own JSON, so that ``sfumato render --transfer FILE`` takes it too. Values
are the volume's own, as everywhere.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

from sfumato import SceneError, TransferFunction
from sfumato.export.atomic import replacing
from sfumato.scene.params import from_json, to_json
from sfumato.scene.presets import Preset

from .own_files import MAX_NAME, OwnFiles

#: A transfer function has a few hundred bytes; what is larger than this is something else.
_MAX_BYTES = 4 << 20
#: Ending of the files.
SUFFIX = ".json"


class OwnPresets(OwnFiles[TransferFunction]):
    """The presets in a folder."""

    folder, noun = "presets", "preset"

    @property
    def presets(self) -> tuple[Preset, ...]:
        """All of them in the order of their names."""
        return tuple(
            Preset(name, replace(transfer, name=name), f"Own preset {name}", "")
            for name, transfer in self.kept.items()
        )

    def read(self, path: Path) -> tuple[str, TransferFunction]:
        """Return the name in a file and its function."""
        if path.stat().st_size > _MAX_BYTES:
            raise SceneError("transfer", path.name, "a file of a transfer function is smaller")
        transfer = from_json(TransferFunction, json.loads(path.read_text(encoding="utf-8")), "transfer")
        return transfer.name, transfer

    def write(self, path: Path, name: str, thing: TransferFunction) -> None:
        """Write one under a name."""
        with replacing(path) as part:
            part.write_text(json.dumps(to_json(replace(thing, name=name)), indent=1) + "\n", encoding="utf-8")


__all__ = ["MAX_NAME", "SUFFIX", "OwnPresets"]
