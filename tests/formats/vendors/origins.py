"""Numbers of the vendors' public files, and texts made of them: YAML as the vendors write it, and
URDF as their xacro makes it of the same numbers.
"""

from __future__ import annotations

from collections.abc import Sequence

Row = tuple[float, float, float, float, float, float]

KEYS = ("x", "y", "z", "roll", "pitch", "yaw")
QUARTER = 1.5708
"""A quarter turn as UFACTORY's files have it."""

# xarm_ros and xarm_ros2, xarm_description/config/kinematics/default/<arm>_default_kinematics.yaml.
UFACTORY: dict[str, list[Row]] = {
    "xarm5": [
        (0, 0, 0.267, 0, 0, 0),
        (0, 0, 0, -1.5708, 0, 0),
        (0.0535, -0.2845, 0, 0, 0, 0),
        (0.0775, 0.3425, 0, 0, 0, 0),
        (0.076, 0.097, 0, -1.5708, 0, 0),
    ],
    "xarm6": [
        (0, 0, 0.267, 0, 0, 0),
        (0, 0, 0, -1.5708, 0, 0),
        (0.0535, -0.2845, 0, 0, 0, 0),
        (0.0775, 0.3425, 0, -1.5708, 0, 0),
        (0, 0, 0, 1.5708, 0, 0),
        (0.076, 0.097, 0, -1.5708, 0, 0),
    ],
    "xarm7": [
        (0, 0, 0.267, 0, 0, 0),
        (0, 0, 0, -1.5708, 0, 0),
        (0, -0.293, 0, 1.5708, 0, 0),
        (0.0525, 0, 0, 1.5708, 0, 0),
        (0.0775, -0.3425, 0, 1.5708, 0, 0),
        (0, 0, 0, 1.5708, 0, 0),
        (0.076, 0.097, 0, -1.5708, 0, 0),
    ],
    "xarm7_mirror": [
        (-0.00052471, 0, 0.2668, 0, 0, 0),
        (0, 0, 0, 1.5708, 0, 0),
        (0, 0.29289, 0, -1.5708, 0, 0),
        (0.052665, 0, 0, -1.5708, 0, 0),
        (0.077699, 0.34258, 0, -1.5708, 0, 0),
        (0, 0, 0, -1.5708, 0, 0),
        (0.075998, -0.096156, 0, 1.5708, 0, 0),
    ],
    "lite6": [
        (0, 0, 0.2435, 0, 0, 0),
        (0, 0, 0, 1.5708, -1.5708, 3.1416),
        (0.2002, 0, 0, -3.1416, 0, 1.5708),
        (0.087, -0.22761, 0, 1.5708, 0, 0),
        (0, 0, 0, 1.5708, 0, 0),
        (0, 0.0625, 0, -1.5708, 0, 0),
    ],
    "uf850": [
        (0, 0, 0.364, 0, 0, 0),
        (0, 0, 0, 1.5708, -1.5708, 0),
        (0.39, 0, 0, -3.1416, 0, -1.5708),
        (0.15, 0.426, 0, -1.5708, 0, 0),
        (0, 0, 0, -1.5708, 0, 0),
        (0, -0.09, 0, 1.5708, 0, 0),
    ],
}

# flexiv_description, config/<arm>/default_kinematics.yaml.
FLEXIV: dict[str, list[Row]] = {
    "Rizon4 or 4s": [
        (0, 0, 0.155, 0, 0, -3.141592654),
        (0, 0.03, 0.21, 0, 0, 0),
        (0, 0.035, 0.205, 0, 0, 0),
        (-0.02, -0.03, 0.19, 0, 0, -3.141592654),
        (-0.02, 0.025, 0.195, 0, 0, -3.141592654),
        (0, 0.03, 0.19, 0, 0, 0),
        (-0.015, 0.073, 0.11, 0, -1.570796327, 0),
    ],
    "Rizon10 or 10s": [
        (0, 0, 0.21, 0, 0, 3.141592653589793),
        (0, 0.0675, 0.24, 0, 0, 0),
        (0, 0.0625, 0.2275, 0, 0, 0),
        (0, -0.0625, 0.2225, 0, 0, 3.141592653589793),
        (0, 0.0575, 0.205, 0, 0, 3.141592653589793),
        (0, 0.03, 0.19, 0, 0, 0),
        (-0.015, 0.073, 0.11, 0, -1.5707963267948966, 0),
    ],
    "Enlight-L": [
        (0, 0, 0.146, 0, 0, 0),
        (0, -0.037, 0.114, 1.5707963267948966, 0, 0),
        (0, 0.181, -0.037, -1.5707963267948966, 0, 0),
        (0, 0.037, 0.109, -1.5707963267948966, 0, 0),
        (0, -0.156, -0.037, 1.5707963267948966, 0, 0),
        (0, -0.0261, 0.124, 1.5707963267948966, 0, 0),
        (0, 0.134, -0.0261, -1.5707963267948966, 0, 0),
    ],
}

# A calibrated Rizon 4s: flexivrobotics/isaac_sim_ws, tools/calibration/test,
# Rizon4_calibrated_kinematics.example.yaml; Rizon4_calibrated.example.urdf has the same.
RIZON_4S: list[Row] = [
    (0, 0, 0.155, 0, -0.0, 3.1415926535897931),
    (
        0.00085097431715900002, 0.030543584115857, 0.21007948258339601,
        -3.1389903917275652, -3.1415433954416989, 3.1415925254069039,
    ),
    (
        -0.00096952358946900011, 0.035213784686364998, 0.205418728741774,
        -0.0010406881360843999, 8.8759836932849438e-06, 0.0085287464788619573,
    ),
    (
        -0.019034909752679002, -0.029831349555787, 0.18999266428183301,
        -0.00024591423876988989, 0.0080144605996290402, 3.1415906827408748,
    ),
    (
        -0.019134483328809002, 0.024871277704987999, 0.19547581873981301,
        3.140934149945616, 3.1415904246142068, 0.003384896606806187,
    ),
    (
        -0.000106684477073, 0.030556358788644999, 0.19009072135197699,
        0.0029689797884276531, 0.0016682165802365679, 4.9529135643478664e-06,
    ),
    (
        -0.054998658263429999, 0.070066232710202, 0.109083179674417,
        -1.570796326737685, -1.570801103288247, 1.5695920668475101,
    ),
]  # fmt: skip
RIZON_FLANGE: Row = (0, 0, 0.124, 0, 0, 3.1415926535897931)
RIZON_AXES = ("", "0 1 0", "", "0 1 0", "", "0 1 0", "")

# A UR5e of a laboratory: RoboticManipulation/Universal_Robots_ROS2_Description, in the place of
# config/ur5e/default_kinematics.yaml.
UR5E: list[Row] = [
    (0, 0, 0.1624601664919684, 0, 0, -1.1748799915323876e-07),
    (0.00013693066835674709, 0, 0, 1.5705887548757873, 0, 1.0291143113467932e-06),
    (
        -0.42542032535287599, 0, 0,
        0.00086180224484494103, 0.0021886127482178132, -1.9793852235756926e-07,
    ),
    (
        -0.39260562769873419, -7.2989153671478886e-06, 0.13388369108414155,
        5.4516836971052413e-05, -0.001205676433986502, -3.5563392305313958e-06,
    ),
    (
        9.1961927830986801e-05, -0.099676956423467064, 0.00014115972125381174,
        1.5693801556761988, 0, 1.1516874805772574e-06,
    ),
    (
        4.2288555675900251e-05, 0.099577471762275743, 7.9056043482053824e-05,
        1.5715902415777612, 3.1415926535897931, -3.1415926244038093,
    ),
]  # fmt: skip
UR_LINKS = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")


def yaml(
    rows: Sequence[Row],
    *,
    names: Sequence[str] = (),
    axes: Sequence[str] = (),
    flange: Row | None = None,
    indent: str = "",
) -> str:
    """The file of these origins; joint1, joint2, ... where the entries have no other names."""
    names = names or [f"joint{i}" for i in range(1, len(rows) + 1)]
    entries = dict(zip(names, rows, strict=True))
    if flange is not None:
        entries[f"link{len(rows)}_to_flange"] = flange
    lines = []
    if not indent:
        lines.append("kinematics:")
    for i, (name, row) in enumerate(entries.items()):
        lines.append(f"{indent}  {name}:")
        lines += [f"{indent}    {k}: {v!r}" for k, v in zip(KEYS, row, strict=True)]
        if i < len(axes) and axes[i]:
            lines.append(f"{indent}    axis: {axes[i]}")
    return "\n".join([*lines, ""])


def urdf(
    rows: Sequence[Row],
    *,
    base: str,
    tip: str,
    axes: Sequence[str] = (),
    flange: Row = (0, 0, 0, 0, 0, 0),
    prefix: str = "",
) -> str:
    """The URDF that a vendor's xacro makes of these origins, on a stand."""
    links = [base, *(f"link{i}" for i in range(1, len(rows) + 1)), tip]
    lines = [
        '<robot name="arm">',
        '<link name="world"/>',
        *(f'<link name="{prefix}{link}"/>' for link in links),
        f'<joint name="stand" type="fixed"><parent link="world"/><child link="{prefix}{base}"/>'
        '<origin xyz="0.3 -0.2 0.7" rpy="0.1 0.2 0.3"/></joint>',
    ]
    for i, row in enumerate([*rows, flange]):
        xyz, rpy = (" ".join(map(repr, part)) for part in (row[:3], row[3:]))
        kind = "revolute"
        if i == len(rows):
            kind = "fixed"
        axis = "0 0 1"
        if i < len(axes) and axes[i]:
            axis = axes[i]
        lines.append(
            f'<joint name="{prefix}joint{i + 1}" type="{kind}"><parent link="{prefix}{links[i]}"/>'
            f'<child link="{prefix}{links[i + 1]}"/><origin xyz="{xyz}" rpy="{rpy}"/>'
            f'<axis xyz="{axis}"/><limit lower="-3" upper="3" effort="50" velocity="2"/></joint>'
        )
    return "\n".join([*lines, "</robot>", ""])
