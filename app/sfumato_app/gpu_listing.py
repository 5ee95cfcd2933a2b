"""What `info --gpu` prints: the bytes of everything that drawing a scene leaves on the GPU."""

from __future__ import annotations

from rich.console import Console
from rich.table import Table

from sfumato import Renderer, Scene
from sfumato.gpu import GpuObject
from sfumato.techniques import technique_for

MIB = 2**20


def gpu_objects_of(scene: Scene, size: tuple[int, int]) -> tuple[list[GpuObject], int, int, str]:
    """Draw a frame of a scene and return what is on the GPU then.

    Returns
    -------
    objects : list of GpuObject
        The largest first.
    kept : int
        Bytes of what is kept for frames to come.
    budget : int
        Bytes that it may take.
    device : str
        Name of the device.

    Raises
    ------
    SfumatoError
        If the scene cannot be drawn.
    """
    renderer = Renderer()
    try:
        picture = renderer.begin(scene, size)
        for _ in picture.add_frame():
            pass
        store = renderer.device.store
        listed = renderer.gpu_objects(picture)
        kept = store.bytes_in_use + store.bytes_of_guests
        picture.release()
        return listed, kept, store.budget, renderer.name
    finally:
        renderer.close()


def print_gpu(scene: Scene, size: tuple[int, int]) -> None:
    """Print the table."""
    objects, kept, budget, device = gpu_objects_of(scene, size)
    title = f"{technique_for(scene.technique).id}, {size[0]} x {size[1]} pixels, on {device}"
    table = Table(box=None, pad_edge=False, title=title, title_justify="left")
    table.add_column("what")
    table.add_column("texels")
    table.add_column("MiB", justify="right")
    for item in objects:
        table.add_row(item.name, item.shape, f"{item.size / MIB:.3f}")
    total = sum(item.size for item in objects)
    for name, value in (
        ("total", total),
        ("kept for later frames", kept),
        ("budget of what is kept", budget),
    ):
        table.add_row(name, "", f"{value / MIB:.3f}")
    console = Console(highlight=False)
    (console if console.is_terminal else Console(highlight=False, width=160)).print(table)
