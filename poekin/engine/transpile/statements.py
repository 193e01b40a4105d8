"""Statements of a function, and the function of C that they make."""

from __future__ import annotations

import ast
import itertools
from collections.abc import Iterator
from contextlib import contextmanager

from .c_types import DOUBLE, INT, CRow, CTable, CTuple, CType, unify
from .calls import CallWriter
from .function_source import Blocks, FunctionSource, always_returns
from .values import Argument, CValue, Instance, InstanceSource, as_double, initial, scalar

_MOST_RUNS = 20


class FunctionWriter(CallWriter):
    """One function for arguments of given types.

    The body is written again until the types of its names, which of them are read, and which
    pointers are written to no longer change.
    """

    def __init__(
        self, source: FunctionSource, units: InstanceSource, arguments: list[Argument]
    ) -> None:
        super().__init__(source, units)
        self.arguments = dict(zip(source.parameters, arguments, strict=True))
        self.returns: CType | None = None
        self.live: set[str] | None = None
        self.before: set[str] = set()
        self.blocks: Blocks = ()
        self.top: dict[str, CType] = {}
        self.declared: set[str] = set()

    def write(self, instance: Instance) -> None:
        """Text, type and needs of the function."""
        for _ in range(_MOST_RUNS):
            state = (dict(self.types), self.live, set(self.written), self.returns)
            self._run()
            self.live = set(self.read)
            if state == (self.types, self.live, self.written, self.returns):
                break
        instance.written = {name for name in self.written if name in self.arguments}
        instance.runtime = [name for name, given in self.arguments.items() if given.told is None]
        instance.returns = self.returns
        instance.tell(self.results)
        instance.called = list(self.called)
        returned = "void" if self.returns is None else self.structures.spell(self.returns)
        parameters = ", ".join(self._parameter(name) for name in instance.runtime)
        instance.head = f"static inline {returned} {instance.name}({parameters or 'void'})"
        unread = [name for name in instance.runtime if name not in self.read | self.written]
        lines = [f"    (void){self.c_name(name)};" for name in unread]
        lines += [
            f"    {self.structures.spell(kind)} {self.c_name(name)};"
            for name, kind in self.top.items()
        ]
        instance.text = "\n".join([instance.head, "{", *lines, *self.lines, "}"])

    def _run(self) -> None:
        self.lines = []
        self.temporaries = 0
        self.read = set()
        self.before = set(self.written)
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
        self.body(self.source.tree.body)
        if self.returns is not None and not always_returns(self.source.tree.body):
            self.refuse(self.source.tree, "a function that may end without its value")

    def _parameter(self, name: str) -> str:
        kind = self.arguments[name].type
        return self._declaration(kind, name, name, "")

    def _declaration(self, kind: CType, name: str, root: str, const: str) -> str:
        """Type and name; a pointer is to what is not written, unless it is."""
        if isinstance(kind, (CRow, CTable)):
            star = "double *" if root in self.written else "const double *"
            return f"{star}{const}{self.c_name(name)}"
        return f"{const}{self.structures.spell(kind)} {self.c_name(name)}"

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
            ast.Assign: self._assign,
            ast.AugAssign: self._augmented,
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
        kind = value.type if self.returns is None else unify(self.returns, value.type)
        if kind is None or isinstance(kind, (CRow, CTable)):
            self.refuse(node, "a result of two types, or a row as a result,")
        self.returns = kind
        self.results.append(value)
        self.put(f"return {self.converted(node, value, kind).text};")

    def _assign(self, node: ast.Assign) -> None:
        if len(node.targets) > 1:
            self.refuse(node, "an assignment to several targets")
        target = node.targets[0]
        if isinstance(target, (ast.Tuple, ast.List)):
            self._unpack(node, target)
        elif isinstance(target, ast.Subscript):
            self._store(node, target, as_double(self.expression(node.value)))
        elif isinstance(target, ast.Name):
            self._name_value(node, target.id)
        else:
            self.refuse(node, f"an assignment to {ast.unparse(target)}")

    def _name_value(self, node: ast.Assign, name: str) -> None:
        """name = value, left out where nothing reads it."""
        mark = self.mark()
        value = self.expression(node.value)
        if self.live is not None and name not in self.live and not value.known:
            if not isinstance(node.value, ast.Call):
                self.back_to(mark)
                return
            self.put(f"(void){value.text};")
            return
        self.bind(node, name, value)

    def bind(self, node: ast.AST, name: str, value: CValue) -> None:
        """Give a name a value."""
        once = self.source.stores[name] == 1 and name not in self.source.parameters
        stays = value.fixed or value.type == INT or isinstance(value.type, (CRow, CTable))
        if once and value.known and stays:
            self.known[name] = value
            return
        self.known.pop(name, None)
        if self.live is not None and name not in self.live:
            return
        kind = unify(self.types.get(name, value.type), value.type)
        if kind is None:
            self.refuse(node, f"the name {name} for values of two types")
        if isinstance(kind, (CRow, CTable)):
            if not once:
                self.refuse(node, f"the name {name} for several rows")
            self.roots[name] = value.root
        elif name in self.arguments and self.types[name] != kind:
            self.refuse(node, f"the parameter {name} for values of two types")
        self.types[name] = kind
        if once and any(value.told):
            self.told[name] = value.told
        text = self.converted(node, value, kind).text
        parameter = name in self.arguments and self.arguments[name].told is None
        if parameter or name in self.declared or self.source.homes[name] != self.blocks:
            if not parameter and name not in self.declared:
                self.top[name] = kind
            self.put(f"{self.c_name(name)} = {text};")
            return
        self.declared.add(name)
        const = "const " if self.source.stores[name] == 1 else ""
        text = initial(text, self.structures.spell(kind))
        self.put(f"{self._declaration(kind, name, self.roots.get(name, ''), const)} = {text};")

    def _unpack(self, node: ast.Assign, target: ast.Tuple | ast.List) -> None:
        before = set(self.read)
        value = self.expression(node.value)
        if not isinstance(value.type, (CTuple, CRow)):
            self.refuse(node, "unpacking a number")
        if isinstance(node.value, ast.Name) and self._are_unread(target.elts):
            self.read = before
            return
        items = self.items(value)
        if len(items) != len(target.elts):
            self.refuse(node, f"unpacking {len(items)} values into {len(target.elts)} names")
        kept = [not (isinstance(name, ast.Name) and name.id == "_") for name in target.elts]
        if isinstance(node.value, ast.Tuple):
            # all are taken before one is given another value
            items = [self._apart(item) if k else item for item, k in zip(items, kept, strict=True)]
        for name, item in zip(target.elts, items, strict=True):
            if isinstance(name, ast.Subscript):
                self._store(node, name, as_double(item))
            elif not isinstance(name, ast.Name):
                self.refuse(node, f"unpacking into {ast.unparse(name)}")
            elif name.id != "_":
                self.bind(node, name.id, item)

    def _are_unread(self, targets: list[ast.expr]) -> bool:
        """Whether targets are names that nothing reads."""
        if self.live is None:
            return False
        return all(isinstance(name, ast.Name) and name.id not in self.live for name in targets)

    def _apart(self, value: CValue) -> CValue:
        """The value as it is now."""
        if value.known:
            return value
        return self.held(CValue(value.type, value.text, 0))

    def _store(self, node: ast.AST, target: ast.Subscript, value: CValue) -> None:
        """row[i] = value."""
        place = self.expression(target)
        if place.type != DOUBLE or not place.root:
            self.refuse(node, f"writing to {ast.unparse(target)}")
        self.written.add(place.root)
        self.put(f"{place.text} = {value.text};")

    def _augmented(self, node: ast.AugAssign) -> None:
        read = ast.copy_location(ast.parse(ast.unparse(node.target), mode="eval").body, node)
        old = self.expression(read)
        value = self.arithmetic(node, node.op, old, self.expression(node.value))
        if isinstance(node.target, ast.Name):
            self.bind(node, node.target.id, value)
        elif isinstance(node.target, ast.Subscript):
            self._store(node, node.target, as_double(value))
        else:
            self.refuse(node, f"an assignment to {ast.unparse(node.target)}")

    def _if(self, node: ast.If) -> bool:
        test = self.test(node.test)
        if test.known:
            chosen = node.body if test.constant else node.orelse
            with self._inside(node, 0 if test.constant else 1, deeper=False):
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
            if len(node.orelse) == 1 and isinstance(node.orelse[0], ast.If):
                self._join_else_if(start)
        self.put("}")
        return False

    def _join_else_if(self, start: int) -> None:
        """`} else {`, `if` and its end as `} else if`, where nothing else stands in there."""
        inner = self.lines[start + 1 :]
        deeper = "    " * (self.indent + 1)
        ends = [k for k, line in enumerate(inner) if line == f"{deeper}}}"]
        if inner and inner[0].startswith(f"{deeper}if (") and ends == [len(inner) - 1]:
            joined = [line[4:] for line in inner[:-1]]
            joined[0] = "    " * self.indent + "} else " + joined[0].strip()
            self.lines[start:] = joined

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
        else:
            self.put("for (;;) {" if test.known and test.constant else f"while ({test.text}) {{")
        with self._inside(node, 0):
            self.body(node.body)
        self.put("}")

    def _for(self, node: ast.For) -> None:
        if node.orelse or not isinstance(node.target, ast.Name):
            self.refuse(node, "`else` of a loop, or a loop over several names,")
        called = isinstance(node.iter, ast.Call) and isinstance(node.iter.func, ast.Name)
        if called and node.iter.func.id == "range":  # type: ignore[attr-defined]
            self._for_range(node, node.target.id, self.listed(node.iter.args))  # type: ignore[attr-defined]
            return
        leaves = any(isinstance(inner, (ast.Break, ast.Continue)) for inner in ast.walk(node))
        listed = isinstance(node.iter, ast.Tuple) and not leaves
        if listed:
            items = self.listed(node.iter.elts)  # type: ignore[attr-defined]
        else:
            value = self.expression(node.iter)
            if not isinstance(value.type, CTuple):
                self.refuse(node, "a loop over anything but range and a tuple")
            if value.type.uniform:
                self._for_items(node, node.target.id, self.held(value))
                return
            if leaves:
                self.refuse(node, "break or continue in a loop over a tuple of several types")
            items = self.items(value)
        for item in items:
            self.put("{")
            with self._inside(node, 0):
                self.bind(node, node.target.id, item)
                self.body(node.body)
            self.put("}")

    def _counter(self) -> str:
        for k in itertools.count(self.temporaries + 1):
            if f"k{k}" not in self.source.stores:
                self.temporaries = k
                return f"k{k}"
        raise RuntimeError("no name is left")

    def _for_items(self, node: ast.For, name: str, value: CValue) -> None:
        """A loop over the items of an array."""
        if not isinstance(value.type, CTuple):
            self.refuse(node, "a loop over a number")
        k = self._counter()
        self.put(f"for (int {k} = 0; {k} < {len(value.type.items)}; {k}++) {{")
        with self._inside(node, 0):
            self.bind(node, name, CValue(value.type.items[0], f"{value.text}.v[{k}]"))
            self.body(node.body)
        self.put("}")

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
        start = bounds[0] if len(bounds) > 1 else scalar(0, INT)
        stop = bounds[0] if len(bounds) == 1 else bounds[1]
        step = bounds[2] if len(bounds) == 3 else scalar(1, INT)
        if not step.known or step.constant == 0:
            self.refuse(node, "range with a step that is not known")
        if not stop.known and not self._stays(stop):
            stop = self._apart(stop)
        if name == "_":
            counter = self._counter()
        else:
            if not self.source.stays_in_loops(name):
                self.refuse(node, f"the use of {name} beside its loop")
            counter = self.c_name(name)
            self.types[name] = INT
        sign = "<" if step.constant > 0 else ">"
        count = {1: f"{counter}++", -1: f"{counter}--"}.get(
            step.constant, f"{counter} += {step.text}"
        )
        self.put(f"for (int {counter} = {start.text}; {counter} {sign} {stop.text}; {count}) {{")
        with self._inside(node, 0):
            self.body(node.body)
        self.put("}")
