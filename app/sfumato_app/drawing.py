"""A scene to a picture file."""

from __future__ import annotations

import time
from collections import deque
from contextlib import closing
from pathlib import Path

import sfumato
from sfumato import Scene, SceneError
from sfumato.export.linear import LINEAR_SUFFIXES, write_linear
from sfumato.export.picture import STREAMS, PictureSpec, write_picture
from sfumato.techniques import technique_for

from .errors import UsageError
from .opening import SAMPLE


def target_of(path: str, output: Path | None, linear: bool) -> tuple[Path, bool]:
    """Return the file to write, and whether its picture is linear, which its ending can tell too.

    Raises
    ------
    UsageError
        If the ending does not fit.
    """
    if output is None:
        output = _default_target(path, ".exr" if linear else ".png")
    suffix = output.suffix.lower()
    if linear and suffix not in LINEAR_SUFFIXES:
        raise UsageError(f"-o {output}: with --linear it must end in {' or '.join(LINEAR_SUFFIXES)}")
    if suffix not in (*STREAMS, *LINEAR_SUFFIXES):
        raise UsageError(f"-o {output}: it must end in {', '.join(STREAMS)}, {' or '.join(LINEAR_SUFFIXES)}")
    if _same(output, path):
        raise UsageError(f"-o {output}: this is the input; give another name")
    return output, suffix in LINEAR_SUFFIXES


def _default_target(path: str, suffix: str) -> Path:
    target = Path(stem_of(path) + suffix)
    return target.with_stem(target.stem + "-again") if _same(target, path) else target


def _same(target: Path, path: str) -> bool:
    return target.exists() and Path(path).exists() and target.samefile(path)


def stem_of(path: str) -> str:
    """Return the name of a file or folder without its ending(s), for a picture of it."""
    name = Path(path.removeprefix(SAMPLE)).resolve().name
    for ending in (".gz", ".nii", ".ome.zarr"):
        name = name.removesuffix(ending)
    return name.rsplit(".", 1)[0] if "." in name.lstrip(".") else name


def draw(scene: Scene, spec: PictureSpec, target: Path, linear: bool = False) -> str:
    """Draw a scene, write it, and return a line that says so.

    Raises
    ------
    SfumatoError
        If it cannot be drawn or written.
    """
    if scene.volume is None and not scene.geometry:
        raise SceneError("volume", None, "the scene shows nothing; name a volume")
    if scene.volume is None and not technique_for(scene.technique).geometry:
        raise SceneError("technique", scene.technique_id, "without a volume, one that draws geometry")
    if not target.parent.is_dir():
        raise sfumato.SfumatoError(f"{target}: there is no folder {target.parent}")
    began = time.perf_counter()
    if linear:
        write_linear(target, sfumato.render(scene, size=spec.size, linear=True), scene)
    else:
        _write_with_progress(scene, spec, target)
    seconds = time.perf_counter() - began
    return f"{target}: {spec.size[0]} x {spec.size[1]}, {scene.technique_id}, {seconds:.1f} s"


def _write_with_progress(scene: Scene, spec: PictureSpec, target: Path) -> None:
    """Draw and write; on a terminal, with a bar that goes away when it is done."""
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True)
    with closing(write_picture(target, scene, spec)) as pieces:
        if not console.is_terminal:
            deque(pieces, maxlen=0)
            return
        with Progress(console=console, transient=True) as bar:
            task = bar.add_task(target.name, total=1.0)
            for done in pieces:
                bar.update(task, completed=done)
