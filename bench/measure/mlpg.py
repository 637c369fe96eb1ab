"""Equation 3 alone on the host, beside hts_engine and SPTK: instructions and memory for the same units."""

from __future__ import annotations

import os
import re
import shutil
import tempfile
from pathlib import Path
from typing import List, Union

from measure.core import Bench, LeftOut, run, version
from measure.host import collected, heap_peak, shown_callgrind

#: Units of 42 frames and 8 channels that are solved; FEW and MANY tell SPTK's cost per frame from its start.
UNITS, FEW, MANY = 20, 5, 25

FRAMES = 42 * 8  #: of all channels of one unit

UNIT = "instructions/frame and channel"
#: Solves a unit in steps of three frames, like a stream and the boards' image: decodes the state, adds the rows, and
#: makes a backward pass from the latest.
SOLVE = "bench_unit_solve"


def measure(bench: Bench, compiler: str) -> None:
    program = bench.build / "bench" / "labial-bench-mlpg"
    command = [program, "labial", str(UNITS)]
    count = collected(command, SOLVE)
    bench.add("host", "MLPG", round(count / (UNITS * FRAMES), 1), UNIT,
              shown_callgrind(command, SOLVE), version(compiler))
    about = [program, "about", "1"]
    found = re.search(rb"memory: (\d+) bytes", run(about).stdout)
    if not found:
        raise RuntimeError(f"{program} does not say what memory it needs")
    bench.add("host", "MLPG: memory", int(found.group(1)), "bytes", about, "the interface")


def _beside(bench: Bench, name: str, count: float, memory: int, command: List[Union[str, Path]], tool: str) -> None:
    own, own_memory = bench.value("host", "MLPG"), bench.value("host", "MLPG: memory")
    bench.add("host", f"MLPG by {name}", round(count, 1), UNIT, command, tool)
    bench.add("host", f"MLPG by {name}: heap", memory, "bytes", command, tool)
    if own and own_memory:
        for figure, value, unit in (("", round(count / own, 2), "times Labial's instructions"),
                                    (": memory", round(memory / own_memory, 1), "times Labial's bytes")):
            bench.add("host", f"MLPG by {name} / Labial{figure}", value, unit, command, tool)


def hts_engine(bench: Bench) -> None:
    """hts_engine's HTS_PStreamSet_create(), for the same equation unit by unit; its solution must equal Labial's."""
    program = bench.build / "bench" / "labial-bench-mlpg"
    if b"hts_engine: yes" not in run([program, "about", "1"]).stdout:
        raise LeftOut("The comparison with hts_engine is left out: install the Debian package libhtsengine-dev "
                      "and configure again.")
    run([program, "compare", "1"])
    function = "HTS_PStreamSet_create"
    command = [program, "hts", str(UNITS)]
    count = collected(command, function) / (UNITS * FRAMES)
    with tempfile.TemporaryDirectory(prefix="labial-bench-") as scratch:
        memory = heap_peak([program, "hts", "1"], Path(scratch))
    _beside(bench, "hts_engine", count, memory, shown_callgrind(command, function), "hts_engine")


def sptk(bench: Bench) -> None:
    """SPTK's program, for the same frames as one sequence: the cost of each further frame, including reading and
    writing, and its peak memory."""
    program = bench.build / "bench" / "labial-bench-mlpg"
    folders = ("/usr/libexec/sptk/bin", "/usr/lib/sptk/bin", "/usr/local/SPTK/bin", os.environ["PATH"])
    found = shutil.which("mlpg", path=os.pathsep.join(folders))
    if not found:
        raise LeftOut("The comparison with SPTK is left out: install the Debian package sptk.")
    mlpg = [found, "-l", "13", "-i", "1", "-d", "-0.5", "0", "0.5", "-d", "1", "-2", "1"]
    with tempfile.TemporaryDirectory(prefix="labial-bench-") as scratch:
        counts = {}
        for units in (FEW, MANY):
            path = Path(scratch) / f"{units}.f"
            path.write_bytes(run([program, "sptk", str(units)]).stdout)
            counts[units] = collected([*mlpg, path])
        memory = heap_peak([*mlpg, Path(scratch) / f"{FEW}.f"], Path(scratch))
    shown: List[Union[str, Path]] = [program, "sptk", str(MANY), "|", *shown_callgrind(mlpg, "")]
    _beside(bench, "SPTK", (counts[MANY] - counts[FEW]) / ((MANY - FEW) * FRAMES), memory, shown, "SPTK")
