"""A parameter is declared once, beside its field.

``Annotated[float, Param("Half angle of the cone", unit="deg", ge=1, le=80)] = 20.0`` is the whole
declaration: its slider, command-line flag, JSON field, check, tooltip and row in the manual are made
from it. This module reads such declarations, checks values against them and turns frozen dataclasses
into JSON data and back.
"""

from __future__ import annotations

import dataclasses
import functools
import math
import types
import typing
from dataclasses import dataclass
from typing import Any, Literal, TypeVar, Union

from ..errors import SceneError

Stale = Literal["frame", "light", "kernel", "program", "nothing"]
T = TypeVar("T")


@dataclass(frozen=True)
class Param:
    """What there is to say about one parameter.

    Parameters
    ----------
    meaning : str
        One line for people: tooltip and manual.
    label : str
        Short name shown beside the control; the field's name if empty.
    unit : str
        ``"deg"``, ``"mm"``, ``"voxel"``, … or nothing.
    ge, le, gt, lt : float, optional
        Allowed range, inclusive and exclusive bounds.
    soft : (float, float), optional
        Range of a slider where it is narrower than the allowed one.
    choices : tuple of str
        The allowed words, for text fields.
    source : str
        Paper and equation, by the key in ``references.bib``.
    stale : str
        What a change makes stale: the whole ``frame``, the ``light`` volume, the ``kernel``, the ``program``.
    tab : str
        Where its control lives in the window: ``light``, ``material``, ``view`` or nowhere.
    level : str
        ``essential`` or ``more``.
    none_label : str
        What no value means, where a parameter may have none: ``"automatic"``, ``"from lamp"``.
    """

    meaning: str
    label: str = ""
    unit: str = ""
    ge: float | None = None
    le: float | None = None
    gt: float | None = None
    lt: float | None = None
    soft: tuple[float, float] | None = None
    choices: tuple[str, ...] = ()
    source: str = ""
    stale: Stale = "frame"
    tab: str = ""
    level: Literal["essential", "more"] = "essential"
    none_label: str = ""

    def allowed(self) -> str:
        """Return the allowed values in words."""
        if self.choices:
            return "one of " + ", ".join(self.choices)
        low = f">= {self.ge:g}" if self.ge is not None else f"> {self.gt:g}" if self.gt is not None else ""
        high = f"<= {self.le:g}" if self.le is not None else f"< {self.lt:g}" if self.lt is not None else ""
        unit = f" {self.unit}" if self.unit else ""
        return "allowed: " + (" and ".join(w + unit for w in (low, high) if w) or "any finite number" + unit)

    def admits(self, value: float) -> bool:
        """Tell whether a number lies in the range; NaN and infinity never do."""
        return (
            math.isfinite(value)
            and (self.ge is None or value >= self.ge)
            and (self.le is None or value <= self.le)
            and (self.gt is None or value > self.gt)
            and (self.lt is None or value < self.lt)
        )


@dataclass(frozen=True)
class Field:
    """A dataclass field with its resolved type and its declaration, if it has one."""

    name: str
    type: Any
    param: Param | None
    default: Any

    @property
    def optional(self) -> bool:
        """Whether it may have no value."""
        return _is_union(self.type) and type(None) in typing.get_args(self.type)

    @property
    def kind(self) -> Any:
        """The type that a value has, if there is one."""
        if not self.optional:
            return self.type
        return next(k for k in typing.get_args(self.type) if k is not type(None))


def fields_of(cls: type) -> dict[str, Field]:
    """Return the fields of a frozen dataclass by name, with the parameters declared on them."""
    return _fields_of(cls)


@functools.cache
def _fields_of(cls: type) -> dict[str, Field]:
    hints = typing.get_type_hints(cls, include_extras=True)
    found: dict[str, Field] = {}
    for field in dataclasses.fields(cls):
        hint, param = hints[field.name], None
        if typing.get_origin(hint) is typing.Annotated:
            hint, *extras = typing.get_args(hint)
            param = next((e for e in extras if isinstance(e, Param)), None)
        default = field.default if field.default is not dataclasses.MISSING else None
        found[field.name] = Field(field.name, hint, param, default)
    return found


def _is_union(hint: Any) -> bool:
    return typing.get_origin(hint) in (Union, types.UnionType)


def _coerce_number(value: Any, kind: type, path: str, param: Param | None) -> Any:
    allowed = param.allowed() if param else "allowed: a finite number"
    if isinstance(value, bool) or not hasattr(value, "__float__") or isinstance(value, str):
        raise SceneError(path, value, allowed)
    number = float(value)
    if not (param.admits(number) if param else math.isfinite(number)):
        raise SceneError(path, value, allowed)
    if kind is int:
        if number != int(number):
            raise SceneError(path, value, "allowed: a whole number")
        return int(number)
    return number


def _coerce_tuple(value: Any, hint: Any, path: str, param: Param | None) -> tuple[Any, ...]:
    args = typing.get_args(hint)
    if isinstance(value, str | bytes | dict) or not hasattr(value, "__iter__"):
        raise SceneError(path, value, "a sequence is needed here")
    items = list(value)
    if len(args) == 2 and args[1] is Ellipsis:
        kinds = [args[0]] * len(items)
    else:
        kinds = list(args)
        if len(items) != len(kinds):
            raise SceneError(path, value, f"exactly {len(kinds)} values are needed here")
    return tuple(
        coerce(v, k, f"{path}.{i}", param) for i, (v, k) in enumerate(zip(items, kinds, strict=True))
    )


def coerce(value: Any, hint: Any, path: str, param: Param | None = None) -> Any:
    """Check a value against a field's type and declaration and return it in canonical form.

    Raises
    ------
    SceneError
        Naming the path, the value and what is allowed.
    """
    if _is_union(hint):
        return _coerce_union(value, hint, path, param)
    origin = typing.get_origin(hint)
    if hint is Any:
        return value
    if origin is Literal:
        if value not in typing.get_args(hint):
            raise SceneError(path, value, "one of " + ", ".join(map(str, typing.get_args(hint))))
        return value
    if origin is tuple:
        return _coerce_tuple(value, hint, path, param)
    if hint is bool:
        if not isinstance(value, bool):
            raise SceneError(path, value, "true or false")
        return value
    if hint in (int, float):
        return _coerce_number(value, hint, path, param)
    if hint is str:
        if not isinstance(value, str) or (param and param.choices and value not in param.choices):
            raise SceneError(path, value, param.allowed() if param else "a text is needed here")
        return value
    if isinstance(hint, type) and not isinstance(value, hint):
        raise SceneError(path, value, f"a {hint.__name__} is needed here")
    return value


def _coerce_union(value: Any, hint: Any, path: str, param: Param | None) -> Any:
    kinds = typing.get_args(hint)
    if value is None and type(None) in kinds:
        return None
    rest = [k for k in kinds if k is not type(None)]
    for kind in rest:
        if isinstance(kind, type) and dataclasses.is_dataclass(kind) and isinstance(value, kind):
            return value
    try:
        return coerce(value, rest[0], path, param)
    except SceneError as error:
        if param is None or type(None) not in kinds:
            raise
        meaning = f" ({param.none_label})" if param.none_label else ""
        raise SceneError(error.path, error.value, f"{error.allowed}, or none{meaning}") from None


def check(instance: Any, path: str = "") -> None:
    """Check every field of a frozen dataclass in its ``__post_init__`` and store canonical values."""
    for name, field in fields_of(type(instance)).items():
        where = f"{path}.{name}" if path else name
        value = coerce(getattr(instance, name), field.type, where, field.param)
        object.__setattr__(instance, name, value)


def to_json(value: Any) -> Any:
    """Turn a frozen dataclass tree into plain JSON data; fields at their default are kept (a scene is explicit)."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {f.name: to_json(getattr(value, f.name)) for f in dataclasses.fields(value)}
    if isinstance(value, tuple | list):
        return [to_json(v) for v in value]
    return value


def from_json(cls: type[T], data: Any, path: str = "") -> T:
    """Build a frozen dataclass from JSON data; unknown names are refused, missing ones take the default.

    Raises
    ------
    SceneError
        With the full path of the offending field.
    """
    if not isinstance(data, dict):
        raise SceneError(path or cls.__name__, data, "an object is needed here")
    known = fields_of(cls)
    prefix = f"{path}." if path else ""
    for name in data:
        if name not in known:
            raise SceneError(prefix + str(name), data[name], "unknown field; known: " + ", ".join(known))
    values = {n: _value_from_json(known[n].type, v, prefix + n) for n, v in data.items()}
    try:
        return cls(**values)
    except SceneError as error:
        raise SceneError(prefix + error.path, error.value, error.allowed) from None
    except TypeError as error:
        raise SceneError(path or cls.__name__, data, str(error)) from None


def _value_from_json(hint: Any, value: Any, path: str) -> Any:
    if value is None:
        return None
    if _is_union(hint):
        hint = next((k for k in typing.get_args(hint) if k is not type(None)), hint)
    if isinstance(hint, type) and dataclasses.is_dataclass(hint):
        return from_json(hint, value, path)
    if typing.get_origin(hint) is tuple and isinstance(value, list):
        args = typing.get_args(hint)
        kinds = [args[0]] * len(value) if len(args) == 2 and args[1] is Ellipsis else list(args)
        if len(kinds) != len(value):
            raise SceneError(path, value, f"exactly {len(kinds)} values are needed here")
        return tuple(
            _value_from_json(k, v, f"{path}.{i}") for i, (k, v) in enumerate(zip(kinds, value, strict=True))
        )
    return value
