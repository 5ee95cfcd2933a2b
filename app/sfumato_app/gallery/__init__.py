"""``sfumato gallery``: the figures of Soltesova2010, made again with our samples, and the README's picture.

::

    figure    what a figure and its panels are
    setting   cameras and lamps that the figures share
    staging   a cloth behind a sample, for shadows to fall on
    figures/  the figures as data, one module a subject
    sheet     a figure to a picture
    page      the page of the docs
    hero      the README's picture
    command   the command line

Everything shown comes from ``sample_volumes``: whoever has the program can draw the page.
"""

from .command import main

__all__ = ["main"]
