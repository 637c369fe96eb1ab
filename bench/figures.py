#!/usr/bin/env python3
"""Writes the figures of README.md, DESIGN.md and the pages of docs/ and export/, or checks them.

    python3 bench/figures.py                     writes the figures that bench/measure/figures.py lists
    python3 bench/figures.py --check             fails if a page has another; names the page, the line and both figures
    python3 bench/figures.py --measure           first runs the commands of bench/records.json that are outdated: the
                                                 models or their frames have changed since; takes minutes
    python3 bench/figures.py --measure NAME ...  runs these, also sections of export/RESULTS.md; takes up to hours
    python3 bench/figures.py --list              prints all names, and which are outdated

bench/bench.py measures and updates bench/baseline.json. --measure needs a Python with the packages of
export/requirements-reproduce.txt, flite and espeak-ng, and LABIAL_RUNTIME, a build of flat/.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from measure import figures, pages, records

ROOT = Path(__file__).resolve().parents[1]


def main() -> int:
    """Returns the exit status: 1 if a page has another figure than its source, or if a record is outdated."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--check", action="store_true", help="write nothing; fail on a difference")
    what.add_argument("--measure", nargs="*", metavar="NAME", help="run the outdated commands, or these")
    what.add_argument("--list", action="store_true", help="print the names that --measure takes")
    options = parser.parse_args()
    outdated = records.outdated(ROOT, records.read(ROOT))
    if options.list:
        print("\n".join(name + (", outdated" if name in outdated else "") for name in records.names(ROOT)))
        return 0
    if options.measure is not None:
        wanted = options.measure or [name for name in outdated if name in records.COMMANDS]
        unknown = set(wanted) - set(records.names(ROOT))
        if unknown:
            raise ValueError(f"{', '.join(sorted(unknown))}: not among {', '.join(records.names(ROOT))}")
        for name in wanted:
            records.measure(ROOT, name)
    complaints = [*records.refresh(ROOT, not options.check),
                  *pages.refresh(ROOT, figures.of(ROOT), write=not options.check)]
    print("\n".join(complaints) or "Every figure is that of its source.")
    if not options.check:
        complaints = records.refresh(ROOT, False)  # what no writing mends
    elif complaints:
        print("To write the figures into the pages: python3 bench/figures.py")
    return 1 if complaints else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (RuntimeError, ValueError, OSError) as error:
        print(f"figures: {error}", file=sys.stderr)
        sys.exit(1)
