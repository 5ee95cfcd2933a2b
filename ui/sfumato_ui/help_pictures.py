"""Small pictures of less and more in the tooltips, drawn once by `sfumato gallery --help-pictures`."""

from __future__ import annotations

import functools
import html
import json
from pathlib import Path

FOLDER = Path(__file__).parent / "assets" / "help"
INDEX = "index.json"
#: Width and height of a picture in widget pixels.
SIZE = (112, 112)


@functools.cache
def kept_index(folder: Path = FOLDER) -> dict[str, list[str]]:
    """Return what stands below the pictures of each key; nothing, if they are not there."""
    try:
        kept = json.loads((folder / INDEX).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return dict(kept)


def pictures_of(key: str) -> str:
    """Return the pictures of a parameter as rich text; nothing, if it has none.

    Parameters
    ----------
    key : str
        ``Light.tilt``, ``Scene.exposure``, ``cone.specular``: class or technique, and field.
    """
    below = kept_index().get(key)
    if below is None:
        return ""
    cells = "".join(
        f'<td align="center"><img src="{(FOLDER / f"{key}-{k}.jpg").as_posix()}" width="{SIZE[0]}" '
        f'height="{SIZE[1]}"><br>{html.escape(text)}</td>'
        for k, text in enumerate(below)
    )
    return f'<table cellspacing="4"><tr>{cells}</tr></table>'


def illustrated(tip: str, key: str) -> str:
    """Return a tooltip with the pictures of a parameter, as rich text if it has any."""
    pictures = pictures_of(key)
    return f"<p>{html.escape(tip, quote=False)}</p>{pictures}" if pictures else tip
