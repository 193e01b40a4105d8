"""Stäubli's arm.cfx: what it says of an arm, and why no model is made of it.

`<DhArray name="dhOffset">` has six offsets a link, theta, d, a, b, alpha, beta, to a nominal DH
table that is not in the file. In which order the turns and shifts follow one another is not
published, and it matters at first order: where alpha is -90°, alpha and beta in the other order
turn the next axis by 1.4 beta. So offsets that are not 0 are not made into a model.
"""

from __future__ import annotations

from ...errors import ModelError, quote
from ..text import xml
from ..text.numbers import real

ENDING = ".cfx"
COLUMNS = ("theta", "d", "a", "b", "alpha", "beta")
_INSTEAD = (
    "pk.calibration.from_fk makes the calibrated arm out of the controller's own forward kinematics"
)


def refusal(text: str, place: str) -> ModelError:
    """Error that says what an arm.cfx holds, and what to do instead of reading it.

    Raises: ModelError where the text is no XML of Stäubli's, or an offset no number.
    """
    root = xml.parse(text, place, tell=False)
    if root.tag != "arm":
        raise ModelError(f"{place}: expected Stäubli's <arm>, got <{root.tag}>")
    offsets = root.find("DhArray[@name='dhOffset']")
    if offsets is None:
        return ModelError(
            f"{place}: there are no offsets (dhOffset) in it: Stäubli did not calibrate this arm, and"
            " the nominal model is all there is"
        )
    found = [
        _number(link.get(column, "0"), column, f"{place}:{link.sourceline}")
        for link in offsets.iterfind("DH")
        for column in COLUMNS
    ]
    if not any(found):
        return ModelError(
            f"{place}: all {len(found)} offsets (dhOffset) are 0: the axes of this arm are the nominal"
            " ones, and no calibrated model is needed"
        )
    return ModelError(
        f"{place}: Stäubli's offsets (dhOffset) are to a DH table that is not in the file, and the"
        f" order of their turns is not published: {_INSTEAD}"
    )


def _number(text: str, column: str, where: str) -> float:
    number = real(text)
    if number is None:
        raise ModelError(f"{where}: {column}: expected a number, got {quote(text)}")
    return number
