"""Finished splits of an evaluation, stored on the disk, so that an interrupted evaluation can continue.

Each is a file of the folder ``.splits`` in the report's folder: the measures as JSON, and the motion for plots as
arrays. A file is valid only for the same corpus, options and versions; the folder is removed when the report is
written.
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
from labial.core.library import library_path
from labial.errors import LabialError
from labial.evaluate.material import Example, Options, Outcome, Split, Utterance
from labial.evaluate.methods import select
from labial.files.arrays import array, read_zip
from labial.files.outputs import writing
from labial.train.workers import versions

#: Their folder in the report's folder.
FOLDER = ".splits"
#: Most bytes of a file.
_LARGEST = 500_000_000


class Kept:
    """The finished splits of one evaluation in `folder`, that of the report."""

    def __init__(self, folder: Path, corpus: Sequence[Utterance], options: Options) -> None:
        self._folder = folder / FOLDER
        self._corpus = corpus
        self._of = _fingerprint(corpus, options)

    def find(self, split: Split) -> Optional[Outcome]:
        """The stored split, or None."""
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
        """Stores a split; warns if that fails, since the evaluation can continue without."""
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


def remove_kept(folder: Path) -> None:
    """Removes the stored splits of the report in `folder`."""
    shutil.rmtree(folder / FOLDER, ignore_errors=True)


def _fingerprint(corpus: Sequence[Utterance], options: Options) -> str:
    """A checksum of everything that outcomes depend on, including Labial's code, so that no report mixes two versions
    of it."""
    found = hashlib.sha256()
    sources = list(Path(labial.__file__).parent.rglob("*.py"))
    with suppress(LabialError):  # without the library the methods that need it report an error
        sources.append(library_path())
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
