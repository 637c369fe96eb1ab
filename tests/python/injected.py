"""Runs commands of ``labial`` that fail or die at chosen writes, for test_outputs.py, with injector.c preloaded.

    python injected.py INJECTOR FOLDER ROUNDS

FOLDER holds a corpus called ``corpus``.

Prints as JSON, for each command, what is wrong with what it left behind: an empty list where nothing is. What takes
long before anything is written, such as training, gives way to results made up here.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import importlib
import json
import os
import random
import shutil
import signal
import sys
import types
from pathlib import Path
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Tuple

import numpy as np
from matplotlib import pyplot

import labial.corpus
import labial.evaluate.loss
import labial.evaluate.protocol
import labial.train
from labial.__main__ import main
from labial.corpus import read_corpus
from labial.corpus.episode import Segment
from labial.evaluate.loss import measure
from labial.evaluate.material import Options
from labial.evaluate.protocol import evaluate
from labial.see import plot
from labial.tables.model import save
from labial.tables.phones import drawn_streams
from labial.tables.quantise import quantise
from models import random_model, write_motion, write_wav
from test_record import talking
from test_record import write as write_landmarks

MODELS = Path(labial.corpus.__file__).parents[2] / "models"
PICTURES = ["amplitude.png", "error_per_class.png", "steps_and_curve.png", "trajectories.png"]
NOTHING, FULL, KILL, TERM = range(4)
OLD = b"what was there before\n"
LAB = "0.00 0.20 SIL\n0.20 0.31 P\n0.71 1.00 SIL\n"
FACE = '[output.jaw]\nfrom = "jaw"\nneutral = 1400\nfull = 1900\n'


class Case(NamedTuple):
    """A command and what it writes into the folder ``out``."""

    arguments: List[str]
    targets: List[str]
    there: bool = True  #: the targets were there before
    patch: Optional[Callable[[], None]] = None


def _train() -> None:
    labial.train.train = lambda *_, **__: random_model(2)  # type: ignore[attr-defined]
    labial.train.backed_off = lambda _: []  # type: ignore[attr-defined]
    labial.corpus.read_corpora = lambda *_, **options: []  # type: ignore[attr-defined]


def _export() -> None:
    labial.evaluate.loss.measure = _measured  # type: ignore[assignment]


@functools.cache
def _loss() -> Any:
    model = random_model(1)
    return measure(model, quantise(model, "m"), drawn_streams(model)[:1])


def _measured(*_: Any) -> Any:
    return _loss()


def _evaluate() -> None:
    from labial.evaluate import report

    def blank(_: Any, __: Any, folder: Path) -> List[str]:
        for name in PICTURES:
            plot.write(pyplot.figure(figsize=(1, 1)), folder / name)
        return PICTURES

    labial.evaluate.protocol.run_split = lambda _, split, __: _outcomes()[split.number]  # type: ignore[assignment]
    report.draw = blank


@functools.cache
def _outcomes() -> list:
    return evaluate(read_corpus("corpus"), Options(methods="mean", splits=2), progress=False)


def _align() -> None:
    import labial.sound.align as align

    align.align_with_bar = lambda *_: align.Alignment((Segment(0.0, 1.0, "SIL"),), ())  # type: ignore[assignment]


def _track() -> None:
    for name in ("mediapipe", "av"):
        sys.modules.setdefault(name, types.ModuleType(name))
    import labial.capture.track as track

    points, _ = talking()

    class Tracker:
        def find(self, _: float, __: Any) -> list:
            return [(points[0].astype(np.float32), np.nan)]

        def close(self) -> None:
            pass

    track.FaceMesh = Tracker  # type: ignore
    track.pictures = lambda _: ((n / 25, np.zeros((2, 2, 3), np.uint8)) for n in range(20))  # type: ignore
    track.length = lambda _: 1.0  # type: ignore[assignment]


def _fit() -> None:
    import labial.fit.fit as fit
    import labial.see.picture as picture

    fit.fit = lambda *_: fit.Fitted("made up\n", None, object(), ["made up"])  # type: ignore
    picture.draw = lambda *given: given[-1].write_bytes(bytes(20000))  # type: ignore[assignment]


def _train_words() -> None:
    from labial.words import dictionary, tables, training

    trained = tables.load(MODELS / "words_en.npz")
    dictionary.read_dictionary = lambda _: []  # type: ignore[assignment]
    training.train = lambda *_, **__: trained  # type: ignore[assignment]


def _train_hear() -> None:
    import labial.hearing
    from labial.hearing import clips, model, prepared

    def train(_: Any, __: Any, checkpoint: str, *___: Any) -> model.HearingModel:
        Path(checkpoint).touch()
        return model.load(MODELS / "hear_small.npz")

    made = types.ModuleType("labial.hearing.train")  # which needs PyTorch
    made.Options, made.train = lambda *_: None, train  # type: ignore[attr-defined]
    labial.hearing.train = made  # type: ignore[attr-defined]
    sys.modules.update({"torch": types.ModuleType("torch"), made.__name__: made})
    clips.read = lambda *_: []  # type: ignore[assignment]
    prepared.prepare = lambda *_: types.SimpleNamespace(classes=[])  # type: ignore


def _evaluate_hear() -> None:
    from labial.evaluate import hearing

    hearing.of_voice = lambda *_: None  # type: ignore
    hearing.evaluated = lambda *_: []  # type: ignore
    hearing.table = lambda _: "made up\n" * 2000  # type: ignore[assignment]


def _speech_corpus() -> None:
    from labial.hearing import voices

    said = voices.Spoken(np.arange(8000, dtype=np.int16), 16000, (Segment(0.0, 0.5, "SIL"),))
    voices.speak = lambda *_: iter([said])  # type: ignore[assignment]


def cases() -> Dict[str, Case]:
    """Every command that writes, and some in both ways that a folder can be."""
    reports = ["report.md", "table1.csv", "table2.csv", "table3.csv", "table4.csv", "splits.csv", *PICTURES]
    evaluate = ["evaluate", "corpus", "--splits", "2", "--jobs", "1", "--methods", "mean", "--quiet"]
    return {
        "train": Case(["train", "corpus", "-o", "out/m.npz"], ["m.npz"], patch=_train),
        "synth": Case(["synth", "model.npz", "a.lab", "-o", "out/f.csv"], ["f.csv"]),
        "timings": Case(["timings", "a.lab", "-o", "out/b.lab"], ["b.lab"]),
        "align": Case(["align", "a.wav", "-o", "out/b.lab"], ["b.lab"], patch=_align),
        "bake": Case(["bake", "f.csv", "-o", "out/b.h"], ["b.h", "labial_player.h"]),
        "export": Case(["export", "model.npz", "--name", "m", "--blob", "-o", "out"],
                       ["m.h", "m.c", "m_names.c", "m.lbm"], patch=_export),
        "export, new": Case(["export", "model.npz", "--name", "m", "--blob", "-o", "out/new"],
                            ["new/m.h", "new/m.c", "new/m_names.c", "new/m.lbm"], there=False,
                            patch=_export),
        "evaluate": Case([*evaluate, "-o", "out"], reports, patch=_evaluate),
        "laughter-corpus": Case(["laughter-corpus", "out/c", "--episodes", "2"],
                                [f"c/laugh000{n}.{kind}" for n in range(2) for kind in ("csv", "lab")]
                                + ["c/README.md"], there=False),
        "rig": Case(["rig", "face.toml", "-o", "out"], ["face.h", "face.c", "face.svg"]),
        "fit": Case(["fit", "a.glb", "-o", "out/n.toml"], ["n.toml", "n.png"], patch=_fit),
        "plot": Case(["plot", "f.csv", "-o", "out/p.png"], ["p.png"]),
        "page": Case(["page", "f.csv", "-o", "out/p.html"], ["p.html"]),
        "landmarks": Case(["landmarks", "v.mp4", "-o", "out/l.npz", "--quiet"], ["l.npz"], patch=_track),
        "record": Case(["record", "seen.npz", "-o", "out/c"], ["c/seen.csv", "c/seen.lab"], there=False),
        "say": Case(["say", "Hi", "--voice", "none", "-o", "out/s.csv"], ["s.csv"]),
        "hear": Case(["hear", "a.wav", "--sound-alone", "-o", "out/h.csv"], ["h.csv"]),
        "train-hear": Case(["train-hear", "corpus", "-o", "out/h.npz", "--quiet"], ["h.npz"], patch=_train_hear),
        "evaluate-hear": Case(["evaluate-hear", str(MODELS / "hear_small.npz"), "-o", "out/t.md", "--cache", "cache"],
                              ["t.md"], patch=_evaluate_hear),
        "speech-corpus": Case(["speech-corpus", "out/c", "--sentences", "a.lab", "--voices", "flite:slt", "--minutes",
                               ".008", "--quiet"], ["c/00000_flite-slt.flac", "c/00000_flite-slt.lab"], there=False,
                              patch=_speech_corpus),
        "train-words": Case(["train-words", "a.lab", "-o", "out/w.npz", "--quiet"], ["w.npz"], patch=_train_words),
    }  # fmt: skip


def given() -> None:
    """What the commands read."""
    save(random_model(1), "model.npz")
    Path("a.lab").write_text(LAB)
    Path("face.toml").write_text(FACE)
    write_motion(Path("f.csv"), np.arange(40) / 50, 20 * np.sin(np.add.outer(np.arange(40), np.arange(13))))
    write_landmarks(Path(), "seen", landmarks=talking()[0])
    write_wav(Path("a.wav"), np.zeros(32000))


def lay(case: Case) -> None:
    """The folder as it is before a command."""
    shutil.rmtree("out", ignore_errors=True)
    os.mkdir("out")
    for name in case.targets if case.there else []:
        Path("out", name).write_bytes(OLD)


def run(inject: Any, case: Case, after: int, mode: int) -> Tuple[int, int, str]:
    """Exit status (negative: the signal that ended it), writes, and what standard error said. What the command imports
    is imported here, too, so that no later one has to."""
    known = set(sys.modules)
    counted, count = os.pipe()
    said, say = os.pipe()
    child = os.fork()
    if not child:
        status = 70
        try:
            os.dup2(say, 2)
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            sys.stdout, sys.stderr = open(1, "w"), open(2, "w", buffering=1)  # noqa: SIM115
            if case.patch:
                case.patch()
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
            inject(after, mode)
            status = main(case.arguments)
            number = inject(0, NOTHING)
            names = [name for name in set(sys.modules) - known if getattr(sys.modules[name], "__spec__", None)]
            os.write(count, " ".join([str(number), *names]).encode())
            sys.stderr.flush()
        finally:
            os._exit(status)
    os.close(count)
    os.close(say)
    with open(counted, "rb") as numbers, open(said, "rb") as lines:
        text = lines.read().decode()
        number, *names = numbers.read().decode().split() or ["0"]
    for name in sorted(names):
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), int(number), text


def left() -> Dict[str, bytes]:
    return {str(path.relative_to("out")): path.read_bytes() for path in Path("out").rglob("*") if path.is_file()}


def faults(case: Case, new: Dict[str, bytes], mode: int, status: int, said: str) -> List[str]:
    """What is wrong with the files that a command left behind, and with what it said."""
    found = left()
    hidden = [name for name in found if any(part.startswith(".") for part in Path(name).parts)]
    # What an evaluation has finished stays, so that it can be taken up again.
    hidden = [name for name in hidden if not name.startswith(".splits")]
    states = {name: "new" if found.get(name) == new[name] else "old" if found.get(name) == (OLD if case.there else None)
              else "another" for name in case.targets}
    kinds = set(states.values())
    wrong = [f"{name} is neither the old nor the new file" for name, state in states.items() if state == "another"]
    if not case.there and len(kinds) > 1:
        wrong.append("a part of a new folder")
    if mode == KILL:
        return wrong if status == -signal.SIGKILL else [*wrong, f"status {status}"]
    if hidden:
        wrong.append(f"left behind: {hidden}")
    if mode == TERM:
        return wrong if status in (0, 143) and len(kinds) == 1 else [*wrong, f"status {status}, {states}"]
    if status == 0 and kinds != {"new"} or status not in (0, 1):
        wrong.append(f"status {status}")
    said = "".join(line for line in said.splitlines(keepends=True) if not line.startswith("labial: warning: "))
    written = next(item for item in case.arguments if item.startswith("out"))
    meant = [f"labial: {name}: " for name in (written, f"{written}.checkpoint",
                                              *(f"out/{name}" for name in case.targets))]
    if status == 1 and (said.count("\n") != 1 or not said.startswith(tuple(meant))):
        wrong.append("says: " + said)
    if len(kinds) > 1 and not ("new" in said and "as before" in said):
        wrong.append("a part is new, and it does not say which: " + said)
    return wrong


def main_of_the_test() -> None:
    """See the top."""
    inject = ctypes.CDLL(sys.argv[1]).inject
    inject.argtypes, inject.restype = [ctypes.c_long, ctypes.c_int], ctypes.c_long
    sys.dont_write_bytecode = True  # of what the commands import, which would count as theirs
    os.chdir(sys.argv[2])
    given()
    pyplot.figure().savefig(os.devnull, format="png")  # the fonts are found, once for all
    _loss(), _outcomes()
    rounds, draw = int(sys.argv[3]), random.Random(19)
    result = {}
    for name, case in cases().items():
        lay(case)
        status, count, said = run(inject, case, 0, NOTHING)
        new = left()
        wrong = [] if status == 0 and set(case.targets) <= set(new) else [f"does not run: {status}, {said}"]
        ways = [(after, mode) for after in range(count) for mode in (FULL, KILL, TERM)]
        for after, mode in [] if wrong else draw.sample(ways, min(rounds, len(ways))):
            lay(case)
            status, _, said = run(inject, case, after, mode)
            what = f"{('', 'full', 'killed', 'ended')[mode]} at {after} of {count}"
            wrong += [f"{what}: {fault}" for fault in faults(case, new, mode, status, said)]
        result[name] = wrong
    print(json.dumps(result))


if __name__ == "__main__":
    main_of_the_test()
