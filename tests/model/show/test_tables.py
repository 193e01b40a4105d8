"""What notebooks show of chains, robots, tables of DH parameters and results."""

from __future__ import annotations

import re
from itertools import pairwise

import numpy as np

import poekin as pk
from poekin.model.show.tables import ROWS, numbers


def cells(html):
    return [re.findall(r"<td[^>]*>(.*?)</td>", line) for line in html.splitlines() if "<td" in line]


def test_a_chain_shows_its_screws_and_limits_joint_by_joint():
    screws = [pk.screw.revolute([0, 0, 1], [0.2, 0, 0]), pk.screw.prismatic([1, 0, 0])]
    limits = [(-np.inf, np.inf), (-0.1, 0.25)]
    arm = pk.Chain(screws, np.eye(4), frame="space", joint_names=["<b>", "slide"], limits=limits)
    html = arm._repr_html_()
    # 0.2 to the first axis, 0.2 back to the tool at the origin, and 1 for a unit of the slide
    assert "Chain base → tool, space screws at q = 0, reach 1.4 m" in html
    assert cells(html) == [
        ["&lt;b&gt;", "revolute", "0, 0, 1", "0, -0.2, 0", ""],
        ["slide", "prismatic", "0, 0, 0", "1, 0, 0", "-0.1 … 0.25"],
    ]


def test_a_robot_shows_what_its_joints_connect_and_follow():
    left = pk.Joint("left", "prismatic", "hand", "l", axis=(0, 1, 0), limits=(0, 0.04))
    right = pk.Joint("right", "prismatic", "hand", "r", axis=(0, 1, 0), mimic=pk.Mimic("left"))
    html = pk.Robot("grip", ["hand", "l", "r"], [left, right])._repr_html_()
    assert "Robot grip" in html
    assert cells(html) == [
        ["left", "prismatic", "hand", "l", "0 … 0.04", ""],
        ["right", "prismatic", "hand", "r", "", "left"],
    ]


def test_numbers_are_shown_to_four_digits_and_without_the_sign_of_zero():
    assert numbers([-0.0, 0.0, -1.23456]) == "0, 0, -1.235"
    assert numbers([1e-7, -0.0], between="; ") == "1e-07; 0"


def test_a_long_table_says_how_many_rows_there_are():
    assert ROWS == 60
    links = [f"l{k}" for k in range(ROWS + 2)]
    joints = [pk.Joint(f"j{k}", "fixed", *pair) for k, pair in enumerate(pairwise(links))]
    html = pk.Robot("snake", links, joints)._repr_html_()
    assert f"the first {ROWS} of {ROWS + 1} joints" in html
    assert len(cells(html)) == ROWS


def test_a_dh_table_has_its_units_in_the_heads():
    table = pk.dh.published("puma560")
    html = table._repr_html_()
    assert f"{table.convention} DH table puma560" in html
    assert re.findall("<th[^>]*>(.*?)</th>", html)[2:] == ["θ, rad", "d, m", "a, m", "α, rad"]
    assert [row[0] for row in cells(html)] == [row.name for row in table.rows]
    assert float(cells(html)[1][4]) == table.rows[1].a


def test_a_result_shows_its_summary_escaped():
    report = pk.axes(pk.load("ur5e").chain())
    html = report._repr_html_()
    assert html.startswith("<pre>")
    assert report.summary().splitlines()[0].replace("<", "&lt;") in html
