"""What the window remembers between sessions; tests point it to a temporary folder."""

from __future__ import annotations

import os

from qtpy.QtCore import QSettings


def settings() -> QSettings:
    """Return the settings: an INI file in the user's configuration folder, or in ``SFUMATO_SETTINGS``."""
    folder = os.environ.get("SFUMATO_SETTINGS")
    if folder:
        return QSettings(os.path.join(folder, "sfumato.ini"), QSettings.Format.IniFormat)
    return QSettings(QSettings.Format.IniFormat, QSettings.Scope.UserScope, "sfumato", "sfumato")
