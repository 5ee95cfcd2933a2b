"""What a figure is: panels side by side, each a scene or a cut through a volume."""

from __future__ import annotations

from dataclasses import dataclass

from sfumato import Scene, Volume

#: The paper whose figures go by their numbers alone.
FIRST = "Soltesova2010"
#: Jittered frames of a finished panel.
FRAMES = 8
#: Linear colour behind the subjects: a cool grey, darker than ivory in the light, lighter than any shadow.
PAPER = (0.47, 0.49, 0.51, 1.0)


@dataclass(frozen=True)
class Cuts:
    """Grey cuts through a volume, as a scanner's own screen shows them.

    Parameters
    ----------
    volume : Volume
        What is cut; across its three array axes.
    at : (x, y, z)
        Where, in fractions of the array's sides.
    window : (low, high)
        Values shown as black and as white.
    """

    volume: Volume
    at: tuple[float, float, float]
    window: tuple[float, float]


@dataclass(frozen=True)
class Difference:
    """How far one scene's picture is from another's, as grey.

    Parameters
    ----------
    scene, truth : Scene
        What is compared, and with what.
    white : float
        Distance in CIELAB that is drawn white.
    """

    scene: Scene
    truth: Scene
    white: float = 10.0


@dataclass(frozen=True)
class Explicit:
    """A scene of `extinction` whose light from all around is found by a look at each cell around each cell."""

    scene: Scene


@dataclass(frozen=True)
class Panel:
    """One picture of a figure.

    Parameters
    ----------
    label : str
        The letter below it.
    picture : Scene, Cuts, Difference or Explicit
        What it shows.
    note : str
        How it was made, a few words.
    """

    label: str
    picture: Scene | Cuts | Difference | Explicit
    note: str


@dataclass(frozen=True)
class Figure:
    """One figure of a paper, made again.

    Parameters
    ----------
    number : int
        Its number in the paper.
    title : str
        A few words.
    caption : str
        What is compared, and what to look for.
    panels : tuple of Panel
        From left to right, row by row.
    size : (width, height)
        Of a finished panel in pixels.
    paper : str
        Key of the paper.
    columns : int
        Panels of a row; 0: all.
    """

    number: int
    title: str
    caption: str
    panels: tuple[Panel, ...]
    size: tuple[int, int] = (480, 480)
    paper: str = FIRST
    columns: int = 0

    @property
    def file_name(self) -> str:
        """Name of the picture file."""
        return file_name(self.id)

    @property
    def id(self) -> str:
        """What ``--only`` calls it: its number, after the paper's key if it is not the first paper's."""
        return str(self.number) if self.paper == FIRST else f"{self.paper.lower()}-{self.number}"


def file_name(figure: int | str) -> str:
    """Return the name of a figure's picture file, by its `Figure.id`."""
    paper, _, number = str(figure).rpartition("-")
    return f"{paper + '-' if paper else ''}fig{int(number):02d}.png"


def panels(*parts: tuple[Scene | Cuts | Difference | Explicit, str]) -> tuple[Panel, ...]:
    """Letter pictures with notes from (a)."""
    return tuple(Panel(chr(ord("a") + k), picture, note) for k, (picture, note) in enumerate(parts))
