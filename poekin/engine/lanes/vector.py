"""The scalar of `rows` for Numba: a vector of four numbers, its operators and its rows.

Importing this module registers them. Vectors that a processor lacks, LLVM makes of what it has.
"""

from __future__ import annotations

import math
import operator

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.typeconv.castgraph import Conversion
from numba.extending import intrinsic, lower_cast, models, overload, register_model

from ...formulas import elementary
from . import rows as lanes

_COUNT = 4
_VECTOR = ir.VectorType(ir.DoubleType(), _COUNT)


class Lanes(types.Type):
    """Four numbers; a number is taken four times where it meets them."""

    def unify(self, typingctx, other):
        """The type that a variable has which is either."""
        if isinstance(other, types.Float):
            return self
        return None

    def can_convert_from(self, typingctx, other):
        """Whether a number of another type can be taken four times."""
        if isinstance(other, types.Float):
            return Conversion.safe
        return None


class LaneRows(types.Type):
    """Rows of four numbers, each row a scalar."""


class LaneTable(types.Type):
    """Rows of such rows, each as long as the others."""


_LANES = Lanes("Lanes")
_ROWS = LaneRows("LaneRows")
_TABLE = LaneTable("LaneTable")


@register_model(Lanes)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager, type_):
        super().__init__(manager, type_, _VECTOR)


@register_model(LaneRows)
class _RowsModel(models.PrimitiveModel):
    def __init__(self, manager, type_):
        super().__init__(manager, type_, _VECTOR.as_pointer())


@register_model(LaneTable)
class _TableModel(models.StructModel):
    def __init__(self, manager, type_):
        members = [("first", _ROWS), ("width", types.intp)]
        super().__init__(manager, type_, members)


def _vector(context, builder, value, kind):
    """A vector, or a number taken four times."""
    if kind == _LANES:
        return value
    number = context.cast(builder, value, kind, types.float64)
    empty = ir.Constant(_VECTOR, ir.Undefined)
    index = ir.IntType(32)
    first = ir.Constant(index, 0)
    one = builder.insert_element(empty, number, first)
    mask = ir.Constant(ir.VectorType(index, _COUNT), [0] * _COUNT)
    return builder.shuffle_vector(one, empty, mask)


def _vectors(context, builder, signature, values):
    pairs = zip(values, signature.args, strict=True)
    return [_vector(context, builder, value, kind) for value, kind in pairs]


@lower_cast(types.Float, Lanes)
def _cast(context, builder, fromty, toty, value):
    return _vector(context, builder, value, fromty)


def _is_scalar(x):
    return isinstance(x, (Lanes, types.Float, types.Integer))


def _register_binary(function, name):
    @intrinsic
    def of_vectors(typingctx, a, b):
        def generate(context, builder, signature, arguments):
            vectors = _vectors(context, builder, signature, arguments)
            return getattr(builder, name)(*vectors)

        return _LANES(a, b), generate

    @overload(function)
    def chosen(a, b):
        if _LANES in (a, b) and _is_scalar(a) and _is_scalar(b):
            return lambda a, b: of_vectors(a, b)  # type: ignore[call-arg]
        return None


for _function, _name in (
    (operator.add, "fadd"),
    (operator.iadd, "fadd"),
    (operator.sub, "fsub"),
    (operator.isub, "fsub"),
    (operator.mul, "fmul"),
    (operator.imul, "fmul"),
    (operator.truediv, "fdiv"),
    (operator.itruediv, "fdiv"),
):
    _register_binary(_function, _name)


def _call(builder, name, vectors):
    """A function of LLVM's own, of each lane."""
    kind = ir.FunctionType(_VECTOR, [_VECTOR] * len(vectors))
    whole = f"llvm.{name}.v{_COUNT}f64"
    used = cgutils.get_or_insert_function(builder.module, kind, whole)
    return builder.call(used, vectors)


def _register_unary(function, name):
    @intrinsic
    def of_vectors(typingctx, a):
        def generate(context, builder, signature, arguments):
            return _call(builder, name, arguments)

        return _LANES(a), generate

    @overload(function)
    def chosen(a):
        if a == _LANES:
            return lambda a: of_vectors(a)  # type: ignore[call-arg]
        return None


_register_unary(abs, "fabs")
_register_unary(math.sqrt, "sqrt")


@intrinsic
def _with_sign(typingctx, a, b):
    def generate(context, builder, signature, arguments):
        vectors = _vectors(context, builder, signature, arguments)
        return _call(builder, "copysign", vectors)

    return _LANES(a, b), generate


@overload(math.copysign)
def _copysign(a, b):
    if _LANES in (a, b):
        return lambda a, b: _with_sign(a, b)  # type: ignore[call-arg]
    return None


@overload(operator.neg)
def _negative(a):
    if a == _LANES:
        return lambda a: -1.0 * a
    return None


@intrinsic
def _where_less(typingctx, a, b, x, y):
    def generate(context, builder, signature, arguments):
        a, b, x, y = _vectors(context, builder, signature, arguments)
        less = builder.fcmp_ordered("<", a, b)
        return builder.select(less, x, y)

    return _LANES(a, b, x, y), generate


@overload(elementary.where_less)
def _chosen(a, b, x, y):
    if _LANES in (a, b, x, y):
        return lambda a, b, x, y: _where_less(a, b, x, y)  # type: ignore[call-arg]
    return elementary.where_less


def _struct(context, builder, signature, arguments):
    """The array that is the first argument."""
    make = context.make_array(signature.args[0])
    return make(context, builder, arguments[0])


def _index(context, builder, signature, arguments):
    """The second argument as an index."""
    return context.cast(builder, arguments[1], signature.args[1], types.intp)


@intrinsic
def _of_array(typingctx, array):
    def generate(context, builder, signature, arguments):
        struct = _struct(context, builder, signature, arguments)
        return builder.bitcast(struct.data, _VECTOR.as_pointer())

    return _ROWS(array), generate


@intrinsic
def _of_matrix(typingctx, array):
    def generate(context, builder, signature, arguments):
        struct = _struct(context, builder, signature, arguments)
        table = cgutils.create_struct_proxy(_TABLE)(context, builder)
        table.first = builder.bitcast(struct.data, _VECTOR.as_pointer())
        count = context.get_constant(types.intp, _COUNT)
        _, columns = cgutils.unpack_tuple(builder, struct.shape)
        table.width = builder.sdiv(columns, count)
        return table._getvalue()

    return _TABLE(array), generate


@intrinsic
def _row(typingctx, table, k):
    def generate(context, builder, signature, arguments):
        whole = cgutils.create_struct_proxy(_TABLE)(context, builder, arguments[0])
        k = _index(context, builder, signature, arguments)
        start = builder.mul(k, whole.width)
        return builder.gep(whole.first, [start])

    return _ROWS(table, k), generate


# numbers of an array begin at multiples of eight bytes
_ALIGNED = 8


@intrinsic
def _loaded(typingctx, rows, k):
    def generate(context, builder, signature, arguments):
        k = _index(context, builder, signature, arguments)
        place = builder.gep(arguments[0], [k])
        return builder.load(place, align=_ALIGNED)

    return _LANES(rows, k), generate


@intrinsic
def _stored(typingctx, rows, k, x):
    def generate(context, builder, signature, arguments):
        k = _index(context, builder, signature, arguments)
        value = _vector(context, builder, arguments[2], signature.args[2])
        place = builder.gep(arguments[0], [k])
        builder.store(value, place, align=_ALIGNED)
        return context.get_dummy_value()

    return types.none(rows, k, x), generate


@overload(operator.getitem)
def _get(rows, k):
    if rows == _ROWS:
        return lambda rows, k: _loaded(rows, k)  # type: ignore[call-arg]
    if rows == _TABLE:
        return lambda rows, k: _row(rows, k)  # type: ignore[call-arg]
    return None


@overload(operator.setitem)
def _set(rows, k, x):
    if rows == _ROWS:
        return lambda rows, k, x: _stored(rows, k, x)  # type: ignore[call-arg]
    return None


@overload(lanes.at_once)
def _at_once():
    return lambda: _COUNT


@overload(lanes.rows)
def _rows(array):
    return lambda array: _of_array(array)  # type: ignore[call-arg]


@overload(lanes.table)
def _table(array):
    return lambda array: _of_matrix(array)  # type: ignore[call-arg]


OVERLOADED = (elementary.where_less, lanes.at_once, lanes.rows, lanes.table)
"""Functions that are not compiled as they stand."""
