"""Files that are there whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..errors import SfumatoError


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a name to write to; after the block it takes the target's place, or goes if the block fails.

    Raises
    ------
    SfumatoError
        If the file cannot be written.
    """
    target = Path(path)
    # The suffix stays last: writers choose the format by it.
    part = target.with_name(f".{target.stem}.{os.getpid()}.part{target.suffix}")
    try:
        yield part
        part.replace(target)
    except OSError as error:
        raise SfumatoError(f"{target}: the picture could not be written: {error.strerror or error}") from None
    finally:
        part.unlink(missing_ok=True)
