"""Denavit-Hartenberg tables, standard (Paul) and modified (Craig): to screws and back, and as files."""

from .from_chain import FromChain, from_chain
from .published_tables import published
from .table import Convention, Row, Table
from .table_io import read, write
from .to_chain import to_chain, to_robot

__all__ = [
    "Convention",
    "FromChain",
    "Row",
    "Table",
    "from_chain",
    "published",
    "read",
    "to_chain",
    "to_robot",
    "write",
]
