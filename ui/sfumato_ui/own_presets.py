"""Transfer functions that the user keeps: one JSON file each, in the folder of what the user makes.

The file is the transfer function's own JSON, so that ``sfumato render --transfer FILE`` takes it too. Values
are the volume's own, as everywhere.
"""

from __future__ import annotations

import json
import re
import unicodedata
from dataclasses import replace
from pathlib import Path

from sfumato import SceneError, SfumatoError, TransferFunction
from sfumato.export.atomic import replacing
from sfumato.scene.params import from_json, to_json
from sfumato.scene.presets import Preset

from .settings import data_dir

MAX_NAME = 40
#: A transfer function has a few hundred bytes; what is larger than this is something else.
_MAX_BYTES = 4 << 20


class OwnPresets:
    """The presets in a folder; reading never fails as a whole.

    Attributes
    ----------
    presets : tuple of Preset
        In the order of their names.
    problems : tuple of str
        One line for each file that could not be read.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self._folder = folder
        self._paths: dict[str, Path] = {}
        self.presets: tuple[Preset, ...] = ()
        self.problems: tuple[str, ...] = ()
        self.load()

    def load(self) -> None:
        """Read the folder anew."""
        found: list[Preset] = []
        problems: list[str] = []
        self._paths = {}
        try:
            files = sorted(self._home().glob("*.json"))
        except OSError as error:
            files, problems = [], [f"Own presets cannot be read: {error.strerror or error}"]
        for path in files:
            if path.name.startswith("."):
                continue
            try:
                transfer = _read(path)
            except (OSError, ValueError, RecursionError, SfumatoError) as error:
                problems.append(f"The preset {path.name} cannot be read: {str(error).splitlines()[0]}")
                continue
            name = transfer.name if transfer.name and transfer.name not in self._paths else path.stem
            self._paths[name] = path
            found.append(Preset(name, replace(transfer, name=name), f"Own preset {name}", ""))
        self.presets = tuple(sorted(found, key=lambda p: p.name.lower()))
        self.problems = tuple(problems)

    def complaint(self, name: str) -> str:
        """Return what is wrong with a new name, or nothing."""
        name = name.strip()
        if not name:
            return "A name is needed"
        if len(name) > MAX_NAME:
            return f"At most {MAX_NAME} letters"
        if name.lower() in (n.lower() for n in self._paths):
            return "An own preset has this name"
        return ""

    def save(self, name: str, transfer: TransferFunction) -> None:
        """Keep a transfer function under a new name.

        Raises
        ------
        SfumatoError
            If the name cannot be taken or the file cannot be written.
        """
        name = name.strip()
        if self.complaint(name):
            raise SfumatoError(f"{name}: {self.complaint(name)}")
        self._write(self._free_path(name), replace(transfer, name=name))
        self.load()

    def rename(self, old: str, new: str) -> None:
        """Give a preset another name; its file's name follows.

        Raises
        ------
        SfumatoError
            If there is no such preset, the name cannot be taken or the file cannot be written.
        """
        new, path = new.strip(), self._path(old)
        if new == old:
            return
        if new.lower() != old.lower() and self.complaint(new):
            raise SfumatoError(f"{new}: {self.complaint(new)}")
        transfer = next(p.transfer for p in self.presets if p.name == old)
        self._write(self._free_path(new), replace(transfer, name=new))
        self._unlink(path)
        self.load()

    def delete(self, name: str) -> None:
        """Remove a preset.

        Raises
        ------
        SfumatoError
            If there is no such preset or its file cannot be removed.
        """
        self._unlink(self._path(name))
        self.load()

    # -- files ------------------------------------------------------------------------------------
    def _home(self) -> Path:
        home = self._folder or data_dir() / "presets"
        home.mkdir(parents=True, exist_ok=True)
        return home

    def _path(self, name: str) -> Path:
        if name not in self._paths:
            raise SfumatoError(f"There is no own preset {name}")
        return self._paths[name]

    def _free_path(self, name: str) -> Path:
        """Return a path for a name that no file has yet."""
        plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode().lower()
        stem = re.sub(r"[^a-z0-9]+", "-", plain).strip("-") or "preset"
        try:
            home = self._home()
        except OSError as error:
            raise SfumatoError(f"The preset cannot be written: {error.strerror or error}") from None
        candidates = [stem, *(f"{stem}-{i}" for i in range(2, len(self._paths) + 1000))]
        return next(p for p in (home / f"{c}.json" for c in candidates) if not p.exists())

    def _write(self, path: Path, transfer: TransferFunction) -> None:
        with replacing(path) as part:
            part.write_text(json.dumps(to_json(transfer), indent=1) + "\n", encoding="utf-8")

    def _unlink(self, path: Path) -> None:
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise SfumatoError(f"{path}: cannot be removed: {error.strerror or error}") from None


def _read(path: Path) -> TransferFunction:
    if path.stat().st_size > _MAX_BYTES:
        raise SceneError("transfer", path.name, "a file of a transfer function is smaller")
    return from_json(TransferFunction, json.loads(path.read_text(encoding="utf-8")), "transfer")
