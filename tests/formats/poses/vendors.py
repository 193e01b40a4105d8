"""Conventions of controllers as their manuals state them: the rotation of their three numbers,
multiplied out of elementary rotations in mpmath, and numbers out of manuals and real files.

Every rotation is that of the tool in its frame (columns: the tool's axes), right-handed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import mpmath
import numpy as np

from poekin.formats.poses.layout import PoseFormat


def about(axis: str, degrees: Any) -> Any:
    """The elementary rotation about x, y or z."""
    angle = mpmath.mpf(degrees) * mpmath.pi / 180
    s, c = mpmath.sin(angle), mpmath.cos(angle)
    rows = {
        "x": [[1, 0, 0], [0, c, -s], [0, s, c]],
        "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
        "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]],
    }
    return mpmath.matrix(rows[axis])


def yaskawa_quaternion(rx: Any, ry: Any, rz: Any) -> Any:
    """The quaternion that Basler's page on Yaskawa writes out, as a rotation."""
    half = [mpmath.mpf(a) * mpmath.pi / 360 for a in (rx, ry, rz)]
    sx, sy, sz = map(mpmath.sin, half)
    cx, cy, cz = map(mpmath.cos, half)
    return of_quaternion(
        cz * cy * cx + sz * sy * sx,
        cz * cy * sx - sz * sy * cx,
        cz * sy * cx + sz * cy * sx,
        sz * cy * cx - cz * sy * sx,
    )


def of_quaternion(w: Any, x: Any, y: Any, z: Any) -> Any:
    """The rotation of a unit quaternion, entry by entry as the RAPID reference has it ("orient")."""
    return mpmath.matrix(
        [
            [2 * (w * w + x * x) - 1, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 2 * (w * w + y * y) - 1, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 2 * (w * w + z * z) - 1],
        ]
    )


class Vendor(NamedTuple):
    """A format, its rotation of three angles in degrees, and where that is stated."""

    format: PoseFormat
    rotation: Callable[[Any, Any, Any], Any]
    source: str


VENDORS = (
    Vendor(
        "kuka",
        lambda a, b, c: about("z", a) * about("y", b) * about("x", c),
        "KUKA.OfficeLite/KSS: A about z, B about y', C about x''; docs.baslerweb.com pose_format_kuka",
    ),
    Vendor(
        "fanuc",
        lambda w, p, r: about("z", r) * about("y", p) * about("x", w),
        "W, P, R about the fixed x, y, z in this order; docs.baslerweb.com pose_format_fanuc",
    ),
    Vendor("yaskawa", yaskawa_quaternion, "docs.baslerweb.com pose_format_yaskawa"),
    Vendor(
        "mitsubishi",
        lambda a, b, c: about("z", c) * about("y", b) * about("x", a),
        "docs.baslerweb.com pose_format_mitsubishi; the melfa driver's setRPY(a, b, c)",
    ),
    Vendor(
        "staubli",
        lambda rx, ry, rz: about("x", rx) * about("y", ry) * about("z", rz),
        "VAL3: turns about the moving x, y, z; RoboDK robomath Pose_2_Staubli; visose EulerXYZ",
    ),
    Vendor(
        "doosan",
        lambda a, b, c: about("z", a) * about("y", b) * about("z", c),
        "DoosanRobotics/doosan-robot issue 87: ZYZ Euler angles",
    ),
    Vendor(
        "kawasaki",
        lambda o, a, t: about("z", o) * about("y", a) * about("z", t),
        "V+ Language User's Guide p. 168, ZYZ'; docs.baslerweb.com pose_format_kawasaki",
    ),
)
ALIASES: dict[PoseFormat, PoseFormat] = {"abc": "kuka", "wpr": "fanuc", "zyz": "doosan"}


class Example(NamedTuple):
    """Numbers of a pose out of a manual or a file, its rotation there or worked out by hand from
    the convention, and half a unit of the last digit of either.
    """

    format: PoseFormat
    numbers: tuple[float, ...]
    R: Any
    digits: float
    source: str


def _rows(*numbers: float) -> np.ndarray:
    return np.reshape(numbers, (3, 3))


EXAMPLES = (
    Example(
        "ur",
        (0.2, 0.3, 0.5, 3.14, 1.57, 0),
        _rows(0.613465, 0.773070, -0.161317, 0.773070, -0.546141, 0.322633, 0.161317, -0.322633, -0.932676),
        5e-7,
        "URScript directory, rotvec2rpy([3.14, 1.57, 0]) = [-2.80856, -0.16202, 0.9]",
    ),
    Example(
        "rpy",
        (0, 0, 0, -2.80856, -0.16202, 0.9),
        _rows(0.613465, 0.773070, -0.161317, 0.773070, -0.546141, 0.322633, 0.161317, -0.322633, -0.932676),
        1e-5,
        "the same, of the rpy that the manual prints to five decimals",
    ),
    Example(
        "ur",
        (0.2, 0.3, 0.5, 2.22153, 0.00177, -2.21976),
        _rows(0.000796, 0.001593, -0.999998, 0, -0.999999, -0.001593, -1, 0.000001, -0.000796),
        1e-5,
        "URScript directory, rpy2rotvec([3.14, 1.57, 0])",
    ),
    Example(
        "abb",
        (600, 500, 225.3, 0.965926, 0, 0.258819, 0),
        _rows(np.sqrt(3) / 2, 0, 0.5, 0, 1, 0, -0.5, 0, np.sqrt(3) / 2),
        1e-6,
        "RAPID reference, orient, example 2: x' = (cos 30, 0, -sin 30), z' = (sin 30, 0, cos 30)",
    ),
    Example(
        "abb",
        (449.998977661, 699.995788574, 240, 0, 0.707106781, 0.707106781, 0),
        _rows(0, 1, 0, 1, 0, 0, 0, 0, -1),
        1e-8,
        "a robtarget of RobotStudio, nine decimals",
    ),
    Example(
        "kawasaki",
        (0, 0, 0, 90, -30, -90),
        _rows(1, 0, 0, 0, np.sqrt(3) / 2, -0.5, 0, 0.5, np.sqrt(3) / 2),
        1e-15,
        "TRANS(0,0,0,90,-30,-90) is 30 degrees about x: industrialmonitordirect.com",
    ),
    Example(
        "kuka",
        (0, 0, 0, 45, 60, 22.5),
        _rows(0.3536, -0.4189, 0.8364, 0.3536, 0.8876, 0.2952, -0.8660, 0.1913, 0.4619),
        5e-5,
        "MATLAB se3, eul2tform ZYX of [pi/4 pi/3 pi/8]",
    ),
    Example(
        "kuka",
        (280, 0, -10, 30, 90, 0),
        _rows(0, -0.5, np.sqrt(3) / 2, 0, np.sqrt(3) / 2, 0.5, -1, 0, 0),
        1e-15,
        "javakuka.org/26.html: PTP {X 280, Y 0, Z -10, A 30, B 90, C 0}",
    ),
    Example(
        "doosan",
        (0, 0, 0, 0, 90, 90),
        _rows(0, 0, 1, 1, 0, 0, 0, 1, 0),
        1e-15,
        "MATLAB eul2rotm ZYZ of [0 pi/2 pi/2]",
    ),
    Example(
        "fanuc",
        (0, 0, 0, 142.550, 72.302, -130.575),
        _rows(-0.197735, -0.979794, 0.030075, -0.230905, 0.076373, 0.969974, -0.952672, 0.184853, -0.241341),
        5e-7,
        "a position of an LS file",
    ),
    Example(
        "staubli",
        (0, 0, 0, 23, -41, 67),
        _rows(0.294889, -0.694714, -0.656059, 0.747168, 0.595635, -0.294889, 0.595635, -0.403227, 0.694714),
        5e-7,
        "visose/Robots, test values of EulerXYZ",
    ),
    Example(
        "mitsubishi",
        (0, 0, 100, 0, -90, 0),
        _rows(0, 0, -1, 0, 1, 0, 1, 0, 0),
        1e-15,
        "MELFA BFP-A8787 p. 91: the tool (0,0,100,0,-90,0)",
    ),
    Example(
        "yaskawa",
        (185, 0, 85, 180, 0, 0),
        _rows(1, 0, 0, 0, -1, 0, 0, 0, -1),
        1e-15,
        "a position of a JBI file: C00000=185.000,0.000,85.000,180.0000,0.0000,0.0000",
    ),
)  # fmt: skip

# R = Rz(30) Ry(20) Rx(10) in every format, its numbers to 13 digits, of lengths 1 m, 2 m, 3 m.
ONE_ROTATION: dict[PoseFormat, tuple[float, ...]] = {
    "abc": (30, 20, 10),
    "kuka": (30, 20, 10),
    "wpr": (10, 20, 30),
    "fanuc": (10, 20, 30),
    "yaskawa": (10, 20, 30),
    "mitsubishi": (10, 20, 30),
    "rpy": (0.17453292519943295, 0.3490658503988659, 0.5235987755982988),
    "rotvec": (0.0775253166151, 0.3848515688452, 0.4864792299808),
    "ur": (0.0775253166151, 0.3848515688452, 0.4864792299808),
    "abb": (0.9515485246438, 0.0381345764749, 0.1893078574120, 0.2392983377447),
    "ros": (0.0381345764749, 0.1893078574120, 0.2392983377447, 0.9515485246438),
    "staubli": (-1.1160546770046, 22.2421809103095, 28.4517752565855),
    "zyz": (2.7268304431963, 22.2687444952969, 25.5055502609826),
    "doosan": (2.7268304431963, 22.2687444952969, 25.5055502609826),
    "kawasaki": (2.7268304431963, 22.2687444952969, 25.5055502609826),
}
