"""Every public name says what goes in and comes out: shapes, units, frame, errors, source.

numpydoc's validator judges the form (`python -m tools.check_docstrings`); this holds what a user of
arrays needs besides:
- the type of an array, taken or returned, has its shape;
- what checks its arguments says what it raises;
- where there are arrays, there is a unit; where there are poses, twists or Jacobians, a frame;
- what computes arrays from arrays has a source.
The class or the module may say all but the shapes.
"""

from __future__ import annotations

import enum
import inspect
import re
from dataclasses import dataclass
from typing import Any

import pytest

from tools import docs_names, docs_render

SHAPE = r"\((?:\.\.\.|\*?\w+(?: ?[-+*] ?\w+)?)(?:, ?(?:\.\.\.|\w+(?: ?[-+*] ?\w+)?)?)*\)"
UNIT = r"(?<![\w.])(?:rad|m|mm|deg|s|degrees|metres|radians|seconds|m/s|rad/s|unit|SI)(?![\w(])"
FRAME = r"\b(?:frames?|axes|base|tool|tip)\b|\b[TRV]_[a-z]{1,2}\b"
SPATIAL = r"\((?:[\w.]+, ?)*(?:4, ?4|6)\)|\(6, [nm]\)"
NAMED_Q = {"q", "dq", "ddq", "q0", "T", "p", "d", "poses"}  # annotated as Any: a dict will do too
ARRAY = r"(ArrayLike|Array|NDArray|(np\.)?ndarray)\b"
IN = ("Parameters", "Other Parameters", "Attributes")


@dataclass(frozen=True)
class Name:
    """A public name: what it stands for, and the docstrings of its class or module."""

    dotted: str
    thing: Any
    around: str = ""


def doc_of(thing: object) -> str:
    return inspect.getdoc(thing) or ""


def public() -> list[Name]:
    names = []
    for dotted in docs_names.documented():
        thing = docs_names.resolved(dotted)
        above = docs_names.resolved(dotted.rsplit(".", 1)[0])
        if inspect.isclass(above):
            method = dotted.rsplit(".", 1)[1]
            thing = dict(docs_names.members(above))[method]
            if overrides(above, method):
                continue
        names.append(Name(dotted, thing, doc_of(above)))
    return names


def overrides(owner: type, method: str) -> bool:
    """Whether a method is that of a base in poekin, which says what goes in and comes out."""
    bases = [base for base in owner.__mro__[1:] if docs_names.own(base)]
    return any(doc_of(vars(base).get(method)) for base in bases if method in vars(base))


def entries(text: str) -> dict[str, dict[str, str]]:
    """Types of the entries of each section, by name."""
    found: dict[str, dict[str, str]] = {}
    for title, lines in docs_render.sections(text.splitlines()):
        heads = [line.partition(" : ") for line in lines if line and not line.startswith(" ")]
        found[title] = {
            name.lstrip("*"): kind for names, _, kind in heads for name in names.split(", ")
        }
    return found


def is_array(annotation: object, name: str = "") -> bool:
    """Arrays as they are annotated here: ArrayLike, Array; or Any, of the names that arrays have."""
    text = annotation if isinstance(annotation, str) else getattr(annotation, "__name__", "")
    if any(re.match(ARRAY, kind) for kind in text.split(" | ")):
        return True
    return text == "Any" and name in NAMED_Q


def checks(thing: Any) -> bool:
    """Whether a function, or the making of a class, may refuse its arguments."""
    if not inspect.isclass(thing):
        return True
    made_by_hand = "__dataclass_fields__" not in vars(thing) and "__init__" in vars(thing)
    return made_by_hand or "__post_init__" in vars(thing)


def faults(name: Name) -> list[str]:
    """What a name's docstring lacks, one line each."""
    own = doc_of(name.thing)
    is_class = inspect.isclass(name.thing)
    if is_class and issubclass(name.thing, (BaseException, enum.Enum)):
        return []
    signature = inspect.signature(name.thing)
    parameters = {n: p for n, p in signature.parameters.items() if n not in ("self", "cls")}
    sections = entries(own)
    told = {n: kind for section in IN for n, kind in sections.get(section, {}).items()}
    taken = [n for n, p in parameters.items() if is_array(p.annotation, n)]
    given = not is_class and is_array(signature.return_annotation)
    lacking = [f"shape of {n}" for n in taken if not re.search(SHAPE, told.get(n, ""))]
    returned = " ".join(sections.get("Returns", {}).values()) if parameters else own
    if given and not re.search(SHAPE, returned):
        lacking.append("shape of what it returns")
    whole = f"{own}\n{name.around}"
    if parameters and checks(name.thing) and "Raises" not in whole:
        lacking.append("raises")
    if (taken or given) and not re.search(UNIT, re.sub(SHAPE, " ", whole)):
        lacking.append("unit")
    if (taken or given) and re.search(SPATIAL, own) and not re.search(FRAME, whole):
        lacking.append("frame")
    if taken and given and "Source" not in whole and "References" not in sections:
        lacking.append("source")
    return [f"{name.dotted}: {what}" for what in lacking]


NAMES = public()


def test_every_public_name_says_shapes_units_frame_errors_and_source():
    assert len(NAMES) > 400, "hardly anything was checked"
    assert [fault for name in NAMES for fault in faults(name)] == []


def test_every_public_name_is_on_exactly_one_page_of_the_reference():
    listed = [name for _, names in docs_names.PAGES.values() for name in names]
    assert len(listed) == len(set(listed))
    assert set(docs_names.poekin.__all__) <= set(listed)


SOUND = """Pose of the tool.

    Parameters
    ----------
    q : (..., m) array_like
        Coordinates, rad or m.

    Returns
    -------
    T : (..., 4, 4) ndarray
        Pose in the base frame.

    Raises
    ------
    ShapeError
        If q has another length.

    Notes
    -----
    Source: Park 1994, eq. (1).
"""


def planted(doc: str | None, code: str = "def f(q: ArrayLike) -> Array: ...") -> list[str]:
    """The faults of a function or class of that docstring."""
    space: dict = {}
    exec(code, {"__name__": "poekin.planted"}, space)
    (thing,) = space.values()
    thing.__doc__ = doc
    return [fault.removeprefix("f: ") for fault in faults(Name("f", thing))]


def test_a_sound_docstring_has_no_fault():
    assert planted(SOUND) == []
    assert planted("No arrays.", "def f() -> int: ...") == []


PLANTED = {
    "no shape": (SOUND.replace("(..., m) ", ""), "shape of q"),
    "the parameter is not named": (SOUND.replace("q :", "x :"), "shape of q"),
    "no shape of the result": (SOUND.replace("(..., 4, 4) ", ""), "shape of what it returns"),
    "no raises": (SOUND.replace("Raises\n    ------", "Warns\n    -----"), "raises"),
    "no unit": (SOUND.replace(", rad or m", ""), "unit"),
    "no frame": (SOUND.replace(" in the base frame", "").replace(" of the tool", ""), "frame"),
    "no source": (SOUND.replace("Source:", "By"), "source"),
}


@pytest.mark.parametrize(("doc", "fault"), PLANTED.values(), ids=PLANTED)
def test_a_planted_fault_is_caught(doc, fault):
    assert fault in planted(doc)


def test_a_class_that_checks_its_fields_says_what_it_raises():
    code = "class f:\n    def __init__(self, q: ArrayLike): ..."
    assert planted(SOUND, code) == []
    assert planted(SOUND.replace("Raises\n    ------", "Warns\n    -----"), code) == ["raises"]


# Options: parameters that take one of a few strings.

OPTIONS = {
    *("by", "convention", "counting", "criterion", "format", "frame", "kind", "loss"),
    *("method", "on_rank_deficiency", "part", "quaternion", "secondary_objective", "task", "wrt"),
}
FREE = {"base", "name", "tip", "title"}  # strings with a default that are no options


def loose_options(name: Name) -> list[str]:
    """Parameters that take one of a few strings and are annotated as any string."""
    try:
        parameters = inspect.signature(name.thing).parameters.values()
    except ValueError:
        return []
    return [
        f"{name.dotted}: {p.name}"
        for p in parameters
        if str(p.annotation).partition(" |")[0] == "str"
        and (p.name in OPTIONS or (p.default and isinstance(p.default, str) and p.name not in FREE))
    ]


def test_an_option_names_its_choices_in_its_type():
    assert [found for name in NAMES for found in loose_options(name)] == []


def test_an_option_of_any_string_is_caught():
    space: dict = {}
    exec("def f(frame: str, along: str = 'line', tip: str = 'tool'): ...", space)
    assert loose_options(Name("f", space["f"])) == ["f: frame", "f: along"]
