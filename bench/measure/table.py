"""bench.md: the figures as tables for choosing a processor."""

from __future__ import annotations

from typing import Callable, Dict, List, Optional, Sequence, Tuple

from measure.boards import BOARDS, RATE, SECONDS
from measure.core import Bench, Figure
from measure.profile import Row
from measure.sizes import CORE

#: Goals: name, target, figure, the limit, and whether the limit is a minimum.
GOALS = (
    ("speech, Cortex-M0", "m0", "speech: mean", 18000, False),
    ("worst tick / mean, speech, Cortex-M0", "m0", "speech: worst tick / mean", 1.25, False),
    ("worst tick / mean, laughter, Cortex-M0", "m0", "laughter: worst tick / mean", 1.25, False),
    ("worst tick in which the model changes / mean, Cortex-M0", "m0", "turns: worst change / mean", 2, False),
    ("MLPG, Cortex-M0", "m0", "MLPG", 360, False),
    ("MLPG, Cortex-M4F", "m4", "MLPG", 200, False),
    ("MLPG, x86-64", "host", "MLPG", 210, False),
    ("MLPG error, largest, speech", "accuracy", "speech, *: MLPG error, largest", 0.1, False),
    ("MLPG error, largest, laughter", "accuracy", "laughter, *: MLPG error, largest", 0.1, False),
    ("code that plays compiled-in models, Cortex-M0 -Os", "m0", "code -Os: total", 5200, False),
    ("speech model", "m0", "speech: model", 38500, False),
    ("laughter model", "m0", "laughter: model", 40 * 1024, False),
    ("workspace and labial_t", "m0", "speech: workspace and labial_t", 3072, False),
    ("latest frame of the demo's sentence, ms", "delay", "demo sentence: latest frame", 450, False),
    ("stack, Cortex-M0 -Os", "m0", "stack -Os: every function", 512, False),
    ("stack, Cortex-M0 -O2", "m0", "stack -O2: every function", 512, False),
    ("Python, rendered whole, us per frame", "python", "speech: rendered whole", 5, False),
    ("npm, what a page that speaks fetches, bytes", "wasm", "a page that speaks, each script compressed", 65000, False),
    ("node, rendered whole, us per frame", "wasm", "speech: rendered whole", 10, False),
    ("node, rendered for the first time, us per frame", "wasm", "speech: rendered whole, the first time", 10, False),
    (f"x86-64, times real time at {RATE} frames/s", "host", f"speech: speed at {RATE} frames/s", 200, True),
)
#: Targets with their own columns, by the column's title.
COLUMNS: Dict[str, str] = {**{board.preset: board.core for board in BOARDS}, "host": "x86-64"}


def _of(target: str) -> Callable[[Figure], bool]:
    return lambda figure: figure.target == target


def _on_a_processor(what: str) -> Callable[[Figure], bool]:
    """Of the targets with columns those figures that are about "Equation 3", "Speed", "Bytes" or "A frame"."""
    def about(figure: Figure) -> str:
        return ("Equation 3" if figure.figure.startswith("MLPG") else "Speed" if figure.timed
                else "Bytes" if figure.unit == "bytes" else "A frame")

    return lambda figure: figure.target in COLUMNS and about(figure) == what


#: Sections: a title, a text, and whether a figure is shown there.
SECTIONS: Tuple[Tuple[str, str, Callable[[Figure], bool]], ...] = (
    ("A frame of 13 channels",
     f"Built with -O2; {SECONDS} s of a sentence, or of laughter, in a loop. The mean is that of all calls of "
     "`labial_tick()` from the first, while nothing is ready yet, to the last, divided by the frames delivered; the "
     "worst tick is the worst of them all. By turns, the model changes every few phonemes; the worst tick of that "
     "stream counts as one in which it does. QEMU counts no cycles. Where Arm publishes how many each instruction "
     "takes, they are summed up: without wait states, the most where there is a range, `labial_init()` and pushing "
     f"included. Shares are of these cycles at {RATE} frames/s. Clocks: "
     + "; ".join(f"{board.core} {board.clock} MHz ({board.chip})" for board in BOARDS) + ".",
     _on_a_processor("A frame")),
    ("Bytes",
     "Code is .text with read-only data. What plays compiled-in models, the total, is "
     f"{', '.join(f'`{name}.c`' for name in CORE)}. The other files of `lib/` are linked only when a program calls "
     "them: `model.c`, the check of a model, and `blob.c` for models from binary files. The compiler's helpers are "
     "functions of its own, such as division where the processor has none; what the C library brings for `memcpy`, "
     "`memmove`, `memset` is not counted. Stack counts all of these. The most that it can take comes from the "
     "compiler's frames and call graph and from the machine code of its own functions; the program's callback is not "
     "in it, but in what was painted.", _on_a_processor("Bytes")),
    ("Equation 3 alone",
     "Units of 42 frames of the speech model's states, three frames each, solved as a stream does it: in turns of "
     "three frames, each of which ends with its way back. On x86-64, by callgrind and massif. hts_engine: its "
     "`HTS_PStreamSet_create()`, which is handed the same means and variances unit by unit as its public structures, "
     "in doubles, its allocations included; its solution is Labial's whole one to less than a tenth of a FAP unit. "
     "SPTK: its program `mlpg`, which recurses over the frames as they arrive; the same frames as one sequence, what "
     "each further frame costs, reading and writing included. Memory: Labial's solvers and factors of all channels, "
     "however long the utterance; the others' heap at its peak.", _on_a_processor("Equation 3")),
    ("What integers cost",
     "MLPG: the library's solution of whole utterances, rounded to 1/16 FAP unit as it is, against float64 for the "
     "same tables, state paths and targets. Full scale is what a position can be, 1,024 FAP units to either side, "
     "so that the unit of error is one FAP unit. Window: what the motion differs from such a whole solution, in "
     "float64, because each frame is delivered when `LABIAL_WINDOW` frames beyond it are known. Paths: the "
     "likelihood, under the trained float64 model, that the exported tables' path, decided as the frames come, "
     "loses to the best path through the whole utterance by a search over all transitions, which like the library's "
     "sees one frame of those that share a state.", _of("accuracy")),
    ("The latest frame",
     "Phonemes are pushed when they begin, pauses too with their whole duration, `labial_end()` is called when the "
     "last one is over, and one tick follows in each frame period: how long after its own time a frame comes, the "
     "largest of each utterance.", _of("delay")),
    ("Python",
     "On the host, by bench/runtime.py: utterances rendered whole by `labial.render()`, and frame by frame from a "
     "`labial.Stream`, parsing of labels included.", _of("python")),
    ("WebAssembly",
     "The npm package under node, on the host, by bench/npm.mjs: utterances rendered whole by `labial.render()`, "
     "ticks of a `labial.stream()`, and `track.at()`, 60 times per second. Compressed by gzip at its highest "
     "level.", _of("wasm")),
    ("Arduino Uno", "Flash of examples/uno without its motion, and of the player of baked motion alone.", _of("uno")),
    ("Speed of the host, one core", "", _on_a_processor("Speed")),
)


def _number(value: Optional[float]) -> str:
    if value is None:
        return ""
    if value == int(value):
        return f"{int(value):,}"
    return f"{value:,.1f}" if abs(value) >= 100 else f"{value:.3g}"


def _rows(head: Sequence[str], rows: Sequence[Sequence[str]]) -> List[str]:
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    return [*lines, *("| " + " | ".join(row) + " |" for row in rows), ""]


def _sections(bench: Bench) -> List[str]:
    """The sections that have figures: a row for each figure, a column for each target."""
    lines: List[str] = []
    for title, text, belongs in SECTIONS:
        figures = [one for one in bench.figures if belongs(one)]
        targets = [name for name in COLUMNS if any(one.target == name for one in figures)] or [""]
        rows = [[figure, *(_number(next((one.value for one in figures if one.figure == figure and one.unit == unit
                                         and target in ("", one.target)), None)) for target in targets), unit]
                for figure, unit in dict.fromkeys((one.figure, one.unit) for one in figures)]
        if rows:
            head = ["", *(COLUMNS.get(target, "") for target in targets), ""]
            lines += [f"## {title}", "", *([text, ""] if text else []), *_rows(head, rows)]
    return lines


def _profile(profile: Sequence[Row]) -> List[str]:
    total = sum(row.instructions for row in profile)
    rows = [[f"`{row.function}`", f"{row.instructions:,.0f}", f"{100.0 * row.instructions / total:.1f} %",
             f"{row.cycles:,.0f}", f"{row.calls:,.2f}", f"{row.instructions / row.calls:,.0f}" if row.calls else ""]
            for row in profile if row.instructions >= 0.5]
    return [
        "## Where the instructions go on Cortex-M0", "",
        "The speech run by function: pushing, ticks and `labial_init()`, without the image's own code. Functions that "
        "the compiler inlined count in their callers.", "",
        *_rows(["function", "instructions/frame", "share", "cycles/frame", "calls/frame", "instructions/call"], rows),
    ]


def _goal_value(bench: Bench, target: str, figure: str) -> Optional[float]:
    begin, star, end = figure.partition("*")
    return next((one.value for one in bench.figures if one.target == target and (
        one.figure == figure or star and one.checked and one.figure.startswith(begin) and one.figure.endswith(end))),
        None)


def goals(bench: Bench) -> List[Tuple[str, float, float, bool]]:
    """Goals: name, limit, value and whether it is reached, for all measured figures."""
    found = []
    for name, target, figure, limit, least in GOALS:
        value = _goal_value(bench, target, figure)
        if value is not None:
            found.append((name, float(limit), value, value >= limit if least else value <= limit))
    return found


def _goals(bench: Bench) -> List[str]:
    rows = [[name, _number(limit), _number(value), "yes" if reached else "**no**"]
            for name, limit, value, reached in goals(bench)]
    return ["## Goals", "", *_rows(["", "goal", "measured", "reached"], rows)]


def markdown(bench: Bench, profile: Sequence[Row]) -> str:
    tools = sorted({figure.tool for figure in bench.figures if any(c.isdigit() for c in figure.tool)})
    lines = ["# Figures", "", "Measured by `cmake --workflow --preset bench`; `bench.json` has the command of each.",
             f"Tools: {', '.join(tools)}.", ""]
    lines += _sections(bench)
    lines += _profile(profile) if profile else []
    lines += _goals(bench)
    if bench.left_out:
        lines += ["## Left out", "", *(f"- {sentence}" for sentence in bench.left_out), ""]
    return "\n".join(lines)
