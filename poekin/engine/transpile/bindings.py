"""Names and rows that a function gives values, and their declarations in C."""

from __future__ import annotations

import ast

from .c_types import DOUBLE, INT, CRow, CTuple, CType, Pointer, unify
from .calls import CallWriter
from .function_source import Blocks, FunctionSource
from .values import Argument, CValue, InstanceSource, as_double, initial


class BindingWriter(CallWriter):
    """Assignments of one function: `live` are the names that something reads, None where that is not
    known yet, and `top` those that are declared at its beginning.
    """

    # of one run over the function, as the other ones
    top: dict[str, CType]
    declared: set[str]

    def __init__(
        self, source: FunctionSource, units: InstanceSource, arguments: list[Argument]
    ) -> None:
        super().__init__(source, units)
        self.arguments = dict(zip(source.parameters, arguments, strict=True))
        self.live: set[str] | None = None
        self.blocks: Blocks = ()

    def assign(self, node: ast.Assign) -> None:
        """target = value."""
        if len(node.targets) > 1:
            self.refuse(node, "an assignment to several targets")
        match node.targets[0]:
            case ast.Tuple(targets) | ast.List(targets):
                self._unpack(node, targets)
            case ast.Subscript() as place:
                self._store(node, place, self.expression(node.value))
            case ast.Name(name):
                self._name_value(node, name)
            case target:
                self.refuse(node, f"an assignment to {ast.unparse(target)}")

    def augmented(self, node: ast.AugAssign) -> None:
        """target op= value."""
        target = node.target
        read = ast.parse(ast.unparse(target), mode="eval").body
        for part in ast.walk(read):
            ast.copy_location(part, node)
        old = self.expression(read)
        value = self.arithmetic(node, node.op, old, self.expression(node.value))
        match target:
            case ast.Name(name):
                self.bind(node, name, value)
            case ast.Subscript():
                self._store(node, target, value)
            case _:
                self.refuse(node, f"an assignment to {ast.unparse(target)}")

    def _name_value(self, node: ast.Assign, name: str) -> None:
        """name = value, left out where nothing reads it."""
        mark = self.mark()
        value = self.expression(node.value)
        if self._is_read(name) or value.known:
            self.bind(node, name, value)
        elif isinstance(node.value, ast.Call):
            self.put(f"(void){value.text};")
        else:
            self.back_to(mark)

    def _is_read(self, name: str) -> bool:
        """Whether something reads a name, as far as is known."""
        return self.live is None or name in self.live

    def bind(self, node: ast.AST, name: str, value: CValue) -> None:
        """Give a name a value."""
        is_pointer = isinstance(value.type, Pointer)
        once = self.source.stores[name] == 1
        once = once and name not in self.source.parameters
        stays = value.fixed or value.type == INT or is_pointer
        if once and value.known and stays:
            self.known[name] = value
            return
        self.known.pop(name, None)
        if not self._is_read(name):
            return
        before = self.types.get(name, value.type)
        kind = unify(before, value.type)
        if kind is None:
            self.refuse(node, f"the name {name} for values of two types")
        if isinstance(kind, Pointer):
            if not once:
                self.refuse(node, f"the name {name} for several rows")
            self.roots[name] = value.root
        elif name in self.arguments and before != kind:
            self.refuse(node, f"the parameter {name} for values of two types")
        self.types[name] = kind
        if once and any(value.told):
            self.told[name] = value.told
        self._write_value(name, kind, self.converted(node, value, kind).text)

    def _write_value(self, name: str, kind: CType, text: str) -> None:
        """The value of a name, with its declaration where its first use is."""
        parameter = name in self.arguments and self.arguments[name].told is None
        declared = parameter or name in self.declared
        if not declared and self.source.homes[name] == self.blocks:
            self.declared.add(name)
            const = "const " if self.source.stores[name] == 1 else ""
            root = self.roots.get(name, "")
            declaration = self.declaration(kind, name, root, const)
            self.put(f"{declaration} = {initial(text, self.structures.spell(kind))};")
            return
        if not declared:
            self.top[name] = kind
        self.put(f"{self.c_name(name)} = {text};")

    def declaration(self, kind: CType, name: str, root: str, const: str = "") -> str:
        """Type and name; a pointer is to what is not written, unless it is."""
        if isinstance(kind, Pointer):
            star = "double *" if root in self.written else "const double *"
            return f"{star}{const}{self.c_name(name)}"
        return f"{const}{self.structures.spell(kind)} {self.c_name(name)}"

    def _unpack(self, node: ast.Assign, targets: list[ast.expr]) -> None:
        before = set(self.read)
        value = self.expression(node.value)
        if not isinstance(value.type, (CTuple, CRow)):
            self.refuse(node, "unpacking a number")
        if isinstance(node.value, ast.Name) and self._are_unread(targets):
            self.read = before
            return
        items = self.items(value)
        if len(items) != len(targets):
            self.refuse(node, f"unpacking {len(items)} values into {len(targets)} names")
        kept = [
            (name, item) for name, item in zip(targets, items, strict=True) if not _is_blank(name)
        ]
        if isinstance(node.value, ast.Tuple):
            # all are taken before one is given another value
            kept = [(name, self.apart(item)) for name, item in kept]
        for target, item in kept:
            match target:
                case ast.Subscript():
                    self._store(node, target, item)
                case ast.Name(name):
                    self.bind(node, name, item)
                case _:
                    self.refuse(node, f"unpacking into {ast.unparse(target)}")

    def _are_unread(self, targets: list[ast.expr]) -> bool:
        """Whether targets are names that nothing reads."""
        return all(
            isinstance(target, ast.Name) and not self._is_read(target.id) for target in targets
        )

    def apart(self, value: CValue) -> CValue:
        """The value as it is now."""
        if value.known:
            return value
        return self.held(CValue(value.type, value.text, 0))

    def _store(self, node: ast.AST, target: ast.Subscript, value: CValue) -> None:
        """row[i] = value."""
        number = as_double(value)
        place = self.expression(target)
        if place.type != DOUBLE or not place.root:
            self.refuse(node, f"writing to {ast.unparse(target)}")
        self.written.add(place.root)
        self.put(f"{place.text} = {number.text};")


def _is_blank(target: ast.expr) -> bool:
    """Whether a target is the name of what is not used, _."""
    return isinstance(target, ast.Name) and target.id == "_"
