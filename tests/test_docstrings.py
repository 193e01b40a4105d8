"""Every public name says what goes in and comes out: shapes, units, frame, errors, source.

The rule is mechanical. A docstring counts with those that it defers to ("as `fk`"), with its
class's, and for the functions of a public module with the module's. Then, of a function or method:
- it names each of its parameters, and an array with its shape;
- where there are parameters, it says what it returns and what it raises;
- where there are arrays, it has a unit; where there are poses, twists or Jacobians, a frame; and it
  has a source.
A class names its parameters, and what it raises where it checks them. A property has its shape
where it is an array.
"""

from __future__ import annotations

import enum
import inspect
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import pytest

from tools import docs_names

SHAPE = (
    r"\((?:\d+|[a-zA-Z]{1,2})\)"
    r"|\((?:\.\.\.|\*?\w+(?: [-+*] \w+)?)?(?:, ?(?:\.\.\.|\w+(?: [-+*] \w+)?)?)+\)|\(\.\.\.\)"
)
UNIT = r"(?<![\w.])(?:rad|m|mm|deg|s|degrees|metres|radians|seconds|m/s|rad/s|unit|SI)(?![\w(])"
FRAME = r"\b(?:frames?|axes|base|tool|tip)\b|\b[TRV]_[a-z]{1,2}\b"
SPATIAL = r"4, ?4\)|(?:\.\.\.|[nN]), ?6[,)]|\(6,?\)"
OF_THE_BATCH = (
    r"\b[Aa]rrays? (?:over|of) the batch"  # what a class may say of all its fields at once
)
DEFERS = (
    r"(?:\b[Aa]s|\bof|\b[Ss]ee|\bto|\bby)((?:[\s,(]+(?:in|of|and|that|those|what)?\s*`[\w.]+`)+)"
)
NAMED_Q = {"q", "dq", "ddq", "q0", "T", "p", "d", "poses"}  # annotated as Any: a dict will do too
LABELS = {"returns": r"[Rr]eturns", "raises": r"[Rr]aises|errors", "source": r"[Ss]ource"}


@dataclass(frozen=True)
class Name:
    """A public name: what it stands for, and the docstrings that count beside its own."""

    dotted: str
    thing: Any
    around: str
    links: Mapping[str, str]


def doc_of(thing: object) -> str:
    return inspect.getdoc(thing) or ""


def public() -> list[Name]:
    names = []
    for dotted in docs_names.documented():
        thing = docs_names.resolved(dotted)
        above = docs_names.resolved(dotted.rsplit(".", 1)[0])
        of_page = (
            dotted.count(".") == 2 or getattr(above, "__name__", "") in docs_names.testing_modules()
        )
        around = doc_of(above) if inspect.isclass(above) or of_page else ""
        if inspect.isclass(above):
            name = dotted.rsplit(".", 1)[1]
            thing = dict(docs_names.members(above))[name]
            # What overrides a method of a base keeps what that one promises.
            around += "".join(
                "\n" + doc_of(getattr(base, name, None))
                for base in above.__mro__[1:]
                if docs_names.own(base)
            )
        names.append(Name(dotted, thing, around, docs_names.links(dotted)))
    return names


def deferred(text: str, links: Mapping[str, str], seen: frozenset[str] = frozenset()) -> str:
    """The docstrings of all that a docstring sends its readers to: "as `fk` and `jacobian`", "see
    `x`".
    """
    found = ""
    for chain in re.findall(DEFERS, text):
        for word in re.findall(r"`([\w.]+)`", chain):
            dotted = links.get(word)
            if dotted and dotted not in seen:
                inner = doc_of(docs_names.resolved(dotted))
                found += "\n" + inner + deferred(inner, docs_names.links(dotted), seen | {dotted})
    return found


def labelled(text: str, label: str) -> bool:
    """Whether a label stands in the text, alone ("Returns:") or among others ("Raises, accuracy,
    source:").
    """
    heads = re.findall(r"(?:^|[\s.;)])((?:[A-Z]\w+)(?:,? (?:and )?\w+){0,5}):(?=\s)", text)
    underlined = re.findall(r"^(\w+)\n-{3,}", text, re.MULTILINE)
    return any(re.search(rf"\b(?:{LABELS[label]})\b", head) for head in [*heads, *underlined])


def is_array(annotation: object, name: str) -> bool:
    """Arrays as they are annotated here: ArrayLike, Array; or Any, of the names that arrays have."""
    text = (
        annotation
        if isinstance(annotation, str)
        else getattr(annotation, "__name__", str(annotation))
    )
    return "Array" in text or "ndarray" in text or (text == "Any" and name in NAMED_Q)


def faults(name: Name) -> list[str]:
    """What a name's docstring lacks, one line each."""
    own = doc_of(name.thing)
    if not own:
        return [f"{name.dotted}: no docstring"]
    lacking: list[str] = []
    text = f"{own}\n{deferred(own, name.links)}\n{name.around}"
    text = re.sub(
        r"eqs?\. \(\d+\)(?: and \(\d+\))?", "", text
    )  # the number of an equation is no shape
    whole = own if inspect.isclass(name.thing) else text
    is_class = inspect.isclass(name.thing)
    if is_class and issubclass(name.thing, (BaseException, enum.Enum)):
        return []
    try:
        signature = inspect.signature(name.thing)
    except (TypeError, ValueError):
        return [f"{name.dotted}: no signature"]
    parameters = {n: p for n, p in signature.parameters.items() if n not in ("self", "cls")}
    for parameter, about in parameters.items():
        if not re.search(rf"(?<![\w.]){re.escape(parameter)}s?(?!\w)", text):
            lacking.append(f"parameter {parameter}")
        elif is_array(about.annotation, parameter) and not re.search(
            # Its own shape, or one given to several names at once: "q, dq (..., m)".
            rf"(?<![\w.]){re.escape(parameter)}\b[^.;]{{0,60}}?(?:{SHAPE}|shape|number|broadcast)"
            + (f"|{OF_THE_BATCH}" if is_class else ""),
            text,
        ):
            lacking.append(f"shape of {parameter}")
    returned = signature.return_annotation
    gives = not is_class and returned not in ("None", None, inspect.Signature.empty)
    arrays = any(is_array(p.annotation, n) for n, p in parameters.items()) or (
        gives and is_array(returned, "")
    )
    checks = not is_class or any(
        k in vars(name.thing) and getattr(vars(name.thing)[k], "__module__", "").startswith("poekin")
        and (k == "__post_init__" or "__dataclass_fields__" not in vars(name.thing))
        for k in ("__init__", "__post_init__")
    )  # fmt: skip
    if (
        gives
        and (len(parameters) > 1 or (parameters and is_array(returned, "")))
        and not labelled(whole, "returns")
    ):
        lacking.append("returns")
    if gives and is_array(returned, "") and not re.search(SHAPE, text):
        lacking.append("shape of what it returns")
    if parameters and checks and not labelled(whole, "raises"):
        lacking.append("raises")
    bare = re.sub(SHAPE, " ", text)
    if arrays and not re.search(UNIT, bare):
        lacking.append("unit")
    if arrays and re.search(SPATIAL, own) and not re.search(FRAME, text):
        lacking.append("frame")
    if arrays and not is_class and parameters and not labelled(whole, "source"):
        lacking.append("source")
    return [f"{name.dotted}: {what}" for what in lacking]


def test_every_public_name_says_shapes_units_frame_errors_and_source():
    names = public()
    assert len(names) > 400, "hardly anything was checked"
    assert [fault for name in names for fault in faults(name)] == []


def test_every_public_name_is_on_exactly_one_page_of_the_reference():
    listed = [name for _, names in docs_names.PAGES.values() for name in names]
    assert len(listed) == len(set(listed))
    assert set(docs_names.poekin.__all__) <= set(listed)


SOUND = """Pose of the tool.

    Parameters: q (..., m), rad or m. Returns: T (..., 4, 4), in the base frame.
    Raises: ShapeError. Source: Park 1994, eq. (1).
"""


def planted(doc: str | None, code: str = "def f(q: 'ArrayLike') -> 'Array': ...") -> list[str]:
    """The faults of a function or class of that docstring."""
    space: dict = {}
    exec(code, {"__name__": "poekin.planted"}, space)
    (thing,) = space.values()
    thing.__doc__ = doc
    return [
        fault.removeprefix("f: ")
        for fault in faults(Name("f", thing, "", {"fk": "poekin.Chain.fk"}))
    ]


def test_a_sound_docstring_has_no_fault():
    assert planted(SOUND) == []
    assert planted("As `fk`, otherwise written.") == []


PLANTED = {
    "no docstring": (None, "no docstring"),
    "the parameter is not named": (SOUND.replace("q (", "x ("), "parameter q"),
    "no shape": (SOUND.replace("q (..., m)", "q"), "shape of q"),
    "no returns": (SOUND.replace("Returns: ", ""), "returns"),
    "no shape of the result": (
        SOUND.replace("q (..., m)", "q, a number").replace("(..., 4, 4), in", "in"), "shape of what it returns"
    ),
    "no raises": (SOUND.replace("Raises: ShapeError. ", ""), "raises"),
    "no unit": (SOUND.replace(", rad or m", ""), "unit"),
    "no frame": (SOUND.replace("in the base frame", "so").replace("of the tool", ""), "frame"),
    "no source": (SOUND.replace("Source", "By"), "source"),
    "sent to what says nothing of it": ("Otherwise like `fk`.", "parameter q"),
}  # fmt: skip


@pytest.mark.parametrize(("doc", "fault"), PLANTED.values(), ids=PLANTED)
def test_a_planted_fault_is_caught(doc, fault):
    assert fault in planted(doc)


def test_a_class_that_checks_its_fields_says_what_it_raises():
    code = "class f:\n    def __init__(self, screws: 'ArrayLike'): ..."
    says = "Screws.\n\nParameters: screws (n, 6), rad and m, in the base frame."
    assert planted(says, code) == ["raises"]
    assert planted(says + " Raises: ScrewError.", code) == []
    assert (
        planted(says.replace("screws (n, 6)", "none"), code)
        == ["parameter screws", "raises", "unit"][:2]
    )
