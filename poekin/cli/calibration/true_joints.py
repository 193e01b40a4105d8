"""True joint values of a calibration's readings among what `poekin emit` writes."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from ...errors import InputError, PoekinWarning, join_names
from ...formats import chain_toml
from ...formats.content import kinds
from ...formats.emit.correction.python_text import python_function
from ...formats.text import toml_text
from ...model.chain import Chain
from ...solve.calibration.calibration import Calibration
from ...solve.calibration.emission import correction
from ...solve.calibration.report import toml_io
from .. import model
from ..output import complain


@contextmanager
def terms_are_told() -> Iterator[None]:
    """Reading of a calibration without the warning that it has terms: they are written, or told."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", f".*: {chain_toml.TERMS}", PoekinWarning)
        yield


def with_terms(file: str) -> Calibration | None:
    """The calibration in a FILE, of which the model was read, that is one with non-geometric terms; None
    of any other. Raises: as `calibration.load`.
    """
    content = model.content(file)
    if kinds.kind_of(content) != "toml":
        return None
    place = model.called(file)
    text = kinds.decode(content, place)
    if toml_text.parse(text, place).get("format") != chain_toml.FORMAT:
        return None
    found = Calibration(**vars(toml_io.read_text(text, place)))
    return found if found.error_model.terms else None


def tell_of_terms(file: str, what: str) -> None:
    """Tells of a calibration's terms where what is written takes, or gives, true joint values only."""
    if with_terms(file) is not None:
        complain(
            f"warning: {chain_toml.TERMS}, of which {what} has nothing: its joint values are true ones, not"
            " readings; without it, --lang c and python write true joints of readings too"
        )


def add_true_joints(
    texts: dict[str, str],
    found: Calibration | None,
    chain: Chain,
    language: str,
    options: Mapping[str, str],
) -> None:
    """Adds what makes true joint values of readings: files of C, or one more function of Python.

    Raises: InputError where the chain has other coordinates.
    """
    if found is None:
        return
    if language not in ("c", "python"):
        complain(
            f"warning: {chain_toml.TERMS}: the arm takes true joint values, and what makes"
            f" them of readings is written in c and python only, not in {language}"
        )
        return
    if chain.q_names != found.chain.q_names:
        raise InputError(
            f"--tip and --base: the calibration's terms are of {join_names(found.chain.q_names)},"
            f" and this chain has {join_names(chain.q_names)}"
        )
    if language == "c":
        texts |= found.emit("c", name=options["name"], origin=options["origin"]).files
        return
    (file_name,) = texts
    texts[file_name] += f"\n\n{python_function(correction(found))}"
