"""exp and log as each library's users type them: poekin, and the peers of `benchmarks.peers` that
are installed.

The functions of SE(3) are the peer's own adapter. Those of SO(3) are `TEXTS`, run as they
stand; and the texts are what is printed beside a bad result, for anybody to paste. In them x is a
rotation vector (3,), a twist (6,) with the angular part first, or a matrix (3, 3) or (4, 4): where
a library documents its twists linear part first, the text swaps the halves.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..peers import Found, Peer, attempt, chosen
from ..subjects.exp_log_texts import TEXTS

Function = Callable[[np.ndarray], Any]


@dataclass(frozen=True)
class Library:
    """What is judged: a name, its version, its functions by name (of `accuracy_judge.FUNCTIONS`).

    problem says in one line why there are none.
    """

    name: str
    version: str = ""
    functions: Mapping[str, Function] = field(default_factory=dict)
    problem: str = ""


def poekin() -> Library:
    """poekin itself, called by its text."""
    from poekin import __version__

    return Library(
        "poekin", __version__, {name: _function("poekin", name) for name in TEXTS["poekin"][1]}
    )


def peers(found: Iterable[Found] | None = None) -> list[Library]:
    """The peers of this run (or others) that have exp and log of poses, present or not."""
    return [_library(f) for f in (chosen() if found is None else found) if f.peer.group is not None]


def typed(name: str, function: str, argument: np.ndarray) -> str:
    """A library's call as one line of Python: imports, the argument to its last digit, the call; ""
    if unknown.
    """
    if name not in TEXTS:
        return ""
    before, calls = TEXTS[name]
    shown = f"print(np.asarray({calls[function]}).tolist())"
    return f"import numpy as np; {before}; x = np.array({argument.tolist()!r}); {shown}"


def replayed(name: str, function: str, argument: np.ndarray) -> np.ndarray | None:
    """What the text returns, to be held against what the adapter returned; None if there is no
    text.
    """
    return np.asarray(_function(name, function)(argument.copy())) if name in TEXTS else None


def _library(found: Found) -> Library:
    peer = found.peer
    if found.problem:
        return Library(peer.name, peer.version, problem=found.problem)
    functions, problem = attempt(lambda: _functions(peer))
    return Library(peer.name, peer.version, functions or {}, problem)


def _functions(peer: Peer) -> dict[str, Function]:
    group = peer.group() if peer.group else None
    functions = {"exp_se3": _one(group.exp_of), "log_se3": _one(group.log_of)} if group else {}
    texts = ("exp_so3", "log_so3") if peer.name in TEXTS else ()
    return functions | {name: _function(peer.name, name) for name in texts}


def _one(many: Callable[[np.ndarray], np.ndarray]) -> Function:
    return lambda x: many(x[None])[0]


def _function(name: str, function: str) -> Function:
    """The text as a function: what is printed is what was run."""
    before, calls = TEXTS[name]
    names: dict[str, Any] = {"np": np}
    # Constants of this repository, no input of anybody's.
    exec(before, names)
    return eval(f"lambda x: {calls[function]}", names)
