"""Interleaved measurement: each contender has its turn in every round; what disturbs one disturbs all.

CPU time is that of all threads of this process: a software renderer's workers and VTK's are among them.
"""

from __future__ import annotations

import gc
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from .contender import Contender, Unavailable
from .rows import Row, Stage

#: A turn lasts at least this long, by as many frames as that takes: clocks are too coarse for a GPU's frames.
TURN_SECONDS = 0.1
MAX_FRAMES = 50


@dataclass
class Result:
    """One row's measurements.

    Attributes
    ----------
    frames : int
        Frames a turn.
    cpu, wall : list of float
        Milliseconds a frame, one entry a round.
    missing : str
        Why there are none; empty if there are.
    picture : ndarray or None
        Its picture in linear light, float32 (height, width, 3).
    """

    row: Row
    frames: int = 0
    cpu: list[float] = field(default_factory=list)
    wall: list[float] = field(default_factory=list)
    missing: str = ""
    picture: np.ndarray | None = None


@dataclass(frozen=True)
class Spread:
    """Median and quartiles."""

    median: float
    q1: float
    q3: float

    @staticmethod
    def of(values: Sequence[float]) -> Spread:
        """Return the spread of at least one number."""
        q1, median, q3 = (float(q) for q in np.percentile(np.asarray(values, dtype=float), (25, 50, 75)))
        return Spread(median, q1, q3)


def warm_up(
    rows: Sequence[Row], stage: Stage, tell: Callable[[str], None]
) -> list[tuple[Result, Contender | None]]:
    """Make all contenders and let each draw: shaders are compiled, volumes uploaded, pictures kept."""
    lineup: list[tuple[Result, Contender | None]] = []
    for row in rows:
        result, contender = Result(row), None
        try:
            tell(f"warming up {row.id}")
            contender = row.make(stage, row.setting)
            result.picture = contender.light()
            result.frames = _frames_a_turn(contender)
        except Unavailable as reason:
            result.missing = str(reason)
        lineup.append((result, contender))
    return lineup


def _frames_a_turn(contender: Contender) -> int:
    started = time.perf_counter()
    contender.draw()
    seconds = time.perf_counter() - started
    return max(1, min(MAX_FRAMES, math.ceil(TURN_SECONDS / max(seconds, 1e-6))))


def run(lineup: Sequence[tuple[Result, Contender | None]], rounds: int, tell: Callable[[str], None]) -> None:
    """Let every contender have its turn in each round, in turning order, and note its times."""
    taking_part = [(result, contender) for result, contender in lineup if contender is not None]
    gc.collect()
    gc.disable()
    try:
        for number in range(rounds):
            tell(f"round {number + 1} of {rounds}")
            for result, contender in taking_part[:: 1 if number % 2 == 0 else -1]:
                _turn(result, contender)
    finally:
        gc.enable()


def _turn(result: Result, contender: Contender) -> None:
    contender.settle()
    cpu, wall = time.process_time(), time.perf_counter()
    for _ in range(result.frames):
        contender.draw()
    result.cpu.append((time.process_time() - cpu) * 1000 / result.frames)
    result.wall.append((time.perf_counter() - wall) * 1000 / result.frames)
