"""Input number i of a reader: random bytes, a document out of nothing, or a mutated one; always the
same.
"""

from __future__ import annotations

import hashlib
import random

from .draw import Draw
from .mutate import LARGEST, encoded, mutated
from .readers import Reader

ODDS = (0.0, 0.01, 0.03, 0.2)
"""How probable an odd value is: one of these in each document."""


def make(reader: Reader, seed: int, index: int) -> bytes:
    """Input number `index` of a reader, of at most `LARGEST` bytes."""
    key = hashlib.blake2b(f"{seed}/{reader.name}/{index}".encode(), digest_size=8).digest()
    d = Draw(random.Random(int.from_bytes(key, "little")))
    kind = d.source.random()
    if kind < 0.02:
        return d.source.randbytes(d.below(d.pick((4, 64, 2000))))
    if kind < 0.15 and reader.seeds():
        return mutated(d, d.pick(reader.seeds()), reader.seeds())
    d.odd = d.pick(ODDS)
    made = reader.grammar(d)
    data = (encoded(made) if isinstance(made, str) else made)[:LARGEST]
    return data if kind < 0.55 else mutated(d, data, reader.seeds())
