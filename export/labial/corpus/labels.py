"""Labels of phonemes: stripped of marks that do not change the mouth's shape, and what they mean in each set of labels.

The C library strips them in exactly the same way (lib/names.c): every rule compares sequences of characters, and none
needs a Unicode table.

Aliases are, for each set of labels, the phonemes and the labels that mean them. They are case-sensitive, since case
matters in some sets (X-SAMPA ``@U``, ``tS``), and are listed without the marks that :func:`normalise` drops. A label
may mean different sounds in different sets (``y``, ``th``, ``N``).

The IPA's symbols are read as the International Phonetic Association defines them, by what lips and jaw do:

- A vowel without an English relative becomes the English one of the nearest height and, above all, rounding: the front
  rounded ones go with UW, UH and OW, the unrounded back ones with IH and AH.
- A diphthong becomes its English relative, else its first element; one that rises to an open vowel (``ua``, ``ea``) is
  that open vowel, which shows most.
- Trills and taps use the tongue and not the lips, like T, D, N and L; only ``ɹ`` and ``ɻ`` are the English R, which
rounds. Uvular sounds go with the velars.

X-SAMPA is the same in ASCII (Wells, 1995), with further labels of MBROLA's and MARY's voices; ``r`` is the English one,
as in these voices.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Dict, Iterable, List, Mapping, Optional, Tuple

from labial.files import limits

#: Combining marks (ties, nasalisation, syllabicity, releases), except the cedilla, which makes another consonant.
_COMBINING = re.compile("[\u0300-\u0326\u0328-\u036f]")
#: Length, half length; aspirated, palatalised, labialised, velarised, pharyngealised, released nasally or laterally.
_MODIFIER = re.compile("[\u02d0\u02d1\u02b0\u02b2\u02b7\u02e0\u02e4\u207f\u02e1]")
#: Marks before a symbol: primary and secondary stress in IPA, X-SAMPA and espeak; a glottal stop, which lips do not
#: show.
_LEADING = "\u02c8\u02cc'\",%?\u0294"
#: Marks after a symbol: X-SAMPA's length, syllabicity, nasalisation and palatalisation, its diacritics (``_h``),
#: Kaldi's places in a word (``_B``), and the signs that espeak's names of variants end in.
_TRAILING = re.compile(r"(?<=[^ ])(?:[:=~;.^\"-]|_[A-Za-z0-9=~^])$")
_STRESS_DIGIT = re.compile(r"(?<=[A-Za-z]{2})[012]$")
#: Diacritics, length and stress as Praat's backslash sequences. ``\h^`` is not one: it is a consonant.
_PRAAT_MARK = re.compile(r"\\[|0OT\-+:~NUDn3cv'`^][v^()]|\\[:.]f|\\'[12]")
_LETTER = re.compile(r"[A-Za-z\u0080-\U0010ffff]")
_BLANKS = " \t\r\n"
#: Bytes of a label without meaning in which a known part is looked for (LABEL_MAX of lib/names.c).
_SEARCHED = 32
#: Sets of labels: one set, or "auto", any of them, ARPABET before the IPA before X-SAMPA.
AUTO = "auto"


@lru_cache(maxsize=8)  # a label without a meaning comes at once again
def without_marks(label: str) -> str:
    """`label` without stress digits (0-2 after two letters or more), stress and length signs, ties and diacritics; ""
    when it consists of marks alone."""
    text = label.strip(_BLANKS)
    if "\\" in text:
        text = _PRAAT_MARK.sub("", text)
    if not text.isascii():
        text = _MODIFIER.sub("", _COMBINING.sub("", text))
    text = text.lstrip(_LEADING)
    while _TRAILING.search(text):
        text = _TRAILING.sub("", text)
    return _STRESS_DIGIT.sub("", text)


def normalise(label: str) -> str:
    """`label` without its marks; unchanged if it consists only of marks."""
    return without_marks(label) or label.strip(_BLANKS)


def find(names: Mapping[str, str], label: str) -> Optional[str]:
    """The meaning of `label` in `names` (label or alias -> phoneme), or None: first without blanks around it, then also
    without its marks. A label longer than `limits.LABEL` bytes has none."""
    return find_first((names,), label)


def find_first(tables: Iterable[Mapping[str, str]], label: str) -> Optional[str]:
    """The same in the first of several tables that knows `label`."""
    label = label.strip(_BLANKS)
    if len(label) > limits.LABEL or len(label.encode("utf-8", "replace")) > limits.LABEL:
        return None
    bare = without_marks(label) or label
    known = (names.get(label, names.get(bare)) for names in tables)
    return next((meaning for meaning in known if meaning is not None), None)


def longest_of(names: Mapping[str, str]) -> Dict[str, int]:
    """How long the names are that begin with a character, at most: what :func:`nearest` compares."""
    return {name[0]: len(name) for name in sorted(names, key=len)}


def nearest(names: Mapping[str, str], longest: Mapping[str, int], label: str, silence: str, neutral: str) -> str:
    """A phoneme for a label without a meaning: silence for text in brackets, and for labels of nothing but marks,
    digits and punctuation; else the first known part of its first 32 bytes, the longest there; else `neutral`."""
    label = label.strip(_BLANKS)
    if len(label) > 1 and label[0] + label[-1] in ("<>", "[]", "()", "{}", "++", "**", "##"):
        return silence
    if len(label) > _SEARCHED or not label.isascii():
        label = label[:_SEARCHED].encode("utf-8", "replace")[:_SEARCHED].decode("utf-8", "replace")
    text = without_marks(label)
    if not _LETTER.search(text):
        return silence
    for start, first in enumerate(text):
        for end in range(min(len(text), start + longest.get(first, 0)), start, -1):
            if text[start:end] in names:
                return names[text[start:end]]
    return neutral


def entries(names: Mapping[str, Mapping[str, str]]) -> List[Tuple[str, str, Tuple[str, ...]]]:
    """The names of each set of labels as one table: name, phoneme, and the sets in which that name means it. The table
    leaves out names that mean the same when their marks are dropped. It is sorted by the names' bytes; a name of
    several meanings occurs once for each, in the order of `names`' sets, of which the first one is the default."""
    table = []
    for name in sorted({name for known in names.values() for name in known}, key=str.encode):
        meanings = _meanings(names, name)
        plain = _meanings(names, normalise(name)) if normalise(name) != name else {}
        if meanings.items() <= plain.items() and next(iter(meanings.values())) == next(iter(plain.values())):
            continue
        table += [(name, phoneme, tuple(labels for labels, meaning in meanings.items() if meaning == phoneme))
                  for phoneme in dict.fromkeys(meanings.values())]
    return table


def _meanings(names: Mapping[str, Mapping[str, str]], name: str) -> Dict[str, str]:
    return {labels: known[name] for labels, known in names.items() if name in known}


#: The sets of labels, in the order of their priority if none is named, and the bit of each in tables: labial_labels_t
#: of include/labial/names.h.
LABEL_SETS: Dict[str, int] = {"arpabet": 0x20, "ipa": 0x40, "xsampa": 0x80}

_FILLERS = "BREATHING BREATH LAUGHTER GARBAGE LIPSMACK SMACK NOISE COUGH NSN SPN SIL INHALE EXHALE".split()
#: Silence and noises, the same in every set.
_SILENCE = (
    "sil pau PAU brth BRTH sp SP spn SPN nsn NSN ssil SSIL h# H# # epi <sil> <SIL> <s> </s> <eps> _ __ _! "
    + " ".join(f"{plus}{name}{plus}" for name in _FILLERS for plus in ("+", "++"))
    + " [NOISE] [COUGH] [SMACK] [SPEECH] [LAUGHTER] [BREATH]"
)
#: In addition to ARPABET's spellings: flite's, Sphinx's and TIMIT's.
_ARPABET = {
    "SIL": _SILENCE, "AH": "ax AX ax-h AX-H +UH+ ++UH++ +UM+ ++UM++", "ER": "axr AXR", "IH": "ix IX", "UW": "ux UX",
    "B": "bcl BCL BD bd", "P": "pcl PCL PD pd", "M": "em EM", "D": "dcl DCL DD dd dx DX nx NX", "T": "tcl TCL TD td",
    "N": "en EN", "L": "el EL", "S": "TS ts", "Z": "dz DZ", "K": "kcl KCL KD kd", "G": "gcl GCL GD gd",
    "NG": "eng ENG", "HH": "hv HV h H q",
}

_IPA = {
    "SIL": _SILENCE,
    # Vowels. ä ã õ ... are single characters here; as letters with a combining mark they lose it.
    "IY": "i i? ĩ iɪ iu iʊ iw iy iə iɐ ie iɛ", "IH": "ɪ ᵻ ɨ ɯ ɪə ɪɐ ɪʊ ɪɹ iɹ ɪ^",
    "EH": "e ɛ ε ẽ eə ɛə eɐ ɛɐ eɹ ɛɹ eu eʊ ew ɛʊ ɛu ey je",
    "AE": "æ a ä ã ea ia ja yæ oæ", "AA": "ɑ ɑɹ ua uɑ uai iɑ jɑ oa ɔa", "AH": "ə ʌ ɐ ɘ ɤ",
    "ER": "ɜ ɝ ɚ ɜɹ əɹ ər ʌɹ ɚɹ ɹ̩ ɻ̩ ə˞ ɜ˞ ɜr", "AO": "ɔ ɔ+ ɒ ɶ oɹ ɔɹ",
    "UH": "ʊ ʏ ɵ ɞ ʊə ʊɐ ʊɹ uɹ uə uɐ ɯᵝ", "UW": "u ʉ y yː ø ũ ui uɪ ʊi ʊɪ uj ʉɪ uo uɔ yə yɛ yɪ yʊ yi yu yø ju øi øy øɪ",
    "OW": "o œ õ oʊ ou ow əʊ əw oə œy œʏ œi onɡ io iou jo eo",
    # Diphthongs with an English relative.
    "EY": "eɪ ei ej ɛɪ ɛi ɛj əɪ əi əj uei",
    "AY": "aɪ ai aj ae aɛ äi ɑɪ ɑi ɑj aɪə aɪɚ aɪɜ aɪʊɹ aɪɐ ɐɪ ɐi ʌɪ æi æɪ",
    "AW": "aʊ au aw ao aɔ ɑu ɑʊ ɑw æʊ æu æw æy aʊə aʊɚ aʊɐ ʌʊ ʌu ɐʊ ɐu ɐw iɑu",
    "OY": "ɔɪ ɔi ɔj ɔø ɔʏ ɔy oɪ oi oj ɒɪ ɒi",
    # Lips.
    "P": "p ɸ ʘ pɸ pf ph kp", "B": "b β ɓ ʙ bv ɡb gb", "M": "m ŋm", "F": "f", "V": "v ʋ ɱ ⱱ",
    # Tongue.
    "T": "t ʈ th ǀ ǃ ǂ", "D": "d ɖ ɗ ɾ", "N": "n ɲ ɳ", "L": "l ɫ ɬ ɭ ɮ ʎ ɺ ɽ r əl tɬ dɮ ǁ", "TH": "θ tθ", "DH": "ð dð",
    "S": "s ts ʦ tsh ss", "Z": "z dz ʣ", "SH": "ʃ ɕ ʂ ɧ sx s.", "ZH": "ʒ ʑ ʐ",
    "CH": "tʃ ʧ tɕ ʨ tʂ ʈʂ ꭧ tɕh ts. ts.h cr", "JH": "dʒ ʤ dʑ ʥ dʐ ɖʐ ꭦ", "R": "ɹ ɻ", "Y": "j ʝ",
    "K": "k c q x kh kx c\u00e7 qχ", "G": "g ɡ ɟ ɣ ɢ ʁ ʀ ɰ ɠ ʄ ʛ ɟʝ", "NG": "ŋ ɴ",
    "HH": "h ɦ \u00e7 c\u0327 χ ħ ʕ ʔ ʡ ʜ ʢ", "W": "w ʍ ɥ",
}

_XSAMPA = {
    "SIL": _SILENCE,
    "IY": "i iu iU i@ i@3 i3 ie iE", "IH": r"I I\ 1 M I@ I2 I#", "EH": "e E e@ E@ E2 eU eu EU",
    "AE": "a { ea ia", "AA": "A A@ a# ua uA", "AH": r"@ V 6 7 @\ @2 @5 @-", "ER": r"3 3\ @` 3` r= @r",
    "AO": "O Q 0 & O2 O@", "UH": r"U Y 8 U\ U@ u@", "UW": "u } y y: 2 ui uI Ui uo y@",
    "OW": "o 9 oU @U ou o@ 9y 9Y", "EY": "eI ei ej EI Ei Ej @i @I", "AY": "aI ai aj AI Ai Aj Ae ae VI {I {i aI@ aI3",
    "AW": "aU au aw ao AU Au VU Vu {U {u 6U aU@", "OY": "OI Oi Oj OY oI oi oj",
    "P": r"p p\ O\ pf kp", "B": r"b B B\ b_< gb", "M": "m", "F": "f", "V": r"v v\ P F",
    "T": r"|\ !\ =\ t t` t# t[", "D": "d d` d[ d_< 4", "N": "n J n` n^ J^ n-",
    "L": r"l 5 l` l\ L L\ K K\ |\|\ r` l^ @l @L", "TH": "T", "DH": "D", "S": "s ts", "Z": "z dz",
    "SH": r"s\ x\ S s`", "ZH": r"z\ Z z`", "CH": r"tS ts\ ts`", "JH": r"dZ dz\ dz`",
    "K": "k c q x kx", "G": r"g J\ G G\ R R\ R2 M\ g_<", "NG": r"N\ N", "HH": r"h\ H\ ?\ X\ <\ >\ h ? C X",
    "R": r"r r\ r\`", "Y": r"j\ j", "W": "w W H",
}
#: Labels of speech: set of labels -> phoneme -> labels, blanks between.
SPEECH_LABELS: Dict[str, Dict[str, str]] = {"arpabet": _ARPABET, "ipa": _IPA, "xsampa": _XSAMPA}
#: Symbols of the AVLaughterCycle annotation: words, IPA, and IPA as Praat's backslash sequences. Vowels go to the
#: nearest of the four; the voiceless ``ic`` is how that annotation writes a cackle; a snore is friction in the nose.
LAUGHTER_LABELS = {
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
