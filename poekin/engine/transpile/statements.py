"""Statements of a function, and the function of C that they make."""

from __future__ import annotations

import ast
import itertools
from collections.abc import Iterator
from contextlib import contextmanager

from .bindings import BindingWriter
from .c_types import DOUBLE, INT, CTuple, CType, Pointer, unify
from .function_source import FunctionSource, always_returns
from .values import Argument, CValue, Instance, InstanceSource, scalar

_MOST_RUNS = 20


class FunctionWriter(BindingWriter):
    """One function for arguments of given types.

    The body is written again until the types of its names, which of them are read, and which
    pointers are written to no longer change.
    """

    def __init__(
        self, source: FunctionSource, units: InstanceSource, arguments: list[Argument]
    ) -> None:
        super().__init__(source, units, arguments)
        self.returns: CType | None = None

    def write(self, instance: Instance) -> None:
        """Text, type and needs of the function."""
        for _ in range(_MOST_RUNS):
            types = dict(self.types)
            written = set(self.written)
            before = (types, self.live, written, self.returns)
            self._run()
            self.live = set(self.read)
            if before == (self.types, self.live, self.written, self.returns):
                break
        arguments = self.arguments
        instance.written = self.written & arguments.keys()
        instance.runtime = [name for name, given in arguments.items() if given.told is None]
        instance.returns = self.returns
        instance.tell(self.results)
        instance.called = list(self.called)
        returned = "void"
        if self.returns is not None:
            returned = self.structures.spell(self.returns)
        parameters = ", ".join(map(self._parameter, instance.runtime)) or "void"
        instance.head = f"static inline {returned} {instance.name}({parameters})"
        used = self.read | self.written
        unread = [name for name in instance.runtime if name not in used]
        lines = [instance.head, "{"]
        lines += [f"    (void){self.c_name(name)};" for name in unread]
        for name, kind in self.top.items():
            lines.append(f"    {self.structures.spell(kind)} {self.c_name(name)};")
        lines += [*self.lines, "}"]
        instance.text = "\n".join(lines)

    def _run(self) -> None:
        self.lines = []
        self.temporaries = 0
        self.read = set()
        self.called = {}
        self.top = {}
        self.declared = set()
        self.known = {}
        self.told = {}
        self.results = []
        for name, given in self.arguments.items():
            if given.told is not None:
                self.known[name] = given.told
                continue
            self.types[name] = given.type
            self.roots[name] = name
        tree = self.source.tree
        self.body(tree.body)
        if self.returns is not None and not always_returns(tree.body):
            self.refuse(tree, "a function that may end without its value")

    def _parameter(self, name: str) -> str:
        kind = self.arguments[name].type
        return self.declaration(kind, name, name)

    def body(self, statements: list[ast.stmt]) -> None:
        """Statements one after the other, up to the first that leaves."""
        for statement in statements:
            if self.statement(statement):
                break

    def statement(self, node: ast.stmt) -> bool:
        """One statement; whether it was left for good."""
        if isinstance(node, ast.If):
            return self._if(node)
        methods = {
            ast.Assign: self.assign,
            ast.AugAssign: self.augmented,
            ast.For: self._for,
            ast.While: self._while,
            ast.Return: self._return,
            ast.Expr: self._alone,
            ast.Break: lambda _: self.put("break;"),
            ast.Continue: lambda _: self.put("continue;"),
            ast.Pass: lambda _: None,
        }
        method = methods.get(type(node))
        if method is None:
            self.refuse(node, f"a statement {type(node).__name__}")
        method(node)
        return isinstance(node, (ast.Return, ast.Break, ast.Continue))

    @contextmanager
    def _inside(self, statement: ast.stmt, part: int, deeper: bool = True) -> Iterator[None]:
        """A block of a statement."""
        blocks = self.blocks
        declared = set(self.declared)
        self.blocks = (*blocks, id(statement), part)
        self.indent += deeper
        yield
        self.indent -= deeper
        self.blocks = blocks
        if deeper:
            self.declared = declared

    def _alone(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Constant):
            return
        if not isinstance(node.value, ast.Call):
            self.refuse(node, "an expression without effect")
        kind, text = self.call(node.value)
        if isinstance(text, CValue):
            return
        self.put(f"{text};" if kind is None else f"(void){text};")

    def _return(self, node: ast.Return) -> None:
        if node.value is None:
            self.put("return;")
            return
        value = self.expression(node.value)
        kind = unify(self.returns or value.type, value.type)
        if kind is None or isinstance(kind, Pointer):
            self.refuse(node, "a result of two types, or a row as a result,")
        self.returns = kind
        self.results.append(value)
        self.put(f"return {self.converted(node, value, kind).text};")

    def _if(self, node: ast.If) -> bool:
        test = self.test(node.test)
        if test.known:
            part = 0 if test.constant else 1
            chosen = (node.body, node.orelse)[part]
            with self._inside(node, part, deeper=False):
                self.body(chosen)
            return always_returns(chosen)
        self.put(f"if ({test.text}) {{")
        known = dict(self.known)
        with self._inside(node, 0):
            self.body(node.body)
        self.known = known
        if node.orelse:
            start = len(self.lines)
            self.put("} else {")
            with self._inside(node, 1):
                self.body(node.orelse)
            self.known = known
            first, *others = node.orelse
            if isinstance(first, ast.If) and not others:
                self._join_else_if(start)
        self.put("}")
        return False

    def _join_else_if(self, start: int) -> None:
        """`} else {`, `if` and its end as `} else if`, where nothing else stands in there."""
        inner = self.lines[start + 1 :]
        deeper = "    " * (self.indent + 1)
        ends = [k for k, line in enumerate(inner) if line == f"{deeper}}}"]
        alone = ends == [len(inner) - 1]
        if alone and inner[0].startswith(f"{deeper}if ("):
            first, *others = inner[:-1]
            joined = "    " * self.indent + "} else " + first.strip()
            self.lines[start:] = [joined, *(line[4:] for line in others)]

    def _while(self, node: ast.While) -> None:
        if node.orelse:
            self.refuse(node, "`else` of a loop")
        start = len(self.lines)
        self.indent += 1
        test = self.test(node.test)
        self.indent -= 1
        ahead = self.lines[start:]
        del self.lines[start:]
        if ahead:
            self.put("for (;;) {")
            self.lines += ahead
            self.put(f"    if (!({test.text})) {{")
            self.put("        break;")
            self.put("    }")
        elif test.known and test.constant:
            self.put("for (;;) {")
        else:
            self.put(f"while ({test.text}) {{")
        with self._inside(node, 0):
            self.body(node.body)
        self.put("}")

    def _for(self, node: ast.For) -> None:
        if node.orelse or not isinstance(node.target, ast.Name):
            self.refuse(node, "`else` of a loop, or a loop over several names,")
        name = node.target.id
        leaves = any(isinstance(inner, (ast.Break, ast.Continue)) for inner in ast.walk(node))
        match node.iter:
            case ast.Call(ast.Name("range"), bounds):
                self._for_range(node, name, self.listed(bounds))
                return
            case ast.Tuple(items) if not leaves:
                self._for_each(node, name, self.listed(items))
                return
        value = self.expression(node.iter)
        if not isinstance(value.type, CTuple):
            self.refuse(node, "a loop over anything but range and a tuple")
        if value.type.uniform:
            self._for_items(node, name, self.held(value), value.type)
            return
        if leaves:
            self.refuse(node, "break or continue in a loop over a tuple of several types")
        self._for_each(node, name, self.items(value))

    def _for_each(self, node: ast.For, name: str, items: list[CValue]) -> None:
        """The body of a loop for each item, one after the other."""
        for item in items:
            self.put("{")
            self._body_with(node, name, item)

    def _body_with(self, node: ast.For, name: str, item: CValue) -> None:
        """The body of a loop, its name bound to an item, and its end."""
        with self._inside(node, 0):
            self.bind(node, name, item)
            self.body(node.body)
        self.put("}")

    def _counter(self) -> str:
        for k in itertools.count(self.temporaries + 1):
            if f"k{k}" not in self.source.stores:
                self.temporaries = k
                return f"k{k}"
        raise RuntimeError("no name is left")

    def _for_items(self, node: ast.For, name: str, value: CValue, kind: CTuple) -> None:
        """A loop over the items of an array."""
        k = self._counter()
        self.put(f"for (int {k} = 0; {k} < {len(kind.items)}; {k}++) {{")
        item = CValue(kind.items[0], f"{value.text}.v[{k}]")
        self._body_with(node, name, item)

    def _stays(self, value: CValue) -> bool:
        """Whether a bound is a name that has one value as long as a loop runs."""
        name = value.text
        stores = self.source.stores.get(name)
        once = stores == (name not in self.source.parameters)
        return stores is not None and (once or self.source.stays_in_loops(name))

    def _for_range(self, node: ast.For, name: str, bounds: list[CValue]) -> None:
        """A loop over range; its name is a name of the loop alone."""
        if not 1 <= len(bounds) <= 3 or any(bound.type == DOUBLE for bound in bounds):
            self.refuse(node, "range of anything but one to three integers")
        if len(bounds) == 1:
            bounds = [scalar(0, INT), *bounds]
        start, stop, step = [*bounds, scalar(1, INT)][:3]
        if not step.known or step.constant == 0:
            self.refuse(node, "range with a step that is not known")
        if not stop.known and not self._stays(stop):
            stop = self.apart(stop)
        if name == "_":
            counter = self._counter()
        else:
            if not self.source.stays_in_loops(name):
                self.refuse(node, f"the use of {name} beside its loop")
            counter = self.c_name(name)
            self.types[name] = INT
        sign = "<" if step.constant > 0 else ">"
        ahead = {1: "++", -1: "--"}.get(step.constant, f" += {step.text}")
        begin = f"int {counter} = {start.text}"
        goes_on = f"{counter} {sign} {stop.text}"
        self.put(f"for ({begin}; {goes_on}; {counter}{ahead}) {{")
        with self._inside(node, 0):
            self.body(node.body)
        self.put("}")
