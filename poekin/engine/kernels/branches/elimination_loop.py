"""The loop that six revolute joints close, read from either end and begun at any joint.

Arm: the table (9, 9) of `elimination_kernels`.
"""

from ....algebra import (
    add,
    compose,
    cross,
    inverse,
    make_pose,
    rotate,
    scale,
    subtract,
    transform,
)
from ....formulas.ik.slides.position import across
from ...jit.array_io import load_matrix
from .closed_arm import vector

UNIT = 0
REVERSED = 1
BEGIN = 2
QUARTERS = 3


def nine(numbers):
    """Nine numbers of a row, or of a pose, as a rotation."""
    return (
        numbers[0],
        numbers[1],
        numbers[2],
        numbers[3],
        numbers[4],
        numbers[5],
        numbers[6],
        numbers[7],
        numbers[8],
    )


def motion(arm, target):
    """G of e_1 ... e_6 = G in the arm's unit of length."""
    T = load_matrix(target)
    tip = vector(arm[6], 3)
    for i in range(6):
        tip = add(tip, vector(arm[i], 3))
    home = make_pose(nine(arm[7]), tip)
    return compose(T, inverse(home))


def is_far_side_fixed(arm):
    """Whether the target moves none of the axes from the second one on among themselves."""
    begin = arm[8][BEGIN]
    return begin == 0.0 or begin == 5.0


def loop(arm, G, axes):
    """Writes directions and points of the six axes in the order of the loop, the second axis the z
    axis, and returns the motion they make.

    e_begin ... e_5 e_0 ... = G, the axes that come first moved by G itself.
    """
    how = arm[8]
    unit = 1.0 / how[UNIT]
    begin = int(how[BEGIN])
    is_reversed = how[REVERSED] != 0.0
    o = (0.0, 0.0, 0.0)
    for i in range(6):
        o = add(o, vector(arm[i], 3))
        h = vector(arm[i], 0)
        k = i
        if is_reversed:
            h = scale(-1.0, h)
            k = 5 - i
        k = (k - begin) % 6
        _store(axes[k], h, o)
    if is_reversed:
        G = inverse(G)
    if begin > 0:
        for k in range(6 - begin):
            h = rotate(G, _direction(axes, k))
            o = transform(G, point(axes, k))
            _store(axes[k], h, o)
    z = _direction(axes, 1)
    x = across(z)
    rotation = (*x, *cross(z, x), *z)
    origin = rotate(rotation, point(axes, 1))
    frame = make_pose(rotation, scale(-1.0, origin))
    for k in range(6):
        h = rotate(frame, _direction(axes, k))
        o = transform(frame, point(axes, k))
        _store(axes[k], h, scale(unit, o))
    G = compose(compose(frame, G), inverse(frame))
    shift = (G[9], G[10], G[11])
    return make_pose(nine(G), scale(unit, shift))


def _direction(axes, k):
    return vector(axes[k], 0)


def point(axes, k):
    """A point of the k-th axis."""
    return vector(axes[k], 3)


def _store(row, h, o):
    for j in range(3):
        row[j] = h[j]
        row[3 + j] = o[j]


def directions(axes):
    """Directions of the six axes."""
    return (
        _direction(axes, 0),
        _direction(axes, 1),
        _direction(axes, 2),
        _direction(axes, 3),
        _direction(axes, 4),
        _direction(axes, 5),
    )


def _step(axes, i):
    begin = point(axes, i)
    end = point(axes, i + 1)
    return subtract(end, begin)


def steps(axes):
    """Steps from each axis's point to the next one's."""
    return (
        _step(axes, 0),
        _step(axes, 1),
        _step(axes, 2),
        _step(axes, 3),
        _step(axes, 4),
    )
