"""Real documents to start from: the files of this repository, those of example-robot-data, and what
poekin writes.
"""

from __future__ import annotations

import gzip
import importlib.util
import io
import re
import tempfile
import zipfile
from functools import cache
from importlib import resources
from pathlib import Path

import numpy as np

import poekin as pk
from poekin.errors import MissingExtra
from poekin.formats import catalogue, dh, erd
from poekin.formats.dh import table_io as dh_files
from poekin.formats.dh.published_tables import NAMES
from poekin.formats.poses.layout import FORMATS, OF_CONTROLLERS, PoseFormat, QuaternionOrder
from poekin.formats.vendors import ur, yaml_io
from poekin.formats.vendors.known_arms import known_arms

SMALL = 16_000
"""Bytes of a file; a longer one loses its shapes and masses, which no reader looks at, and what is
beyond.
"""

_SHAPES = re.compile(
    rb"<(visual|collision|inertial|gazebo|transmission|dynamics)\b.*?</\1>|<!--.*?-->", re.DOTALL
)


@cache
def urdf() -> tuple[bytes, ...]:
    """The catalogue's, and those of example-robot-data where it is installed."""
    texts = [catalogue.text(name) for name in catalogue.NAMES]
    try:
        texts += [Path(path).read_bytes() for path in erd.available().values()]
    except MissingExtra:
        pass
    return tuple(text if len(text) <= SMALL else _shorter(text) for text in texts)


_TF2_ECHO = b"""At time 1700000000.12345
- Translation: [0.659, 0.459, 1.550]
- Rotation: in Quaternion (xyzw) [-0.604, 0.696, 0.293, 0.254]
- Rotation: in RPY (radian) [2.999, 0.787, -1.771]
- Rotation: in RPY (degree) [171.830, 45.092, -101.471]
- Matrix:
 -0.140 -0.990  0.000  0.659
"""
_LS = b"""P[1]{
   GP1:
\tUF : 1, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',
\tX =  -464.787  mm,\tY =   .002  mm,\tZ =   1.  mm,
\tW =   142.550 deg,\tP =    72.302 deg,\tR =  -130.575 deg
};
"""


@cache
def pose_texts() -> tuple[bytes, ...]:
    """Poses as each controller writes them, an LS file, and what tf2_echo prints."""
    T = pk.se3.exp([[0.1, 0.2, 0.3, 1, 2, 3], [3, 0, 0, 0, 0, 1e-9]])
    written = [
        pk.poses.write(T, format).encode()
        for format in FORMATS
        if OF_CONTROLLERS.get(format) is not None
    ]
    spreadsheet = b"X [mm];Y [mm];Z [mm];A;B;C\n1,5;2;3;10;20;30\n"
    return (*written, _TF2_ECHO, _LS, spreadsheet)


@cache
def piped() -> tuple[bytes, ...]:
    """The catalogue's as ROS prints them, by gzip and in an archive; a table and a calibration."""
    texts = urdf()[: len(catalogue.NAMES)]
    return (
        *(message(text, kind) for text in texts for kind in MESSAGES),
        *(gzip.compress(message(text, "topic")) for text in texts),
        *map(_archive, texts),
        *dh_toml()[:2],
        *dh_csv()[:2],
        *calibration_yaml()[:2],
    )


MESSAGES = ("topic", "field", "parameter", "dump")
"""Kinds of `message`."""


def message(text: bytes, kind: str) -> bytes:
    """A text as ROS prints it: of a topic, of its field, of a parameter, of all parameters."""
    quoted = b"'" + text.replace(b"'", b"''").replace(b"\n", b"\n\n  ") + b"'"
    return {
        "topic": b"data: " + quoted + b"\n---\n",
        "field": text + b"\n---\n",
        "parameter": b"String value is: " + text,
        "dump": b"/node:\n  ros__parameters:\n    robot_description: " + quoted + b"\n",
    }[kind]


def _archive(text: bytes) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("arm.urdf", text)
    return out.getvalue()


def _shorter(text: bytes) -> bytes:
    bare = re.sub(rb"\s*\n\s*", b"\n", _SHAPES.sub(b"", text))
    if len(bare) <= SMALL:
        return bare
    cut = bare.rfind(b"</joint>", 0, SMALL)
    return bare[: cut + 8] + b"</robot>"


@cache
def mjcf() -> tuple[bytes, ...]:
    """Documents with every element that the reader looks at, and most that it does not; and
    MuJoCo's own, if it is installed.
    """
    package = importlib.util.find_spec("mujoco")
    own = (
        Path(package.origin).parent / "testdata" / "model.xml"
        if package and package.origin
        else None
    )
    return (
        b"""<mujoco model="arm"><compiler angle="degree" eulerseq="XYZ" autolimits="true"/>
<default><joint axis="0 0 1" range="-90 90"/><default class="slide"><joint type="slide" range="0 0.5"/></default>
<geom type="capsule" size="0.05"/></default>
<worldbody><light pos="0 0 3"/><geom type="plane" size="1 1 1"/>
<body name="base" pos="0 0 0.1"><geom fromto="0 0 0 0 0 0.3"/>
<body name="upper" pos="0 0 0.3" euler="90 0 0"><joint name="shoulder" pos="0 0 0.01"/><joint name="roll" axis="1 0 0"/>
<geom fromto="0 0 0 0 0 0.3"/>
<frame pos="0 0 0.3" euler="0 0 30"><body name="lower"><joint name="slide" class="slide"/><geom fromto="0 0 0 0 0 1"/>
<site name="tcp" pos="0 0 1" quat="1 0 1 0"/></body></frame></body></body>
<body name="box" pos="1 0 0"><freejoint name="free"/><geom type="box" size="0.1 0.1 0.1"/></body></worldbody>
<equality><joint joint1="roll" joint2="shoulder" polycoef="0.1 0.5 0 0 0"/><weld body1="box" body2="base"/></equality>
<actuator><position joint="shoulder" kp="10"/></actuator><sensor><jointpos joint="roll"/></sensor>
<keyframe><key name="home" qpos="0 0 0 1 0 0 1 0 0 0"/></keyframe></mujoco>""",
        b"""<mujoco><asset><mesh name="m" file="m.stl"/><texture name="t" builtin="flat" type="2d" width="4"
height="4"/><material name="mat" texture="t"/></asset><worldbody><replicate count="3" offset="0.2 0 0" euler="0 0 20">
<body name="leg"><joint type="ball"/><geom type="mesh" mesh="m" material="mat"/>
<site name="foot" pos="0 0 -1"/></body>
</replicate><body mocap="true" name="target"><site name="goal"/></body>
<body name="cable"><composite type="cable" curve="s" count="5 1 1" size="1">
<geom type="capsule" size=".01"/></composite>
</body></worldbody><contact><exclude body1="world" body2="target"/></contact>
<tendon><spatial><site site="goal"/><site site="foot0"/></spatial></tendon></mujoco>""",
        *urdf()[:3],
        *((own.read_bytes(),) if own and own.is_file() else ()),
    )


def xacro() -> tuple[bytes, ...]:
    return (
        b"""<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="length" default="0.5"/>
<xacro:property name="height" value="0.75"/><xacro:macro name="body" params="n *o"><link name="${n}"/>
<xacro:if value="${n == 'b'}"><joint name="j" type="continuous"><parent link="a"/><child link="b"/>
<xacro:insert_block name="o"/></joint></xacro:if></xacro:macro>
<xacro:body n="a"><origin/></xacro:body>
<xacro:body n="b"><origin xyz="$(arg length) ${height} 0" rpy="${pi/2} 0 0"/></xacro:body></robot>""",
    )


@cache
def dh_toml() -> tuple[bytes, ...]:
    return tuple(resources.files(catalogue).joinpath(f"{name}.toml").read_bytes() for name in NAMES)


@cache
def dh_csv() -> tuple[bytes, ...]:
    return tuple(dh_files.make_text(dh.published(name), ".csv").encode() for name in NAMES)


@cache
def calibration_yaml() -> tuple[bytes, ...]:
    """Of nominal arms; of Universal Robots as the driver writes it and as ur_description reads it."""
    table = dh.published("ur10e")
    found = ur.from_dh(table, nominal=table, hash="calib_1234567890")
    both = [yaml_io.make_text(found, rpy=rpy) for rpy in ("fixed", "moving")]
    others = [yaml_io.make_text(arm.calibration) for arm in known_arms(7)]
    return tuple(text.encode() for text in (*both, *others))


@cache
def ur_conf() -> tuple[bytes, ...]:
    numbers = ", ".join(f"{x!r}" for x in (-2.4e-07, 1.6023, -1.686, 0.0837, -1.0e-07, 3.9e-08))
    names = ("delta_theta", "delta_a", "delta_d", "delta_alpha", "joint_checksum")
    return (
        "\n".join(
            ["[mounting]", *(f"{name} = [ {numbers}]" for name in names), "linearity = 1"]
        ).encode(),
    )


@cache
def chain() -> pk.Chain:
    """The chain of three joints, a, b, c, whose poses, configurations and measurements are read."""
    screws = [
        pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.revolute([0, 1, 0], [0, 0, 0.5]),
        pk.screw.prismatic([1, 0, 0]),
    ]  # fmt: skip
    return pk.Chain.from_space(
        screws, np.eye(4), q_names=["a", "b", "c"], joint_names=["a", "b", "c"]
    )


@cache
def written() -> dict[str, tuple[bytes, ...]]:
    """What poekin itself writes of that chain: poses, configurations, measurements; and
    calibrations: of it, of one with the frame of a device and with folds, and of one with a coupled
    joint and outliers.
    """
    from poekin.solve import motion
    from poekin.solve.calibration import Points, Poses
    from poekin.solve.calibration.measurements import data

    arm, found = chain(), {}
    q = arm.random(0, 12)
    T = arm.fk(q)
    coupled = pk.Chain.from_space(
        arm.screws, arm.home, joint_names=["a", "b", "c"], q_names=["a", "b"], coupling=[[1, 0], [0, 1], [0, -0.5]],
        offset=[0, 0, 0.1],
    )  # fmt: skip
    q2, X = coupled.random(0, 12), pk.se3.exp([0.1, 0.2, 0.3, 0.1, 0.2, 0.3])
    p = coupled.fk(q2 * 1.001 + 0.01)[:, :3, 3]
    p[3] += 0.2
    with tempfile.TemporaryDirectory() as folder:
        ways: list[tuple[PoseFormat, QuaternionOrder | None]] = [
            ("12", None), ("16", None), ("7", "wxyz")
        ]  # fmt: skip
        for format, order in ways:
            motion.write_poses(f"{folder}/poses{format}.csv", T[:5], format, quaternion=order)
        motion.write_joints(f"{folder}/joints.csv", q[:5], arm, times=np.arange(5.0))
        data.write(f"{folder}/measured.csv", arm, q[:5], Poses(T[:5]))
        made = (
            pk.calibrate(arm, q * 1.001 + 0.01, Poses(T), parameters=("offsets", "gains"), folds=0),
            pk.calibrate(arm, q, Points((pk.se3.inverse(X) @ T)[:, :3, 3], frame="unknown"), parameters=("offsets",),
                         folds=2, on_rank_deficiency="fix"),
            pk.calibrate(coupled, q2, Points(p), parameters=("offsets", "gains"), folds=0, loss="huber"),
        )  # fmt: skip
        for k, calibration in enumerate(made):
            calibration.save(f"{folder}/arm{k}.toml")
        for file in sorted(Path(folder).iterdir()):
            kind = re.sub(r"\d+$", "", file.stem)
            found[kind] = (*found.get(kind, ()), file.read_bytes())
    out = io.BytesIO()
    np.save(out, q)
    return found | {"npy": (out.getvalue(),)}
