"""The window of Sfumato (Qt through qtpy)."""
