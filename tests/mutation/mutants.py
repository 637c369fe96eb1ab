"""Small changes of sources in C, JavaScript and Python, each of which some test should detect."""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterator, List, NamedTuple, Pattern, Sequence, Set, Tuple

from python_changes import SYMMETRIC, Change, python_changes

#: Replacements of operators; the left operand of a binary one ends with a word, a number or a closing bracket.
BINARY: Dict[str, Tuple[str, ...]] = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
    "+": ("-",), "-": ("+",), "*": ("+",), "/": ("*",), "%": ("*",), "<<": (">>",), ">>": ("<<",),
    "&": ("|",), "|": ("&",), "^": ("&",), "&&": ("||",), "||": ("&&",),
    "+=": ("-=",), "-=": ("+=",), "*=": ("+=",), "|=": ("&=",), "&=": ("|=",), "<<=": (">>=",), ">>=": ("<<=",),
    "^=": ("&=",), "===": ("!==",), "!==": ("===",), "??": ("&&",), ">>>": ("<<",),
}  # fmt: skip
#: Replacements of unary operators.
UNARY: Dict[str, Tuple[str, ...]] = {"!": ("",), "-": ("",), "~": ("",), "++": ("--",), "--": ("++",)}

#: Kinds of changes: one sign or number, an inverted condition, a removed statement; two neighbouring arguments of a
#: call swapped, a named constant or its definition off by one, a factor that converts units omitted, one of several
#: members that are set together omitted; in JavaScript and Python also a statement that sets something to nothing.
KINDS = ("sign", "number", "condition", "statement", "argument", "constant", "unit", "reset")

_C_TOKEN = re.compile(
    r"(?P<space>\s+|//[^\n]*|/\*.*?\*/|^[ \t]*\#(?:[^\n\\]|\\\n)*)"
    r"|(?P<text>\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*')"
    r"|(?P<number>0[xX][0-9a-fA-F]+[uUlL]*|\d+[uUlL]*)"
    r"|(?P<word>[A-Za-z_]\w*)"
    r"|(?P<sign><<=|>>=|->|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|.)",
    re.DOTALL | re.MULTILINE,
)
#: A regular expression stands where a value can begin; templates count as texts.
_JS_TOKEN = re.compile(
    r"(?P<space>\s+|//[^\n]*|/\*.*?\*/)"
    r"|(?P<text>\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*'|`(?:[^`\\]|\\.)*`"
    r"|(?:(?<=[(,=:!&|?{;])|(?<=[(,=:!&|?{;][ ]))/(?:[^/\\\n\[]|\\.|\[(?:[^\]\\\n]|\\.)*\])+/[a-z]*)"
    r"|(?P<number>0[xX][0-9a-fA-F]+|\d[\d_]*(?:\.\d+)?(?:[eE][-+]?\d+)?)"
    r"|(?P<word>[A-Za-z_$\#][\w$]*)"
    r"|(?P<sign>>>>=|\.\.\.|===|!==|\*\*|>>>|&&=|\|\|=|\?\?=|=>|\?\?|\?\.|<<=|>>=|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\|"
    r"|[-+*/%&|^]=|.)",
    re.DOTALL,
)
#: Named constants of lib/ or of its headers; macros with arguments are excluded.
_CONSTANT = re.compile(r"[A-Z][A-Z0-9]*(?:_[A-Z0-9]+)*_?(?:MAX)?$")
_C_DEFINITION = re.compile(r"^#define [A-Z][A-Z0-9_]* (0[xX][0-9a-fA-F]+[uUlL]*|\d+[uUlL]*)(?=\s)", re.MULTILINE)
_JS_DEFINITION = re.compile(r"^(?:export )?const [A-Z][A-Z0-9_]* = (\d+)(?=;)", re.MULTILINE)
#: Words behind which - or * stands alone, and those that begin no statement that could go.
_C_KEYWORDS = set("return case else do sizeof goto break continue default switch for while if".split())
_JS_KEYWORDS = (_C_KEYWORDS - {"sizeof", "goto"}) | set(
    "function class const let import export throw async await yield catch try finally of in typeof new delete".split())
_C_DECLARATION = re.compile(r"(?:const|static|extern|unsigned|signed|int|char|typedef|enum|struct|\w+_t|return|case)\b")
_JS_DECLARATION = re.compile(r"static\b")
#: What a statement of JavaScript sets something to that begins anew.
_NOTHING = re.compile(r"=\s*(?:-?\d+|null|undefined|false|true|Infinity|\"\"|\[\]|\{\}|new \w+\(\))$|\.clear\(\)$")


class _Language(NamedTuple):
    token: Pattern[str]
    definition: Pattern[str]
    keywords: Set[str]
    declaration: Pattern[str]
    begins: Tuple[str, ...]  #: what a statement follows


_C = _Language(_C_TOKEN, _C_DEFINITION, _C_KEYWORDS, _C_DECLARATION, ("{", "}", ";"))
_JS = _Language(_JS_TOKEN, _JS_DEFINITION, _JS_KEYWORDS, _JS_DECLARATION, ("{", "}", ";", ")", "else"))
#: Least number that may convert units.
_FACTOR_MIN = 10


@dataclass(frozen=True)
class Mutant:
    file: str
    start: int
    old: str
    new: str
    line: int
    key: str  #: identifies the change by the text of its line, wherever that moves
    kind: str  #: one of KINDS

    def apply(self, source: str) -> str:
        return source[: self.start] + self.new + source[self.start + len(self.old) :]


class _Token(NamedTuple):
    kind: str
    text: str
    start: int


def _tokens(source: str, language: _Language) -> List[_Token]:
    return [_Token(match.lastgroup or "", match.group(), match.start()) for match in language.token.finditer(source)
            if match.lastgroup != "space"]


def _number_changes(text: str) -> Iterator[str]:
    digits = re.match(r"0[xX][0-9a-fA-F]+|\d+(?![\d_.eE])", text)
    if not digits:
        return  # no whole number
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


def _statement(language: _Language, source: str, tokens: Sequence[_Token], i: int) -> str:
    """The expression statement that begins with token `i`, without its semicolon; empty where none does."""
    if tokens[i - 1].text not in language.begins or tokens[i].kind != "word" or tokens[i].text in language.keywords:
        return ""
    depth = 0
    for token in tokens[i:]:
        depth += (token.text in "([") - (token.text in ")]")
        if depth < 0 or token.text in "{}":
            return ""
        if token.text == ";":
            text = source[tokens[i].start : token.start]
            return "" if language.declaration.match(text) or text.startswith("(void)") else text
    return ""


def _changes(language: _Language, source: str, tokens: Sequence[_Token], i: int) -> Iterator[Tuple[str, str, str]]:
    """What stands at token `i`, or in the bracket behind it, and may become another: kind, old text, new text."""
    token, before = tokens[i], tokens[i - 1]
    is_value = before.kind in ("word", "number") and before.text not in language.keywords
    is_binary = is_value or before.text in (")", "]")
    if token.text in ("*", "/") and is_binary and not _is_cast(tokens, i) and _is_factor(tokens, i + 1):
        yield "unit", source[token.start : tokens[i + 1].start + len(tokens[i + 1].text)], ""
    if token.kind == "number":
        for new in _number_changes(token.text):
            yield "number", token.text, new
    elif _is_constant(tokens, i, language):
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
    elif token.kind == "word" and token.text not in (*language.keywords, *SYMMETRIC) and tokens[i + 1].text == "(":
        behind = tokens[_closing(tokens, i + 1) + 1].text
        if language is _C or (before.text != "function" and behind not in ("{", "=>")):  # which define
            for swapped in _swaps(source, tokens, i + 1):
                yield "argument", _bracket(source, tokens, i + 1), swapped
    statement = _statement(language, source, tokens, i)
    if statement:
        yield "reset" if language is _JS and _NOTHING.search(statement) else "statement", statement, ""
        for new in _fewer_targets(statement):
            yield "reset", statement, new


def _is_constant(tokens: Sequence[_Token], i: int, language: _Language = _C) -> bool:
    """Whether token `i` is a named constant that is used, not the length of an array that is declared; in JavaScript
    constants may be texts, and are left alone."""
    token, before, behind = tokens[i], tokens[i - 1], tokens[i + 1]
    if language is not _C or token.kind != "word" or not _CONSTANT.match(token.text):
        return False
    if token.text == "NULL" or behind.text == "(":
        return False
    declares = before.text == "[" and behind.text == "]" and tokens[i - 2].kind == "word" and (
        tokens[i - 3].kind == "word" and tokens[i - 3].text not in _C_KEYWORDS)
    return not declares


def _is_factor(tokens: Sequence[_Token], i: int) -> bool:
    """Whether token `i` is a number or a named constant alone that may convert one unit to another."""
    if tokens[i + 1].text in ("(", "[", ".", "->", "?.", "**"):
        return False
    if tokens[i].kind == "number":
        digits = re.match(r"\d+", tokens[i].text)
        return digits is not None and int(digits.group()) >= _FACTOR_MIN
    return tokens[i].kind == "word" and bool(_CONSTANT.match(tokens[i].text))


def _closing(tokens: Sequence[_Token], i: int) -> int:
    """The token that closes the bracket that token `i` opens."""
    depth = 0
    for j in range(i, len(tokens)):
        depth += (tokens[j].text == "(") - (tokens[j].text == ")")
        if depth == 0:
            return j
    raise ValueError("a bracket is not closed")


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
    return source[tokens[i].start : tokens[_closing(tokens, i)].start + 1]


def _changed(path: Path, source: str) -> Iterator[Change]:
    """All changes of the functions of a file, and of the numbers that it gives names."""
    if path.suffix == ".py":
        yield from python_changes(source)
        return
    language = _JS if path.suffix == ".js" else _C
    tokens = _tokens(source, language)
    for match in language.definition.finditer(source):
        for new in _number_changes(match.group(1)):
            yield Change(match.start(1), "constant", match.group(1), new)
    for begin, end in _bodies(tokens) if language is _C else [(0, len(tokens) - 2)]:
        for i in range(begin + 1, end):
            for kind, old, new in _changes(language, source, tokens, i):
                yield Change(tokens[i + old.startswith("(")].start, kind, old, new)


def mutants(path: Path, name: str) -> List[Mutant]:
    """All changes of a file, which has this name in their keys."""
    source = path.read_text(encoding="utf-8")
    found, seen = [], {}  # type: List[Mutant], Dict[str, int]
    lines = source.splitlines()
    for start, kind, old, new in _changed(path, source):
        line = source.count("\n", 0, start) + 1
        text = " ".join(lines[line - 1].split())
        key = f"{name} | {text} | {_brief(old)} -> {_brief(new)}"
        seen[key] = seen.get(key, 0) + 1
        if seen[key] > 1:
            key += f" ({seen[key]})"
        found.append(Mutant(name, start, old, new, line, key, kind))
    return found


def _brief(text: str) -> str:
    return " ".join(text.split()) or "nothing"


def chosen(candidates: Sequence[Mutant], seed: int) -> List[Mutant]:
    """The candidates in an order that the seed gives, and in which each keeps its place when others change."""
    return sorted(candidates, key=lambda mutant: hashlib.sha256(f"{seed} {mutant.key}".encode()).digest())
