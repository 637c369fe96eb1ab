"""Small changes of C sources, each of which some test should detect."""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterator, List, Sequence, Tuple

#: Replacements of operators; the left operand of a binary one ends with a word, a number or a closing bracket.
BINARY: Dict[str, Tuple[str, ...]] = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
    "+": ("-",), "-": ("+",), "*": ("+",), "/": ("*",), "%": ("*",), "<<": (">>",), ">>": ("<<",),
    "&": ("|",), "|": ("&",), "^": ("&",), "&&": ("||",), "||": ("&&",),
    "+=": ("-=",), "-=": ("+=",), "*=": ("+=",), "|=": ("&=",), "&=": ("|=",), "<<=": (">>=",), ">>=": ("<<=",),
    "^=": ("&=",),
}  # fmt: skip
#: Replacements of unary operators.
UNARY: Dict[str, Tuple[str, ...]] = {"!": ("",), "-": ("",), "~": ("",), "++": ("--",), "--": ("++",)}

#: Kinds of changes: one sign or number, an inverted condition, a removed statement; two neighbouring arguments of a
#: call swapped, a named constant or its definition off by one, one of several members that are set together omitted.
KINDS = ("sign", "number", "condition", "statement", "argument", "constant", "reset")

_TOKEN = re.compile(
    r"(?P<space>\s+|//[^\n]*|/\*.*?\*/|^[ \t]*\#(?:[^\n\\]|\\\n)*)"
    r"|(?P<text>\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*')"
    r"|(?P<number>0[xX][0-9a-fA-F]+[uUlL]*|\d+[uUlL]*)"
    r"|(?P<word>[A-Za-z_]\w*)"
    r"|(?P<sign><<=|>>=|->|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|.)",
    re.DOTALL | re.MULTILINE,
)
#: Named constants of lib/ or of its headers; macros with arguments are excluded.
_CONSTANT = re.compile(r"[A-Z][A-Z0-9]*(?:_[A-Z0-9]+)*_?(?:MAX)?$")
_DEFINITION = re.compile(r"^#define [A-Z][A-Z0-9_]* (0[xX][0-9a-fA-F]+[uUlL]*|\d+[uUlL]*)(?=\s)", re.MULTILINE)
#: Words behind which - or * stands alone, and those that begin no statement that could go.
_KEYWORDS = set("return case else do sizeof goto break continue default switch for while if".split())
_DECLARATION = re.compile(r"(?:const|static|extern|unsigned|signed|int|char|typedef|enum|struct|\w+_t|return|case)\b")


@dataclass(frozen=True)
class Mutant:
    """A change of `old` to `new` at the character `start` of a file."""

    file: str
    start: int
    old: str
    new: str
    line: int
    key: str  #: identifies the change by the text of its line, wherever that moves
    kind: str  #: one of KINDS

    def apply(self, source: str) -> str:
        """The changed source."""
        return source[: self.start] + self.new + source[self.start + len(self.old) :]


@dataclass(frozen=True)
class _Token:
    kind: str
    text: str
    start: int


def _tokens(source: str) -> List[_Token]:
    found = ((match.lastgroup or "", match.group(), match.start()) for match in _TOKEN.finditer(source))
    return [_Token(*token) for token in found if token[0] != "space"]


def _number_changes(text: str) -> Iterator[str]:
    digits = re.match(r"0[xX][0-9a-fA-F]+|\d+", text)
    assert digits
    value, suffix = int(digits.group(), 0), text[digits.end() :]
    yield f"{value + 1}{suffix}"
    if value > 0:
        yield f"{value - 1}{suffix}"


def _bodies(tokens: Sequence[_Token]) -> Iterator[Tuple[int, int]]:
    """The ranges of tokens within the braces of functions."""
    depth, begin, is_function = 0, 0, False
    for i, token in enumerate(tokens):
        if token.text == "{":
            if depth == 0:
                begin, is_function = i, i > 0 and tokens[i - 1].text == ")"
            depth += 1
        elif token.text == "}":
            depth -= 1
            if depth == 0 and is_function:
                yield begin, i


def _statement(source: str, tokens: Sequence[_Token], i: int) -> str:
    """The expression statement that begins with token `i`, without its semicolon; empty where none does."""
    if tokens[i - 1].text not in "{};" or tokens[i].kind != "word" or tokens[i].text in _KEYWORDS:
        return ""
    depth = 0
    for token in tokens[i:]:
        depth += (token.text in "([") - (token.text in ")]")
        if depth < 0 or token.text in "{}":
            return ""
        if token.text == ";":
            text = source[tokens[i].start : token.start]
            return "" if _DECLARATION.match(text) or text.startswith("(void)") else text
    return ""


def _changes(source: str, tokens: Sequence[_Token], i: int) -> Iterator[Tuple[str, str, str]]:
    """What stands at token `i`, or in the bracket behind it, and may become another: kind, old text, new text."""
    token, before = tokens[i], tokens[i - 1]
    is_binary = (before.kind in ("word", "number") and before.text not in _KEYWORDS) or before.text in (")", "]")
    if token.kind == "number":
        for new in _number_changes(token.text):
            yield "number", token.text, new
    elif _is_constant(tokens, i):
        yield "constant", token.text, f"({token.text} + 1)"
        yield "constant", token.text, f"({token.text} - 1)"
    elif token.text in BINARY and is_binary and not _is_cast(tokens, i):
        for new in BINARY[token.text]:
            yield "sign", token.text, new
    elif token.text in UNARY and (token.text in ("++", "--") or not is_binary):
        for new in UNARY[token.text]:
            yield "sign", token.text, new
    elif token.text in ("if", "while") and tokens[i + 1].text == "(":
        condition = _bracket(source, tokens, i + 1)
        yield "condition", condition, f"(!{condition})"
    elif token.kind == "word" and token.text not in _KEYWORDS and tokens[i + 1].text == "(":
        for swapped in _swaps(source, tokens, i + 1):
            yield "argument", _bracket(source, tokens, i + 1), swapped
    statement = _statement(source, tokens, i)
    if statement:
        yield "statement", statement, ""
        for new in _fewer_targets(statement):
            yield "reset", statement, new


def _is_constant(tokens: Sequence[_Token], i: int) -> bool:
    """Whether token `i` is a named constant that is used, not the length of an array that is declared."""
    token, before, behind = tokens[i], tokens[i - 1], tokens[i + 1]
    if token.kind != "word" or not _CONSTANT.match(token.text) or token.text == "NULL" or behind.text == "(":
        return False
    declares = before.text == "[" and behind.text == "]" and tokens[i - 2].kind == "word" and (
        tokens[i - 3].kind == "word" and tokens[i - 3].text not in _KEYWORDS)
    return not declares


def _arguments(source: str, tokens: Sequence[_Token], i: int) -> List[Tuple[int, int]]:
    """Where each argument of the bracket that token `i` opens begins and ends."""
    depth, begin, found = 0, i + 1, []  # type: int, int, List[Tuple[int, int]]
    for j in range(i, len(tokens)):
        text = tokens[j].text
        depth += (text in "([{") - (text in ")]}")
        if depth == 0 or (depth == 1 and text == ","):
            if j > begin:
                found.append((tokens[begin].start, tokens[j - 1].start + len(tokens[j - 1].text)))
            begin = j + 1
        if depth == 0:
            break
    return found


def _swaps(source: str, tokens: Sequence[_Token], i: int) -> Iterator[str]:
    """The bracket that token `i` opens with two neighbours among its arguments swapped."""
    bracket, start = _bracket(source, tokens, i), tokens[i].start
    arguments = _arguments(source, tokens, i)
    for (a, b), (c, d) in zip(arguments, arguments[1:]):
        if source[a:b] != source[c:d]:
            yield (bracket[: a - start] + source[c:d] + bracket[b - start : c - start] + source[a:b]
                   + bracket[d - start :])


def _fewer_targets(statement: str) -> Iterator[str]:
    """A statement that assigns one value to several, without one of these."""
    parts = re.split(r"(?<![=!<>+\-*/%&|^])=(?!=)", statement)
    if len(parts) > 2 and "(" not in "".join(parts[:-1]):
        for k in range(len(parts) - 1):
            yield "=".join(parts[:k] + parts[k + 1 :]).strip()


def _is_cast(tokens: Sequence[_Token], i: int) -> bool:
    """Whether `*` or `-` at token `i` stands behind a type in brackets or in a declaration."""
    before = tokens[i - 1]
    if before.text == ")":
        j = i - 2
        while tokens[j].kind == "word" or tokens[j].text == "*":
            j -= 1
        inner = [token.text for token in tokens[j + 1 : i - 1]]
        return tokens[j].text == "(" and any(word.endswith("_t") or word in ("int", "unsigned", "void", "char", "float")
                                             for word in inner)
    return tokens[i].text == "*" and (before.text.endswith("_t") or before.text in ("void", "char", "const", "int"))


def _bracket(source: str, tokens: Sequence[_Token], i: int) -> str:
    depth = 0
    for token in tokens[i:]:
        depth += (token.text == "(") - (token.text == ")")
        if depth == 0:
            return source[tokens[i].start : token.start + 1]
    raise ValueError("a bracket is not closed")


def mutants(path: Path) -> List[Mutant]:
    """All changes of the functions of a file, and of the numbers that it gives names."""
    source = path.read_text(encoding="utf-8")
    tokens, found, seen = _tokens(source), [], {}  # type: List[_Token], List[Mutant], Dict[str, int]
    places = [(match.start(1), "constant", match.group(1), new) for match in _DEFINITION.finditer(source)
              for new in _number_changes(match.group(1))]
    for begin, end in _bodies(tokens):
        for i in range(begin + 1, end):
            for kind, old, new in _changes(source, tokens, i):
                places.append((tokens[i + 1].start if old.startswith("(") else tokens[i].start, kind, old, new))
    for start, kind, old, new in places:
        line = source.count("\n", 0, start) + 1
        text = " ".join(source.splitlines()[line - 1].split())
        key = f"{path.name} | {text} | {_brief(old)} -> {_brief(new)}"
        seen[key] = seen.get(key, 0) + 1
        if seen[key] > 1:
            key += f" ({seen[key]})"
        found.append(Mutant(path.name, start, old, new, line, key, kind))
    return found


def _brief(text: str) -> str:
    return " ".join(text.split()) or "nothing"


def chosen(candidates: Sequence[Mutant], seed: int) -> List[Mutant]:
    """The candidates in an order that the seed gives, and in which each keeps its place when others change."""
    return sorted(candidates, key=lambda mutant: hashlib.sha256(f"{seed} {mutant.key}".encode()).digest())
