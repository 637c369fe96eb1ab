"""Splits that an evaluation has finished, kept on the disk, so that one that was interrupted goes on where it was.

Each is a file of the folder ``.splits`` in the report's folder: the measures as JSON, and the motion that plots show as
arrays. A file is of use for the same corpus, options and versions alone; the folder goes when the report is written.
"""

from __future__ import annotations

import hashlib
import io
import json
import shutil
import warnings
import zipfile
from contextlib import suppress
from dataclasses import astuple, replace
from pathlib import Path
from typing import Dict, Optional, Sequence

import numpy as np

import labial
from labial.arrays import array, read_zip
from labial.errors import LabialError
from labial.evaluate.material import Utterance
from labial.evaluate.methods import select
from labial.evaluate.protocol import Example, Options, Outcome
from labial.evaluate.splits import Split
from labial.native import library_root
from labial.outputs import writing
from labial.train.workers import versions

#: Where they are in the report's folder.
FOLDER = ".splits"
#: Bytes that a file has at most.
_LARGEST = 500_000_000


class Kept:
    """The finished splits of one evaluation in `folder`, that of the report."""

    def __init__(self, folder: Path, corpus: Sequence[Utterance], options: Options) -> None:
        self._folder = folder / FOLDER
        self._corpus = corpus
        self._of = _fingerprint(corpus, options)

    def find(self, split: Split) -> Optional[Outcome]:
        """What is kept of a split, or None."""
        try:
            members = read_zip(self._path(split), None, _LARGEST)
            about = json.loads(members["outcome.json"])
            if about["of"] != self._of or about["split"] != json.loads(json.dumps(astuple(split))):
                return None
            outcome = Outcome(split, about["frames"], about["measures"], about["seconds"])
            if about["example"] is not None:
                shown, stretch = about["example"]["index"], about["example"]["stretch"]
                motion = {name: array(name, members[f"{number}.npy"])
                          for number, name in enumerate(about["example"]["motion"])}
                outcome = replace(outcome, example=Example(
                    about["example"]["kind"], shown, self._corpus[shown], stretch and tuple(stretch),
                    array("steps", members["steps.npy"]), motion))
        except (OSError, LabialError, ValueError, KeyError, TypeError, IndexError):  # none, or another version's
            return None
        return outcome

    def keep(self, outcome: Outcome) -> None:
        """Keeps a split; warns where that fails, since the evaluation can go on without."""
        example = outcome.example
        arrays: Dict[str, np.ndarray] = {}
        about: Dict[str, object] = {"of": self._of, "split": astuple(outcome.split), "frames": outcome.frames,
                 "measures": outcome.measures, "seconds": outcome.seconds, "example": None}
        if example is not None:
            about["example"] = {"kind": example.kind, "index": example.index, "stretch": example.stretch,
                                "motion": list(example.motion)}
            arrays = {"steps": example.steps, **{str(n): item for n, item in enumerate(example.motion.values())}}
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            with writing(self._path(outcome.split)) as file, zipfile.ZipFile(file, "w") as archive:
                archive.writestr("outcome.json", json.dumps(about))
                for name, values in arrays.items():
                    buffer = io.BytesIO()
                    np.lib.format.write_array(buffer, np.ascontiguousarray(values), allow_pickle=False)
                    archive.writestr(f"{name}.npy", buffer.getvalue())
        except (OSError, LabialError) as error:
            warnings.warn(f"split {outcome.split.number} is not kept for another start: {error}", stacklevel=1)

    def _path(self, split: Split) -> Path:
        return self._folder / f"{split.number}.zip"


def forget(folder: Path) -> None:
    """Forgets the splits of the report in `folder`."""
    shutil.rmtree(folder / FOLDER, ignore_errors=True)


def _fingerprint(corpus: Sequence[Utterance], options: Options) -> str:
    """What outcomes depend on, as a sum of its bytes; Labial's own code, too, so that somebody who works on it gets no
    report that mixes two states of it."""
    found = hashlib.sha256()
    sources = list(Path(labial.__file__).parent.rglob("*.py"))
    with suppress(LabialError):  # without the library the methods that run it say so themselves
        sources += library_root().glob("lib/*.[ch]")
    for path in sorted(sources):
        found.update(path.read_bytes())
    named = replace(options, methods=",".join(method.name for method in select(options.methods)))
    found.update(repr((named, sorted(versions().items()))).encode())
    for item in corpus:
        of = item.episode.source
        found.update(repr((item.episode.name, item.episode.segments, replace(of, left_out=frozenset()),
                           sorted(of.left_out))).encode())
        for values in (item.episode.times, item.episode.frames):
            found.update(np.ascontiguousarray(values).tobytes())
    return found.hexdigest()
