"""What the user keeps: one JSON file each, in a folder; names are unique, and reading never fails as a whole."""

from __future__ import annotations

import re
import unicodedata
from pathlib import Path
from typing import Generic, TypeVar

from sfumato import SfumatoError

from .settings import data_dir

MAX_NAME = 40
T = TypeVar("T")


class OwnFiles(Generic[T]):
    """The files of one kind in a folder.

    Subclasses say how one is read, written and named.

    Attributes
    ----------
    kept : dict
        What is there, by name, in the order of the names.
    problems : tuple of str
        One line for each file that could not be read.
    """

    #: Folder in the settings, and what one is called.
    folder, noun = "", ""

    def __init__(self, home: Path | None = None) -> None:
        self._folder = home
        self._paths: dict[str, Path] = {}
        self.kept: dict[str, T] = {}
        self.problems: tuple[str, ...] = ()
        self.load()

    # -- of each kind -----------------------------------------------------------------------------
    def read(self, path: Path) -> tuple[str, T]:
        """Return the name in a file and what it holds."""
        raise NotImplementedError

    def write(self, path: Path, name: str, thing: T) -> None:
        """Write one under a name."""
        raise NotImplementedError

    # -- all of them ------------------------------------------------------------------------------
    def load(self) -> None:
        """Read the folder anew."""
        found: dict[str, T] = {}
        problems: list[str] = []
        self._paths = {}
        try:
            files = sorted(self._home().glob("*.json"))
        except OSError as error:
            files, problems = [], [f"Own {self.noun}s cannot be read: {error.strerror or error}"]
        for path in files:
            if path.name.startswith("."):
                continue
            try:
                told, thing = self.read(path)
            except (OSError, ValueError, RecursionError, SfumatoError) as error:
                problems.append(f"The {self.noun} {path.name} cannot be read: {str(error).splitlines()[0]}")
                continue
            name = told if told and told not in self._paths else path.stem
            self._paths[name], found[name] = path, thing
        self.kept = dict(sorted(found.items(), key=lambda item: item[0].lower()))
        self.problems = tuple(problems)

    def complaint(self, name: str) -> str:
        """Return what is wrong with a new name, or nothing."""
        name = name.strip()
        if not name:
            return "A name is needed"
        if len(name) > MAX_NAME:
            return f"At most {MAX_NAME} letters"
        if name.lower() in (n.lower() for n in self._paths):
            return f"An own {self.noun} has this name"
        return ""

    def free_name(self, name: str) -> str:
        """Return a name that can be taken, like this one."""
        stem = name.strip()[: MAX_NAME - 4] or self.noun.capitalize()
        return next(n for n in (stem, *(f"{stem} {i}" for i in range(2, 1000))) if not self.complaint(n))

    def save(self, name: str, thing: T) -> None:
        """Keep something under a new name.

        Raises
        ------
        SfumatoError
            If the name cannot be taken or the file cannot be written.
        """
        name = name.strip()
        if self.complaint(name):
            raise SfumatoError(f"{name}: {self.complaint(name)}")
        self.write(self._free_path(name), name, thing)
        self.load()

    def rename(self, old: str, new: str) -> None:
        """Give one another name; its file's name follows.

        Raises
        ------
        SfumatoError
            If there is no such one, the name cannot be taken or the file cannot be written.
        """
        new, path = new.strip(), self._path(old)
        if new == old:
            return
        if new.lower() != old.lower() and self.complaint(new):
            raise SfumatoError(f"{new}: {self.complaint(new)}")
        self.write(self._free_path(new), new, self.kept[old])
        self._unlink(path)
        self.load()

    def delete(self, name: str) -> None:
        """Remove one.

        Raises
        ------
        SfumatoError
            If there is no such one or its file cannot be removed.
        """
        self._unlink(self._path(name))
        self.load()

    # -- files ------------------------------------------------------------------------------------
    def _home(self) -> Path:
        home = self._folder or data_dir() / self.folder
        home.mkdir(parents=True, exist_ok=True)
        return home

    def _path(self, name: str) -> Path:
        if name not in self._paths:
            raise SfumatoError(f"There is no own {self.noun} {name}")
        return self._paths[name]

    def _free_path(self, name: str) -> Path:
        """Return a path for a name that no file has yet."""
        plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode().lower()
        stem = re.sub(r"[^a-z0-9]+", "-", plain).strip("-") or self.noun
        try:
            home = self._home()
        except OSError as error:
            raise SfumatoError(f"The {self.noun} cannot be written: {error.strerror or error}") from None
        candidates = [stem, *(f"{stem}-{i}" for i in range(2, len(self._paths) + 1000))]
        return next(p for p in (home / f"{c}.json" for c in candidates) if not p.exists())

    @staticmethod
    def _unlink(path: Path) -> None:
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise SfumatoError(f"{path}: cannot be removed: {error.strerror or error}") from None
