"""Runs commands of ``labial`` that are killed at random moments, for test_outputs.py.

    python killed.py FOLDER ROUNDS

FOLDER holds a corpus called ``corpus``. Nothing gives way to what is made up: the commands work as they do for a user.
Prints as JSON, for each command, what is wrong with what it left behind: an empty list where nothing is.
"""

from __future__ import annotations

import json
import os
import random
import shutil
import signal
import sys
import time
from pathlib import Path
from typing import Dict, List, NamedTuple

import numpy as np

import labial.bake.bake
import labial.evaluate.loss
import labial.fit.fit
import labial.train  # noqa: F401, what the commands import is in memory
from avatars import document_of, glb, made_head
from labial.__main__ import main
from labial.tables.model import save
from models import random_model, write_motion

OLD = b"what was there before\n"


class Case(NamedTuple):
    """A command and what it writes into the folder ``out``."""

    arguments: List[str]
    targets: List[str]


CASES = {
    "train": Case(["train", "corpus", "-o", "out/m.npz", "--jobs", "1", "--codebook", "4", "--components", "1"],
                  ["m.npz"]),
    "fit": Case(["fit", "a.glb", "-o", "out/n.toml"], ["n.toml", "n.png"]),
    "export": Case(["export", "model.npz", "--name", "m", "--blob", "-o", "out"],
                   ["m.h", "m.c", "m_names.c", "m.lbm"]),
    "bake": Case(["bake", "f.csv", "-o", "out/b.h"], ["b.h", "labial_player.h"]),
}  # fmt: skip


def given() -> None:
    """What the commands read."""
    save(random_model(1), "model.npz")
    write_motion(Path("f.csv"), np.arange(40) / 50, 20 * np.sin(np.add.outer(np.arange(40), np.arange(13))))
    Path("a.glb").write_bytes(glb(*document_of(*made_head())))


def started(case: Case) -> int:
    """The process of a command that says nothing."""
    child = os.fork()
    if not child:
        status = 70
        try:
            nothing = os.open(os.devnull, os.O_RDWR)
            for number in (0, 1, 2):
                os.dup2(nothing, number)
            status = main(case.arguments)
        finally:
            os._exit(status)
    return child


def left() -> Dict[str, bytes]:
    """The files in ``out``."""
    return {str(path.relative_to("out")): path.read_bytes() for path in Path("out").rglob("*") if path.is_file()}


def faults(case: Case, rounds: int, draw: random.Random) -> List[str]:
    """What is wrong after a command that runs to its end, and after `rounds` that are killed meanwhile."""
    os.makedirs("out", exist_ok=True)
    for _ in range(2):  # the first time takes longer
        begin = time.monotonic()
        if os.waitpid(started(case), 0)[1] != 0:
            return ["it fails"]
    lasts, new, wrong, died = time.monotonic() - begin, left(), [], 0
    for _ in range(rounds):
        for name in case.targets:
            Path("out", name).write_bytes(OLD)
        # Every other one near the end, where files are written.
        moment = lasts * draw.uniform(0.0, 1.0) if draw.random() < 0.5 else lasts * draw.uniform(0.85, 1.05)
        child = started(case)
        time.sleep(moment)
        os.kill(child, signal.SIGKILL)
        died += os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == -signal.SIGKILL
        found = left()
        wrong += [f"killed after {moment:.3f} s, {name} is neither the old nor the new file"
                  for name in case.targets if found.get(name) not in (OLD, new[name])]
    if not died:
        wrong.append("it was never killed")
    if os.waitpid(started(case), 0)[1] != 0 or left() != new:
        wrong.append(f"after the last one, there are {sorted(left())}")
    return wrong


def main_of_the_test() -> None:
    """See the top."""
    os.chdir(sys.argv[1])
    given()
    rounds, draw = int(sys.argv[2]), random.Random(7)
    result = {}
    for name, case in CASES.items():
        shutil.rmtree("out", ignore_errors=True)
        result[name] = faults(case, rounds, draw)
    print(json.dumps(result))


if __name__ == "__main__":
    main_of_the_test()
