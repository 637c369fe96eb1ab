"""Text of C: names, comments and lines of numbers."""

from __future__ import annotations

import re
import textwrap
from typing import Dict, Iterable, List, Sequence, Tuple

from labial import __version__
from labial.errors import ModelError

_C_KEYWORDS = frozenset(
    """alignas alignof and and_eq asm auto bitand bitor bool break case catch char class compl const constexpr
    const_cast continue decltype default delete do double dynamic_cast else enum explicit export extern false float for
    friend goto if inline int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected
    public register reinterpret_cast restrict return short signed sizeof static static_assert static_cast struct switch
    template this thread_local throw true try typedef typeid typename union unsigned using virtual void volatile wchar_t
    while xor xor_eq main errno linux unix typeof null eof""".split()
)
#: Headers of C and POSIX whose names could be a file's: NAME.h beside the sources would take their place.
_C_HEADERS = frozenset(
    """assert complex ctype dirent dlfcn fcntl fenv float inttypes iso646 limits locale math pthread sched semaphore
    setjmp signal stdalign stdarg stdatomic stdbit stdbool stdckdint stddef stdint stdio stdlib stdnoreturn string
    strings tgmath threads time uchar unistd wchar wctype""".split()
)
#: Headers of Arduino and of its usual libraries, which file systems without capitals do not tell from a file's.
_ARDUINO_HEADERS = frozenset("arduino client esp esp32servo print printable serial servo spi stream wifi wire".split())
#: The tables that the library comes with: only their own exports may write files of these names.
OWN_TABLES = frozenset("hear_ahead hear_host hear_large hear_small laughter_synthetic speech_en words_en".split())


def check_name(name: str, what: str = "model") -> None:
    """Raises ModelError, which says `what` it names, unless `name` can be a global name in C and C++, and NAME.h takes
    no other header's place. Models and tables of words may have the names of the library's own, which they replace."""
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,47}", name) or "__" in name:
        raise ModelError(
            f"{name!r} is no name for a {what}: letters, digits and single underscores, a letter first, at most 48"
        )
    lower = name.lower()  # constants of the name, NAME_LABEL, are in capitals
    taken = _C_KEYWORDS | _C_HEADERS | _ARDUINO_HEADERS
    if lower in taken or lower.startswith("labial") or (what in ("rig", "header") and lower in OWN_TABLES):
        raise ModelError(f"{name!r} is no name for a {what}: C, C++ or the library already uses it")


def constants_of(name: str, labels: Sequence[str]) -> List[str]:
    """The C constant of each label, ``NAME_LABEL``; labels that C cannot spell are numbered."""
    used: Dict[str, int] = {}
    names = []
    for number, label in enumerate(labels):
        spelled = re.sub(r"[^A-Za-z0-9_]", "_", label).upper()
        if not spelled or spelled in used:
            spelled = f"PHONEME_{number}"
        used[spelled] = number
        names.append(f"{name.upper()}_{spelled}")
    return names


def block_comment(text: str, width: int = 114) -> str:
    """`text` for a C comment, in lines of at most `width` columns, without the beginning or end of a comment;
    unprintable characters become question marks."""
    shown = "".join(c if c.isprintable() else " " if c.isspace() else "?" for c in text)
    apart = shown.replace("*/", "* /").replace("/*", "/ *")
    body = textwrap.fill(apart, width=width, initial_indent=" * ", subsequent_indent=" * ")
    return f"/*\n{body}\n */\n"


def written_by(command: str, text: str, width: int = 114) -> str:
    """The first comment of a file that `labial COMMAND` writes: `text`, and where the file is from."""
    return block_comment(f"{text} Written by labial {command} {__version__}; do not edit.", width)


def rows(values: Iterable[object]) -> str:
    """Values of an array, comma-separated, in lines of at most 120 columns."""
    return textwrap.fill(", ".join(str(value).replace(" ", "\u00a0") for value in values), width=118,
                         initial_indent="    ", subsequent_indent="    ",
                         break_on_hyphens=False).replace("\u00a0", " ")


def array(kind: str, name: str, values: Iterable[object]) -> str:
    """A constant array of a file's own."""
    items = list(values)
    return f"static const {kind} {name}[{len(items)}] = {{\n{rows(items)}\n}};\n"


def exported_header(comment: str, name: str, prefix: str, include: str, form: Tuple[str, int], body: str) -> str:
    """NAME.h of a table NAME, with the guard PREFIX_NAME_H, which includes a header of the library; `form` is the
    library's constant for the format of such tables, and the number that it must have."""
    guard = f"{prefix}_{name.upper()}_H"
    return f"""{comment}#ifndef {guard}
#define {guard}

#include "{include}"

#if {form[0]} != {form[1]}
#error "{name} was exported for another version of Labial: run labial export again."
#endif

#ifdef __cplusplus
extern "C" {{
#endif

{body}
#ifdef __cplusplus
}}
#endif

#endif
"""
