"""Cloud of points that a tip reaches, coloured by how well it moves there."""

from __future__ import annotations

from ....analysis.dexterity.manipulability import manipulability
from ....groups.vectors import translation_part
from ....model.chain import Chain
from ...nodes import Attachment, Cloud

SEED = 0


def reach_cloud(chain: Chain, count: int, size: float) -> Cloud:
    """Positions of the tip at configurations drawn uniformly within the limits, with Yoshikawa's
    measure of its translation; the chain begins at the arm's root.
    """
    q = chain.random(SEED, size=count)
    values = manipulability(chain, q).translation.yoshikawa
    attachment = Attachment("cloud", "first", name=f"points that {chain.tip} reaches")
    return Cloud(attachment, translation_part(chain.fk(q)), 0.006 * size, values)
