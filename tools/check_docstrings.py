"""Docstrings of the public names, judged by numpydoc's validator: `python -m tools.check_docstrings
[PART ...]` takes the names that contain one of the parts, without one all.
"""

from __future__ import annotations

import enum
import inspect
import sys
from collections.abc import Sequence
from typing import NamedTuple

from numpydoc.docscrape import NumpyDocString
from numpydoc.validate import validate

from . import docs_names

# Codes of the validator that are not asked for, each with the reason.
WAIVED = {
    "GL01": "a docstring begins beside its quotes",
    "ES01": "a summary may be all there is to say",
    "SS05": "a summary is a noun phrase, or a verb in the third person",
    "SA01": "links stand where they are needed",
    "EX01": "a number of examples is asked for, not one of each name",
    "RT02": "a result has a name, as in SciPy",
}
PARAMETERS = {"PR01", "PR02", "PR03"}  # of a class: the fields of a result stand under Attributes
OVERRIDING = {"PR01", "RT01"}  # of a method: the one that it overrides says these


class Fault(NamedTuple):
    """A fault of the docstring of a public name: the validator's code, and what it says."""

    name: str
    code: str
    text: str

    def __str__(self) -> str:
        return f"{self.name}: {self.code} {self.text}"


def faults(name: str) -> list[Fault]:
    """Faults of the docstring of a public name, such as `poekin.Chain.fk`."""
    thing = docs_names.resolved(name)
    of_class = inspect.isclass(thing)
    waived = set(WAIVED)
    if of_class:
        waived |= PARAMETERS
    elif overrides(name):
        waived |= OVERRIDING
    where = name
    if name in sys.modules and inspect.isfunction(thing):  # numpydoc would take the module
        where = f"{thing.__module__}.{thing.__name__}"
    found = [Fault(name, *error) for error in validate(where)["errors"] if error[0] not in waived]
    if of_class and not issubclass(thing, (BaseException, enum.Enum)):
        found += [Fault(name, "PR01", f"field {field!r} not documented") for field in untold(thing)]
    return found


def overrides(name: str) -> bool:
    """Whether a public name is a method that overrides one of a base of the package."""
    owner, _, method = name.rpartition(".")
    above = docs_names.resolved(owner)
    bases = above.__mro__[1:] if inspect.isclass(above) else ()
    return any(docs_names.own(base) and method in vars(base) for base in bases)


def untold(owner: type) -> list[str]:
    """Parameters of a class that stand neither under Parameters nor under Attributes."""
    document = NumpyDocString(inspect.getdoc(owner) or "")
    sections = ("Parameters", "Other Parameters", "Attributes")
    told = {name for s in sections for entry in document[s] for name in entry.name.split(", ")}
    try:
        signature = inspect.signature(owner)
    except ValueError:
        return []
    return [name for name in signature.parameters if name.lstrip("*") not in told]


def main(parts: Sequence[str]) -> int:
    """Print the faults of the public names; 1 where there are any."""
    names = [n for n in docs_names.documented() if not parts or any(p in n for p in parts)]
    found = [fault for name in names for fault in faults(name)]
    for fault in found:
        print(fault)
    print(f"{len(found)} faults in {len(names)} docstrings")
    return int(bool(found) or not names)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
