"""Phone sets: complete, consistent, and read by every alias that front ends use."""

from __future__ import annotations

import pytest

from labial.corpus.phonesets import (
    ARPABET,
    LAUGHTER,
    PHONE_SETS,
    SPEECH,
    VOWELS,
    candidates_for,
    normalise,
    substitute_for,
)


@pytest.mark.parametrize("phone_set", PHONE_SETS.values(), ids=PHONE_SETS)
def test_every_phoneme_has_a_class_and_every_alias_a_phoneme(phone_set):
    """Catches a phoneme that was left out of the class table, an unused class, or an alias that shadows a phoneme."""
    assert phone_set.phonemes[0] == phone_set.silence
    assert len(set(phone_set.phonemes)) == len(phone_set.phonemes)
    assert len(phone_set.viseme_class) == len(phone_set.boundary) == len(phone_set.phonemes)
    assert set(phone_set.viseme_class) == set(range(len(phone_set.classes)))
    assert set(phone_set.aliases) == {"arpabet", "ipa", "xsampa"}
    for aliases in phone_set.aliases.values():
        assert set(aliases.values()) <= set(phone_set.phonemes)
    assert not set(phone_set.aliases["arpabet"]) & set(phone_set.phonemes)
    if phone_set is SPEECH:  # what X-SAMPA means by them is another sound
        assert set(phone_set.aliases["xsampa"]) & set(phone_set.phonemes) == set("DFKMNPRSTVYZ")


def test_inventories_are_those_of_the_method():
    """Catches a lost phoneme, a changed order of the interface, or units that break at other places."""
    assert SPEECH.phonemes == ("SIL", *ARPABET) and len(ARPABET) == 39
    assert LAUGHTER.phonemes[:12] == tuple("silence ne click nasal plosive fricative ic e o grunt cackle a".split())
    graded = "fricative ic e o cackle a".split()
    assert LAUGHTER.phonemes[12:] == tuple(f"{label}_{grade}" for label in graded for grade in ("soft", "loud"))
    boundaries = {p for p, b in zip(SPEECH.phonemes, SPEECH.boundary) if b}
    assert boundaries == {*VOWELS.split(), "P", "B", "M"} and len(VOWELS.split()) == 15
    vowels = [p for p in LAUGHTER.phonemes if p.split("_")[0] in "a e o ic cackle".split()]
    assert [p for p, b in zip(LAUGHTER.phonemes, LAUGHTER.boundary) if b] == vowels and len(vowels) == 15


def test_grades_that_a_corpus_lacks_are_the_plain_phoneme():
    """Catches a model of labels without grades (AVLaughterCycle's) whose loud vowels look like anything else."""
    plain = LAUGHTER.phonemes[:12]
    for label in LAUGHTER.phonemes[12:]:
        assert substitute_for(label, plain) == label.split("_")[0]


def test_arpabet_in_either_case_with_or_without_stress():
    """Catches aliases that were generated for one case or one digit only."""
    for label in ARPABET:
        for spelling in (label, label.lower()):
            assert SPEECH.resolve(spelling) == label
            if label in VOWELS.split():
                assert [SPEECH.resolve(f"{spelling}{digit}") for digit in "012"] == [label] * 3


@pytest.mark.parametrize("label, phoneme", [
    ("pau", "SIL"), ("ax", "AH"), ("axr", "ER"), ("KD", "K"), ("TS", "S"), ("+BREATHING+", "SIL"), ("<sil>", "SIL"),
    ("++LAUGHTER++", "SIL"), ("</s>", "SIL"), ("_", "SIL"), ("_:", "SIL"), ("ˈaɪ", "AY"), ("t͡ʃ", "CH"), ("dʒ", "JH"),
    ("əʊ", "OW"), ("oʊ", "OW"), ("iː", "IY"), ("ɝ", "ER"), ("ɜː", "ER"), ("n̩", "N"), ("tʰ", "T"), ("ŋ", "NG"),
    ("@U", "OW"), ("tS", "CH"), ("i:", "IY"), ("'eI", "EY"), ("N", "N"), ("S", "S"), ("ç", "HH"),
    ("axr1", "ER"), ("spn", "SIL"),
])  # fmt: skip
def test_labels_of_front_ends(label, phoneme):
    """Catches a front end's label that means nothing, or X-SAMPA read where ARPABET was written."""
    assert SPEECH.resolve(label) == phoneme


@pytest.mark.parametrize("label, phoneme", [
    ("hum", "nasal"), ("groan", "grunt"), ("vocal_fry", "grunt"), ("snore", "ne"), ("ne?", "ne"), ("ni", "ne"),
    (r"\ic\O^", "cackle"), (r"\ic", "ic"), (r"\ic\:f", "ic"), (r"\sw\~^", "e"), (r"\h^", "fricative"), ("ə", "e"),
    ("ɪ̊", "cackle"), ("h", "fricative"), ("k", "plosive"), ("ɑ", "a"),
])  # fmt: skip
def test_symbols_of_laughter(label, phoneme):
    """Catches the cackle's voiceless mark being stripped like other marks, or a diacritic that is not."""
    assert LAUGHTER.resolve(label) == phoneme


def test_unknown_labels_are_none_and_marks_alone_survive():
    """Catches a normalisation that turns nonsense or a lone mark into some phoneme."""
    for label in ("XX", "", "AH3", "Aa", "ː", "speech"):
        assert SPEECH.resolve(label) is None
    assert normalise("ː") == "ː" and normalise("I2") == "I2" and normalise("_:") == "_"


@pytest.mark.parametrize("phone_set", PHONE_SETS.values(), ids=PHONE_SETS)
def test_any_missing_phoneme_finds_a_substitute(phone_set):
    """Catches a phoneme for which a small corpus would have nothing."""
    for label in phone_set.phonemes:
        assert set(candidates_for(label)) == set(phone_set.phonemes)
        for only in phone_set.phonemes:
            assert substitute_for(label, {only}) == only
    with pytest.raises(ValueError):
        substitute_for(phone_set.phonemes[1], set())


def test_declared_substitutes_come_first():
    """Catches an order by alphabet instead of by looks, and a consonant in a vowel's place."""
    grid = set(SPEECH.phonemes) - {"ER", "OY", "SH", "ZH", "NG", "UH"}
    found = {label: substitute_for(label, grid) for label in ("ER", "OY", "SH", "ZH", "NG", "UH")}
    assert found == {"ER": "AH", "OY": "AO", "SH": "CH", "ZH": "JH", "NG": "K", "UH": "UW"}
    assert substitute_for("P", {"B", "SIL"}) == "B" and substitute_for("AA", {"AA", "AO"}) == "AA"


def test_names_are_made_once() -> None:
    """A corpus asks for them with each of its labels."""
    assert SPEECH.names() is SPEECH.names() and SPEECH.names("ipa") is not SPEECH.names()
