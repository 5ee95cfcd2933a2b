"""The composition root: command line, settings, the window's start."""
