r"""Phone sets: a model's phonemes, their viseme classes, the boundaries of units, and the aliases.

A *phoneme* is a label of a model's inventory, an *alias* a label of some front end or corpus that means one. The
meaning of an alias depends on the set of labels that it belongs to (:mod:`labial.corpus.labels`); if none is named,
ARPABET comes before the IPA, and the IPA before X-SAMPA.

Viseme classes of speech group what lips and jaw do, not what the tongue does: so /k g ng/ go with /hh/, which leave the
lips to their neighbours, /w/ with the close rounded vowels, and /r/ with /er/. Diphthongs go with the part that
opens or rounds most.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Collection, Dict, List, Optional, Sequence, Tuple

from labial.corpus.labels import (
    AUTO,
    LABEL_SETS,
    LAUGHTER_LABELS,
    SPEECH_LABELS,
    find,
    find_first,
    longest_of,
    nearest,
    normalise,
)

__all__ = ["ARPABET", "AUTO", "LABEL_SETS", "LAUGHTER", "LAUGHTER_GRADES", "PHONE_SETS", "SPEECH", "VOWELS", "PhoneSet",
           "aliases_for", "candidates_for", "normalise", "substitute_for"]


@dataclass(frozen=True)
class PhoneSet:
    """The phonemes of one kind of model ("speech" or "laughter") and their properties."""

    kind: str
    phonemes: Tuple[str, ...]  #: P labels, silence first; the order is part of the model's interface
    classes: Tuple[str, ...]  #: names of the viseme classes
    viseme_class: Tuple[int, ...]  #: (P,) index into `classes`
    boundary: Tuple[bool, ...]  #: (P,) units begin and end here
    silence: str
    aliases: Dict[str, Dict[str, str]]  #: set of labels -> other label -> phoneme

    def names(self, labels: str = AUTO) -> Dict[str, str]:
        """Every label that has a meaning, and that meaning, in one of `LABEL_SETS` or in any of them. The phonemes' own
        labels stand in every set, unless the IPA or X-SAMPA means other sounds by them. A lone digit is a phoneme
        only in X-SAMPA; if no set is named, it is more likely an error. The result must not be changed."""
        return self._names[labels]

    @cached_property
    def _names(self) -> Dict[str, Dict[str, str]]:
        own = {label: label for label in self.phonemes}
        known: Dict[str, str] = {}
        for item in reversed(LABEL_SETS):
            known.update(self.aliases[item])
        known = {label: phoneme for label, phoneme in known.items() if label not in tuple("0123456789")}
        return {**{labels: {**own, **table} for labels, table in self.aliases.items()},
                "arpabet": {**self.aliases["arpabet"], **own}, AUTO: {**known, **own}}

    @cached_property
    def _longest(self) -> Dict[str, Dict[str, int]]:
        return {labels: longest_of(names) for labels, names in self._names.items()}

    def resolve(self, label: str, labels: str = AUTO) -> Optional[str]:
        """The phoneme that `label` means in the set `labels`, or None: as it stands, else without marks."""
        return find(self.names(labels), label)

    def nearest(self, label: str, labels: str = AUTO, first: str = "") -> str:
        """A phoneme for any label: its meaning, in the set `first` before `labels`, the most similar one, or schwa."""
        names = self.names(labels)
        known = find_first((self.names(first), names) if first else (names,), label)
        if known is not None:
            return known
        return nearest(names, self._longest[labels], label, self.silence, self.names().get("ə", self.silence))


def aliases_for(kind: str, phonemes: Sequence[str], own: Dict[str, str]) -> Dict[str, Dict[str, str]]:
    """The aliases of a model's phonemes: those of its kind's phone set, and `own` where that does not know the label,
    in every set of labels. So a model knows the current labels, not those of the time of its training."""
    built_in = PHONE_SETS[kind].aliases if kind in PHONE_SETS else {}
    known = {labels: {alias: label for alias, label in built_in.get(labels, {}).items() if label in phonemes}
             for labels in LABEL_SETS}
    further = {alias: label for alias, label in own.items() if not any(find(item, alias) for item in known.values())}
    return {labels: {**further, **item} for labels, item in known.items()}


def substitute_for(label: str, available: Collection[str]) -> str:
    """The phoneme of `available` that looks most like `label` (of either kind): `label` itself if it is there.
    Candidates in order: those declared for the phoneme, its viseme class, the other vowels if it is one, else the other
    consonants, all others but silence, silence; P, B, M, F and V, which close the lips, stand in for the rest last.
    Raises ValueError when no phoneme of the kind is available or `label` is none."""
    for candidate in candidates_for(label):
        if candidate in available:
            return candidate
    raise ValueError(f"no phoneme of {label!r}'s phone set is available")


def candidates_for(label: str) -> List[str]:
    """All phonemes of `label`'s set, from `label` itself to the least alike. Raises ValueError for an unknown label."""
    phone_set = next((item for item in PHONE_SETS.values() if label in item.phonemes), None)
    if phone_set is None:
        raise ValueError(f"{label!r} is not a phoneme")
    class_of = dict(zip(phone_set.phonemes, phone_set.viseme_class))
    boundary = dict(zip(phone_set.phonemes, phone_set.boundary))
    sounding = [item for item in phone_set.phonemes if item != phone_set.silence]
    order = [label, *_ALIKE.get(label, "").split()]
    order += [item for item in sounding if class_of[item] == class_of[label]]
    closed = "P B M F V".split()
    vowel = {item: boundary[item] and item not in closed for item in boundary}
    order += sorted(sounding, key=lambda item: (item in closed, vowel[item] != vowel[label]))
    return list(dict.fromkeys([*order, phone_set.silence]))


def _phone_set(kind: str, groups: Dict[str, str], boundary: str, order: str,
               aliases: Dict[str, Dict[str, str]]) -> PhoneSet:
    phonemes = tuple(order.split())
    index = {label: number for number, labels in enumerate(groups.values()) for label in labels.split()}
    ends = boundary.split()
    return PhoneSet(kind, phonemes, tuple(groups), tuple(index[label] for label in phonemes),
                    tuple(label in ends for label in phonemes), phonemes[0],
                    {labels: _spread(labels, table) for labels, table in aliases.items()})


def _spread(labels: str, table: Dict[str, str]) -> Dict[str, str]:
    """Phoneme -> labels, as label -> phoneme."""
    known: Dict[str, str] = {}
    for phoneme, text in table.items():
        for alias in text.split():
            if alias != phoneme and known.setdefault(alias, phoneme) != phoneme:
                raise AssertionError(f"{labels} {alias!r} has two meanings")
    return known


VOWELS = "AA AE AH AO AW AY EH ER EY IH IY OW OY UH UW"
_CONSONANTS = "B CH D DH F G HH JH K L M N NG P R S SH T TH V W Y Z ZH"
#: The 39 labels of the CMU dictionary, without stress.
ARPABET = tuple(sorted((VOWELS + " " + _CONSONANTS).split()))

_SPEECH_CLASSES = {
    "silence": "SIL",
    "bilabial": "P B M",  # lips closed
    "labiodental": "F V",  # lower lip under the upper teeth
    "dental": "TH DH",
    "alveolar": "T D N L",
    "sibilant": "S Z",  # teeth nearly shut
    "postalveolar": "SH CH JH ZH",  # teeth nearly shut, lips pushed forward
    "velar": "K G NG HH",  # lips free
    "rhotic": "R ER",
    "close_rounded": "W UW UH",
    "mid_rounded": "OW AO OY",
    "open": "AA AE AY AW",
    "mid": "AH EH",
    "spread": "IY IH EY Y",
}
#: What is laughed softly, lips nearly closed, and loudly, mouth wide open, has phonemes of its own: by the phoneme of
#: middle loudness, which is what every label without a grade means.
LAUGHTER_GRADES = {label: (f"{label}_soft", f"{label}_loud") for label in "fricative ic e o cackle a".split()}
#: Declared substitutes, closest first. Vowels look for vowels and /p b m/ for each other, so that units stay units.
_ALIKE = {
    "AA": "AO AY AE AH AW", "AE": "EH AA AY AH", "AH": "EH AA UH ER AE IH", "AO": "OW AA OY UH", "AW": "AA OW AE AO",
    "AY": "AA AE EY AH", "EH": "AE EY AH IH", "ER": "AH UH EH R", "EY": "EH IH IY AE", "IH": "IY EY EH AH",
    "IY": "IH EY Y EH", "OW": "AO UH UW OY AA", "OY": "AO OW AY UW", "UH": "UW OW AO AH", "UW": "UH OW W AO",
    "P": "B M", "B": "P M", "M": "B P", "F": "V TH", "V": "F DH", "TH": "DH T S", "DH": "TH D L", "T": "D N S L",
    "D": "T N L", "N": "D T L", "L": "N D T", "S": "Z T", "Z": "S D", "SH": "CH JH ZH S R", "ZH": "JH SH CH Z R",
    "CH": "SH JH ZH T", "JH": "CH ZH SH D", "K": "G NG HH T D N", "G": "K NG HH D T N", "NG": "K G N HH",
    "HH": "K G AH", "R": "ER W L", "W": "UW UH R OW", "Y": "IY IH EY",
    "ne": "nasal", "nasal": "ne silence", "click": "plosive", "plosive": "click fricative", "fricative": "e plosive",
    "ic": "e a", "e": "a ic", "a": "e cackle ic", "o": "e a", "cackle": "a e ic", "grunt": "nasal e",
    **{graded: f"{label} e" for label, grades in LAUGHTER_GRADES.items() for graded in grades},
}


_LAUGHTER_CLASSES = {
    "silence": "silence", "nose": "ne nasal",  # air goes through the nose, lips rest on each other
    "stop": "click plosive", "fricative": "fricative", "spread": "ic e", "open": "a cackle", "rounded": "o",
    "throat": "grunt",
    "soft": " ".join(soft for soft, _ in LAUGHTER_GRADES.values()),
    "loud": " ".join(loud for _, loud in LAUGHTER_GRADES.values()),
}

_ARPABET_LABELS = {label: " ".join([
    label, label.lower(), *(f"{name}{stress}" for name in (label, label.lower()) for stress in (0, 1, 2)
                            if label in VOWELS.split()), SPEECH_LABELS["arpabet"].get(label, "")])
    for label in ("SIL", *ARPABET)}
#: English speech: 39 ARPABET phonemes and silence.
SPEECH = _phone_set("speech", _SPEECH_CLASSES, f"{VOWELS} P B M", " ".join(("SIL", *ARPABET)),
                    {**SPEECH_LABELS, "arpabet": _ARPABET_LABELS})
#: The twelve laughter phonemes, whose labels are the same in every set, and the soft and loud grades of six of them.
LAUGHTER = _phone_set(
    "laughter", _LAUGHTER_CLASSES,
    " ".join(item for label in "a e o ic cackle".split() for item in (label, *LAUGHTER_GRADES[label])),
    " ".join(["silence ne click nasal plosive fricative ic e o grunt cackle a",
              *(item for grades in LAUGHTER_GRADES.values() for item in grades)]),
    dict.fromkeys(LABEL_SETS, LAUGHTER_LABELS),
)
#: Phone set of each kind of model.
PHONE_SETS = {"speech": SPEECH, "laughter": LAUGHTER}
