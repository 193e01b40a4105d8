"""A straight-line program as machine code, for one configuration and for four at a time.

The program is handed to LLVM as it is: nothing is left in it to be found out, so this takes a tenth
of a second where a compiler of Python would take a few. Products and sums may be fused; nothing
else is reordered.

    angles(q, sines, stride)
    one(sines, cosines, stride, q, width, T, J)    four(...)    columns(...)

`angles` writes the angle j of one configuration to sines[stride j]: it becomes its sine there. The
others read sine and cosine of angle j at [stride j + lane], and coordinate k at q[width lane + k]
where joints slide; they write the pose's 16 numbers at T[16 lane], and the Jacobian's 6 m at J[6 m
lane]. What the program does not have is not written.

`columns`, which stands alone, takes four too and leaves each number with those of its like: number i
of the pose's twelve at T[stride i + lane], of the Jacobian at J[4 i + lane]. So does its `angles`,
whose q and sines are of four: coordinate k is at q[stride k + lane] to both. Nothing is fused in
it: it gives the same bits on every processor.
"""

# pyright: reportCallIssue=false
# (llvmlite's builder wraps its methods, and their signatures are lost on the way)
from __future__ import annotations

from functools import reduce
from typing import Any, Literal

from llvmlite import binding, ir
from numba.core import codegen, config

from .program import Program
from .trace import Node

LANES = 4
LONGEST = 512
"""Steps and stores in a block of LLVM's, whose scheduling takes time as the square of a block's
length.
"""
Layout = Literal["rows", "columns"]
FUNCTIONS: dict[Layout, dict[str, int]] = {
    "rows": {"one": 1, "four": LANES},
    "columns": {"columns": LANES},
}
"""Functions of a layout of the results, and configurations that each takes."""
_CONTRACT = ("contract",)
_DOUBLE = ir.DoubleType()
_INT = ir.IntType(64)
_INDEX = ir.IntType(32)
_POINTER = _DOUBLE.as_pointer()
ANGLES = ir.FunctionType(ir.VoidType(), [_POINTER, _POINTER, _INT])
SIGNATURE = ir.FunctionType(
    ir.VoidType(),
    [_POINTER, _POINTER, _INT, _POINTER, _INT, _POINTER, _POINTER],
)


def processor() -> tuple[str, str]:
    """LLVM's name and features of the processor: the host's, or those of NUMBA_CPU_NAME and
    NUMBA_CPU_FEATURES.
    """
    name = config.CPU_NAME  # type: ignore[attr-defined]
    features = config.CPU_FEATURES  # type: ignore[attr-defined]
    return (
        name or binding.get_host_cpu_name(),
        codegen.get_host_cpu_features() if features is None else features,
    )


def target_machine() -> Any:
    """The machine that the code is made for."""
    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    name, features = processor()
    target = binding.Target.from_default_triple()
    return target.create_target_machine(
        cpu=name,
        features=features,
        opt=3,
        jit=True,
        codemodel="jitdefault",
    )


def object_code(program: Program, pose: bool, layout: Layout = "rows") -> bytes:
    """The machine code of a program whose outputs begin with a pose or not."""
    module = ir.Module("arm")
    module.triple = binding.get_default_triple()
    lanes = LANES if layout == "columns" else 1
    _Function(module, "angles", lanes, layout, ANGLES).write_angles(program)
    for name, lanes in FUNCTIONS[layout].items():
        _Function(module, name, lanes, layout).write(program, pose)
    # LLVM keeps constants as long as their context: in the global one those of every arm would stay
    parsed = binding.parse_assembly(str(module), binding.create_context())
    parsed.verify()
    return target_machine().emit_object(parsed)


class LoadedCode:
    """Machine code in memory: the addresses of `angles` and of the layout's functions hold as long
    as this object lives.
    """

    def __init__(self, code: bytes, layout: Layout = "rows"):
        target = target_machine()
        self._engine = binding.create_mcjit_compiler(binding.parse_assembly(""), target)
        self._engine.add_object_file(binding.ObjectFileRef.from_data(code))
        self._engine.finalize_object()
        names = "angles", *FUNCTIONS[layout]
        self.addresses = tuple(map(self._engine.get_function_address, names))


class _Function:
    """One function of the module, over `lanes` configurations side by side."""

    def __init__(
        self,
        module: ir.Module,
        name: str,
        lanes: int,
        layout: Layout,
        signature: ir.FunctionType = SIGNATURE,
    ):
        self.function = ir.Function(module, signature, name)
        self.build = ir.IRBuilder(self.function.append_basic_block())
        self.lanes = lanes
        self.layout = layout
        self.flags = _CONTRACT if layout == "rows" else ()
        self.length = 0
        self.type = _DOUBLE if lanes == 1 else ir.VectorType(_DOUBLE, lanes)

    def write_angles(self, program: Program) -> None:
        """All of `angles`."""
        build = self.build
        q, sines, stride = self.function.args
        values: list[Any] = []
        for angle in program.angles:
            parts = [] if angle.base is None else [values[angle.base]]
            for k, factor in angle.terms:
                x = self._coordinate(k, q, stride, _INT(0))
                if factor == -1:
                    x = build.fneg(x)
                elif factor != 1:
                    x = build.fmul(self._constant(factor), x)
                parts.append(x)
            if angle.offset:
                parts.append(self._constant(angle.offset))
            values.append(reduce(build.fadd, parts))
        for j, value in enumerate(values):
            build.store(value, self._row(sines, stride, j), align=8)
        build.ret_void()

    def write(self, program: Program, pose: bool) -> None:
        """All of it: inputs, steps, outputs."""
        build = self.build
        values = {}
        for number, node in program.steps:
            self._extend_block()
            if node.kind == "input":
                values[number] = self._input(int(node.first))
                continue
            if node.kind == "constant":
                values[number] = self._constant(node.first)
                continue
            second = values[node.second]
            if node.kind == "scaled":
                factor = self._constant(node.first)
                values[number] = build.fmul(factor, second, flags=self.flags)
            elif node.kind == "reciprocal":
                one = self._constant(1.0)
                values[number] = build.fdiv(one, second)
            else:
                operation = self._operation(node)
                first = values[int(node.first)]
                values[number] = operation(first, second, flags=self.flags)
        outputs = [self._output(values, number, sign) for number, sign in program.outputs]
        _, _, stride, *_, T, J = self.function.args
        numbers = outputs[:12] if pose else []
        entries = outputs[len(numbers) :]
        if self.layout == "columns":
            self._store_columns(T, numbers, stride)
            self._store_columns(J, entries, _INT(LANES))
        else:
            if pose:
                R = numbers[:9]
                rows = []
                for k, p in enumerate(numbers[9:]):
                    rows += [*R[3 * k : 3 * k + 3], p]
                last_row = map(self._constant, (0.0, 0.0, 0.0, 1.0))
                self._store(T, [*rows, *last_row])
            self._store(J, entries)
        build.ret_void()

    def _operation(self, node: Node) -> Any:
        """The builder's method for a product or a sum."""
        if node.kind == "product":
            return self.build.fmul
        if node.sign > 0:
            return self.build.fadd
        return self.build.fsub

    def _output(
        self,
        values: dict[int, Any],
        number: int | None,
        sign: float,
    ) -> Any:
        """One output: a constant, or a node with its sign."""
        if number is None:
            return self._constant(sign)
        if sign > 0:
            return values[number]
        return self.build.fneg(values[number])

    def _extend_block(self, by: int = 1) -> None:
        """Count steps of the block, and begin another where it is long enough."""
        self.length += by
        if self.length > LONGEST:
            self.length = by
            following = self.function.append_basic_block()
            # a branch that is always taken, which LLVM cannot know: it would make one block of two
            # otherwise
            _, _, stride, *_ = self.function.args
            never = self.build.icmp_signed("<=", stride, _INT(0))
            with self.build.if_then(never, likely=False):
                self.build.ret_void()
            self.build.branch(following)
            self.build.position_at_end(following)

    def _constant(self, value: float):
        if self.lanes == 1:
            return _DOUBLE(value)
        return ir.Constant(self.type, [value] * self.lanes)

    def _input(self, number: int):
        sines, cosines, stride, q, width, *_ = self.function.args
        if number < 0:
            return self._coordinate(-1 - number, q, stride, width)
        row = self._row((sines, cosines)[number % 2], stride, number // 2)
        return self.build.load(row, align=8)

    def _coordinate(self, k: int, q, stride, width):
        """Coordinate k of all lanes."""
        build = self.build
        if self.layout == "columns":
            return build.load(self._row(q, stride, k), align=8)
        value = build.load(build.gep(q, [_INT(k)]), align=8)
        if self.lanes == 1:
            return value
        undefined = ir.Constant(self.type, ir.Undefined)
        row = build.insert_element(undefined, value, _INDEX(0))
        for lane in range(1, self.lanes):
            start = build.mul(width, _INT(lane))
            place = build.gep(q, [build.add(start, _INT(k))])
            value = build.load(place, align=8)
            row = build.insert_element(row, value, _INDEX(lane))
        return row

    def _row(self, start, stride, i: int):
        """Place of the lanes that stand i times `stride` behind a start."""
        place = self.build.gep(start, [self.build.mul(stride, _INT(i))])
        return self._cast_pointer(place, self.type)

    def _store_columns(self, start, values, stride) -> None:
        """Each value with all its lanes, one `stride` after the other."""
        for i, value in enumerate(values):
            self._extend_block()
            self.build.store(value, self._row(start, stride, i), align=8)

    def _store(self, start, values) -> None:
        """The values one after the other; of several lanes each lane's, four by four turned from
        columns into rows.
        """
        build = self.build
        size = len(values)
        for i in range(0, size, LANES):
            group = values[i : i + LANES]
            self._extend_block(len(group))
            if self.lanes == 1:
                for k, value in enumerate(group):
                    place = build.gep(start, [_INT(i + k)])
                    build.store(value, place, align=8)
            else:
                for lane, row in enumerate(self._transposed(group)):
                    place = build.gep(start, [_INT(lane * size + i)])
                    build.store(row, self._cast_pointer(place, row.type), align=8)

    def _transposed(self, group):
        """Four vectors, or two, transposed: for each lane the vector of what they have there.

        A pose has 16 numbers and a Jacobian 6 m: there is never one left, nor three.
        """
        if len(group) == LANES:
            even, odd = self._even_odd(*group[:2])
            even2, odd2 = self._even_odd(*group[2:])
            pairs = ((even, even2), (odd, odd2))
            halves = ([0, 1, 4, 5], [2, 3, 6, 7])
            return [self._shuffled(*pair, half) for half in halves for pair in pairs]
        lanes = range(LANES)
        return [self._shuffled(*group, [lane, LANES + lane]) for lane in lanes]

    def _even_odd(self, a, b):
        even = self._shuffled(a, b, [0, 4, 2, 6])
        odd = self._shuffled(a, b, [1, 5, 3, 7])
        return even, odd

    def _shuffled(self, a, b, mask):
        kind = ir.VectorType(_INDEX, len(mask))
        return self.build.shuffle_vector(a, b, ir.Constant(kind, mask))

    def _cast_pointer(self, place, kind):
        """A place in an array of numbers, as one of `kind`."""
        if kind == _DOUBLE:
            return place
        return self.build.bitcast(place, kind.as_pointer())
