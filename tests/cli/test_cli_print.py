"""`sfumato render` for print: millimetres at dpi, 16 bits, TIFF, scale bar."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from sfumato.export.png import read_scene_data

pytestmark = pytest.mark.gpu
FAST = ("--technique", "raycast", "--frames", 1)


def test_millimetres_at_dpi(run, ball):
    outcome = run("render", ball, "-o", "a.png", "--mm", "25.4x12.7", "--dpi", 120, *FAST)
    assert (outcome.status, outcome.err) == (0, "")
    assert "a.png: 120 x 60" in outcome.out
    with Image.open("a.png") as image:
        assert image.size == (120, 60)
        assert image.info["dpi"] == pytest.approx((120, 120), abs=0.02)
    assert run("render", ball, "-o", "b.png", "--mm", "5x5", *FAST).out.startswith("b.png: 59 x 59")


def test_sixteen_bits_and_tiff(run, ball):
    tifffile = pytest.importorskip("tifffile")
    assert (
        run("render", ball, "-o", "a.tif", "--size", "40x30", "--bits", 16, "--dpi", 600, *FAST).status == 0
    )
    picture = tifffile.imread("a.tif")
    assert (picture.dtype, picture.shape) == (np.uint16, (30, 40, 4))
    assert read_scene_data("a.tif")["technique"]["id"] == "raycast"
    assert run("render", "a.tif", "-o", "b.tif", "--size", "40x30", "--bits", 16).status == 0
    np.testing.assert_array_equal(tifffile.imread("b.tif"), picture)
    assert '"raycast"' in run("info", "a.tif").out


def test_scale_bar(run, ball):
    flags = ("--size", "200x150", *FAST)
    flat = ("--set", "camera.parallel_projection=true")
    assert run("render", ball, "-o", "a.png", *flat, *flags).status == 0
    assert run("render", ball, "-o", "b.png", "--scale-bar", *flat, *flags).status == 0
    with Image.open("a.png") as a, Image.open("b.png") as b:
        changed = np.abs(np.asarray(a).astype(int) - np.asarray(b)).max(axis=2) > 0
    y, x = np.nonzero(changed)
    assert x.min() > 100
    assert y.min() > 100
    assert "orthographic" in run("render", ball, "-o", "c.png", "--scale-bar", *flags).failed_with(1)


def test_orientation_cube(run, ball):
    flags = ("--size", "200x150", *FAST)
    assert run("render", ball, "-o", "a.png", *flags).status == 0
    assert run("render", ball, "-o", "b.png", "--orientation-cube", *flags).status == 0
    with Image.open("a.png") as a, Image.open("b.png") as b:
        changed = np.abs(np.asarray(a).astype(int) - np.asarray(b)).max(axis=2) > 0
    y, x = np.nonzero(changed)
    assert max(x.max(), y.max()) < 80
    assert min(x.min(), y.min()) > 2
    assert "--orientation-cube" in run(
        "render", ball, "-o", "c.npy", "--orientation-cube", "--linear"
    ).failed_with(2)


def test_wrong_use(run, ball):
    assert "one of them" in run("render", ball, "--mm", "5x5", "--size", "5x5").failed_with(2)
    assert "85x60" in run("render", ball, "--mm", "5").failed_with(2)
    assert "--mm" in run("render", ball, "--mm", "0x5").failed_with(2)
    assert "linear" in run("render", ball, "-o", "a.exr", "--bits", 16).failed_with(2)
    assert "8 or 16" in run("render", ball, "--bits", 12).failed_with(1)
    assert "pixels on a side" in run("render", ball, "--size", "90000x5").failed_with(1)
