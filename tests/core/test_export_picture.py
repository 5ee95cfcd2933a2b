"""Pictures for print: tiles without a seam, 16 bits, PNG and TIFF, resolution, cancel, failure."""

from __future__ import annotations

import json
import resource
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import sfumato
from sfumato import Camera, Geometry, Light, Lines, LoadError, Scene, SceneError, SfumatoError
from sfumato.export.color_bars import BarsInk
from sfumato.export.encode import encode16, srgb
from sfumato.export.picture import PictureSpec, framed, pixels_of, write_picture
from sfumato.export.png import carries_scene, open_png, read_scene_data, write_png
from sfumato.export.scale_bar import ScaleBar, round_length, words_for
from sfumato.export.tiles import bands_of
from sfumato.techniques import techniques

tifffile = pytest.importorskip("tifffile")
SimpleITK = pytest.importorskip("SimpleITK")


def finish(*arguments, **options):
    """Write a picture to its end; returns the progress that was told."""
    return list(write_picture(*arguments, **options))


def sixteen(path):
    """Return a 16-bit PNG as another program reads it."""
    return SimpleITK.GetArrayFromImage(SimpleITK.ReadImage(str(path)))


def pixels(path):
    with Image.open(path) as image:
        return np.asarray(image).astype(int)


@pytest.fixture
def scene(still_life, still_life_colors):
    return Scene(
        volume=still_life, transfer=still_life_colors, step=1.0, background=(0.1, 0.1, 0.1, 1.0),
        lights=(Light(), Light(tilt=130, rotation=10, aperture=12, intensity=0.7)),
    )  # fmt: skip


# -- tiles ------------------------------------------------------------------------------------------
@pytest.mark.parametrize("size", [(1, 1), (10_000, 7_000), (4097, 3), (640, 480), (32_768, 100)])
def test_tiles_cover_the_picture_once(size):
    bands = bands_of(size)
    assert sum(tile.width * tile.height for band in bands for tile in band) == size[0] * size[1]
    y = 0
    for band in bands:
        x = 0
        for tile in band:
            assert (tile.x, tile.y) == (x, y)
            assert max(tile.width, tile.height) <= 4096
            assert 0 < tile.width * tile.height <= 1 << 22
            x += tile.width
        assert x == size[0]
        y += band[0].height
    assert y == size[1]


@pytest.mark.gpu
@pytest.mark.parametrize("parallel", [True, False])
@pytest.mark.parametrize("technique", [i for i in techniques() if i != "reference"])
def test_no_seam(tmp_path, scene, technique, parallel):
    scene = scene.with_(technique=technique, **{"camera.parallel_projection": parallel})
    scene = scene.with_(**{"camera.window_center": (0.1, -0.2)})
    size = (96, 70)
    finish(tmp_path / "whole.png", scene, PictureSpec(size, frames=2))
    finish(tmp_path / "tiles.png", scene, PictureSpec(size, frames=2), tile_side=40)
    whole, tiles = pixels(tmp_path / "whole.png"), pixels(tmp_path / "tiles.png")
    assert np.ptp(whole[..., 0]) > 80
    assert np.abs(whole - tiles).max() == 0, "not even the last bit differs"


# -- files ------------------------------------------------------------------------------------------
@pytest.mark.gpu
def test_eight_bits_are_the_picture_that_render_returns(tmp_path, scene):
    progress = finish(tmp_path / "a.png", scene, PictureSpec((60, 40), dpi=300, frames=1))
    assert progress == sorted(progress)
    assert progress[-1] == 1
    picture = sfumato.render(scene, (60, 40))
    with Image.open(tmp_path / "a.png") as image:
        np.testing.assert_array_equal(np.asarray(image), picture)
        assert image.info["dpi"] == pytest.approx((300, 300), abs=0.02)
        assert "srgb" in image.info
    assert open_png(tmp_path / "a.png", scene.volume) == scene
    finish(tmp_path / "a.tif", scene, PictureSpec((60, 40), dpi=300))
    with tifffile.TiffFile(tmp_path / "a.tif") as file:
        np.testing.assert_array_equal(file.asarray(), picture)


@pytest.mark.gpu
@pytest.mark.parametrize("ending", ["png", "tiff"])
def test_sixteen_bits_are_sixteen(tmp_path, scene, ending):
    scene = scene.with_(exposure=0.5, background=(0.0, 0.0, 0.0, 0.0))
    path = tmp_path / f"a.{ending}"
    finish(path, scene, PictureSpec((150, 90), bits=16, dpi=600))
    got = sixteen(path) if ending == "png" else tifffile.imread(path)
    assert got.dtype == np.uint16
    assert got.shape == (90, 150, 4)
    np.testing.assert_array_equal(got, encode16(sfumato.render(scene, (150, 90), linear=True), 0.5))
    eight = sfumato.render(scene, (150, 90)).astype(int)
    assert np.abs(got / 257 - eight).max() <= 0.51
    assert len(np.unique(got[..., 0])) > 256, "more steps than eight bits have"


@pytest.mark.gpu
def test_tiff_tells_resolution_colour_and_scene(tmp_path, scene):
    finish(tmp_path / "a.tif", scene, PictureSpec((70, 130), bits=16, dpi=450.5))
    with tifffile.TiffFile(tmp_path / "a.tif") as file:
        tags = file.pages[0].tags
        assert tags["XResolution"].value == (450500, 1000)
        assert tags["ResolutionUnit"].value == 2
        assert tags["ExtraSamples"].value == (2,), "straight alpha"
        assert "sRGB".encode("utf-16-be") in tags["InterColorProfile"].value
        data = json.loads(tags["ImageDescription"].value)
    assert Scene.from_json(data["scene"], scene.volume) == scene
    with Image.open(tmp_path / "a.tif") as image:
        assert image.size == (70, 130)


def test_png_of_arrays_of_any_size(tmp_path):
    rng = np.random.default_rng(0)
    for size in ((1, 1), (64, 3), (65, 130), (200, 7)):
        for kind in (np.uint8, np.uint16):
            array = rng.integers(0, np.iinfo(kind).max, (*size, 4), dtype=kind)
            array[::2] = np.arange(size[1])[:, None]
            write_png(tmp_path / "a.png", array)
            got = pixels(tmp_path / "a.png") if kind is np.uint8 else sixteen(tmp_path / "a.png")
            np.testing.assert_array_equal(got.reshape(array.shape), array)


def test_sixteen_bit_encoding():
    linear = np.array(
        [[[0.2, 0.5, 0.001, 1.0], [0.1, 0.1, 0.1, 0.5], [2, 0, 0, 1], [0, 0, 0, 0]]], np.float32
    )
    got = encode16(linear) / 65535
    expected = [[*srgb(np.array([0.2, 0.5, 0.001])), 1], [*srgb(np.full(3, 0.2)), 0.5], [1, 0, 0, 1], [0] * 4]
    np.testing.assert_allclose(got[0], expected, atol=1e-5)
    with pytest.raises(SceneError):
        encode16(np.zeros((2, 2, 3), np.float32))


def test_no_patient_and_no_folder_in_the_files(tmp_path, still_life):
    info = sfumato.VolumeInfo(
        path="/home/jane/DOE^JOHN 1950/Doe 3", modality="CT", name="DOE^JOHN thorax", notices=("Doe",)
    )
    volume = sfumato.Volume(still_life.data, info=info)
    for ending in ("png", "tif"):
        path = tmp_path / f"a.{ending}"
        finish(path, Scene(volume=volume, technique="raycast"), PictureSpec((8, 8)))
        with Image.open(path) as image:
            text = image.info.get("sfumato-scene") or image.tag_v2[270]
        for word in ("jane", "DOE", "Doe", "thorax", "1950"):
            assert word not in text


# -- what may go wrong ------------------------------------------------------------------------------
@pytest.mark.gpu
def test_cancelled_leaves_what_was_there(tmp_path, scene):
    path = tmp_path / "a.png"
    path.write_text("before")
    job = write_picture(path, scene, PictureSpec((150, 110)), tile_side=52)
    for done in job:
        if done > 0.4:
            break
    job.close()
    assert path.read_text() == "before"
    assert [p.name for p in tmp_path.iterdir()] == ["a.png"]


@pytest.mark.gpu
def test_full_disk_is_one_line_and_leaves_nothing(tmp_path, scene):
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, hard))
    try:
        for ending in ("png", "tif"):
            with pytest.raises(SfumatoError, match="could not be written") as caught:
                finish(tmp_path / f"a.{ending}", scene, PictureSpec((200, 150), bits=16))
            assert len(str(caught.value).splitlines()) == 1
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert not list(tmp_path.iterdir())


@pytest.mark.gpu
def test_places_that_do_not_work(tmp_path, scene):
    with pytest.raises(SfumatoError, match="No such file"):
        finish(tmp_path / "none" / "a.png", scene, PictureSpec((8, 8)))
    with pytest.raises(SfumatoError, match=r"\.png, \.tif, \.tiff"):
        finish(tmp_path / "a.jpg", scene, PictureSpec((8, 8)))
    with pytest.raises(SceneError):
        finish(tmp_path / "a.png", Scene(), PictureSpec((8, 8)))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "values",
    [{"size": (0, 5)}, {"size": (40_000, 5)}, {"size": (30_000, 30_000)}, {"bits": 12}, {"dpi": 0.0}],
)
def test_impossible_pictures_are_refused(values):
    with pytest.raises(SceneError):
        PictureSpec(**{"size": (8, 8), **values})


def test_the_renderer_is_lent_in_between(tmp_path, scene):
    class Guest:
        calls, served = 0, 0

        def waiting(self):
            self.calls += 1
            return self.calls in (3, 4)

        def serve(self):
            self.served += 1
            assert sfumato.render(scene.with_(technique="raycast"), (20, 20)).any()

    guest = Guest()
    finish(tmp_path / "a.png", scene, PictureSpec((60, 40), frames=2), guest=guest)
    assert guest.served == 1
    finish(tmp_path / "b.png", scene, PictureSpec((60, 40), frames=2))
    np.testing.assert_array_equal(pixels(tmp_path / "a.png"), pixels(tmp_path / "b.png"))


# -- sizes ------------------------------------------------------------------------------------------
def test_millimetres_are_pixels_at_dpi():
    assert pixels_of(25.4, 300) == 300
    assert PictureSpec.printed((210, 297), 300).size == (2480, 3508)
    assert PictureSpec.printed((85, 60), 600).dpi == 600
    for bad in ((0, 300), (10, -1), (float("nan"), 300), (10, float("inf"))):
        with pytest.raises(SceneError):
            pixels_of(*bad)


def test_memory_stays_bounded():
    assert PictureSpec((10_000, 7_000), bits=16).memory < 1.1e9
    assert PictureSpec((800, 600)).memory < 60e6


@pytest.mark.parametrize("parallel", [True, False])
def test_a_narrower_picture_shows_all_that_was_seen(parallel):
    camera = Camera(parallel_projection=parallel, parallel_scale=80, window_center=(0.2, 0.4))
    assert framed(camera, 1.5, 1.5) == framed(camera, 1.5, 2.0) == camera
    other = framed(camera, 1.5, 0.75)
    seen, now = np.array(camera.half_extent(1.5)), np.array(other.half_extent(0.75))
    np.testing.assert_allclose(now, [seen[0], 2 * seen[1]])
    np.testing.assert_allclose(now * other.window_center, seen * camera.window_center)


def test_written_files_are_named_in_full(tmp_path: Path, scene):
    finish(tmp_path / "a.b.PNG", scene.with_(technique="raycast"), PictureSpec((4, 4)))
    assert [p.name for p in tmp_path.iterdir()] == ["a.b.PNG"]


def test_a_tiff_of_ours_opens_as_its_scene(tmp_path, still_life):
    np.save(tmp_path / "v.npy", still_life.data)
    scene = Scene(volume=sfumato.load(tmp_path / "v.npy"), technique="raycast")
    finish(tmp_path / "a.tif", scene, PictureSpec((6, 4)))
    assert carries_scene(tmp_path / "a.tif")
    assert open_png(tmp_path / "a.tif") == scene
    tifffile.imwrite(tmp_path / "b.tif", np.zeros((5, 6), np.uint8), description='{"program": "other"}')
    assert not carries_scene(tmp_path / "b.tif")
    data = (tmp_path / "a.tif").read_bytes()
    for end in (0, 3, 7, 300, len(data) - 900):
        (tmp_path / "c.tif").write_bytes(data[:end])
        with pytest.raises(LoadError):
            read_scene_data(tmp_path / "c.tif")


# -- the scale bar ----------------------------------------------------------------------------------
def test_lengths_are_round():
    assert [round_length(x) for x in (0.07, 1.0, 1.9, 4.99, 5.0, 23, 700)] == [0.05, 1, 1, 2, 5, 20, 500]
    assert [words_for(x) for x in (0.05, 2, 10, 50, 200)] == ["0.05 mm", "2 mm", "1 cm", "5 cm", "20 cm"]


@pytest.mark.parametrize("dpi", [None, 300])
@pytest.mark.parametrize("ground", [0, 255])
def test_scale_bar_has_its_true_length_and_stands_out(dpi, ground):
    camera = Camera(parallel_projection=True, parallel_scale=60)
    size = (800, 600)
    bar = ScaleBar.for_picture(camera, size, dpi)
    assert bar.pixels == pytest.approx(bar.length * 600 / 120)
    assert (bar.length, bar.label) == (20, "2 cm")
    picture = np.full((600, 800, 4), ground, np.uint8)
    picture[..., 3] = 255
    bar.draw_on(picture, 0)
    row = picture[bar.place[1] + int(np.argmax(bar.ink[..., 0].sum(axis=1))), :, 0].astype(float)
    rim = picture[..., 0].astype(int)
    left = bar.place[0]
    inside = row[left : left + bar.ink.shape[1]]
    if ground == 0:
        assert inside.sum() / 255 == pytest.approx(bar.pixels, abs=0.1), "white, to a tenth of a pixel"
    assert rim.max() == 255
    assert rim.min() == 0
    assert left + bar.ink.shape[1] < 800


def test_scale_bar_in_parts_is_the_same():
    camera = Camera(parallel_projection=True, parallel_scale=60)
    bar = ScaleBar.for_picture(camera, (400, 300))
    whole = np.zeros((300, 400, 4), np.uint16)
    bar.draw_on(whole, 0)
    parts = np.zeros_like(whole)
    for top in range(0, 300, 7):
        bar.draw_on(parts[top : top + 7], top)
    np.testing.assert_array_equal(whole, parts)
    assert whole[..., 3].max() == 65535, "seen on nothing too"


def test_scale_bars_that_cannot_be():
    with pytest.raises(SceneError, match="orthographic"):
        ScaleBar.for_picture(Camera(), (400, 300))
    with pytest.raises(SceneError, match="larger"):
        ScaleBar.for_picture(Camera(parallel_projection=True), (20, 10))


# -- colour bars -----------------------------------------------------------------------------------
@pytest.mark.gpu
def test_a_picture_of_tracts_alone_has_its_colour_bar(tmp_path):
    """Strip from the map's end to its begin, ticks' values beside it; nothing if no scalar colours anything."""
    lines = Lines.of([[[0, 0, 0], [30, 0, 0], [30, 0, 30]]], [("fa", [np.array([0.0, 0.5, 1.0])])])
    tracts = Geometry(lines, radius=0.5, color_by="scalar", colormap="gray")
    scene = Scene(geometry=(tracts,), technique="combined", background=(0.2, 0.3, 0.4, 1))
    pictures = {}
    for name, spec in (("bar", PictureSpec((240, 200), color_bars=True)), ("bare", PictureSpec((240, 200)))):
        for _ in write_picture(tmp_path / f"{name}.png", scene, spec):
            pass
        pictures[name] = np.asarray(Image.open(tmp_path / f"{name}.png").convert("RGB")).astype(int)
    changed = np.abs(pictures["bar"] - pictures["bare"]).max(axis=2) > 4
    rows, columns = np.nonzero(changed)
    assert columns.max() < 120
    assert rows.min() > 100
    ink = BarsInk.for_picture(scene, (240, 200))
    assert ink is not None
    strip = ink.pixels[:, round(0.8 * 9) + 3]
    solid = strip[strip[:, 3] == 1][:, 0]
    assert solid[0] > 0.99
    assert solid[-1] < 0.01
    assert (np.diff(solid) <= 0).all()
    assert BarsInk.for_picture(scene.with_(**{"geometry.0.color_by": "color"}), (240, 200)) is None
    assert BarsInk.for_picture(scene, (60, 40)) is None, "no room"
