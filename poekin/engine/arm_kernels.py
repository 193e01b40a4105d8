"""Kernels that run one arm's machine code (`engine.machine_code`) over configurations: sines and cosines, then the arm.

An arm comes as the address of five integers (`engine.arm.Arm`): those of its two functions and of its table of angles,
and the table's rows and columns; one integer is handed over in less time than an array. The table has a row for each
angle: the number of an earlier one that it adds to or -1, its offset, and the factor of each coordinate. T or J is left
alone where the arm's program does not have it: then the other one stands in its place.
A kernel for one configuration returns 0, and has done nothing, where the arrays' shapes are others or their memory is
shared. Importing this module imports Numba.
"""

# pyright: reportCallIssue=false, reportGeneralTypeIssues=false, reportPrivateImportUsage=false
# (an intrinsic is called with fewer arguments than it is written with)
import numpy as np
from llvmlite import ir
from numba import carray, types
from numba.core import cgutils
from numba.extending import intrinsic

from .kernel import kernel
from .machine_code import LANES, SIGNATURE
from .rows import borrowed
from .sincos import MODERATE, moderate, sincos

BLOCK = 64  # configurations whose sines and cosines are held at a time


@intrinsic
def _run(typing_context, code, sines, cosines, stride, lane, q, T, J, row):
    """Call the machine code: configuration `lane` of the sines and cosines, `row` of q, T and J."""
    int64, arguments = ir.IntType(64), (code, sines, cosines, stride, lane, q, T, J, row)

    def generate(context, builder, signature, values):
        def array(i):
            return context.make_array(signature.args[i])(context, builder, values[i])

        def place(i, size):
            return builder.gep(array(i).data, [builder.mul(values[8], size)])

        def width(i):
            return cgutils.unpack_tuple(builder, array(i).shape, signature.args[i].ndim)[-1]

        function = builder.inttoptr(values[0], SIGNATURE.as_pointer())
        sine, cosine = (builder.gep(array(i).data, [values[4]]) for i in (1, 2))
        columns = builder.mul(width(7), ir.Constant(int64, 6))
        sixteen = ir.Constant(int64, 16)
        places = [place(5, width(5)), width(5), place(6, sixteen), place(7, columns)]
        builder.call(function, [sine, cosine, values[3], *places])
        return context.get_dummy_value()

    return types.void(*arguments), generate


@intrinsic
def _pointer(typing_context, address, kind):
    """An address as a pointer to numbers of a kind."""

    def generate(context, builder, signature, values):
        return builder.inttoptr(values[0], context.get_value_type(signature.return_type))

    return types.CPointer(kind.dtype)(address, kind), generate


def _parts(arm):
    """The two functions and the table of angles of an arm."""
    numbers = carray(_pointer(arm, np.int64), 5)
    return numbers[0], numbers[1], carray(_pointer(numbers[2], np.float64), (numbers[3], numbers[4]))


def _one(code, angles, q, T, J, scratch):
    """One configuration; the memory of the results holds the sines and cosines until they are overwritten."""
    count = angles.shape[0]
    if 2 * count > scratch.size:
        scratch = np.empty(2 * count)
    sines, cosines = scratch[:count], scratch[count:]
    for j in range(count):
        base = int(angles[j, 0])
        x = angles[j, 1]
        if base >= 0:
            x += sines[base]
        for k in range(len(q)):
            x += angles[j, 2 + k] * q[k]
        sines[j] = x
    for j in range(count):
        sines[j], cosines[j] = sincos(sines[j])
    _run(code, sines, cosines, 1, 0, q, T, J, 0)


def _apart(a, b):
    """Whether two arrays share no memory."""
    start, start2 = a.ctypes.data, b.ctypes.data
    return start + 8 * a.size <= start2 or start2 + 8 * b.size <= start


def _fits(angles, q, out):
    """Whether q has the arm's coordinates, and shares no memory with what is written."""
    return q.shape[0] == angles.shape[1] - 2 and _apart(q, out)


@kernel("int w1 w2", returns="int", quick=True)
def pose_one(arm, q, T):
    """f(q) of one configuration."""
    code, _, angles = _parts(arm)
    if T.shape[0] != 4 or T.shape[1] != 4 or not _fits(angles, q, T):
        return 0
    q, T = borrowed(q), borrowed(T)
    _one(code, angles, q, T, T, T.reshape(T.size))
    return 1


@kernel("int w1 w2", returns="int", quick=True)
def jacobian_one(arm, q, J):
    """The Jacobian of one configuration."""
    code, _, angles = _parts(arm)
    if J.shape[0] != 6 or J.shape[1] != q.shape[0] or not _fits(angles, q, J):
        return 0
    q, J = borrowed(q), borrowed(J)
    _one(code, angles, q, J, J, J.reshape(J.size))
    return 1


@kernel("int w1 w2 w2", returns="int", quick=True)
def pose_jacobian_one(arm, q, T, J):
    """f(q) and the Jacobian of one configuration."""
    code, _, angles = _parts(arm)
    if T.shape[0] != 4 or T.shape[1] != 4 or J.shape[0] != 6 or J.shape[1] != q.shape[0]:
        return 0
    if not (_fits(angles, q, T) and _fits(angles, q, J) and _apart(T, J)):
        return 0
    q, T, J = borrowed(q), borrowed(T), borrowed(J)
    _one(code, angles, q, T, J, J.reshape(J.size))
    return 1


def _block(angles, q, start, size, sines, cosines):
    """Sines and cosines of all angles of some configurations."""
    usual = True
    for j in range(angles.shape[0]):
        base, x = int(angles[j, 0]), sines[j]
        for k in range(size):
            x[k] = angles[j, 1]
        if base >= 0:
            for k in range(size):
                x[k] += sines[base, k]
        for i in range(q.shape[1]):
            factor = angles[j, 2 + i]
            if factor != 0.0:
                for k in range(size):
                    x[k] += factor * q[start + k, i]
        for k in range(size):
            usual &= abs(x[k]) <= MODERATE
    for j in range(angles.shape[0]):
        x, y = sines[j], cosines[j]
        if usual:
            for k in range(size):
                x[k], y[k] = moderate(x[k])
        else:
            for k in range(size):
                x[k], y[k] = sincos(x[k])


def _many(arm, q, T, J):
    """All configurations, four at a time, what is left one at a time."""
    one, four, angles = _parts(arm)
    sines, cosines = np.empty((angles.shape[0], BLOCK)), np.empty((angles.shape[0], BLOCK))
    for start in range(0, q.shape[0], BLOCK):
        size = min(BLOCK, q.shape[0] - start)
        _block(angles, q, start, size, sines, cosines)
        whole = size - size % LANES
        for k in range(0, whole, LANES):
            _run(four, sines, cosines, BLOCK, k, q, T, J, start + k)
        for k in range(whole, size):
            _run(one, sines, cosines, BLOCK, k, q, T, J, start + k)


@kernel("int w2 w3")
def pose_many(arm, q, T):
    """f(q) of many configurations."""
    _many(arm, borrowed(q), borrowed(T), borrowed(T))


@kernel("int w2 w3")
def jacobian_many(arm, q, J):
    """The Jacobian of many configurations."""
    _many(arm, borrowed(q), borrowed(J), borrowed(J))


@kernel("int w2 w3 w3")
def pose_jacobian_many(arm, q, T, J):
    """f(q) and the Jacobian of many configurations."""
    _many(arm, borrowed(q), borrowed(T), borrowed(J))
