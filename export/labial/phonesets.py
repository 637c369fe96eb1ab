r"""Phone sets: what a model's phonemes are, how they look, where units begin, and what other labels mean them.

A *phoneme* is a label of a model's inventory, an *alias* a label of some front end or corpus that stands for one.
Aliases are case-sensitive, since phone sets differ by case (X-SAMPA ``@U``, ``tS``). Where one label means different
sounds in two sets, ARPABET wins: ``N S T D Z V`` are read as X-SAMPA only where the format says that they are.

Viseme classes of speech group what lips and jaw do, not what the tongue does: so /k g ng/ go with /hh/, which leave the
lips to their neighbours, /w/ with the close rounded vowels, and /r/ with /er/. Diphthongs go with the part that
opens or rounds most.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Collection, Dict, List, Optional, Sequence, Tuple

from labial.labels import find, nearest, normalise

__all__ = ["ARPABET", "LAUGHTER", "LAUGHTER_GRADES", "PHONE_SETS", "SPEECH", "VOWELS", "PhoneSet", "aliases_for",
           "candidates_for", "normalise", "substitute_for"]


@dataclass(frozen=True)
class PhoneSet:
    """The phonemes of one kind of model ("speech" or "laughter") and what is known about each."""

    kind: str
    phonemes: Tuple[str, ...]  #: P labels, silence first; the order is part of the model's interface
    classes: Tuple[str, ...]  #: names of the viseme classes
    phoneme_class: Tuple[int, ...]  #: (P,) index into `classes`
    boundary: Tuple[bool, ...]  #: (P,) units begin and end here
    silence: str
    aliases: Dict[str, str]  #: other label -> phoneme

    def names(self) -> Dict[str, str]:
        """Every label that has a meaning, and that meaning."""
        return {**self.aliases, **{label: label for label in self.phonemes}}

    def resolve(self, label: str, sampa: bool = False) -> Optional[str]:
        """The phoneme that `label` means, or None: as it stands, else without stress, length and other marks. With
        `sampa`, ``N S T D Z V`` and a few others are read as X-SAMPA."""
        return find(self.names(), label, sampa)

    def nearest(self, label: str) -> str:
        """A phoneme for any label, the one it means or looks most like."""
        return nearest(self.names(), label, self.silence)


def aliases_for(kind: str, phonemes: Sequence[str], own: Dict[str, str]) -> Dict[str, str]:
    """The aliases of a model's phonemes: those of its kind's phone set, and `own`, which come first. A model thus knows
    labels that became known after its training."""
    built_in = PHONE_SETS[kind].aliases if kind in PHONE_SETS else {}
    known = {alias: label for alias, label in built_in.items() if label in phonemes and alias not in phonemes}
    return {**known, **own}


def substitute_for(label: str, available: Collection[str]) -> str:
    """The phoneme of `available` that looks most like `label` (of either kind): `label` itself if it is there.

    Candidates in order: those declared for the phoneme, its viseme class, the vowels if it is one, all others but
    silence, silence. Raises ValueError when no phoneme of the kind is available or `label` is none.
    """
    for candidate in candidates_for(label):
        if candidate in available:
            return candidate
    raise ValueError(f"no phoneme of {label!r}'s phone set is available")


def candidates_for(label: str) -> List[str]:
    """All phonemes of `label`'s set, from `label` itself to the least alike. Raises ValueError for an unknown label."""
    phone_set = next((item for item in (SPEECH, LAUGHTER) if label in item.phonemes), None)
    if phone_set is None:
        raise ValueError(f"{label!r} is not a phoneme")
    class_of = dict(zip(phone_set.phonemes, phone_set.phoneme_class))
    boundary = dict(zip(phone_set.phonemes, phone_set.boundary))
    sounding = [item for item in phone_set.phonemes if item != phone_set.silence]
    order = [label, *_ALIKE.get(label, "").split()]
    order += [item for item in sounding if class_of[item] == class_of[label]]
    order += [item for item in sounding if boundary[item] == boundary[label]]
    order += [*sounding, phone_set.silence]
    return list(dict.fromkeys(order))


def _phone_set(kind: str, groups: Dict[str, str], boundary: str, order: str, aliases: Dict[str, str]) -> PhoneSet:
    phonemes = tuple(order.split())
    index = {label: number for number, labels in enumerate(groups.values()) for label in labels.split()}
    table: Dict[str, str] = {}
    for phoneme, labels in aliases.items():
        for alias in labels.split():
            if alias != phoneme and table.setdefault(alias, phoneme) != phoneme:
                raise AssertionError(f"{kind} alias {alias!r} has two meanings")
    ends = boundary.split()
    return PhoneSet(kind, phonemes, tuple(groups), tuple(index[label] for label in phonemes),
                    tuple(label in ends for label in phonemes), phonemes[0], table)


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
    "CH": "SH JH ZH T", "JH": "CH ZH SH D", "K": "G NG HH", "G": "K NG HH", "NG": "K G N HH", "HH": "K G AH",
    "R": "ER W L", "W": "UW UH R OW", "Y": "IY IH EY",
    "ne": "nasal", "nasal": "ne silence", "click": "plosive", "plosive": "click fricative", "fricative": "e plosive",
    "ic": "e a", "e": "a ic", "a": "e cackle ic", "o": "e a", "cackle": "a e ic", "grunt": "nasal e",
    **{graded: f"{label} e" for label, grades in LAUGHTER_GRADES.items() for graded in grades},
}  # fmt: skip

_FILLERS = "BREATHING BREATH LAUGHTER GARBAGE LIPSMACK SMACK NOISE COUGH NSN SPN SIL INHALE EXHALE".split()

#: Aliases beside ARPABET's own spellings. ARPABET-like: flite, Sphinx, TIMIT. Then IPA, then X-SAMPA and espeak.
_SPEECH_ALIASES = {
    "SIL": "sil pau PAU brth BRTH sp SP spn SPN nsn NSN ssil SSIL h# H# # epi <sil> <SIL> <s> </s> <eps> _ __ _! "
    + " ".join(f"{plus}{name}{plus}" for name in _FILLERS for plus in ("+", "++"))
    + " [NOISE] [COUGH] [SMACK] [SPEECH] [LAUGHTER] [BREATH]",
    "AA": "ɑ A A: aa: a# ɑɹ ɑ̃", "AE": "æ a {",
    "AH": "ax AX ax-h AX-H +UH+ ++UH++ +UM+ ++UM++ ə ʌ ɐ ɘ @ @2 @5 6 ɤ ə- @-",
    "AO": "ɔ ɒ Q O O: 0 O2 oː o: oɹ ɔɹ õ", "AW": "aʊ æʊ aʊə aU aU@ ʌʊ", "AY": "aɪ aj ɑɪ aɪə aɪɚ aɪɜ aI aI@ aI3 AI",
    "EH": "ɛ e E e@ eə ɛə E2 ɛɹ eɹ ẽ", "ER": "axr AXR ɜ ɝ ɚ ə˞ ɜ˞ ɜɹ əɹ 3 3: @` 3` r= @r", "EY": "eɪ ej eI EI",
    "IH": "ix IX ɪ ɨ ᵻ I I2 I# ɪə I@ ɪɹ 1 ĩ", "IY": "i iː i: i3 iə i@ i@3", "OW": "oʊ əʊ əw o oU @U ɐʊ",
    "OY": "ɔɪ ɔj OI oI",
    "UH": "ʊ ʊə ɵ U U@ ʊɹ ʏ 7 8", "UW": "ux UX u ʉ u: y: ø œ ũ 2 9 &",
    "B": "bcl BCL BD bd β", "P": "pcl PCL PD pd", "M": "em EM", "F": "ɸ", "V": "ʋ ɱ",
    "D": "dcl DCL DD dd dx DX nx NX ɾ ɖ 4 d[", "T": "tcl TCL TD td ʈ t# t[",
    "N": "en EN ɲ ɳ J J^ n^ n-", "L": "el EL ɫ ɬ ɭ ʎ əl @L @l 5 l^",
    "TH": "θ", "DH": "ð", "S": "TS ts", "Z": "dz DZ", "SH": "ʃ ɕ ʂ", "ZH": "ʒ ʑ ʐ", "CH": "tʃ ʧ tS tɕ",
    "JH": "dʒ ʤ dZ dʑ", "K": "kcl KCL KD kd c x", "G": "gcl GCL GD gd ɡ ɟ ɣ", "NG": "eng ENG ŋ",
    "HH": "hv HV h H ɦ q ʔ ç ç χ ħ ʕ ? C X", "R": "ɹ ɻ r\\ ʁ ɾ̃ ʀ R2", "W": "ʍ ɥ", "Y": "j ʝ",
}  # fmt: skip


def _spellings(phoneme: str) -> str:
    bare = [phoneme, phoneme.lower()]
    return " ".join(bare + [f"{name}{stress}" for name in bare if phoneme in VOWELS.split() for stress in (0, 1, 2)])


_LAUGHTER_CLASSES = {
    "silence": "silence",
    "nose": "ne nasal",  # air goes through the nose, lips rest on each other
    "stop": "click plosive",
    "fricative": "fricative",
    "spread": "ic e",
    "open": "a cackle",
    "rounded": "o",
    "throat": "grunt",
    "soft": " ".join(soft for soft, _ in LAUGHTER_GRADES.values()),
    "loud": " ".join(loud for _, loud in LAUGHTER_GRADES.values()),
}

#: Symbols of the AVLaughterCycle annotation: words, IPA, and IPA as Praat's backslash sequences. Vowels go to the
#: nearest of the four; the voiceless ``ic`` is how that annotation writes a cackle; a snore is friction in the nose.
_LAUGHTER_ALIASES = {
    "silence": "sil SIL pau PAU <sil> _ #",
    "ne": r"ne? ni ni? ne_ex ne_in nareal nareal_fricative snore",
    "click": r"ʘ ǀ ǃ ǂ ǁ \O. \|1 \! \|2 \|- lipsmack",
    "nasal": r"hum m n ŋ ɲ ɱ ɴ ɳ \ng \nj \mj \nc \n.",
    "plosive": r"p b t d k g q c ɡ ʔ ʡ ɟ ɢ ʈ ɖ \?g \gs \?- \j. \gc \t. \d.",
    "fricative": r"h ɦ f v s z x ç θ ð ʃ ʒ ɸ β χ ʁ ɣ ħ ʕ ʂ ʐ ʝ ʍ ɕ ʑ ʜ ɬ r ɹ ʀ "
    r"\h^ \c, \tf \dh \sh \zh \ff \bf \cf \ri \gf \h- \9e \s. \z. \jc \wt \cc \zc \hc \l- \rt \rc fricatives",
    "ic": r"ɪ i ɨ ɯ j y I \ic \i- \mt ʏ \yc",
    "e": r"ɛ ə ɘ ɜ l E @ \ep \sw \e- \er",
    "o": r"ɔ u ʊ ʉ ɵ ɤ ø œ w O U \ct \hs \u- \o- \o/ \oe \rh",
    "grunt": "groan vocal_fry vocal-fry fry creak",
    "cackle": r"\ic\O^ \ic\0^ \ic\Ov \ic\0v ɪ̊ ɪ̥",
    "a": r"ɑ æ ɐ ʌ ɒ A \as \ae \at \vt \ab vowel",
}

#: English speech: 39 ARPABET phonemes and silence.
SPEECH = _phone_set(
    "speech", _SPEECH_CLASSES, f"{VOWELS} P B M", " ".join(("SIL", *ARPABET)),
    {label: f"{_spellings(label)} {_SPEECH_ALIASES[label]}" for label in ("SIL", *ARPABET)},
)  # fmt: skip

#: The twelve laughter phonemes, and the soft and loud grades of six of them.
LAUGHTER = _phone_set(
    "laughter", _LAUGHTER_CLASSES,
    " ".join(item for label in "a e o ic cackle".split() for item in (label, *LAUGHTER_GRADES[label])),
    " ".join(["silence ne click nasal plosive fricative ic e o grunt cackle a",
              *(item for grades in LAUGHTER_GRADES.values() for item in grades)]), _LAUGHTER_ALIASES,
)  # fmt: skip

#: Phone set of each kind of model.
PHONE_SETS = {"speech": SPEECH, "laughter": LAUGHTER}
