"""The table of techniques, and the flags made from the declared parameters."""

from __future__ import annotations

import json

import pytest

from sfumato import Scene
from sfumato.scene import fields_of
from sfumato.techniques import techniques
from sfumato_app.flags import SceneFlags, TechniqueFlags, changed, declared_flag, declared_parameters


def parameters_of(technique_id):
    return {n: f for n, f in fields_of(techniques()[technique_id].params).items() if f.param is not None}


def test_json_has_every_technique_and_parameter(run):
    listed = {t["id"]: t for t in json.loads(run("techniques", "--json").out)}
    assert list(listed) == list(techniques())
    for technique_id, told in listed.items():
        assert told["title"]
        assert told["summary"]
        declared = parameters_of(technique_id)
        assert [p["name"] for p in told["parameters"]] == list(declared)
        for parameter in told["parameters"]:
            field = declared[parameter["name"]]
            assert parameter["meaning"] == field.param.meaning
            assert parameter["unit"] == field.param.unit
            assert parameter["default"] == field.default
            assert parameter["allowed"]


def test_table_names_everything(run):
    words = run("techniques").out.split()
    for technique_id in techniques():
        assert technique_id in words
        assert set(parameters_of(technique_id)) <= set(words)


def test_help_names_every_flag(run):
    told = run("render", "--help").out
    for name in declared_parameters():
        assert f"--{declared_flag(name)}" in told


@pytest.mark.parametrize("technique_id", list(techniques()))
def test_each_parameter_is_a_flag_of_its_technique(technique_id):
    own = {n: f for n, f in parameters_of(technique_id).items() if n in declared_parameters()}
    wanted = {name: another_value(field) for name, field in own.items()}
    scene = changed(Scene(), SceneFlags(technique=technique_id), TechniqueFlags(**wanted), 1.0)
    assert scene.technique_id == technique_id
    for name, value in wanted.items():
        assert getattr(scene.technique, name) == value


def another_value(field):
    """Return an allowed value that is not the default."""
    param = field.param
    if param.choices:
        return next(c for c in param.choices if c != field.default)
    if field.kind is bool:
        return not field.default
    low, high = param.soft or (param.ge, param.le)
    value = field.kind(low + 0.75 * (high - low))
    return value if value != field.default else field.kind(low + 0.5 * (high - low))


def test_a_technique_keeps_its_parameters_unless_another_is_chosen():
    scene = Scene(technique="multidirectional").with_(**{"technique.ambient": 0.5})
    assert changed(scene, SceneFlags(technique="multidirectional"), TechniqueFlags(), 1.0) == scene
    other = changed(scene, SceneFlags(technique="directional"), TechniqueFlags(), 1.0)
    assert other.technique.ambient == 0.0
