"""Names of the vendors' descriptions: of links, joints and the flange of an arm of any length."""

from __future__ import annotations

import pytest

from poekin.formats.vendors import naming


@pytest.mark.parametrize("n", [5, 6, 7])
def test_links_and_joints_are_numbered_and_the_last_link_is_the_flange_where_there_is_one(n):
    xarm = naming.ufactory(n)
    assert xarm.entries == xarm.joints == tuple(f"joint{i + 1}" for i in range(n))
    assert xarm.links == tuple(f"link{i + 1}" for i in range(n))
    assert (xarm.vendor, xarm.bases, xarm.last) == ("UFACTORY", ("link_base",), "link_eef")
    assert xarm.tip_joint == "joint_eef"
    rizon = naming.flexiv(n)
    assert (rizon.vendor, rizon.bases, rizon.last) == ("Flexiv", ("base_link",), "flange")
    assert rizon.tip_joint == f"link{n}_to_flange"
    assert rizon.links == xarm.links
    bare = naming.flexiv(n, flange=False)
    assert (bare.tip, bare.last) == (None, f"link{n}")


def test_a_universal_robot_ends_at_its_tool():
    assert (naming.UR.last, naming.UR.links[-1]) == ("tool0", "wrist_3_link")
    assert naming.UR.bases == ("base", "base_link_inertia")
