"""True joint values of a calibration's readings among what `poekin emit` writes."""

from __future__ import annotations

import os
from collections.abc import Mapping

from ...errors import InputError, join_names
from ...formats.chain_toml import is_calibration
from ...formats.content import pipes
from ...formats.emit.correction.python_text import python_function
from ...formats.ros import packages
from ...model.chain import Chain
from ...solve.calibration.calibration import Calibration, load
from ...solve.calibration.emission import correction
from ..output import complain


def with_terms(file: str) -> Calibration | None:
    """The calibration in a FILE that is one with non-geometric terms; None of any other, and of a
    pipe, which can be read once only. Raises: as `calibration.load`.
    """
    path = os.fspath(packages.local_path(file))
    if not path.lower().endswith(".toml") or pipes.is_pipe(path) or not is_calibration(path):
        return None
    found = load(path)
    return found if found.error_model.terms else None


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
            "the calibration has non-geometric terms: the arm takes true joint values, and what makes"
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
