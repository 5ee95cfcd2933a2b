"""Parameters declared once: checks, canonical values, JSON."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sfumato import SceneError
from sfumato.scene.params import Param, check, coerce, fields_of, from_json, to_json


@dataclass(frozen=True)
class Inner:
    name: str = "x"
    size: Annotated[float, Param("Size", unit="mm", gt=0, le=10)] = 1.0

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class Outer:
    count: Annotated[int, Param("Count", ge=0, lt=5)] = 1
    place: tuple[float, float] = (0.0, 0.0)
    kind: Annotated[str, Param("Kind", choices=("a", "b"))] = "a"
    limit: Annotated[float | None, Param("Limit", ge=0)] = None
    inner: Inner = Inner()
    many: tuple[Inner, ...] = ()
    on: bool = False

    def __post_init__(self) -> None:
        check(self)


@given(st.floats(allow_nan=True, allow_infinity=True))
@settings(max_examples=60, deadline=None)
def test_a_number_is_taken_exactly_when_its_range_admits_it(value: float) -> None:
    fits = math.isfinite(value) and 0 < value <= 10
    assert Param("Size", gt=0, le=10).admits(value) == fits
    if fits:
        assert Inner(size=value).size == value
    else:
        with pytest.raises(SceneError) as caught:
            Inner(size=value)
        assert caught.value.path == "size"
        assert "> 0 mm and <= 10 mm" in str(caught.value)


@pytest.mark.parametrize("value", ["1", None, True, [1.0], {}, object(), 1j])
def test_what_is_no_number_is_refused(value: Any) -> None:
    with pytest.raises(SceneError, match="size"):
        Inner(size=value)


@pytest.mark.parametrize("value", [5, -1, 1.5, True, "2"])
def test_whole_numbers(value: Any) -> None:
    with pytest.raises(SceneError, match="count"):
        Outer(count=value)


def test_values_become_canonical() -> None:
    made = Outer(count=2.0, place=np.array([1, 2]), limit=np.float32(0.5))  # type: ignore[arg-type]
    assert made == Outer(count=2, place=(1.0, 2.0), limit=0.5)
    assert type(made.count) is int
    assert all(type(v) is float for v in made.place)
    assert hash(made) == hash(Outer(count=2, place=(1.0, 2.0), limit=0.5))


@pytest.mark.parametrize("value", [(1,), (1, 2, 3), "12", 7, (1, "2"), (1, math.nan)])
def test_sequences(value: Any) -> None:
    with pytest.raises(SceneError, match="place"):
        Outer(place=value)


@pytest.mark.parametrize(("value", "hint"), [("c", "one of a, b"), (1, "one of a, b")])
def test_choices_are_named(value: Any, hint: str) -> None:
    with pytest.raises(SceneError, match=hint):
        Outer(kind=value)


@given(
    st.builds(
        Outer,
        count=st.integers(0, 4),
        place=st.tuples(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6)),
        kind=st.sampled_from("ab"),
        limit=st.none() | st.floats(0, 1e9),
        many=st.lists(st.builds(Inner, name=st.text(max_size=5), size=st.floats(0.1, 10)), max_size=3).map(
            tuple
        ),
        on=st.booleans(),
    )
)
@settings(max_examples=20, deadline=None)
def test_json_round_trip(value: Outer) -> None:
    assert from_json(Outer, json.loads(json.dumps(to_json(value)))) == value


@pytest.mark.parametrize(
    ("data", "path"),
    [
        ({"nothing": 1}, "nothing"),
        ({"inner": {"size": -1}}, "inner.size"),
        ({"inner": 3}, "inner"),
        ({"many": [{}, {"size": 11}]}, "many.1.size"),
        ({"many": [{}, {"colour": 11}]}, "many.1.colour"),
        ({"place": [1, 2, 3]}, "place"),
        ({"on": 1}, "on"),
        ([], "Outer"),
    ],
)
def test_errors_name_the_full_path(data: Any, path: str) -> None:
    with pytest.raises(SceneError) as caught:
        from_json(Outer, data)
    assert caught.value.path == path
    assert "\n" not in str(caught.value)


def test_fields_are_resolved() -> None:
    fields = fields_of(Outer)
    assert list(fields) == ["count", "place", "kind", "limit", "inner", "many", "on"]
    assert fields["count"].param is not None
    assert fields["count"].param.allowed() == "allowed: >= 0 and < 5"
    assert fields["place"].param is None
    assert coerce(None, fields["limit"].type, "limit") is None


def test_long_values_are_shortened() -> None:
    with pytest.raises(SceneError) as caught:
        Outer(kind="x" * 5000)
    assert len(str(caught.value)) < 200
