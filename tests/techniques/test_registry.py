"""What every technique in the registry owes its users; a new one is tested by being there."""

from __future__ import annotations

import dataclasses
import importlib
import importlib.util
import json
import math
import re
import sys
from pathlib import Path
from typing import Any

import pytest

import sfumato
from sfumato import Scene, SceneError
from sfumato.scene import Field, fields_of, parse_setting
from sfumato.techniques import Technique, id_of, params_from_json, params_of, technique_for, techniques

ALL = list(techniques().values())
PARAMETERS = [(t, f) for t in ALL for f in fields_of(t.params).values()]
each_technique = pytest.mark.parametrize("technique", ALL, ids=lambda t: t.id)
each_parameter = pytest.mark.parametrize(
    ("technique", "field"), PARAMETERS, ids=[f"{t.id}.{f.name}" for t, f in PARAMETERS]
)


def bibliography() -> set[str]:
    """Keys of the references."""
    text = (Path(sfumato.__file__).parent / "references.bib").read_text(encoding="utf-8")
    return set(re.findall(r"^@\w+\{\s*([\w-]+)\s*,", text, flags=re.MULTILINE))


def other_value(field: Field) -> Any:
    """Return an allowed value that is not the default."""
    param = field.param
    assert param is not None
    if field.kind is bool:
        return not field.default
    if param.choices:
        return next(c for c in param.choices if c != field.default)
    if field.kind is int:
        default = field.default if field.default is not None else int((param.soft or (1, 2))[0])
        return default + 1 if param.admits(default + 1) else default - 1
    default = field.default if field.default is not None else (param.soft or (1.0, 2.0))[1]
    for candidate in (0.9 * default + 0.01, 1.1 * default):
        if param.admits(candidate) and candidate != field.default:
            return candidate
    raise AssertionError(f"no other value for {field.name}")


def set_all(technique: Technique) -> Any:
    """Return parameters of which none has its default."""
    return technique.params(**{f.name: other_value(f) for f in fields_of(technique.params).values()})


@each_technique
def test_json_round_trip(technique: Technique, still_life: sfumato.Volume, tmp_path: Path) -> None:
    scene = Scene(volume=still_life, technique=set_all(technique))
    data = json.loads(json.dumps(scene.to_json()))
    assert data["technique"]["id"] == technique.id
    assert Scene.from_json(data, still_life) == scene
    scene.save(tmp_path / "study.sfumato")
    assert Scene.open(tmp_path / "study.sfumato", volume=still_life) == scene


@each_technique
def test_id_and_parameters_lead_to_each_other(technique: Technique) -> None:
    params = params_of(technique.id)
    assert type(params) is technique.params
    assert technique_for(params) is technique
    assert id_of(params) == technique.id
    assert params_from_json(technique.id) == params_from_json({"id": technique.id}) == params
    assert Scene(technique=technique.id).technique_id == technique.id


@each_technique
def test_unknown_parameters_are_refused(technique: Technique) -> None:
    with pytest.raises(SceneError, match="unknown field"):
        params_from_json({"id": technique.id, "no_such_parameter": 1})


@each_technique
def test_is_documented(technique: Technique) -> None:
    folder = technique.params.__module__.rpartition(".")[0]
    text = sys.modules[folder].__doc__ or ""
    assert technique.id in text or len(techniques_of(folder)) == 1, "the folder's docstring does not name it"
    assert len(text) > 200, "the folder's docstring should read like the abstract of a paper"
    assert technique.title
    assert 10 < len(technique.summary) <= 120
    assert not technique.summary.endswith(".")
    assert technique.params.__doc__
    assert technique.source in bibliography()


def techniques_of(folder: str) -> list[Technique]:
    return [t for t in ALL if t.params.__module__.rpartition(".")[0] == folder]


@each_technique
def test_painter_is_one(technique: Technique) -> None:
    module, name = technique.painter.split(":")
    spec = importlib.util.resolve_name(module, "sfumato.techniques")
    painter = getattr(importlib.import_module(spec), name)
    assert callable(painter.paint)
    assert callable(painter.release)


@each_parameter
def test_parameter_is_documented(technique: Technique, field: Field) -> None:
    param = field.param
    assert param is not None, "every parameter of a technique is declared with Param"
    assert len(param.meaning) > 10
    assert param.label
    assert param.tab in ("light", "material", "view"), "without a tab it has no control"
    cited = re.findall(r"[A-Z][a-z]+\d{4}", param.source)
    assert set(cited) <= bibliography()


@each_parameter
def test_parameter_is_checked_at_its_bounds(technique: Technique, field: Field) -> None:
    param = field.param
    assert param is not None

    def takes(value: Any) -> bool:
        try:
            made = technique.params(**{field.name: value})
        except SceneError as error:
            if error.path != field.name:
                raise
            return False
        return bool(getattr(made, field.name) == value)

    assert takes(field.default)
    if field.kind is bool or param.choices:
        assert all(takes(choice) for choice in param.choices or (False, True))
        assert not takes("nonsense")
        assert not takes(None)
        return
    assert (param.ge, param.gt) != (None, None), "a number needs a lower bound"
    assert (param.le, param.lt) != (None, None), "a number needs an upper bound"
    smallest = 1 if field.kind is int else 1e-9
    lower, upper = ((param.ge, -1, True), (param.gt, -1, False)), ((param.le, 1, True), (param.lt, 1, False))
    for bound, outwards, inclusive in (*lower, *upper):
        if bound is not None:
            assert takes(field.kind(bound)) == inclusive
            assert not takes(bound + outwards * smallest * max(1, abs(bound)))
    assert not any(takes(v) for v in (math.nan, math.inf, -math.inf, "1", True))
    assert takes(None) == field.optional
    assert bool(param.none_label) == field.optional, "no value means something"
    if param.soft:
        assert param.soft[0] < param.soft[1]
        assert all(param.admits(v) for v in param.soft)


@each_parameter
def test_parameter_can_be_set_by_a_flag(technique: Technique, field: Field) -> None:
    scene, path = Scene(technique=technique.id), f"technique.{field.name}"
    value = other_value(field)
    text = value if isinstance(value, str) else json.dumps(value)
    parsed = parse_setting(scene, path, text)
    assert parsed == value
    assert type(parsed) is type(value)
    assert getattr(scene.with_({path: parsed}).technique, field.name) == value
    with pytest.raises(SceneError) as caught:
        parse_setting(scene, path, "[1, 2]")
    assert caught.value.path.startswith(path)


def test_ids_are_unique_and_titles_too() -> None:
    found = [t for folder in registry_folders() for t in folder.TECHNIQUES]
    assert len({t.id for t in found}) == len(found) == len(ALL)
    assert len({t.title for t in found}) == len(found)
    assert len({t.params for t in found}) == len(found), "a technique is found by the type of its parameters"
    assert all(re.fullmatch(r"[a-z]+(-[a-z]+)*", t.id) for t in found)


def registry_folders() -> list[Any]:
    registry = importlib.import_module("sfumato.techniques.registry")
    return [importlib.import_module(f"sfumato.techniques.{name}") for name in registry.FOLDERS]


def test_unknown_technique_is_refused_with_the_known_ones() -> None:
    with pytest.raises(SceneError, match="multidirectional"):
        Scene(technique="no-such")
    with pytest.raises(SceneError, match="one of"):
        params_from_json({"id": 7})

    @dataclasses.dataclass(frozen=True)
    class Stranger(sfumato.scene.TechniqueParams):
        pass

    with pytest.raises(SceneError):
        Scene(technique=Stranger())
