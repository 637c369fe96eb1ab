"""Writes the page that plays what labial-demo printed, by ``labial page``'s player. It needs no numpy.

    page.py demo.json OUTPUT.html [--sound SOUND] [--title TITLE]

The package labial must be on Python's path. SOUND is in step with the frames.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from labial.errors import LabialError
from labial.files.outputs import writing
from labial.see.player import player


def main() -> int:
    """The command line; see the module."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("motion", metavar="demo.json", type=Path)
    parser.add_argument("page", metavar="OUTPUT.html", type=Path)
    parser.add_argument("--sound")
    parser.add_argument("--title", default="Labial: a sentence, a laugh, and both at once")
    options = parser.parse_args()
    try:
        motion = json.loads(options.motion.read_text(encoding="utf-8"))
        page = player(options.title, motion["fps"], motion["frames"], motion["phonemes"], audio=options.sound)
        with writing(options.page, "utf-8") as file:
            file.write(page)
    except (ValueError, KeyError, TypeError) as error:
        print(f"page: {options.motion}: not what labial-demo prints: {error}", file=sys.stderr)
        return 1
    except (LabialError, OSError) as error:
        print(f"page: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
