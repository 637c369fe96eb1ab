"""Phonemes by name: what labels of every phone set mean to the C library and to the exporter."""

from __future__ import annotations

import ctypes
import os
import random
import subprocess
from pathlib import Path

import pytest

from labial.labels import SAMPA, find, nearest, without_redundant
from labial.phonesets import LAUGHTER, PHONE_SETS, SPEECH, aliases_for

SOURCE = Path(os.environ.get("LABIAL_SOURCE", Path(__file__).resolve().parents[2]))
MODELS = {"speech_en": SPEECH, "laughter_synthetic": LAUGHTER}

#: Labels as front ends write them, and what they mean as ARPABET or IPA and as X-SAMPA; None where they are unknown.
LABELS = [
    ("AA1", "AA", "AA"), ("ax", "AH", "AH"), ("AH0_B", "AH", "AH"), ("SIL_S", "SIL", "SIL"), ("ˈaɪ", "AY", "AY"),
    ("t͡ʃ", "CH", "CH"), ("n̩", "N", "N"), ("tʰ", "T", "T"), ("ɔ̃", "AO", "AO"), ("ɚː", "ER", "ER"), ("ç", "HH", "HH"),
    ("ç", "HH", "HH"), ("əl", "L", "L"), ("oːɹ", "AO", "AO"), ("aɪɚ", "AY", "AY"),
    ("N", "N", "NG"), ("S", "S", "SH"), ("T", "T", "TH"), ("D", "D", "DH"), ("Z", "Z", "ZH"), ("V", "V", "AH"),
    ("'V", "V", "AH"), ("tS", "CH", "CH"), ("dZ", "JH", "JH"), ("@U", "OW", "OW"), ("r=", "ER", "ER"),
    ("l=", "L", "L"), ("{", "AE", "AE"), ("3:", "ER", "ER"), ("A:", "AA", "AA"), ("EI", "EY", "EY"), ("i:", "IY", "IY"),
    ("e~", "EH", "EH"), ("t_h", "T", "T"), ("y", "Y", "UW"), ("n;", "N", "N"), ("I2", "IH", "IH"), ("_:", "SIL", "SIL"),
    ("xyzzy", None, None), ("AH3", None, None), ("", None, None), ("<unk>", None, None), ("A1", None, None),
]  # fmt: skip

#: Labels that nobody knows, and what they are taken for.
UNKNOWN = [("<unk>", "SIL"), ("[noise]", "SIL"), ("{LG}", "SIL"), ("+FOO+", "SIL"), ("AXH", "AH"), ("ihr", "IH"),
           ("æ?!", "AE"), ("⟨ʃ⟩", "SH"), ("$$", "AH"), ("CHX", "CH"), ("", "AH")]  # fmt: skip


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    """lib/names.c with the names of the bundled models."""
    target = tmp_path_factory.mktemp("names") / "names.so"
    sources = [SOURCE / "lib/names.c", *(SOURCE / f"lib/models/{name}_names.c" for name in MODELS)]
    subprocess.run([os.environ.get("LABIAL_CC", "cc"), "-O1", "-shared", "-fPIC", f"-I{SOURCE}/include",
                    f"-I{SOURCE}/lib/models", *map(str, sources), "-o", str(target)], check=True)
    return ctypes.CDLL(str(target))


class Names:
    """The three look-ups of the C library in the names of one model."""

    def __init__(self, library: ctypes.CDLL, model: str) -> None:
        self.library, self.phonemes = library, MODELS[model].phonemes
        self.table = ctypes.byref(ctypes.c_byte.in_dll(library, f"{model}_names"))

    def __call__(self, function: str, label: str, *more: int) -> str | None:
        data = label.encode()
        number = getattr(self.library, function)(self.table, data, ctypes.c_size_t(len(data)), *more)
        return self.phonemes[number] if number >= 0 else None


def every_label() -> list[str]:
    """Every alias with and without marks, what the lists above have, and random strings of letters and marks."""
    labels = [label for label, *_ in (*LABELS, *UNKNOWN)]
    for phone_set in PHONE_SETS.values():
        labels += [*phone_set.phonemes, *phone_set.aliases]
    marks = ["ˈ{}", "ˌ{}ː", "'{}", "{}:", "{}0", "{}1", "{}2", "{}3", "{}_B", "{}_h", "{}=", "{}~", "{}ʰ", "{}̃", " {} ",
             r"{}\~^", r"{}\:f", r"\'1{}", "%{};"]  # fmt: skip
    labels += [mark.format(label) for label in list(labels) for mark in marks]
    rng = random.Random(1)
    pieces = [*"aAbBeEiIkKNsStT@{}<>[]+#_:;=~^'\",%\\|0123 ()vf.-", *"ɑəʃθŋːˑˈˌʰʷⁿçɜ˞", "̃", "̩", "͡", "̧", "̊"]
    labels += ["".join(rng.choices(pieces, k=rng.randint(1, 7))) for _ in range(20000)]
    return labels


@pytest.mark.parametrize("model", MODELS)
def test_library_and_exporter_agree_on_every_label(library: ctypes.CDLL, model: str) -> None:
    """Catches a mark that only one of the two drops, aliases of the bundled table that are not the phone set's, and a
    name that was left out of the table as redundant but is not."""
    names, phone_set = Names(library, model), MODELS[model]
    for label in every_label():
        if len(label.encode()) > 32:
            continue
        assert names("labial_find", label) == phone_set.resolve(label), label
        assert names("labial_find_sampa", label) == phone_set.resolve(label, sampa=True), label
        assert names("labial_find_nearest", label, 0) == phone_set.nearest(label), label


@pytest.mark.parametrize(("label", "plain", "sampa"), LABELS)
def test_labels_of_front_ends(label: str, plain: str | None, sampa: str | None) -> None:
    """Catches a label that lost its meaning, or X-SAMPA read where ARPABET was written and the other way round."""
    assert SPEECH.resolve(label) == plain
    assert SPEECH.resolve(label, sampa=True) == sampa


@pytest.mark.parametrize(("label", "phoneme"), UNKNOWN)
def test_unknown_labels_have_a_nearest_phoneme(label: str, phoneme: str) -> None:
    """Catches noise that moves the lips and a look-alike that was found by less than could be."""
    assert SPEECH.resolve(label) is None and SPEECH.nearest(label) == phoneme


def test_what_x_sampa_means_is_known() -> None:
    """Catches a letter of X-SAMPA whose meaning no phoneme has."""
    for letter, meaning in SAMPA.items():
        assert SPEECH.resolve(letter, sampa=True) == SPEECH.resolve(meaning) is not None


def test_a_model_learns_labels_from_its_phone_set() -> None:
    """Catches a model that only knows the labels of the day it was trained, and aliases of phonemes it has not."""
    aliases = aliases_for("speech", ("SIL", "AA", "sil"), {"A": "SIL"})
    assert aliases["A"] == "SIL" and aliases["ɑ"] == "AA" and "sil" not in aliases and "æ" not in aliases
    assert aliases_for("other", ("SIL",), {}) == {}


@pytest.mark.parametrize("phone_set", PHONE_SETS.values(), ids=PHONE_SETS)
def test_redundant_names_are_found_without_their_entry(phone_set) -> None:  # noqa: ANN001
    """Catches a name that is left out of the table and then means something else."""
    names = phone_set.names()
    fewer = without_redundant(names)
    for name in names:
        assert find(fewer, name) == names[name], name
        assert nearest(fewer, name + "§", "?") == nearest(names, name + "§", "?"), name
