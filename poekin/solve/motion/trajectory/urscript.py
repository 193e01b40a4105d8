"""A trajectory as URScript: to its first point by movej, then along it by servoj."""

from __future__ import annotations

from collections.abc import Sequence

from ....errors import ModelError, join_names
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.provenance import warn
from .joint_trajectory import number, number_list

JOINTS = 6
MANY = 5000
"""Lines above which a controller of the CB series chokes."""

HEAD = """\
def poekin_path():
  # rad, rad/s and rad/s^2; joints in the order {names}
  movej({start}, a=1.4, v=1.05)
"""
LINE = "  servoj({q}, 0, 0, {step}, {lookahead}, {gain})\n"
TAIL = """\
  stopj(2.0)
end
"""


def check_urscript(chain: Chain) -> None:
    """Refuses an arm that is no UR: six coordinates, each the angle of one joint. Raises:
    ModelError.
    """
    coupled = chain.nontrivial_coupling is not None
    turning = set(chain.kinds) == {"revolute"}
    if chain.dof != JOINTS or coupled or not turning:
        raise ModelError(
            f"URScript: expected an arm with {JOINTS} revolute joints, each with its own "
            f"coordinate, got {join_names(chain.q_names) or 'none'}; another tip may help"
        )


def urscript(
    names: Sequence[str],
    q: Array,
    step: float,
    lookahead: float,
    gain: float,
) -> str:
    """Program that follows samples q (N, 6), `step` seconds apart."""
    if len(q) > MANY:
        warn(f"URScript: {len(q)} lines; a controller of the CB series may refuse more than {MANY}")
    options = {
        "step": number(step),
        "lookahead": number(lookahead),
        "gain": number(gain),
    }
    # a name of a file must not end the comment, nor leave ASCII
    listed = ", ".join(name.encode("unicode_escape").decode() for name in names)
    rows = q.tolist()
    body = [LINE.format(q=number_list(row), **options) for row in rows[1:]]
    return HEAD.format(names=listed, start=number_list(rows[0])) + "".join(body) + TAIL
