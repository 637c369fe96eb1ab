"""The library as two files: labial.h holds the public headers, labial.c all the rest.

In one translation unit file-scope names must differ. What a private header declares becomes static; a static name that
another file uses too gets its own file's name in front; macros of a source end with it.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Dict, Iterable, Iterator, List, Set

from source import PackError, Source, write_text

#: Comments, literals, numbers, identifiers and, one by one, all other characters.
_TOKEN = re.compile(
    r"/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'|\.?\d[\w.]*|[A-Za-z_]\w*|.", re.DOTALL
)
_IDENTIFIER = re.compile(r"[A-Za-z_]\w*")
_INCLUDE = re.compile(r'^#include "([^"]+)"\n', re.MULTILINE)
#: The start of a function's declaration or definition with external linkage, at the beginning of a line.
_FUNCTION = re.compile(r"^(?!static\b|typedef\b|extern\b|return\b|else\b)[A-Za-z_][\w \t*]*?[ *](\w+)\(", re.MULTILINE)
#: A static function or object, or a type, at the beginning of a line.
_STATIC = re.compile(r"^static\b[^;={(\[\n]*?(\w+) *(?=[;=(\[])", re.MULTILINE)
_TYPE = re.compile(r"^(?:typedef\b[^{;\n]*?|\} *)(\w+);", re.MULTILINE)
_MACRO = re.compile(r"^[ \t]*#[ \t]*define[ \t]+(\w+)", re.MULTILINE)


def _tokens(text: str) -> Iterator[str]:
    return (match[0] for match in _TOKEN.finditer(text))


def _code(text: str) -> str:
    """`text` with comments as spaces, line breaks kept."""
    return "".join(re.sub(r"[^\n]", " ", t) if t.startswith(("/*", "//")) else t for t in _tokens(text))


def _identifiers(text: str) -> Set[str]:
    return {token for token in _tokens(text) if _IDENTIFIER.fullmatch(token)}


def _renamed(text: str, names: Dict[str, str]) -> str:
    """`text` with the identifiers of `names` replaced, members after a dot or an arrow excepted."""
    out: List[str] = []
    before = ""
    for token in _tokens(text):
        if token in names and not before.endswith((".", "->")):
            token = names[token]
        out.append(token)
        if not token.isspace():
            before = (before + token)[-2:]
    return "".join(out)


def _ordered(headers: Iterable[Path]) -> List[Path]:
    """Headers such that each follows those it includes."""
    by_name = {path.name: path for path in headers}
    done: List[Path] = []

    def add(path: Path, via: List[str]) -> None:
        if path.name in via:
            raise PackError(f"{path}: includes itself")
        for name in _INCLUDE.findall(path.read_text(encoding="utf-8")):
            other = by_name.get(name.rsplit("/", 1)[-1])
            if other:
                add(other, [*via, path.name])
        if path not in done:
            done.append(path)

    for path in by_name.values():
        add(path, [])
    return done


def _body(path: Path) -> str:
    """A file without its includes of Labial's own headers and without the blank lines that they leave."""
    text = _INCLUDE.sub("", path.read_text(encoding="utf-8"))
    return re.sub(r"\n{3,}", "\n\n", text).strip("\n") + "\n"


def _banner(source: Source, name: str, what: str) -> str:
    text = f"{name} - {what}; Labial {source.version}.\n\n"
    text += "Written by packaging/pack.py from the files named below; do not edit.\n\n"
    text += source.license.read_text(encoding="utf-8").strip()
    return "/*\n" + "".join(f" * {line}".rstrip() + "\n" for line in text.split("\n")) + " */\n"


def _section(path: Path, folder: str, text: str) -> str:
    title = f"/* ==== {folder}/{path.name} "
    return "\n" + title + "=" * max(4, 116 - len(title)) + " */\n\n" + text


def _static(text: str, names: Set[str]) -> str:
    """`text` with "static" before the functions `names`; lines that continue their heads stay aligned."""
    lines = text.split("\n")
    open_head = 0
    for i, (line, bare) in enumerate(zip(lines, _code(text).split("\n"))):
        match = _FUNCTION.match(bare)
        if open_head:
            lines[i] = " " * len("static ") + line
        elif match and match[1] in names:
            lines[i] = "static " + line
        else:
            continue
        open_head += bare.count("(") - bare.count(")")
    return "\n".join(lines)


def header_text(source: Source) -> str:
    """All public headers as one."""
    text = _banner(source, "labial.h", "lip motion from phonemes: the public headers in one file")
    for path in _ordered(source.public):
        text += _section(path, "include/labial", _body(path))
    return text


def source_text(source: Source) -> str:
    """All of the library's code as one translation unit."""
    bodies = {path: _body(path) for path in [*_ordered(source.private), *source.sources]}
    private: Set[str] = set()
    for path in source.private:
        private |= set(_FUNCTION.findall(_code(bodies[path])))
    used = {path: _identifiers(text) for path, text in bodies.items()}
    public: Set[str] = set()
    for path in source.public:
        public |= _identifiers(path.read_text(encoding="utf-8"))

    text = _banner(source, "labial.c", "lip motion from phonemes: the library in one file")
    text += '#include "labial.h"\n'
    for path, body in bodies.items():
        if path in source.sources:
            bare = _code(body)
            others = set().union(public, *(names for other, names in used.items() if other != path))
            own = set(_STATIC.findall(bare)) | set(_TYPE.findall(bare))
            names = {name: f"{path.stem}_{name}" for name in sorted(own & others)}
            taken = set(names.values()) & (others | used[path])
            if taken:
                raise PackError(f"{path}: {', '.join(sorted(taken))} is taken")
            body = _renamed(body, names)
            macros = [name for name in dict.fromkeys(_MACRO.findall(bare)) if f"#undef {name}\n" not in bare]
            if macros:
                body += "\n" + "".join(f"#undef {name}\n" for name in macros)
        text += _section(path, "lib", _static(body, private))
    return text


def model_text(path: Path) -> str:
    """A model's file, which then includes labial.h alone of the library."""
    text = path.read_text(encoding="utf-8")
    includes = [match for match in _INCLUDE.finditer(text) if match[1].startswith("labial/")]
    for i, match in reversed(list(enumerate(includes))):
        text = text[: match.start()] + ('#include "labial.h"\n' if i == 0 else "") + text[match.end() :]
    return text


def write(source: Source, folder: Path) -> None:
    """Writes labial.h, labial.c, the models and the licence into `folder`."""
    files = {"labial.h": header_text(source), "labial.c": source_text(source)}
    for model in source.models:
        files.update((path.name, model_text(path)) for path in model.files)
    files["LICENSE"] = source.license.read_text(encoding="utf-8")
    for name, text in files.items():
        write_text(folder / name, text)
