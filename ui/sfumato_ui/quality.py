"""How far a still picture is refined; the choice is the user's, not the scene's, and persists."""

from __future__ import annotations

from dataclasses import dataclass

from .jobs import STILL_FRAMES
from .settings import settings

_KEY = "view/quality"


@dataclass(frozen=True)
class PictureQuality:
    """A name and the jittered frames that a still picture accumulates."""

    title: str
    frames: int


DRAFT = PictureQuality("Draft", 2)
NORMAL = PictureQuality("Normal", STILL_FRAMES)
QUALITIES = (DRAFT, NORMAL, PictureQuality("Fine", 32))


def chosen_quality() -> PictureQuality:
    """Return the quality that was chosen last."""
    title = str(settings().value(_KEY, NORMAL.title))
    return next((quality for quality in QUALITIES if quality.title == title), NORMAL)


def remember_quality(quality: PictureQuality) -> None:
    """Keep a quality for the next start."""
    settings().setValue(_KEY, quality.title)
