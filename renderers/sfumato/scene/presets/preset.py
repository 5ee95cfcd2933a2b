"""One preset."""

from __future__ import annotations

from dataclasses import dataclass

from ..transfer import TransferFunction


@dataclass(frozen=True)
class Preset:
    """A transfer function with a name, made for a volume's values.

    Attributes
    ----------
    name : str
        What lists and the command line call it.
    transfer : TransferFunction
        With values in the volume's own scale.
    description : str
        One line for tooltips.
    modality : str
        ``CT``, ``MR``, ``US``, or empty for any values.
    """

    name: str
    transfer: TransferFunction
    description: str
    modality: str
