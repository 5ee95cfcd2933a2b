"""What is measured: techniques with their parameters, at one quality."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

from sfumato import Quality, Scene
from sfumato.techniques import frame, techniques

from ..errors import UsageError
from .trials import Trial

#: Techniques that are measured if none is named, as far as there are such: ours first, the published one last.
PREFERRED = ("cone", "multidirectional", "directional")
#: Lit from the eye whatever the lamp's tilt: takes part where the tilt is 0 alone.
HEADLAMP = ("directional",)


@dataclass(frozen=True)
class Contestant:
    """A technique with some parameters, at one quality.

    Parameters
    ----------
    technique : str
        Its id.
    changes : dict
        Parameters that differ from the defaults.
    quality : Quality
        How much is spent on a frame.
    quality_name : str
        As it was asked for.
    """

    technique: str
    changes: dict[str, Any] = field(default_factory=dict, hash=False)
    quality: Quality = field(default_factory=Quality, hash=False)
    quality_name: str = "full"

    @property
    def id(self) -> str:
        """Technique and parameters as on the command line."""
        return ":".join([self.technique, *(f"{k}={v}" for k, v in self.changes.items())])

    def takes_part(self, trial: Trial) -> bool:
        """Tell whether it knows light as a scene has it."""
        return self.technique not in HEADLAMP or all(light.tilt == 0 for light in trial.lights)

    def scene(self, scene: Scene) -> Scene:
        """Return a scene with this technique."""
        return scene.with_(technique=self.technique).with_(
            {f"technique.{name}": value for name, value in self.changes.items()}
        )


def contestants(names: str, qualities: str) -> tuple[Contestant, ...]:
    """Return the contestants that a command line names, each technique at each quality.

    Parameters
    ----------
    names : str
        As in ``cone,cone:directions=16,multidirectional``; empty: `PREFERRED`.
    qualities : str
        ``full``, ``drag``, or fields as in ``step=2:light=2``; several with commas between them.

    Raises
    ------
    UsageError
        If there is no such technique or quality.
    """
    known = techniques()
    words = names.split(",") if names else [name for name in PREFERRED if name in known]
    made = []
    for word in words:
        technique, *settings = word.strip().split(":")
        if technique not in known:
            raise UsageError(f"--techniques: there is no {technique}; known: {', '.join(known)}")
        changes = dict(_setting(text) for text in settings)
        made += [Contestant(technique, changes, quality_of(q), q) for q in qualities.split(",")]
    return tuple(made)


def quality_of(text: str) -> Quality:
    """Return a quality by its name or its fields.

    Raises
    ------
    UsageError
        If there is no such quality.
    """
    named = getattr(frame, text.upper(), None)
    if isinstance(named, Quality):
        return named
    names: Sequence[str] = [f.name for f in fields(Quality)]
    settings = dict(_setting(part) for part in text.split(":"))
    if not set(settings) <= set(names):
        raise UsageError(f"--quality {text}: full, drag, or {', '.join(names)} as in step=2:light=2")
    return replace(Quality(), **settings)


def _setting(text: str) -> tuple[str, Any]:
    name, equals, value = text.partition("=")
    if not equals:
        raise UsageError(f"{text}: NAME=VALUE is needed")
    try:
        return name, json.loads(value)
    except ValueError:
        return name, value
