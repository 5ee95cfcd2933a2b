"""OpenGL 3.3 is enough: all techniques draw the same on it, in a process where Mesa offers nothing else."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import sfumato
from sfumato import Scene, Volume
from sfumato.techniques import techniques

pytestmark = pytest.mark.gpu

SIDE = 40
#: The version alone still leaves the extensions (``renderer.md``).
PORTABLE = {
    "MESA_GL_VERSION_OVERRIDE": "3.3",
    "MESA_GLSL_VERSION_OVERRIDE": "330",
    "MESA_EXTENSION_OVERRIDE": "-GL_ARB_compute_shader -GL_ARB_shader_image_load_store "
    "-GL_ARB_texture_barrier -GL_ARB_shading_language_420pack "
    "-GL_ARB_buffer_storage -GL_ARB_clear_texture -GL_ARB_copy_image",
}
DRAW_ALL = """
import json, sys
import numpy as np, sfumato
folder = sys.argv[1]
volume = sfumato.Volume(np.load(folder + "/volume.npy"))
pictures = {}
for name, (data, side) in json.load(open(folder + "/scenes.json")).items():
    pictures[name] = sfumato.render(sfumato.Scene.from_json(data, volume), (side, side))
renderer = sfumato.Renderer()
print(renderer.version)
np.savez(folder + "/pictures.npz", **pictures)
"""


def drawn_in_another_process(
    folder: Path, volume: Volume, scenes: dict[str, tuple[Scene, int]]
) -> tuple[str, dict[str, np.ndarray]]:
    """Return the version of OpenGL, and the pictures, of a process that has no more than 3.3."""
    np.save(folder / "volume.npy", volume.data)
    data = {name: (scene.to_json(), side) for name, (scene, side) in scenes.items()}
    (folder / "scenes.json").write_text(json.dumps(data))
    command = [sys.executable, "-c", DRAW_ALL, str(folder)]
    env = {**os.environ, **PORTABLE}
    done = subprocess.run(command, env=env, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 0, done.stderr
    with np.load(folder / "pictures.npz") as pictures:
        return done.stdout.strip(), dict(pictures)


def test_opengl_3_3_draws_the_same(
    tmp_path: Path, still: Callable[..., Scene], still_life: Volume, software_renderer: bool
) -> None:
    if not software_renderer:
        pytest.skip("Mesa's overrides are for its software renderer")
    scenes = {}
    for name, technique in techniques().items():
        if name == "reference":  # drawn on the CPU
            continue
        scenes[name] = still(name), SIDE
        if technique.lit and name != "directional":
            scenes[f"{name} from behind"] = still(name, tilt=130), SIDE
    version, pictures = drawn_in_another_process(tmp_path, still_life, scenes)
    assert version.startswith("3.3")
    for name, (scene, side) in scenes.items():
        here = sfumato.render(scene, (side, side)).astype(int)
        assert here[..., :3].max() > 60, f"{name}: nothing to be seen"
        assert np.abs(here - pictures[name]).max() <= 1, name
