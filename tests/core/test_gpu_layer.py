"""The only folder that calls moderngl: compiling, uniforms, the store, threads, and nothing left behind."""

from __future__ import annotations

import ctypes
import threading
import weakref
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sfumato
from sfumato import CropBox, GpuError, Light, Scene, SceneError, TransferFunction, Volume
from sfumato.gpu import LAYERED, Device, LayerTarget, Program, ShaderSource, Store, Target, Variants
from sfumato.gpu import program as program_module
from sfumato.gpu.program import VARIANTS_KEPT
from sfumato.renderer import Quality, Renderer
from sfumato.techniques import techniques
from sfumato.techniques.light_cache import LightCache

pytestmark = pytest.mark.gpu


@pytest.fixture
def device() -> Iterator[Device]:
    device = Device()
    yield device
    device.make_current()
    device.close()


@pytest.fixture
def shader(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Write a shader (and a library beside it) of a few lines and return its source."""
    (tmp_path / "lib").mkdir()
    monkeypatch.setattr(program_module, "PACKAGE", tmp_path)
    monkeypatch.setattr(program_module, "LIBRARY", tmp_path / "lib")

    def write(text: str, *defines: tuple[str, int], **library: str) -> ShaderSource:
        for name, body in library.items():
            (tmp_path / "lib" / f"{name}.glsl").write_text(body)
        (tmp_path / "own.frag.glsl").write_text(text)
        return ShaderSource("own.frag.glsl", defines)

    return write


def drawn(device: Device, program: Program, components: int = 4) -> np.ndarray:
    """Return the one pixel that a program draws."""
    target = Target(device, (1, 1), components)
    target.fbo.use()
    program.draw()
    pixel = target.read()[0, 0]
    target.release()
    return pixel


# -- programs -----------------------------------------------------------------------------------------
def test_a_compile_error_names_our_file_and_line(device: Device, shader: Any) -> None:
    source = shader("out vec4 o;\n\nvoid main() { o = no_such_name; }\n")
    with pytest.raises(GpuError) as caught:
        Program(device, source)
    assert "own.frag.glsl:3" in str(caught.value)
    assert "no_such_name" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_compile_error_in_an_include_names_the_include(device: Device, shader: Any) -> None:
    source = shader(
        '#include "part"\nout vec4 o;\nvoid main() { o = vec4(f()); }\n',
        part="// fine\n\nfloat f() { return wrong; }\n",
    )
    with pytest.raises(GpuError, match=r"lib/part\.glsl:3"):
        Program(device, source)
    source = shader(
        '#include "part"\nout vec4 o;\nvoid main() { o = vec4(wrong); }\n', part="float f() { return 1.0; }\n"
    )
    with pytest.raises(GpuError, match=r"own\.frag\.glsl:3"):
        Program(device, source)


def test_includes_are_taken_once_and_defines_come_first(device: Device, shader: Any) -> None:
    source = shader(
        '#include "a"\n#include "b"\nout vec4 o;\nvoid main() { o = vec4(a(), b(), VALUE, 1.0); }\n',
        ("VALUE", 7),
        a="float a() { return 2.0; }\n",
        b='#include "a"\nfloat b() { return a() + float(VALUE); }\n',
    )
    assert drawn(device, Program(device, source)).tolist() == [2, 9, 7, 1]


def test_uniform_arrays_may_be_longer_than_the_compilers(device: Device, shader: Any) -> None:
    source = shader(
        "uniform vec3 u_colors[4]; uniform int u_numbers[4]; uniform ivec2 u_pairs[3]; out vec4 o;\n"
        "void main() { o = vec4(u_colors[0].y, u_colors[1].z, u_numbers[1], u_pairs[1].y); }\n"
    )
    program = Program(device, source)
    colors = np.arange(12, dtype=np.float64).reshape(4, 3)
    program.set(u_colors=colors, u_numbers=np.arange(4), u_pairs=np.arange(6).reshape(3, 2), u_no_such=3)
    assert drawn(device, program).tolist() == [1, 5, 1, 3]


def test_programs_in_turn_keep_their_own_textures(device: Device, shader: Any) -> None:
    text = "uniform sampler2D u_a; uniform sampler2D u_b; out vec4 o;\nvoid main() { o = %s; }\n"
    textures = [Target(device, (1, 1)) for _ in range(3)]
    for k, target in enumerate(textures):
        target.clear(k + 1)
    both = Program(
        device, shader(text % "texelFetch(u_a, ivec2(0), 0) + 10.0 * texelFetch(u_b, ivec2(0), 0)")
    )
    other = Program(device, shader(text % "texelFetch(u_b, ivec2(0), 0)"))
    both.bind(u_a=textures[0].texture, u_b=textures[1].texture)
    other.bind(u_b=textures[2].texture)
    assert [drawn(device, p)[0] for p in (both, other, both, other)] == [21, 3, 21, 3]


def test_the_newest_variants_are_kept_and_what_is_held_still_draws(device: Device, shader: Any) -> None:
    """Hundreds of compiled programs would take gigabytes with a software renderer."""
    shader("out vec4 o;\nvoid main() { o = vec4(NUMBER); }\n")
    variants = Variants(device, "own.frag.glsl")
    held = variants.get((("NUMBER", 0),))
    alive = [weakref.ref(variants.get((("NUMBER", n),))) for n in range(1, VARIANTS_KEPT + 10)]
    variants.get((("NUMBER", 10),))  # kept, and now the youngest
    variants.get((("NUMBER", 1000),))
    device.collect()
    assert sum(program() is not None for program in alive) == VARIANTS_KEPT - 1
    assert alive[9]() is not None
    assert drawn(device, held).tolist() == [0, 0, 0, 0]
    assert drawn(device, variants.get((("NUMBER", 1),))).tolist() == [1, 1, 1, 1], "compiled anew"


def test_one_draw_covers_layers_of_two_textures_and_tells_each_its_number(
    device: Device, shader: Any
) -> None:
    stages = [(Path(sfumato.__file__).parent / file).read_text(encoding="utf-8") for file in LAYERED]
    source = shader(
        "flat in int v_layer; layout(location = 0) out float o_a; layout(location = 1) out float o_b;\n"
        "void main() { o_a = float(v_layer) + 0.01 * gl_FragCoord.x; o_b = -o_a; }\n"
    )
    program = Program(device, source, *stages)
    textures = [device.ctx.texture3d((3, 2, 40), 1, dtype="f4", data=bytes(4 * 240)) for _ in range(2)]
    target = LayerTarget(device, layers=2, size=(3, 2))
    target.use_all(textures)
    program.draw_layers(1, 20)
    program.draw_layers(30, 10)
    a, b = (np.frombuffer(t.read(), np.float32).reshape(40, 2, 3) for t in textures)
    drawn_layers = [*range(1, 21), *range(30, 40)]
    wanted = np.zeros((40, 2, 3))
    wanted[drawn_layers] = np.array(drawn_layers)[:, None, None] + 0.01 * (np.arange(3) + 0.5)
    assert np.allclose(a, wanted, atol=1e-5)
    assert np.array_equal(b, -a)


# -- targets ------------------------------------------------------------------------------------------
def test_targets_have_row_0_on_top(device: Device) -> None:
    target = Target(device, (3, 2))
    pixels = np.arange(24, dtype=np.float32).reshape(2, 3, 4)
    target.write(pixels)
    assert np.array_equal(target.read(), pixels)


def test_a_picture_too_large_is_a_gpu_error(device: Device) -> None:
    with pytest.raises(GpuError) as caught:
        Target(device, (10 * device.max_texture_2d, 4))
    assert "\n" not in str(caught.value)
    assert Target(device, (4, 4)).read().shape == (4, 4, 4), "the device goes on"


def test_a_volume_too_long_is_a_gpu_error() -> None:
    renderer = Renderer()
    volume = Volume(np.zeros((1, 1, renderer.device.max_texture_3d + 1), np.uint8))
    with pytest.raises(GpuError, match="along a side"):
        for _ in renderer.begin(Scene(volume=volume), (8, 8)).add_frame():
            pass
    renderer.close()


# -- the store ----------------------------------------------------------------------------------------
class Thing:
    """Something to be released."""

    released = False
    size: tuple[int, ...] = ()

    def release(self) -> None:
        assert not self.released
        self.released = True


def test_the_store_keeps_what_was_used_last_within_its_budget() -> None:
    store, things = Store(budget=300), [Thing() for _ in range(6)]
    for k, thing in enumerate(things[:3]):
        assert store.get(("thing", k), lambda thing=thing: thing, 100) is thing  # type: ignore[misc]
    assert store.get(("thing", 0), Thing, 100) is things[0], "kept, and now the youngest"
    store.get(("thing", 3), lambda: things[3], lambda _: 100)
    assert [t.released for t in things[:4]] == [False, True, False, False]
    assert store.bytes_in_use == 300
    assert store.listing()[0] == ("thing", 100)
    store.drop(lambda key: key == ("thing", 0))
    assert things[0].released
    store.clear()
    assert store.bytes_in_use == 0
    assert things[3].released


def test_of_small_things_a_number_is_kept() -> None:
    """A drag that makes tables anew with each move must not fill the driver's memory with thousands of them."""
    store, things = Store(budget=10**6), [Thing() for _ in range(6)]
    store.get(("other", 0), lambda: things[5], 1)
    for number in range(4):
        store.get(("table", number), lambda n=number: things[n], 1, most=2)  # type: ignore[misc]
    assert [thing.released for thing in things] == [True, True, False, False, False, False]
    with store.frame():
        store.get(("table", 2), Thing, 1, most=2)
        store.get(("table", 4), lambda: things[4], 1, most=1)
        assert not things[2].released, "the frame needs it"
        assert things[3].released


def test_a_frame_keeps_what_it_asked_for_whatever_the_budget() -> None:
    store, things = Store(budget=100), [Thing() for _ in range(4)]

    def get(number: int) -> None:
        store.get(("thing", number), lambda: things[number], 80)

    with store.frame():
        get(0)
        with store.frame():  # another frame, drawn in between
            get(1)
        get(2)
        assert not any(thing.released for thing in things)
    get(3)
    assert [thing.released for thing in things] == [True, True, True, False]
    assert store.bytes_in_use == 80


def test_guests_count_within_the_budget() -> None:
    @dataclass
    class Guest:
        bytes_in_use: int

    store, guest, things = Store(budget=100), Guest(0), [Thing(), Thing()]
    store.admit("guest", guest)
    for number, thing in enumerate(things):
        store.get(("thing", number), lambda thing=thing: thing, 40)  # type: ignore[misc]
    guest.bytes_in_use = 30
    store.make_room()
    assert [thing.released for thing in things] == [True, False]
    assert store.listing() == [("thing", 40), ("guest", 30)]
    store.dismiss(guest)
    assert store.bytes_of_guests == 0


def test_light_of_other_techniques_makes_room() -> None:
    made: list[Thing] = []

    def make(size: tuple[int, int, int]) -> Thing:
        made.append(Thing())
        made[-1].size = size
        return made[-1]

    store, size = Store(budget=1500), (10, 10, 1)
    idle, busy = (LightCache(make, store=store, bytes_per_texel=10) for _ in range(2))
    with store.frame():
        idle.keep("a", idle.take(size, 0))
    with store.frame():
        busy.keep("b", busy.take(size, 0))
        assert [thing.released for thing in made] == [True, False]
        busy.keep("c", busy.take(size, 1))
    assert [thing.released for thing in made] == [True, False, False], "what the frame needs stays"
    assert store.bytes_needed == store.bytes_of_guests == 2000
    assert idle.bytes_in_use == 0


def test_the_user_may_set_the_budget(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SFUMATO_GPU_BUDGET_MB", "64")
    assert Store().budget == 64 << 20
    for wrong in ("1.5", "-3", "much", "1"):
        monkeypatch.setenv("SFUMATO_GPU_BUDGET_MB", wrong)
        with pytest.raises(GpuError, match="SFUMATO_GPU_BUDGET_MB"):
            Store()


# -- threads ------------------------------------------------------------------------------------------
def test_a_device_belongs_to_its_thread(device: Device) -> None:
    caught: list[BaseException] = []

    def elsewhere() -> None:
        try:
            device.make_current()
        except GpuError as error:
            caught.append(error)

    thread = threading.Thread(target=elsewhere)
    thread.start()
    thread.join()
    assert len(caught) == 1
    assert "thread" in str(caught[0])


def test_each_thread_may_render(still_life: Volume) -> None:
    scene, pictures = Scene(volume=still_life, technique="raycast"), {}
    here = sfumato.render(scene, (24, 24))

    def elsewhere(number: int) -> None:
        renderer = Renderer()
        job = renderer.begin(scene, (24, 24))
        for _ in job.add_frame():
            pass
        pictures[number] = job.picture()
        job.release()
        renderer.close()

    threads = [threading.Thread(target=elsewhere, args=(k,)) for k in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(pictures[k], here) for k in range(2))
    assert np.array_equal(sfumato.render(scene, (24, 24)), here)


# -- what a renderer owes -----------------------------------------------------------------------------
@pytest.mark.parametrize("size", [(0, 4), (4, -1), (10**6, 4)])
def test_impossible_sizes(size: tuple[int, int], still_life: Volume) -> None:
    with pytest.raises(SceneError, match="size"):
        sfumato.render(Scene(volume=still_life), size)


def test_no_volume() -> None:
    with pytest.raises(SceneError, match="volume"):
        sfumato.render(Scene())


def random_scene(random: np.random.Generator, volumes: list[Volume], numbers: tuple[int, ...]) -> Scene:
    """Return any of many scenes, by the fast techniques."""
    fast = [name for name in techniques() if name != "reference"]
    low = random.uniform(20, 60)
    transfer = TransferFunction.from_points(
        [(low, (1, 1, 1), 0), (low + 80, tuple(random.uniform(0, 1, 3)), 0.7)]
    )
    # No clip plane: each number of them, as of lights, is another program, and compiling takes long.
    lights = [
        Light(tilt=float(random.choice([20, 60, 130])), rotation=float(random.uniform(0, 360)), aperture=15)
        for _ in range(random.choice(numbers))
    ]
    crop = CropBox(low=tuple(random.uniform(0, 0.4, 3)), high=(1, 1, 1))
    volume = volumes[random.integers(len(volumes))]
    return Scene(
        volume=volume, transfer=transfer, lights=lights, crop=crop, technique=str(random.choice(fast)), step=2.0
    )  # fmt: skip


def names_of(device: Device, kind: str) -> int:
    """Return how many objects of a kind there are."""
    is_one = device._function(f"glIs{kind}", ctypes.c_ubyte, ctypes.c_uint)
    newest = device.ctx.texture((1, 1), 1)
    names = range(1, newest.glo + 1)  # Mesa counts up
    newest.release()
    return sum(bool(is_one(name)) for name in names)


def living(device: Device) -> int:
    """Return how many textures, framebuffers and buffers there are."""
    return sum(names_of(device, kind) for kind in ("Texture", "Framebuffer", "Buffer"))


def draw_at_random(still_life: Volume, number: int, lights: tuple[int, ...]) -> None:
    """Draw pictures of random scenes, some given up, and see that nothing grows and everything is listed."""
    random = np.random.default_rng(7)
    small = still_life.data[::2, ::2, ::2]
    volumes = [Volume(np.ascontiguousarray(small[k:, k:, k:]), spacing=(2, 2, 2)) for k in range(3)]
    budget = 1 << 20
    renderer = Renderer(budget)
    device = renderer.device
    counts = []
    for index in range(number):
        scene = random_scene(random, volumes, lights)
        job = renderer.begin(scene, (16 + index % 3, 16), Quality(light=2.0))
        for progress in job.add_frame():
            if random.uniform() < 0.1:  # a newer scene came
                break
            assert 0 <= progress <= 1
        listed = renderer.gpu_objects(job)
        if index % 10 == 0:
            assert len(listed) == names_of(device, "Texture") + names_of(device, "Buffer"), listed
        job.release()
        device.collect()
        kept = device.store.bytes_in_use + device.store.bytes_of_guests
        assert kept <= max(budget, device.store.bytes_needed), scene.technique
        counts.append((living(device), sum(item.size for item in listed)))
    renderer.close()
    settled = 6 * number // 10
    for before, after in zip(
        zip(*counts[:settled], strict=True), zip(*counts[settled:], strict=True), strict=True
    ):
        assert max(after) <= 1.02 * max(before) + 2


def test_nothing_is_left_behind_by_a_hundred_pictures(still_life: Volume) -> None:
    draw_at_random(still_life, 100, lights=(2,))


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_nothing_is_left_behind_by_a_thousand_pictures(still_life: Volume) -> None:
    draw_at_random(still_life, 1000, lights=(1, 2, 3, 4))
