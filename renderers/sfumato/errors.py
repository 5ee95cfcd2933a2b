"""The errors of the public interface: on bad input nothing else leaves it."""

from __future__ import annotations


class SfumatoError(Exception):
    """Base of all errors that Sfumato raises on purpose; ``str(error)`` is one readable line."""


class LoadError(SfumatoError):
    """A file or folder could not be read.

    Parameters
    ----------
    path : object
        The file or folder.
    problem : str
        What is wrong with it.
    remedy : str
        What the user can do about it.
    """

    def __init__(self, path: object, problem: str, remedy: str = "") -> None:
        self.path = str(path)
        self.problem = problem
        self.remedy = remedy
        super().__init__(f"{self.path}: {problem}" + (f"; {remedy}" if remedy else ""))


class SceneError(SfumatoError):
    """A field of the scene holds a value that it may not hold.

    Parameters
    ----------
    path : str
        The field's path in the scene, for example ``lights.0.tilt``.
    value : object
        The offending value.
    allowed : str
        What is allowed there.
    """

    def __init__(self, path: str, value: object, allowed: str) -> None:
        self.path = path
        self.value = value
        self.allowed = allowed
        shown = repr(value)
        if len(shown) > 80:
            shown = shown[:77] + "..."
        super().__init__(f"{path}: {shown} is not allowed; {allowed}")


class GpuError(SfumatoError):
    """The graphics device cannot do what was asked.

    Parameters
    ----------
    asked : str
        What was asked of the device.
    offers : str
        What the device offers, or what it answered.
    remedy : str
        What would help: ``smaller picture``, ``smaller volume``, ``other technique`` (its shader does not
        compile), ``new renderer`` (the context is lost), or empty.
    """

    def __init__(self, asked: str, offers: str = "", remedy: str = "") -> None:
        self.asked = asked
        self.remedy = remedy
        self.offers = offers
        super().__init__(asked + (f"; {offers}" if offers else ""))
