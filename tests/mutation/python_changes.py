"""Small changes of a Python source: those of mutants.py, found in its syntax tree."""

from __future__ import annotations

import ast
import itertools
import re
from typing import Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple, Union


class Change(NamedTuple):
    """Of `old` to `new` at the character `start`; a kind of ``mutants.KINDS``."""

    start: int
    kind: str
    old: str
    new: str


_COMPARED: Dict[type, Tuple[str, ...]] = {
    ast.Lt: ("<=", ">="), ast.LtE: ("<", ">"), ast.Gt: (">=", "<="), ast.GtE: (">", "<"), ast.Eq: ("!=",),
    ast.NotEq: ("==",), ast.Is: ("is not",), ast.IsNot: ("is",), ast.In: ("not in",), ast.NotIn: ("in",),
}  # fmt: skip
_COMPUTED: Dict[type, Tuple[str, str]] = {
    ast.Add: ("+", "-"), ast.Sub: ("-", "+"), ast.Mult: ("*", "+"), ast.Div: ("/", "*"), ast.FloorDiv: ("//", "*"),
    ast.Mod: ("%", "*"), ast.LShift: ("<<", ">>"), ast.RShift: (">>", "<<"), ast.BitAnd: ("&", "|"),
    ast.BitOr: ("|", "&"),
}  # fmt: skip
_CONSTANT = re.compile(r"_?[A-Z][A-Z0-9_]*$")
#: Least number that may convert units.
_FACTOR_MIN = 10
_CONDITIONS = (ast.If, ast.While, ast.IfExp)
_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
#: Functions whose result does not depend on the order of their arguments.
SYMMETRIC = ("min", "max", "minimum", "maximum")


def python_changes(source: str) -> Iterator[Change]:
    """All changes of the functions of a source, and of the numbers that it gives names."""
    text = _Text(source)
    tree = ast.parse(source)
    for node in tree.body:
        value = node.value if isinstance(node, (ast.Assign, ast.AnnAssign)) else None
        if value is not None and _number(value) is not None:
            for new in _numbers(value):
                yield text.change("constant", value, new)
    for function in ast.walk(tree):
        if isinstance(function, _FUNCTIONS):
            for node in _inside(function):
                yield from _changes(text, node)


class _Text:
    """A source by the positions of its nodes, whose columns count bytes."""

    def __init__(self, source: str) -> None:
        self.source = source
        self.lines = source.splitlines(keepends=True)
        self.starts = [0, *itertools.accumulate(map(len, self.lines))]

    def at(self, line: int, column: int) -> int:
        return self.starts[line - 1] + len(self.lines[line - 1].encode()[:column].decode())

    def span(self, node: ast.AST) -> Tuple[int, int]:
        return (self.at(node.lineno, node.col_offset),  # type: ignore[attr-defined]
                self.at(node.end_lineno, node.end_col_offset))  # type: ignore[attr-defined]

    def of(self, node: ast.AST) -> str:
        begin, end = self.span(node)
        return self.source[begin:end]

    def change(self, kind: str, node: ast.AST, new: str) -> Change:
        return Change(self.span(node)[0], kind, self.of(node), new)

    def between(self, kind: str, left: ast.AST, right: ast.AST, pattern: str, new: str) -> Iterator[Change]:
        """The sign between two operands, which a pattern finds, becomes another."""
        begin, end = self.span(left)[1], self.span(right)[0]
        match = re.search(pattern, self.source[begin:end])
        if match:
            yield Change(begin + match.start(), kind, match.group(), new)


def _inside(function: Union[ast.FunctionDef, ast.AsyncFunctionDef]) -> Iterator[ast.AST]:
    """The nodes of a function's body and of its parameters' values, without annotations and nested functions."""
    waiting: List[ast.AST] = [*function.args.defaults, *filter(None, function.args.kw_defaults), *function.body]
    while waiting:
        node = waiting.pop()
        yield node
        for name, value in ast.iter_fields(node):
            if name not in ("annotation", "returns", "type_comment") and not isinstance(node, ast.JoinedStr):
                waiting += [child for child in (value if isinstance(value, list) else [value])
                            if isinstance(child, ast.AST) and not isinstance(child, _FUNCTIONS)]


def _number(node: Optional[ast.AST]) -> Optional[float]:
    value = node.value if isinstance(node, ast.Constant) else None
    return None if isinstance(value, bool) or not isinstance(value, (int, float)) else value


def _numbers(node: ast.AST) -> Iterator[str]:
    value = _number(node)
    if isinstance(value, int):
        yield str(value + 1)
        if value > 0:
            yield str(value - 1)
    elif value is not None:
        yield repr(value * 1.5 or 1.0)


def _is_factor(node: ast.AST) -> bool:
    value = _number(node)
    return (value is not None and abs(value) >= _FACTOR_MIN) or (
        isinstance(node, ast.Name) and bool(_CONSTANT.match(node.id)))


def _is_nothing(node: ast.AST) -> bool:
    """Whether a value is what something begins with."""
    if isinstance(node, (ast.List, ast.Tuple, ast.Set)):
        return not node.elts
    if isinstance(node, ast.Dict):
        return not node.keys
    if isinstance(node, ast.UnaryOp):
        node = node.operand
    return isinstance(node, ast.Constant) or (isinstance(node, ast.Call) and not node.args and not node.keywords)


def _changes(text: _Text, node: ast.AST) -> Iterator[Change]:
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        for new in _COMPARED[type(node.ops[0])]:
            yield from text.between("sign", node.left, node.comparators[0],
                                    r"[<>=!]=|[<>]|is\s+not|not\s+in|is|in", new)
    elif isinstance(node, ast.BoolOp):
        new = "or" if isinstance(node.op, ast.And) else "and"
        for left, right in zip(node.values, node.values[1:]):
            yield from text.between("sign", left, right, r"\b(?:and|or)\b", new)
    elif isinstance(node, ast.BinOp) and type(node.op) in _COMPUTED:
        old, new = _COMPUTED[type(node.op)]
        yield from text.between("sign", node.left, node.right, re.escape(old), new)
        if isinstance(node.op, (ast.Mult, ast.Div, ast.FloorDiv)) and _is_factor(node.right):
            yield text.change("unit", node, text.of(node.left))
        elif isinstance(node.op, ast.Mult) and _is_factor(node.left):
            yield text.change("unit", node, text.of(node.right))
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.Not, ast.USub)):
        yield text.change("sign", node, f"({text.of(node.operand)})")
    elif _number(node) is not None:
        for new in _numbers(node):
            yield text.change("number", node, new)
    elif isinstance(node, ast.Call):
        if getattr(node.func, "attr", getattr(node.func, "id", "")) not in SYMMETRIC:
            yield from _swaps(text, node.args)
        yield from _swaps(text, [keyword.value for keyword in node.keywords])
    if isinstance(node, _CONDITIONS):
        yield text.change("condition", node.test, f"(not ({text.of(node.test)}))")
    if isinstance(node, ast.comprehension):
        for test in node.ifs:
            yield text.change("condition", test, f"(not ({text.of(test)}))")
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
        cleared = isinstance(node.value.func, ast.Attribute) and node.value.func.attr in ("clear", "reset")
        yield text.change("reset" if cleared else "statement", node, "pass")
    if isinstance(node, ast.AugAssign):
        yield text.change("statement", node, "pass")
    if isinstance(node, ast.Assign) and isinstance(node.targets[0], (ast.Attribute, ast.Subscript)):
        yield text.change("reset" if _is_nothing(node.value) else "statement", node, "pass")


def _swaps(text: _Text, values: Sequence[ast.AST]) -> Iterator[Change]:
    """Two neighbouring arguments of a call swapped."""
    for one, other in zip(values, values[1:]):
        if text.of(one) == text.of(other) or isinstance(one, ast.Starred) or isinstance(other, ast.Starred):
            continue
        begin, end = text.span(one)[0], text.span(other)[1]
        between = text.source[text.span(one)[1] : text.span(other)[0]]
        yield Change(begin, "argument", text.source[begin:end], text.of(other) + between + text.of(one))
