"""Fetches are counted right, and the growth table has all that it promises."""

from __future__ import annotations

import json
import math

import pytest

from sfumato.gpu import Target
from sfumato.gpu.program import FULLSCREEN_VERTEX
from sfumato_app.bench.ceilings import KINDS as CEILINGS
from sfumato_app.bench.fetches import KINDS, FetchCounter, seconds_at_ceiling
from sfumato_app.bench.growth import FACTORS, Point, measure_growth, points, save_growth_plot
from sfumato_app.bench.setting import Setting

SHADER = """#version 330 core
uniform sampler2D u_a; uniform sampler3D u_b; uniform usampler3D u_c; uniform sampler2DArray u_d;
out vec4 o;
float twice(sampler3D s) { return textureLod(s, vec3(0.5), 0.0).r + textureLod(s, vec3(0.2), 0.0).r; }
void main() {
    o = textureLod(u_a, vec2(0.5), 0.0) + textureLod(u_d, vec3(0.5), 0.0) + twice(u_b);
    o += float(texelFetch(u_c, ivec3(0), 0).r);
    if (gl_FragCoord.x < 4.0) return;
    for (int k = 0; k < 3; ++k) o += texelFetch(u_a, ivec2(0), 0);
}
"""


@pytest.mark.gpu
def test_every_fetch_is_counted_once():
    counter = FetchCounter()
    if counter.renderer is None:
        pytest.skip("OpenGL 4.3 is needed to count")
    device = counter.renderer.device
    target = Target(device, (8, 100))
    program = device.ctx.program(vertex_shader=FULLSCREEN_VERTEX, fragment_shader=SHADER)
    for unit, name in enumerate(("u_a", "u_b", "u_c", "u_d")):
        program[name].value = unit
    array = device.ctx.vertex_array(program, [])
    counter.begin()
    target.fbo.use()
    for _ in range(2):
        device.draw_triangles(array, 0, 3)
    pixels = 2 * 8 * 100
    counted = {
        "2D linear": 2 * pixels,
        "3D linear": 2 * pixels,
        "3D nearest": pixels,
        "unfiltered": 3 * pixels // 2,
    }
    assert counter.counts() == counted
    counter.begin()
    assert not any(counter.counts().values())
    counter.close()


def test_time_at_the_ceiling():
    ceilings = {kind: 100.0 for kind in CEILINGS}
    assert set(KINDS.values()) <= set(ceilings)
    assert seconds_at_ceiling({"2D linear": 50, "unfiltered": 150}, ceilings) == 2.0


@pytest.mark.gpu
@pytest.mark.slow
def test_growth_has_times_and_fractions(tmp_path):
    growth = measure_growth(Point(24, 16, 32, 1), {"viewport": (16, 24)}, techniques=("raycast",))
    assert len(growth.samples) == 2
    assert not any(sample.missing for sample in growth.samples)
    assert all(value > 0 for value in growth.ceilings.values())
    for sample in growth.samples:
        assert min(sample.cpu_ms, sample.wall_ms) > 0
        assert sample.fraction is None or math.isfinite(sample.fraction)
    assert "raycast" in growth.text()
    assert json.loads(json.dumps(growth.to_json()))["base"]["volume"] == 24
    pytest.importorskip("matplotlib")
    save_growth_plot(growth, tmp_path / "growth.png")
    assert (tmp_path / "growth.png").stat().st_size > 1000


def test_points_change_one_factor_at_a_time():
    base = Point(128, 256, 256, 1)
    found = points(base, FACTORS)
    assert len(found) == len(set(found)) == sum(map(len, FACTORS.values())) - len(FACTORS) + 1
    for point in found:
        assert sum(a != b for a, b in zip(vars(point).values(), vars(base).values(), strict=True)) <= 1


def test_slices_are_as_many_as_asked_for():
    few, many = Setting.sliced(128, 64, 100, 1), Setting.sliced(128, 64, 400, 1)
    assert few.step == pytest.approx(4 * many.step)
    assert Setting.sliced(256, 64, 100, 1).step == pytest.approx(2 * few.step)
    scene = Setting.sliced(24, 64, 40, 3).scene("raycast")
    assert len(scene.lights) == 3
    assert sum(light.intensity for light in scene.lights) == pytest.approx(1)
