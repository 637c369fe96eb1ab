"""Models for the run-time: the bundled ones, which are compiled in, and binary ones from files (``.lbm``)."""

from __future__ import annotations

import ctypes
import os
import unicodedata
from functools import cache
from typing import Any, Optional, Tuple, Union

from labial.aliases import LABEL_SETS
from labial.errors import LabialError, ModelError, StreamError
from labial.runtime import BUNDLED
from labial.runtime.library import (
    ERROR_NAME,
    ERROR_PHONEME,
    OK,
    About,
    address_of,
    checked,
    failure,
    library,
    memory,
    sentence,
)
from labial.runtime.numbers import whole

#: Sets of labels, labial_labels_t (labial/names.h).
LABELS = {"auto": sum(LABEL_SETS.values()), **LABEL_SETS}


class Model:
    """A model of speech or of laughter, constant: it may serve any number of streams and threads at once.

    ``Model("voice.lbm")`` reads one that ``labial export --blob`` wrote; ``labial.speech_en`` and
    ``labial.laughter_synthetic`` are the bundled ones. Raises ModelError, with the file's name, for a file that is
    damaged or no model, and OSError for one that cannot be read.

    Attributes:
        name: the bundled model's name, else the file's.
        fps: frames per second.
        phonemes: the label of each phoneme, in the order of their numbers; empty where a model has other phonemes than
            the bundled ones, which are then known by number alone.
        silence: the number of its silence.
        stride: frames that share a step of the search; all models of a stream have the same.
        address: where the tables lie.
    """

    name: str
    fps: int
    phonemes: Tuple[str, ...]
    silence: int
    stride: int
    address: int

    def __init__(self, path: Union[str, os.PathLike]) -> None:
        self.name = os.fspath(path) if isinstance(path, (str, os.PathLike)) else ""
        if not isinstance(self.name, str) or not self.name:
            raise TypeError(f"a model is named by a path, not by {type(path).__name__}")
        with open(self.name, "rb") as file:
            content = file.read()
        # The tables are used where they lie: both blocks belong to this object.
        self._content = memory(len(content))
        ctypes.memmove(self._content, content, len(content))
        self._blob = memory(library().labial_python_blob_size())
        result = library().labial_model_load(self._blob, self._content, len(content))
        if result != OK:
            raise ModelError(f"{self.name}: {sentence(result)}")
        self._describe(ctypes.addressof(self._blob))

    def _describe(self, address: int) -> None:
        about = About()
        checked(library().labial_python_model(address, ctypes.byref(about)), self.name)
        self.address, self.stride = address, about.stride
        self.fps, self._count, self.silence = about.fps, about.phonemes, about.silence
        self._names: Optional[int] = None
        self.phonemes = ()
        for name in BUNDLED:
            labels = _labels(name)
            if len(labels) == self._count:
                self._names, self.phonemes = address_of(f"{name}_names"), labels

    @property
    def is_laughter(self) -> bool:
        """Whether its phonemes are those of laughter, so that it can be asked for laughs."""
        return self.phonemes == _labels(BUNDLED[1])

    def find(self, label: str, labels: str = "auto") -> int:
        """The number of the phoneme that `label` means in the set `labels`: auto, arpabet, ipa or xsampa. Raises
        StreamError where it means none."""
        text = self._text(label)
        found = library().labial_find_in(self._names, _set(labels), text, len(text))
        if found < 0:
            raise failure(ERROR_NAME, f"{label!r} in {self.name}")
        return int(found)

    def nearest(self, label: str, labels: str = "auto") -> int:
        """The number of a phoneme for any label: the one that it means or looks most like, silence for noises."""
        text = self._text(label)
        return checked(library().labial_find_nearest(self._names, _set(labels), text, len(text), self.silence))

    def number(self, phoneme: Union[str, int], labels: str = "auto", nearest: bool = False) -> int:
        """The number of a phoneme that is given by its label or its number, which is checked. Punctuation that is no
        label, such as Piper's ``^``, is silence."""
        if isinstance(phoneme, str):
            if nearest:
                return self.nearest(phoneme, labels)
            try:
                return self.find(phoneme, labels)
            except StreamError:
                if phoneme and all(unicodedata.category(c)[0] in "PSZ" for c in phoneme):
                    return self.silence  # punctuation, as synthesisers have it among their phonemes
                raise
        found = whole(phoneme, "a phoneme that is no label")
        if not 0 <= found < self._count:
            raise failure(ERROR_PHONEME, f"{found} in {self.name}")
        return found

    def _text(self, label: Any) -> bytes:
        if not isinstance(label, str):
            raise TypeError(f"a label is a str, not {type(label).__name__}")
        if self._names is None:
            raise LabialError(f"{self.name} has {self._count} phonemes of its own, which are known by number alone")
        return label.encode("utf-8", "replace")

    def __repr__(self) -> str:
        return f"<labial.Model {self.name}: {self._count} phonemes, {self.fps} frames/s>"


@cache
def _labels(name: str) -> Tuple[str, ...]:
    """The labels of a bundled model's phonemes."""
    about = About()
    checked(library().labial_python_model(address_of(name), ctypes.byref(about)), name)
    names = address_of(f"{name}_names")
    return tuple(library().labial_python_label(names, number).decode("utf-8") for number in range(about.phonemes))


@cache
def bundled(name: str) -> Model:
    """One of `BUNDLED`, which is compiled in."""
    model = Model.__new__(Model)
    model.name = name
    model._describe(address_of(name))
    return model


def _set(labels: str) -> int:
    if not isinstance(labels, str) or labels not in LABELS:
        raise LabialError(f"{labels!r} is no set of labels, {', '.join(LABELS)}")
    return LABELS[labels]


