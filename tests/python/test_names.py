"""Phonemes by name: phone sets, and what labels of each mean to the C library and to the exporter."""

from __future__ import annotations

import ctypes
import os
import random
import subprocess

import pytest

from labial.corpus.labels import entries, find
from labial.corpus.phonesets import (
    ARPABET,
    AUTO,
    LABEL_SETS,
    LAUGHTER,
    PHONE_SETS,
    SPEECH,
    VOWELS,
    aliases_for,
    candidates_for,
    substitute_for,
)
from packages import SOURCE

MODELS = {"speech_en": SPEECH, "laughter_synthetic": LAUGHTER}

#: labial_labels_t of include/labial/names.h.
SETS = {"arpabet": 0x20, "ipa": 0x40, "xsampa": 0x80, AUTO: 0xE0}

#: Labels as front ends write them, and what they mean in any set, in ARPABET, the IPA and X-SAMPA; - where unknown.
LABELS = """
AA1 AA AA AA AA | ax AH AH - - | AH0_B AH AH AH AH | SIL_S SIL SIL SIL SIL | hh HH HH - - | em M M - - | ey EY EY EH -
ˈaɪ AY - AY - | t͡ʃ CH - CH - | n̩ N N N N | tʰ T T T T | ɔ̃ AO - AO - | ɚː ER - ER - | ç HH - HH - | ç HH - HH -
əl L - L - | oːɹ AO - AO - | aɪɚ AY - AY - | əʊ OW - OW - | aʊ AW - AW - | ʔe EH - EH EH | ʈʂʰ CH - CH - | s. SH S SH S
y Y Y UW UW | yː UW Y UW UW | ˈyː Y Y UW UW | Y Y Y Y UH | ʏ UH - UH - | ø UW - UW - | øː UW - UW - | œ OW - OW -
th TH TH T - | ph P - P - | ch CH CH - - | sh SH SH - - | au AW - AW AW | ua AA - AA AA | ɔɪ OY - OY - | oɪ OY - OY -
ɔʏ OY - OY - | aw AW AW AW AW | ow OW OW OW - | ej EY - EY EY | ae AE AE AY AY | aa AA AA - - | er ER ER - -
r R R L R | ɹ R - R - | ʁ G - G - | β B - B - | ɸ P - P - | ʋ V - V - | ɱ V - V - | ɯ IH - IH - | ɯᵝ UH - UH -
N N N N NG | S S S S SH | T T T T TH | D D D D DH | Z Z Z Z ZH | V V V V AH | 'V V V V AH | P P P P V | M M M M IH
tS CH - - CH | dZ JH - - JH | @U OW - - OW | r= ER R L ER | l= L L L L | { AE - - AE | 3: - - - ER | A: AA - - AA
EI EY - - EY | OI OY - - OY | i: IY - IY IY | e~ EH - EH EH | t_h T T T T | n; N N N N | I2 IH - - IH | 2: - - - UW
9 - - - OW | 6 - - - AH | 1 - - - IH | 0 - - - AO | 4 - - - D | 12 - - - - | _: SIL SIL SIL SIL | _ SIL SIL SIL SIL
xyzzy - - - - | AH3 - - - - | <unk> - - - - | A1 - - - - | ʲ - - - - | ː - - - - | : - - - - | ˈ - - - - | ʰ - - - -
"""
#: More labels, and what they mean in any set.
ANY_SET = """
pau SIL | axr ER | KD K | TS S | +BREATHING+ SIL | <sil> SIL | ++LAUGHTER++ SIL | </s> SIL | dʒ JH | oʊ OW | iː IY
ɝ ER | ɜː ER | ŋ NG | 'eI EY | axr1 ER | spn SIL
"""
#: Labels that nobody knows, in a set of labels, and what they are taken for.
UNKNOWN = [("<unk>", AUTO, "SIL"), ("[noise]", AUTO, "SIL"), ("{LG}", AUTO, "SIL"), ("+FOO+", AUTO, "SIL"),
           ("AXH", AUTO, "AH"), ("ihr", AUTO, "IH"), ("ihr", "ipa", "IY"), ("æ?!", AUTO, "AE"), ("⟨ʃ⟩", AUTO, "SH"),
           ("CHX", AUTO, "CH"), ("Ж", AUTO, "AH"), ("Ж", "arpabet", "AH"), ("$$", AUTO, "SIL"), ("", AUTO, "SIL"),
           ("ː", "ipa", "SIL"), ("ʲ", "ipa", "SIL"), ("1", "ipa", "SIL"), ("7", AUTO, "SIL"), ("??", "ipa", "SIL"),
           ("zɔ̃b", "ipa", "Z")]  # fmt: skip


def front_end_labels() -> list[tuple[str, str, str | None]]:
    """`LABELS` as (label, set of labels, phoneme or None); marks alone and nothing mean nothing."""
    rows = [item.split() for line in LABELS.strip().splitlines() for item in line.split(" | ")]
    known = [(label, labels, None if phoneme == "-" else phoneme)
             for label, *phonemes in rows for labels, phoneme in zip((AUTO, *LABEL_SETS), phonemes)]
    assert len(known) == 4 * len(rows)
    any_set = [(*item.split(), AUTO) for line in ANY_SET.strip().splitlines() for item in line.split(" | ")]
    return [*known, *((label, labels, phoneme) for label, phoneme, labels in any_set),
            *(("", labels, None) for labels in SETS)]


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

    def __call__(self, function: str, label: str, *before: int, after: tuple[int, ...] = ()) -> str | None:
        data = label.encode()
        number = getattr(self.library, function)(self.table, *before, data, ctypes.c_size_t(len(data)), *after)
        return self.phonemes[number] if number >= 0 else None


def every_label() -> list[str]:
    """Every alias with and without marks, what the lists above have, and random strings of letters and marks."""
    labels = [label for label, *_ in (*front_end_labels(), *UNKNOWN)]
    for phone_set in PHONE_SETS.values():
        labels += [*phone_set.phonemes, *(alias for aliases in phone_set.aliases.values() for alias in aliases)]
    marks = ["ˈ{}", "ˌ{}ː", "'{}", "{}:", "{}0", "{}1", "{}2", "{}3", "{}_B", "{}_h", "{}=", "{}~", "{}ʰ", "{}̃", " {} ",
             r"{}\~^", r"{}\:f", r"\'1{}", "%{};", "ʔ{}", "?{}", "{}-", "{}.", "{}^", '{}"']  # fmt: skip
    labels += [mark.format(label) for label in list(labels) for mark in marks]
    rng = random.Random(1)
    pieces = [*"aAbBeEiIkKNsStT@{}<>[]+#_:;=~^'\",%\\|0123 ()vf.-", *"ɑəʃθŋːˑˈˌʰʷⁿçɜ˞ʔy", "̃", "̩", "͡", "̧", "̊"]
    labels += ["".join(rng.choices(pieces, k=rng.randint(1, 7))) for _ in range(5000)]
    return labels


@pytest.mark.parametrize("model", ["speech_en", pytest.param("laughter_synthetic", marks=pytest.mark.slow)])
def test_library_and_exporter_agree_on_every_label(library: ctypes.CDLL, model: str) -> None:
    """Catches a mark that only one of the two drops, aliases of the bundled table that are not the phone set's, and a
    name that was left out of the table as redundant but is not."""
    names, phone_set = Names(library, model), MODELS[model]
    known = {labels: phone_set.names(labels) for labels in SETS}
    for label in dict.fromkeys(every_label()):
        if len(label.encode()) > 32:
            continue
        assert names("labial_find", label) == find(known[AUTO], label), label
        for labels, bits in SETS.items():
            assert names("labial_find_in", label, bits) == find(known[labels], label), (label, labels)
    for label in random.Random(2).sample(every_label(), 3000):
        if len(label.encode()) > 32:
            continue
        for labels, bits in SETS.items():
            assert names("labial_find_nearest", label, bits, after=(0,)) == phone_set.nearest(label, labels), label


@pytest.mark.parametrize(("label", "labels", "phoneme"), front_end_labels())
def test_labels_of_front_ends(label: str, labels: str, phoneme: str | None) -> None:
    """Catches a label that lost its meaning, and one set's label read as another's."""
    assert SPEECH.resolve(label, labels) == phoneme


@pytest.mark.parametrize(("label", "labels", "phoneme"), UNKNOWN)
def test_unknown_labels_have_a_nearest_phoneme(label: str, labels: str, phoneme: str) -> None:
    """Catches noise or a mark that moves the lips and a look-alike that was found by less than could be."""
    assert SPEECH.resolve(label, labels) is None and SPEECH.nearest(label, labels) == phoneme


def test_a_model_learns_labels_from_its_phone_set() -> None:
    """Catches a model that only knows the labels of the day it was trained, and aliases of phonemes it has not."""
    aliases = aliases_for("speech", ("SIL", "AA", "sil"), {"A": "SIL", "ɑ": "SIL", "my:": "SIL", "aa": "SIL"})
    for labels in LABEL_SETS:
        assert aliases[labels]["my:"] == "SIL" and "æ" not in aliases[labels]
    assert aliases["ipa"]["ɑ"] == "AA" == aliases["xsampa"]["A"] and "A" not in aliases["ipa"]
    assert aliases_for("other", ("SIL",), {}) == dict.fromkeys(LABEL_SETS, {})
    known = {labels: set(SPEECH.names(labels)) for labels in LABEL_SETS}  # no set knows what is another's alone
    for labels in LABEL_SETS:
        assert len(known[labels] - set().union(*(known[other] for other in LABEL_SETS if other != labels))) > 70
    assert SPEECH.names() is SPEECH.names(), "made once: a corpus asks for them with each of its labels"


@pytest.mark.parametrize("phone_set", PHONE_SETS.values(), ids=PHONE_SETS)
def test_redundant_names_are_found_without_their_entry(phone_set) -> None:  # noqa: ANN001
    """Catches a name that is left out of the table and then means something else, in a set or where none is named."""
    names = {labels: phone_set.names(labels) for labels in LABEL_SETS}
    table = entries(names)
    for labels in LABEL_SETS:
        fewer = {name: phoneme for name, phoneme, sets in table if labels in sets}
        assert all(find(fewer, name) == names[labels][name] for name in names[labels])
    first: dict[str, str] = {}
    for name, phoneme, _ in table:
        first.setdefault(name, phoneme)
    known = phone_set.names()
    assert all(find(first, name) == known[name] for name in known)
    assert len(table) < sum(map(len, names.values())) / 1.4


def espeak_labels() -> dict[str, str]:
    """Every label that espeak-ng emits, and its phoneme or - (tests/labels/espeak_labels.py)."""
    lines = (SOURCE / "tests/labels/espeak.tsv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == "label\tphoneme\tlanguages"
    rows = [line.split("\t") for line in lines[1:]]
    assert len({label for label, *_ in rows}) == len(rows) > 300 and all(len(row) == 3 for row in rows)
    return {label: phoneme for label, phoneme, _ in rows}


def test_every_label_of_espeak_is_known(library: ctypes.CDLL) -> None:
    """Catches a sound of any language that another one's lips are given, in the library or the exporter, and one that
    nobody knows."""
    names = Names(library, "speech_en")
    for label, phoneme in espeak_labels().items():
        expected = None if phoneme == "-" else phoneme
        assert SPEECH.resolve(label, "ipa") == expected, label
        assert names("labial_find_in", label, SETS["ipa"]) == expected, label


#: What the first symbol of a label asks of the lips, as the chart of the International Phonetic Association has it,
#: and the viseme classes that do.
CHART = {
    "pbmɸβɓʙ": {"bilabial"}, "fvʋɱⱱ": {"labiodental"}, "yʏøœuʊʉɵoɔɞ": {"close_rounded", "mid_rounded"},
    "θð": {"dental"}, "iɪeɛæaɑəɐʌɜɨɯɤ": {"spread", "mid", "open", "rhotic"},
    "tdnlrɾɽɖʈɳɭɫɬ": {"alveolar", "sibilant", "postalveolar"},
    "sz": {"sibilant", "postalveolar"}, "ʃʒɕʑʂʐ": {"postalveolar"}, "kgɡqxɣŋhħχʁʀɢ": {"velar"}, "w": {"close_rounded"},
}  # fmt: skip
#: Labels whose lips are not those of their first symbol: a rising diphthong, a rounded end, a syllabic l, Swedish sj.
OTHERWISE = set("əl oæ ua uai uei uɑ ɔa iou io eo yæ ɯᵝ əʊ əːʊ ɐ̃ʊ̃ au aʊ aʊə aːʊ ɑu ʌʊ iɑu sx".split())


def test_labels_of_espeak_look_as_the_chart_says() -> None:
    """Catches a slip in the table itself: lips that part in a p, spread in a y, or round in an i."""
    checked = 0
    for label, phoneme in espeak_labels().items():
        symbol = label.lstrip("ʔ?ʰ")[:1] or label[:1]
        for symbols, classes in CHART.items():
            if symbol in symbols and phoneme != "-" and label not in OTHERWISE:
                name = SPEECH.classes[SPEECH.viseme_class[SPEECH.phonemes.index(phoneme)]]
                assert name in classes, (label, phoneme)
                checked += 1
    assert checked > 230


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


def test_arpabet_in_either_case_with_or_without_stress():
    """Catches aliases that were generated for one case or one digit only."""
    for label in ARPABET:
        for spelling in (label, label.lower()):
            assert SPEECH.resolve(spelling) == label
            if label in VOWELS.split():
                assert [SPEECH.resolve(f"{spelling}{digit}") for digit in "012"] == [label] * 3


@pytest.mark.parametrize("label, phoneme", [
    ("hum", "nasal"), ("groan", "grunt"), ("vocal_fry", "grunt"), ("snore", "ne"), ("ne?", "ne"), ("ni", "ne"),
    (r"\ic\O^", "cackle"), (r"\ic", "ic"), (r"\ic\:f", "ic"), (r"\sw\~^", "e"), (r"\h^", "fricative"), ("ə", "e"),
    ("ɪ̊", "cackle"), ("h", "fricative"), ("k", "plosive"), ("ɑ", "a"),
])  # fmt: skip
def test_symbols_of_laughter(label, phoneme):
    """Catches the cackle's voiceless mark being stripped like other marks, or a diacritic that is not."""
    assert LAUGHTER.resolve(label) == phoneme


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
    assert substitute_for("HH", {"F", "V", "N", "IY"}) == "N" and substitute_for("AA", {"B", "F", "IY", "T"}) == "IY"
    assert substitute_for("AA", {"B", "F", "T"}) == substitute_for("K", {"B", "F", "T", "IY"}) == "T"
    plain = LAUGHTER.phonemes[:12]  # as AVLaughterCycle's labels are, without grades
    assert all(substitute_for(label, plain) == label.split("_")[0] for label in LAUGHTER.phonemes[12:])
