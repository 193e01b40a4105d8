"""The public names, what each is called in full, and on which page of the reference it stands."""

from __future__ import annotations

import functools
import importlib
import inspect
import pkgutil
import types
from collections.abc import Iterator

import poekin
from poekin import formulas

from .docs_render import rest

# Page of the reference: its title, and the names of `poekin.__all__` on it, modules with all that
# they hold.
PAGES: dict[str, tuple[str, tuple[str, ...]]] = {
    "models": ("Models: read, make, write", (
        "load", "from_text", "xacro", "from_object", "to_urdf", "relinked", "Robot", "Joint", "Mimic",
        "SafetyController", "LinkMass",
    )),
    "chain": ("Chain: poses, Jacobians, derivatives", ("Chain",)),
    "screw": ("screw: the axes of joints", ("screw",)),
    "so3": ("so3: rotations", ("so3",)),
    "se3": ("se3: poses and twists", ("se3",)),
    "dh": ("dh: Denavit–Hartenberg tables", ("dh",)),
    "vendors": ("vendors: factory calibrations", ("vendors",)),
    "ur": ("ur: DH tables of Universal Robots", ("ur",)),
    "compare": ("Compare and judge models", ("compare", "axes", "validate")),
    "dexterity": ("Manipulability and singularities", ("manipulability", "manipulability_gradient", "singularity")),
    "solve": ("Inverse kinematics", ("ik", "ik_all", "ik_structure", "follow")),
    "motion": ("motion: paths and timing", ("motion",)),
    "sweep": ("sweep: maps over many configurations", ("sweep", "ProgressLine")),
    "poses": ("poses: formats of controllers, ROS and spreadsheets", ("poses",)),
    "calibration": ("Calibration", ("calibrate", "choose_poses", "calibration")),
    "emit": ("emit: source code of an arm", ("emit",)),
    "view": ("view: pages in which arms move", ("view",)),
    "count": ("Operation counts", ("count", "count_table")),
    "errors": ("Errors and warnings", ("PoekinError", "PoekinWarning", "errors")),
}  # fmt: skip

# Pages of `poekin.testing`: title, and modules (of conform, what `__all__` has), each with its text
# and its functions.
TESTING: dict[str, tuple[str, tuple[str, ...]]] = {
    "testing_strategies": ("poekin.testing.strategies", (
        "strategies.group_strategies", "strategies.batch_strategies", "strategies.near_strategies",
        "strategies.chain_strategies",
        "strategies.configuration_strategies", "strategies.robot_strategies", "strategies.urdf_strategies",
        "strategies.dh_strategies", "strategies.decoding.bytes_reader",
    )),
    "testing_laws": ("poekin.testing.laws", (
        "laws.laws", "laws.group", "laws.group_laws", "laws.adjoint_laws", "laws.measures",
    )),
    "testing_oracles": ("poekin.testing.oracles", (
        "oracles.exact", "oracles.exact_chain", "oracles.differences", "oracles.pinocchio_oracle",
    )),
    "testing_accuracy": ("poekin.testing.accuracy", (
        "accuracy.accuracy_laws", "accuracy.error_bounds", "accuracy.falsify",
    )),
    "testing_conform": ("poekin.testing.conform", (
        "conform", "conform.laws.of_groups", "conform.laws.of_arms", "conform.plugin",
    )),
}  # fmt: skip

# What functions and methods return, where the class itself is in no public module: where it is, and
# its page.
RESULTS: dict[str, str] = {
    "poekin.model.chain_data.ScrewForm": "chain",
    "poekin.model.geometry.local.LocalForm": "chain",
    "poekin.model.kinematics.compiled.CompiledChain": "chain",
    "poekin.model.kinematics.derivatives.PoseChanges": "chain",
    "poekin.model.kinematics.derivatives.JacobianChanges": "chain",
    "poekin.model.geometry.idealise.Idealised": "chain",
    "poekin.model.geometry.hp.HPForm": "chain",
    "poekin.analysis.compare.comparison.Comparison": "compare",
    "poekin.analysis.compare.comparison.JointComparison": "compare",
    "poekin.analysis.compare.comparison.PoseDifferences": "compare",
    "poekin.analysis.axes.AxesReport": "compare",
    "poekin.analysis.axes.AxisPair": "compare",
    "poekin.analysis.shapes.Shape": "compare",
    "poekin.analysis.validate.Validation": "compare",
    "poekin.analysis.validate.ChainErrors": "compare",
    "poekin.analysis.dexterity.manipulability.Manipulability": "dexterity",
    "poekin.analysis.dexterity.manipulability.Measures": "dexterity",
    "poekin.analysis.dexterity.singularity.Singularity": "dexterity",
    "poekin.solve.ik.solution.Solution": "solve",
    "poekin.solve.ik_all.all_solutions.AllSolutions": "solve",
    "poekin.solve.ik_structure.result.IKStructure": "solve",
    "poekin.solve.ik_structure.result.Assumption": "solve",
    "poekin.solve.ik_structure.result.LockedStructure": "solve",
    "poekin.solve.path.path_result.PathResult": "solve",
    "poekin.analysis.counting.count_table.CountTable": "count",
    "poekin.analysis.counting.count_table.CountRow": "count",
    "poekin.engine.count.Count": "count",
    "poekin.view.page.Page": "view",
}


def testing_modules() -> dict[str, str]:
    """Full name of each module of `TESTING`, and its page."""
    return {
        f"poekin.testing.{name}": page for page, (_, names) in TESTING.items() for name in names
    }


def own(thing: object) -> bool:
    return (getattr(thing, "__module__", None) or "").split(".")[0] == "poekin"


def of_module(module: types.ModuleType) -> list[str]:
    """The public names of a module: `__all__`, or, of the errors, its classes; of testing, its
    functions as well.
    """
    if hasattr(module, "__all__"):
        return list(module.__all__)
    told = module.__name__ in testing_modules()
    defined = {
        n: x
        for n, x in vars(module).items()
        if inspect.isclass(x) or (told and inspect.isroutine(x))
    }
    return [
        n for n, x in defined.items() if not n.startswith("_") and x.__module__ == module.__name__
    ]


def members(owner: type) -> Iterator[tuple[str, object]]:
    """Public methods and properties of a class and of its bases in poekin; a property as its
    function.
    """
    seen = set()
    for base in owner.__mro__:
        if not own(base):
            continue
        for name, member in vars(base).items():
            ways = ("fget", "func", "__func__")  # of a property, a cached property, a class method
            inner = next((x for w in ways if (x := getattr(member, w, None)) is not None), member)
            if not name.startswith("_") and name not in seen and inspect.isfunction(inner):
                seen.add(name)
                yield name, inner


def resolved(dotted: str) -> object:
    """What a full name stands for: the longest part of it that is a module, then attributes; of a
    module that shares its name with a function beside it, as `poekin.view`, the function.
    """
    parts = dotted.split(".")
    for length in range(len(parts), 0, -1):
        try:
            found: object = importlib.import_module(".".join(parts[:length]))
        except ModuleNotFoundError:
            continue
        if 1 < length == len(parts):
            above = importlib.import_module(".".join(parts[:-1]))
            return getattr(above, parts[-1], found)
        for name in parts[length:]:
            found = getattr(found, name)
        return found
    raise ModuleNotFoundError(dotted)


def pages() -> dict[str, tuple[str, tuple[str, ...]]]:
    """`PAGES` with the names that exist."""
    return {
        page: (title, tuple(n for n in names if n in poekin.__all__))
        for page, (title, names) in PAGES.items()
    }


@functools.cache
def documented() -> dict[str, str]:
    """Full name of every function, class, method and property of the reference, and the page that
    it is on.
    """
    found: dict[str, str] = {}

    def add(dotted: str, thing: object, page: str) -> None:
        found[dotted] = page
        if inspect.isclass(thing):
            for name, _ in members(thing):
                found[f"{dotted}.{name}"] = page

    def add_module(dotted: str, module: types.ModuleType, page: str) -> None:
        for inner in of_module(module):
            if inspect.isroutine(getattr(module, inner)) or inspect.isclass(getattr(module, inner)):
                add(f"{dotted}.{inner}", getattr(module, inner), page)

    for page, (_, names) in pages().items():
        for name in names:
            thing = getattr(poekin, name)
            if isinstance(thing, types.ModuleType):
                add_module(f"poekin.{name}", thing, page)
            else:
                add(f"poekin.{name}", thing, page)
    for dotted, page in testing_modules().items():
        add_module(dotted, importlib.import_module(dotted), page)
    for dotted, page in RESULTS.items():
        add(dotted, resolved(dotted), page)
    return found


def formula_modules() -> list[str]:
    found = pkgutil.walk_packages(formulas.__path__, f"{formulas.__name__}.")
    return [info.name for info in found if not info.ispkg]


def links(name: str) -> dict[str, str]:
    """What may stand in the backquotes of the docstring of `name`, and what it is called in full."""
    found: dict[str, str] = {}
    for dotted in documented():
        parts = dotted.split(".")
        if not dotted.startswith(
            ("poekin.model.", "poekin.analysis.", "poekin.solve.", "poekin.engine.", "poekin.view.")
        ):
            found[".".join(parts[1:])] = found["pk." + ".".join(parts[1:])] = found[dotted] = dotted
        else:
            place = next(i for i, p in enumerate(parts) if p[0].isupper())
            found[".".join(parts[place:])] = dotted
    scope = name
    while "." in scope:  # a class's own names, and names beside it, go without what they belong to
        found |= {d[len(scope) + 1 :]: d for d in documented() if d.startswith(scope + ".")}
        scope = scope.rsplit(".", 1)[0]
    return found


def reference() -> dict[str, str]:
    """File name and text of each page of the reference; the docstrings fill them in."""
    made = {}
    for page, (title, names) in pages().items():
        lines = [title, "=" * len(title), ""]
        for name in names:
            thing = getattr(poekin, name)
            if isinstance(thing, types.ModuleType):
                lines += section(f"poekin.{name}", thing)
            else:
                lines += directive(f"poekin.{name}", thing)
        results = [d for d, p in RESULTS.items() if p == page]
        if results:
            lines += ["What they return", "----------------", ""]
            lines += [line for d in results for line in directive(d, resolved(d))]
        made[f"{page}.rst"] = "\n".join(lines) + "\n"
    for page, (title, names) in TESTING.items():
        lines = [title, "=" * len(title), ""]
        for name in names:
            dotted = f"poekin.testing.{name}"
            lines += [name, "-" * len(name), "", *section(dotted, importlib.import_module(dotted))]
        made[f"{page}.rst"] = "\n".join(lines) + "\n"
    title = "Formulas"
    lines = [title, "=" * len(title), "", FORMULAS, ""]
    for module in formula_modules():
        short = module.removeprefix("poekin.formulas.")
        lines += [short, "-" * len(short), "", f".. automodule:: {module}", "   :members:", ""]
    made["formulas.rst"] = "\n".join(lines) + "\n"
    return made


FORMULAS = (
    "The mathematics itself, each formula once: plain Python over tuples of scalars of any kind. The same function is "
    "compiled, counted, traced into the code of one arm, and run in 60 digits. Each module begins with the paper's "
    "equation; where it departs from the print, it says how."
)


def section(dotted: str, module: types.ModuleType) -> list[str]:
    """A module: its text, and all that is documented of it."""
    # Of the modules of testing the texts name each other's functions; elsewhere they name other
    # pages.
    near = links(f"{dotted}.") if dotted in testing_modules() else {}
    text = rest((inspect.getdoc(module) or "").splitlines(), near)
    inner = [name for name in of_module(module) if f"{dotted}.{name}" in documented()]
    found = [
        line for name in inner for line in directive(f"{dotted}.{name}", getattr(module, name))
    ]
    return [f".. py:module:: {dotted}", "", *text, "", *found]


def directive(dotted: str, thing: object) -> list[str]:
    if inspect.isclass(thing):
        if issubclass(thing, BaseException):
            return [f".. autoexception:: {dotted}", "   :show-inheritance:", ""]
        return [f".. autoclass:: {dotted}", "   :members:", "   :inherited-members: tuple", ""]
    return [f".. autofunction:: {dotted}", ""]
