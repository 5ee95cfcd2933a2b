"""``sfumato walkthrough``: the real window, used by real mouse and key events, and a screenshot of each step.

::

    hand      what a user does: press, drag, type, wait, look
    steps     the walk, one function a step
    crash     a window that dies with unsaved work, for the last step
    command   the command line

The pictures of docs/window.md are chosen from these; the walk is also a test of the whole window.
"""

from .command import main

__all__ = ["main"]
