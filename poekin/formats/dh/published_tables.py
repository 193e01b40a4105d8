"""Published DH tables that come with poekin, each with its source, tool and zero position."""

from __future__ import annotations

import pkgutil

from ...errors import UnknownName, quote, suggest
from . import table_io
from .table import Table

CATALOGUE = "poekin.formats.catalogue"
NAMES = (
    *("cobra600", "iiwa14", "irb140", "jaco", "kr5", "panda", "puma560", "stanford"),
    *("ur10", "ur10e", "ur16e", "ur3", "ur3e", "ur5", "ur5e"),
)
"""The arms whose tables come with poekin."""


def published(name: str) -> Table:
    """Published Denavit-Hartenberg table of an arm; its source stands at the top of its file.

    Parameters
    ----------
    name : str
        One of cobra600, iiwa14, irb140, jaco, kr5, panda, puma560, stanford, ur10, ur10e, ur16e,
        ur3, ur3e, ur5 and ur5e.

    Returns
    -------
    table : Table
        The table as published, rad and m.

    Raises
    ------
    UnknownName
        If there is no such table, with the closest names.

    Notes
    -----
    Accuracy: as published. Source: the one in the file.

    Examples
    --------
    >>> import poekin as pk
    >>> table = pk.dh.published("puma560")
    >>> table.convention
    'standard'
    >>> table.a.tolist()
    [0.0, 0.4318, 0.0203, 0.0, 0.0, 0.0]
    """
    if name not in NAMES:
        raise UnknownName(f"no published table is named {quote(name)}; {suggest(str(name), NAMES)}")
    data = pkgutil.get_data(CATALOGUE, f"{name}.toml") or b""
    return table_io.read_text(data.decode("utf-8"), f"catalogue/{name}.toml")
