"""The samples made by code: the same every time, quick, and what they say they are."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import sfumato
import sfumato_samples
from sfumato_samples import cache, hand
from sfumato_samples.catalogue import CHECKSUMS, ENTRIES
from sfumato_samples.hand.bones import parts
from sfumato_samples.hand.pose import long_bones

NAMES = sfumato_samples.names()


@pytest.fixture(scope="module", autouse=True)
def _own_cache(tmp_path_factory: pytest.TempPathFactory) -> object:
    patch = pytest.MonkeyPatch()
    place = tmp_path_factory.mktemp("samples")
    patch.setattr(cache, "folder", lambda: place)
    yield place
    patch.undo()


@pytest.mark.parametrize("name", NAMES)
def test_loads_as_the_catalogue_says(name: str) -> None:
    entry = ENTRIES[name]
    volume = sfumato_samples.load(name)
    assert volume.dims == entry.dims
    assert volume.spacing == entry.spacing
    assert volume.data.dtype == entry.dtype
    assert volume.info.path == f"sample:{name}"
    assert volume.info.modality == entry.modality
    assert volume.info.orientation_known == entry.orientation_known
    assert volume.info.name == entry.title
    assert entry.licence
    assert "\n" not in entry.description
    # Written into the cache by this very process, read back the same.
    assert sfumato_samples.load(name) == volume


@pytest.mark.parametrize("name", NAMES)
def test_same_values_on_every_run(name: str) -> None:
    assert cache.checksum(sfumato_samples.load(name).data) == ENTRIES[name].checksum


@pytest.mark.parametrize("name", NAMES)
def test_scene_shows_something(name: str) -> None:
    scene = sfumato_samples.scene(name)
    assert scene.transfer is not None
    shown = scene.transfer.evaluate(np.asarray(scene.volume.data[::4, ::4, ::4], dtype=float))[..., 3]
    # Air is clear, the subject is not.
    assert 0.001 < (shown > 0.3).mean() < 0.6
    assert (shown < 0.01).mean() > 0.25


def test_catalogue_lists_the_checksums_of_all_and_only_its_samples() -> None:
    assert tuple(json.loads(CHECKSUMS.read_text(encoding="utf-8"))) == NAMES
    assert [entry.name for entry in sfumato_samples.catalogue()] == list(NAMES)
    assert NAMES[0] == sfumato_samples.DEFAULT == "hand"


def test_default_is_quick() -> None:
    start = time.process_time()
    hand.generate()
    # Alone on a core it takes 1.1 s; the margin is for neighbours that eat the memory's bandwidth.
    assert time.process_time() - start < 4


def test_unknown_name_is_one_line() -> None:
    with pytest.raises(sfumato.LoadError, match="hand, hand-splinter") as caught:
        sfumato_samples.load("foot-of-yeti")
    assert "\n" not in str(caught.value)
    with pytest.raises(sfumato.LoadError, match="pipe"):
        sfumato_samples.load_vectors("hand")


# -- the cache -------------------------------------------------------------------------------------
def _file(folder: Path, name: str) -> Path:
    return next(folder.glob(f"{name}-{ENTRIES[name].checksum[:12]}.npy"))


def test_damaged_file_is_made_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache, "folder", lambda: tmp_path)
    whole = sfumato_samples.load("room")
    path = _file(tmp_path, "room")
    for damage in (b"not an array", path.read_bytes()[:-1], path.read_bytes()[:-1] + b"\x07"):
        path.write_bytes(damage)
        assert sfumato_samples.load("room") == whole
        assert cache.checksum(np.load(path)) == ENTRIES["room"].checksum


def test_folder_that_cannot_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocked = tmp_path / "a file where the folder would be"
    blocked.write_text("")
    monkeypatch.setattr(cache, "folder", lambda: blocked)
    assert sfumato_samples.load("room").dims == ENTRIES["room"].dims


def test_cache_lies_in_the_users_cache_folder(tmp_path: Path) -> None:
    code = "from sfumato_samples import cache; print(cache.folder())"
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={"XDG_CACHE_HOME": str(tmp_path), "HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    assert Path(done.stdout.strip()).is_relative_to(tmp_path)


# -- the hand --------------------------------------------------------------------------------------
def _at(volume: sfumato.Volume, point: np.ndarray) -> float:
    """Mean of the 3 x 3 x 3 voxels around a point of the hand's own space."""
    x, y, z = (round((point[i] - hand.GRID.low[i]) / hand.GRID.spacing - 0.5) for i in range(3))
    return float(volume.data[z - 1 : z + 2, y - 1 : y + 2, x - 1 : x + 2].mean())


def test_hand_has_every_bone() -> None:
    assert len(parts()) == 19 + 8 + 2
    kinds = [bone.kind for bone in long_bones()]
    assert {kind: kinds.count(kind) for kind in kinds} == {
        "metacarpal": 5,
        "proximal": 5,
        "middle": 4,
        "distal": 5,
    }


def test_hand_is_in_hounsfield_units() -> None:
    volume = sfumato_samples.load("hand")
    data = volume.data
    assert data.dtype == np.int16
    assert abs(float(np.median(data)) + 1000) < 5  # most of it is air
    assert abs(float(data[:, :4].std()) - 8) < 1  # with a scanner's noise
    assert 1200 < data.max() < 2000
    for low, high in ((-110, -60), (30, 90), (200, 400), (700, 1500)):  # fat, muscle, spongy bone, cortex
        assert ((data > low) & (data < high)).mean() > 0.001


def test_shafts_hold_marrow_under_cortex() -> None:
    volume = sfumato_samples.load("hand")
    for bone in long_bones():
        if bone.kind == "metacarpal":
            middle = bone.frame.world(0, 1.4, 0.5 * bone.length)  # the shaft bows towards the back
            assert _at(volume, middle) < 600  # the scanner's blur lifts the narrowest cavity to 547
        near_base = bone.frame.world(0, 0, 0.12 * bone.length)
        assert 200 < _at(volume, near_base) < 1100


def test_joints_are_parted() -> None:
    volume = sfumato_samples.load("hand")
    for bone in long_bones():
        if bone.kind == "metacarpal":
            continue
        inside = [_at(volume, bone.frame.world(0, 0, t)) for t in np.arange(-3.5, 3.6, 0.5)]
        assert min(inside) < 0.75 * max(inside)


def test_hand_does_not_touch_the_volumes_edge_but_at_the_forearm() -> None:
    body = sfumato_samples.load("hand").data > -500
    assert body[0].any()
    for face in (body[-3:], body[:, :3], body[:, -3:], body[:, :, :3], body[:, :, -3:]):
        assert not face.any()


def test_thumb_stands_before_the_palm() -> None:
    tip = next(b for b in long_bones() if b.finger == 0 and b.kind == "distal").end
    head = next(b for b in long_bones() if b.finger == 1 and b.kind == "metacarpal").end
    assert tip[1] < head[1] - 30


# -- others ----------------------------------------------------------------------------------------
def test_splinter_is_metal() -> None:
    with_it, without = sfumato_samples.load("hand-splinter").data, sfumato_samples.load("hand").data
    assert with_it.max() > 2500
    assert 20 < (with_it != without).sum() < 20000


def test_pipes_flow_has_no_sources_and_follows_the_pipe() -> None:
    volume, flow = sfumato_samples.load("pipe"), sfumato_samples.load_vectors("pipe")
    assert flow.shape == (*volume.data.shape, 3)
    assert flow.dtype == np.float32
    # A wall cuts off what little is left of the flow there.
    divergence = sum(np.gradient(flow[..., i], axis=2 - i) for i in range(3))
    inner = (slice(3, -3),) * 3
    speed = np.sqrt((flow**2).sum(axis=-1))
    assert np.abs(divergence[inner]).max() < 0.01 * speed.max()
    middle = flow[20:36, 20:36, 10:-10, 0]
    assert middle.mean() > 0.25 * speed.max()


@pytest.mark.parametrize("name", ["shapes", "buckyball", "room"])
def test_values_of_the_labelled_samples_stay_apart(name: str) -> None:
    counts = np.bincount(sfumato_samples.load(name).data.ravel(), minlength=256)
    assert counts.max() / counts.sum() > 0.15  # air
    assert (counts > 0.004 * counts.sum()).sum() >= 3
