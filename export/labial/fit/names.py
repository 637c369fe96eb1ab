"""Names of shapes: compared across spellings, and the side that one tells."""

from __future__ import annotations

import re
from itertools import islice
from typing import Iterator, Tuple

#: A side in a name: a word anywhere, or a letter that stands apart from others: ``L_smile``, ``smile.l``, ``smileL``,
#: ``LSmile``.
_SIDE = re.compile(r"(?i:left|right|(?<![a-z])[lr](?![a-z]))|(?<=[a-z0-9])[LR](?![a-z])"
                   r"|(?<![A-Za-z])[LR](?=[A-Z][a-z])")
#: Sides looked at in one name.
_SIDES = 4


def own(name: str) -> str:
    """A shape's name without its mesh's, which stands before a dot (Maya's ``blendShape1.jawOpen``). Sides and numbers
    behind a dot (Blender's ``mouthSmile.L``, ``jawOpen.001``) belong to the shape."""
    parts = name.split(".")
    first = len(parts) - 1
    while first > 0 and (parts[first].isdecimal() or parts[first].lower() in ("l", "r", "left", "right")):
        first -= 1
    return ".".join(parts[first:])


def _letters(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())


def plain(name: str) -> str:
    """A shape's name for comparing: its own, in lower case, letters and digits."""
    return _letters(own(name))


def sided(name: str) -> Iterator[Tuple[str, str]]:
    """The readings of a name: the plain name without a side, and that side, ``left`` or ``right``. ``brightLeft`` has
    two readings, of which the one that ``brightRight`` shares counts."""
    shape = own(name)
    for found in islice(_SIDE.finditer(shape), _SIDES):
        yield (_letters(shape[: found.start()] + " " + shape[found.end():]),
               "left" if found[0][0] in "lL" else "right")
