"""A robot whose collision geometry has all shapes, as a URDF, and its mesh file."""

import numpy as np

import poekin as pk

SHAPES = {
    "base": '<box size="0.3 0.2 0.1"/>',
    "upper": '<cylinder radius="0.05" length="0.3"/>',
    "lower": '<mesh filename="part.stl" scale="1 -1 1"/>',
    "hand": '<sphere radius="0.06"/>',
}
JOINT = """<joint name="{0}" type="{3}"><parent link="{1}"/><child link="{2}"/><axis xyz="{4}"/>
<origin xyz="{5}" rpy="0.1 0.2 0"/><limit lower="-2.9" upper="2.9" effort="1" velocity="1"/></joint>"""
JOINTS = [
    ("j1", "base", "upper", "revolute", "0 0 1", "0 0 0.1"),
    ("j2", "upper", "lower", "revolute", "0 1 0", "0 0 0.35"),
    ("j3", "lower", "wrist", "revolute", "1 0 0", "0 0 0.3"),
    ("flange", "wrist", "hand", "fixed", "1 0 0", "0.02 0 0.1"),
]


def urdf(shapes=SHAPES):
    """The robot's text."""
    links = "".join(
        f'<link name="{link}"><collision><origin xyz="0 0 0.15" rpy="0 0.1 0.3"/>'
        f"<geometry>{shape}</geometry></collision></link>"
        for link, shape in shapes.items()
    )
    joints = "".join(JOINT.format(*joint) for joint in JOINTS)
    return f'<robot name="r">{links}<link name="wrist"/>{joints}</robot>'


def robot_in(folder, text=None):
    """The robot, its files written to a folder."""
    corners = np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.08, 0], [0.02, 0.02, 0.25]])
    faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    lines = ["solid part"]
    for face in faces:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex {} {} {}".format(*corners[k]) for k in face]
        lines += ["endloop", "endfacet"]
    (folder / "part.stl").write_text("\n".join([*lines, "endsolid"]))
    (folder / "r.urdf").write_text(urdf() if text is None else text)
    return pk.load(folder / "r.urdf")
