#!/usr/bin/env python3
"""Measures Labial: instructions per frame on every board and on the host, bytes, stack, accuracy.

    cmake --workflow --preset bench              measures, writes build/bench/bench.json and bench.md, and checks
    python3 bench/bench.py --update              makes what was measured last the baseline, bench/baseline.json, and
                                                 writes the figures of all pages, as bench/figures.py does

Needs the programs of the preset `bench` in its build folder; measurements without their tools are skipped with a
message.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Callable, Dict, List

from measure import baseline, boards, figures, hearing, host, loss, mlpg, pages, profile, sizes, stack, table
from measure.core import Bench, LeftOut


def _options() -> argparse.Namespace:
    source = Path(__file__).resolve().parents[1]
    parser = argparse.ArgumentParser(description="Measures Labial.")
    parser.add_argument("--build", type=Path, default=source / "build" / "bench", help="folder of the preset `bench`")
    parser.add_argument("--check", action="store_true", help="fail when a figure is worse than bench/baseline.json")
    parser.add_argument("--update", action="store_true",
                        help="measure nothing; make the last figures the baseline and the pages'")
    parser.add_argument("--require-all", action="store_true", help="fail when anything is left out")
    parser.add_argument("--compiler", default="cc", help="that built the host's programs (cc)")
    parser.add_argument("--corpus", default="", help="speech corpus on whose phonemes loss and delay are measured")
    options = parser.parse_args([argument for argument in sys.argv[1:] if argument])
    options.source, options.build = source, options.build.resolve()
    return options


def _measure(bench: Bench, compiler: str, corpus: str) -> List[profile.Row]:
    def attempt(measurement: Callable[..., object], *arguments: object) -> None:
        try:
            measurement(bench, *arguments)
        except LeftOut as reason:
            if str(reason) not in bench.left_out:
                bench.left_out.append(str(reason))

    checksums = host.checksums(bench)
    heard: Dict[str, int] = {}
    for board in boards.BOARDS:
        print(f"{board.core}: code, stack, instructions", flush=True)
        attempt(sizes.measure, board)
        attempt(stack.measure, board)
        attempt(boards.measure, board, checksums)
        attempt(hearing.measure, board, heard)
        attempt(hearing.measure_words, board, heard)
    attempt(sizes.esp32_hear)
    attempt(sizes.uno)
    attempt(sizes.uno_beside)
    print("Host: speed, instructions, equation 3, loss", flush=True)
    attempt(host.measure, compiler)
    attempt(host.python, compiler)
    attempt(host.npm)
    attempt(mlpg.measure, compiler)
    attempt(mlpg.hts_engine)
    attempt(mlpg.sptk)
    attempt(loss.measure, corpus or None)
    attempt(loss.delay, corpus or None)
    rows: List[profile.Row] = []
    attempt(profile.measure, rows)
    return rows


def _check(bench: Bench, path: Path, require_all: bool) -> bool:
    """Prints how the figures compare with the baseline; returns whether that is acceptable."""
    if not path.is_file():
        print(f"There is no {path}; write it by: python3 bench/bench.py --update")
        return False
    worse, passed_over = baseline.compare(baseline.read(path), bench.figures)
    for sentence in (*worse, *passed_over):
        print(sentence)
    if worse:
        print(f"Worse than bench/baseline.json by more than {100 * baseline.TOLERANCE:.0f} %: {len(worse)} of "
              f"{len(bench.figures)} figures. If that is meant: python3 bench/bench.py --update")
    elif not passed_over:
        print("No figure is worse than bench/baseline.json.")
    outdated = pages.refresh(bench.source, figures.of(bench.source, bench.figures), write=False)
    for sentence in outdated:
        print(sentence)
    if outdated:
        print("To write what was measured into bench/baseline.json and the pages: python3 bench/bench.py --update")
    return not outdated and not worse and not (require_all and passed_over)


def main() -> int:
    """Returns the exit status: 1 if the check fails, or if a required measurement was skipped."""
    options = _options()
    recorded, committed = options.build / "bench.json", options.source / "bench" / "baseline.json"
    if options.update:
        baseline.write(committed, baseline.checked(baseline.read(recorded)))
        changed = pages.refresh(options.source, figures.of(options.source), write=True)
        print("\n".join([*changed, f"Written: {committed} and {len(changed)} figures of pages"]))
        return 0
    bench = Bench(options.source, options.build)
    rows = _measure(bench, options.compiler, options.corpus)
    baseline.write(recorded, bench.figures)
    page = options.build / "bench.md"
    page.write_text(table.markdown(bench, rows), encoding="utf-8")
    for sentence in bench.left_out:
        print(sentence)
    for name, limit, value, reached in table.goals(bench):
        if not reached:
            print(f"Short of the goal: {name}: {value:g}, goal {limit:g}.")
    print(f"Figures: {recorded} and {page}")
    accepted = _check(bench, committed, options.require_all) if options.check else True
    return 0 if accepted and not (options.require_all and bench.left_out) else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (RuntimeError, ValueError, OSError) as error:
        print(f"bench: {error}", file=sys.stderr)
        sys.exit(1)
