"""What can go wrong before anything is drawn."""

from __future__ import annotations


class UsageError(Exception):
    """The command line asks for something in the wrong way (exit status 2)."""
