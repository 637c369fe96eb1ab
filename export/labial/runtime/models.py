"""Models for the run-time: the bundled ones, which are compiled in, and binary ones from files (``.lbm``)."""

from __future__ import annotations

import ctypes
import os
import unicodedata
from functools import cache
from typing import Any, Optional, Tuple, Union

from labial.core.guard import whole
from labial.core.library import BLOB_MAGIC, ERROR_PHONEME, OK, checked, failure, library, memory, sentence, texts
from labial.corpus.labels import LABEL_SETS
from labial.errors import LabialError, ModelError, PathLike, StreamError
from labial.files import limits

#: Sets of labels, labial_labels_t (labial/names.h).
LABELS = {"auto": sum(LABEL_SETS.values()), **LABEL_SETS}
#: How a ``.npz`` begins.
_NPZ = b"PK\x03\x04"


class Model:
    """A model of speech or of laughter, constant: it may serve any number of streams and threads at once.

    ``Model("voice.lbm")`` reads one that ``labial export --blob`` wrote; ``labial.speech_en`` and
    ``labial.laughter_synthetic`` are the bundled ones. Raises ModelError, with the file's name, for a damaged file or
    one that is not a model, and OSError for one that cannot be read.

    Attributes:
        name: the bundled model's name, else the file's.
        fps: frames per second.
        phonemes: the label of each phoneme, in the order of their numbers; empty for a model with other phonemes than
        the bundled ones, which have numbers alone. silence: the number of its silence. stride: frames that share
        a step of the search; all models of a stream have the same. address: the address of its tables.
    """

    name: str
    fps: int
    phonemes: Tuple[str, ...]
    silence: int
    stride: int
    address: int

    def __init__(self, path: PathLike) -> None:
        name = os.fspath(path) if isinstance(path, (str, os.PathLike)) else None
        if not isinstance(name, str):
            raise TypeError(f"a model is named by a path, not by {type(path).__name__}")
        self.name = name
        with open(self.name, "rb") as file:
            content = file.read(limits.BLOB + 1)
        if len(content) > limits.BLOB:
            raise ModelError(f"{self.name}: it has more than the {limits.BLOB:,} bytes that are read")
        if content.startswith(_NPZ):
            raise ModelError(f"{self.name}: a model that training wrote; labial export {self.name} --name NAME --blob "
                             "-o DIR makes the NAME.lbm of it that this call reads")
        if not content.startswith(BLOB_MAGIC):
            raise ModelError(f"{self.name}: not a model that labial export --blob wrote (.lbm)")
        # The library uses the tables in place: this object keeps both blocks alive.
        self._content = memory(len(content))
        ctypes.memmove(self._content, content, len(content))
        self._blob = memory(library().blob_size())
        result = library().model_load(self._blob, self._content, len(content))
        if result != OK:
            raise ModelError(f"{self.name}: {sentence(result)}")
        self._describe(ctypes.addressof(self._blob))

    def _describe(self, address: int) -> None:
        core = library()
        self.address, self.stride, self.fps = address, core.model_stride(address), core.model_fps(address)
        self._count, self.silence = core.model_phonemes(address), core.model_silence(address)
        self._names: Optional[int] = None
        self.phonemes = ()
        for number in range(len(_names())):
            labels = _labels(number)
            if len(labels) == self._count:
                self._names, self.phonemes = core.bundled_names(number), labels

    @property
    def is_laughter(self) -> bool:
        """Whether its phonemes are those of laughter."""
        return self.phonemes == _labels(_names().index("laughter_synthetic"))

    def find(self, label: str, labels: str = "auto") -> int:
        """The number of the phoneme that `label` means in the set `labels`: auto, arpabet, ipa or xsampa. Raises
        StreamError if it means none."""
        text = self._text(label)
        return checked(library().find(self._names, set_of(labels), text, len(text)), f"{label!r} in {self.name}")

    def nearest(self, label: str, labels: str = "auto") -> int:
        """The number of a phoneme for any label: its meaning or the most similar phoneme; silence for noises."""
        text = self._text(label)
        return checked(library().find_nearest(self._names, set_of(labels), text, len(text), self.silence))

    def number(self, phoneme: Union[str, int], labels: str = "auto", nearest: bool = False) -> int:
        """The number of a phoneme that is given by its label or its number, which is checked. Punctuation that is not a
        label, such as Piper's ``^``, is silence."""
        if isinstance(phoneme, str):
            if nearest:
                return self.nearest(phoneme, labels)
            try:
                return self.find(phoneme, labels)
            except StreamError:
                if phoneme and all(unicodedata.category(c)[0] in "PSZ" for c in phoneme):
                    return self.silence  # punctuation, which synthesisers report among their phonemes
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
def _names() -> Tuple[str, ...]:
    """The models that the library comes with."""
    return texts(library().bundled_name)


@cache
def _labels(number: int) -> Tuple[str, ...]:
    """The labels of a bundled model's phonemes."""
    core = library()
    names, count = core.bundled_names(number), core.model_phonemes(core.bundled_model(number))
    return tuple(core.label_at(names, phoneme).decode("utf-8") for phoneme in range(count))


@cache
def bundled(name: str) -> Model:
    """One of ``labial.BUNDLED``, which is compiled in."""
    model = Model.__new__(Model)
    model.name = name
    model._describe(library().bundled_model(_names().index(name)))
    return model


def expected(model: Any) -> Model:
    """`model`. Raises TypeError for what is none."""
    if not isinstance(model, Model):
        raise TypeError(f"a model is a labial.Model, not {type(model).__name__}")
    return model


def set_of(labels: str) -> int:
    """The library's number of a set of labels. Raises LabialError for another name."""
    if not isinstance(labels, str) or labels not in LABELS:
        raise LabialError(f"{labels!r} is no set of labels, {', '.join(LABELS)}")
    return LABELS[labels]
