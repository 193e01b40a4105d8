"""Kernels that run the machine code of one arm over configurations: sines and cosines, then the
arm.

An arm comes as the address of five integers (`engine.straight_line.arm_code.ArmCode`): how many angles and
coordinates it has, and where its three functions are; one integer is handed over in less time than
an array. T or J is left alone where the arm's program does not have it: then the other one stands
in its place. A kernel for one configuration returns 0, and has done nothing, where the arrays'
shapes are others or their memory is shared. Importing this module imports Numba.
"""

# pyright: reportCallIssue=false, reportGeneralTypeIssues=false, reportPrivateImportUsage=false
# (an intrinsic is called with fewer arguments than it is written with)
import numpy as np
from llvmlite import ir
from numba import carray, types
from numba.core import cgutils
from numba.extending import intrinsic

from ..jit.array_io import without_refcount
from ..jit.kernel import kernel
from ..straight_line.machine_code import ANGLES, LANES, SIGNATURE
from ..straight_line.sincos import MODERATE, moderate, sincos

BLOCK = 64  # configurations whose sines and cosines are held at a time
_INT = ir.IntType(64)


def _array(context, builder, signature, values, i):
    make = context.make_array(signature.args[i])
    return make(context, builder, values[i])


def _width(context, builder, signature, values, i):
    """The length of an array's last axis."""
    shape = _array(context, builder, signature, values, i).shape
    axes = signature.args[i].ndim
    return cgutils.unpack_tuple(builder, shape, axes)[-1]


@intrinsic
def _angles(typing_context, code, q, row, sines, stride, lane):
    """Call `angles` of the machine code: those of `row` of q, each at [stride j + lane] of the
    sines.
    """

    def generate(context, builder, signature, values):
        function = builder.inttoptr(values[0], ANGLES.as_pointer())
        arguments = (context, builder, signature, values)
        q = _array(*arguments, 1).data
        sines = _array(*arguments, 3).data
        _, _, row, _, stride, lane = values
        start = builder.mul(row, _width(*arguments, 1))
        row_of_q = builder.gep(q, [start])
        first = builder.gep(sines, [lane])
        builder.call(function, [row_of_q, first, stride])
        return context.get_dummy_value()

    return types.void(code, q, row, sines, stride, lane), generate


@intrinsic
def _run(typing_context, code, sines, cosines, stride, lane, q, T, J, row):
    """Call `one` or `four` of the machine code: the lane of the sines and cosines, the row of q, T
    and J.
    """

    def generate(context, builder, signature, values):
        function = builder.inttoptr(values[0], SIGNATURE.as_pointer())
        arguments = (context, builder, signature, values)
        _, _, _, stride, lane, _, _, _, row = values
        sines, cosines = (_array(*arguments, i).data for i in (1, 2))
        q, T, J = (_array(*arguments, i).data for i in (5, 6, 7))
        width = _width(*arguments, 5)
        columns = _width(*arguments, 7)
        entries = builder.mul(columns, ir.Constant(_INT, 6))
        sizes = width, ir.Constant(_INT, 16), entries
        q, T, J = (
            builder.gep(a, [builder.mul(row, s)]) for a, s in zip((q, T, J), sizes, strict=True)
        )
        sines, cosines = (builder.gep(a, [lane]) for a in (sines, cosines))
        builder.call(function, [sines, cosines, stride, q, width, T, J])
        return context.get_dummy_value()

    return types.void(code, sines, cosines, stride, lane, q, T, J, row), generate


@intrinsic
def _integers(typing_context, address):
    """An address as a pointer to integers."""

    def generate(context, builder, signature, values):
        kind = context.get_value_type(signature.return_type)
        return builder.inttoptr(values[0], kind)

    return types.CPointer(types.int64)(address), generate


def _header(arm):
    """Angles, coordinates, and the addresses of the functions `angles`, `one` and `four` of an arm."""
    return carray(_integers(arm), 5)


def sines_room(arm):
    """Number of angles of an arm."""
    return _header(arm)[0]


def sines_of_block(arm, q, sines, cosines):
    """Sines and cosines of the angles of a block of configurations, q (m, BLOCK), by code whose
    layout is "columns".
    """
    count = _header(arm)[0]
    angles = _header(arm)[2]
    for k in range(0, BLOCK, LANES):
        _angles(angles, q[0, k:], 0, sines, BLOCK, k)
    for j in range(count):
        _sines_cosines(sines[j], cosines[j], BLOCK)


def run_columns(arm, sines, cosines, k, q, R_p, J):
    """Four configurations of a block, from its k-th on: the pose's numbers in R_p (12, BLOCK), from
    its k-th column on, and the Jacobian's in J (6 m, LANES).
    """
    columns = _header(arm)[3]
    _run(columns, sines, cosines, BLOCK, k, q[0, k:], R_p[0, k:], J, 0)


def _all_moderate(sines, count):
    """Whether all angles are moderate."""
    usual = True
    for k in range(count):
        usual &= abs(sines[k]) <= MODERATE
    return usual


def _sines_cosines(sines, cosines, count):
    """Angles to sines, in place, and cosines."""
    if _all_moderate(sines, count):
        for k in range(count):
            sines[k], cosines[k] = moderate(sines[k])
    else:
        for k in range(count):
            sines[k], cosines[k] = sincos(sines[k])


def run_one(arm, q, T, J, scratch):
    """One configuration; the memory of the results holds the sines and cosines until they are
    overwritten.
    """
    count, _, angles, one, _ = _header(arm)
    # full lanes are faster, whatever is in the last of them
    whole = (count + LANES - 1) // LANES * LANES
    if 2 * whole > scratch.size:
        scratch = np.empty(2 * whole)
    sines = scratch[:whole]
    cosines = scratch[whole:]
    for k in range(count, whole):
        sines[k] = 0.0
    _angles(angles, q, 0, sines, 1, 0)
    _sines_cosines(sines, cosines, whole)
    _run(one, sines, cosines, 1, 0, q, T, J, 0)


def run_four(arm, q, T, J, scratch):
    """Four configurations, q (4, m), T (4, 4, 4) and J (4, 6, m)."""
    count, _, angles, _, four = _header(arm)
    size = LANES * count
    if 2 * size > scratch.size:
        scratch = np.empty(2 * size)
    sines = scratch[:size]
    cosines = scratch[size:]
    for k in range(LANES):
        _angles(angles, q, k, sines, LANES, k)
    _sines_cosines(sines, cosines, size)
    _run(four, sines, cosines, LANES, 0, q, T, J, 0)


def _apart(a, b):
    """Whether two arrays share no memory."""
    start = a.ctypes.data
    start2 = b.ctypes.data
    end = start + 8 * a.size
    end2 = start2 + 8 * b.size
    return end <= start2 or end2 <= start


@kernel("int w1 w2", returns="int", quick=True)
def pose_one(arm, q, T):
    """f(q) of one configuration."""
    m = _header(arm)[1]
    if len(q) != m or T.shape != (4, 4) or not _apart(q, T):
        return 0
    q = without_refcount(q)
    T = without_refcount(T)
    run_one(arm, q, T, T, T.reshape(T.size))
    return 1


@kernel("int w1 w2", returns="int", quick=True)
def jacobian_one(arm, q, J):
    """The Jacobian of one configuration."""
    m = _header(arm)[1]
    if len(q) != m or J.shape != (6, m) or not _apart(q, J):
        return 0
    q = without_refcount(q)
    J = without_refcount(J)
    run_one(arm, q, J, J, J.reshape(J.size))
    return 1


@kernel("int w1 w2 w2", returns="int", quick=True)
def pose_jacobian_one(arm, q, T, J):
    """f(q) and the Jacobian of one configuration."""
    m = _header(arm)[1]
    if len(q) != m or T.shape != (4, 4) or J.shape != (6, m):
        return 0
    apart = _apart(q, T) and _apart(q, J)
    if not apart or not _apart(T, J):
        return 0
    q = without_refcount(q)
    T = without_refcount(T)
    J = without_refcount(J)
    run_one(arm, q, T, J, J.reshape(J.size))
    return 1


def _many(arm, q, T, J):
    """All configurations, four at a time, what is left one at a time."""
    count, _, angles, one, four = _header(arm)
    sines = np.empty((count, BLOCK))
    cosines = np.empty((count, BLOCK))
    for start in range(0, q.shape[0], BLOCK):
        size = min(BLOCK, q.shape[0] - start)
        for k in range(size):
            _angles(angles, q, start + k, sines, BLOCK, k)
        for j in range(count):
            _sines_cosines(sines[j], cosines[j], size)
        whole = size - size % LANES
        for k in range(0, whole, LANES):
            _run(four, sines, cosines, BLOCK, k, q, T, J, start + k)
        for k in range(whole, size):
            _run(one, sines, cosines, BLOCK, k, q, T, J, start + k)


@kernel("int w2 w3")
def pose_many(arm, q, result):
    """f(q), or the Jacobian, of many configurations: what the arm's code is of."""
    result = without_refcount(result)
    _many(arm, without_refcount(q), result, result)


jacobian_many = pose_many


@kernel("int w2 w3 w3")
def pose_jacobian_many(arm, q, T, J):
    """f(q) and the Jacobian of many configurations."""
    _many(arm, without_refcount(q), without_refcount(T), without_refcount(J))
