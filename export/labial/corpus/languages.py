"""How words of languages other than English sound: by espeak-ng, as the phonemes of ARPABET that look most like its
own.

Chinese goes by pinyin, of the package pypinyin or else of espeak-ng's own dictionary, since espeak-ng speaks Chinese
characters as English names of pinyin. Japanese with kanji needs fugashi and unidic-lite. Arabic without vowel marks
gets a vowel where a syllable of Arabic must have one.
"""

from __future__ import annotations

import difflib
import logging
import re
import shutil
import subprocess
import unicodedata
from functools import cache
from typing import Any, List, Optional, Sequence, Set, Tuple

from labial.core import espeak
from labial.core.words import read
from labial.corpus import signs
from labial.corpus.phonesets import SPEECH, VOWELS
from labial.errors import LabialError, apt, missing, pip

_logger = logging.getLogger("labial")
#: Words that are said to be unspeakable, at most.
_SAID_MOST = 1000
#: Words of which a sentence for espeak-ng has, at most.
_SENTENCE = 60
#: How much of a word in its sentence must be as it is alone, for the two to be the same word.
_ALIKE = 0.5

#: What is a word in its sentence; signs are not, and espeak-ng makes several words of them.
_WORD = re.compile(r"[^\s%‰&+=@°§№#$€£¥₹₽]*[^\W_][^\s%‰&+=@°§№#$€£¥₹₽]*")
#: A word of one letter, with marks or without.
_LETTER = re.compile(r"[^\W\d_][\u0300-\u036f]*")
_VOICE = re.compile(r"[a-z][\w+-]*(?:/[\w+-]+)*")
_CHINESE = re.compile(r"(?:zh|cmn|zho)(?:-.*)?")
#: Chinese that is Cantonese: as services name it, and where it is what people speak.
_CANTONESE = re.compile(r"(?:zh|zho)(?:-hant)?-(?:yue|hk|mo)(?:-.*)?", re.IGNORECASE)
_JAPANESE = re.compile(r"ja(?:-.*)?")
#: espeak-ng's voice that reads pinyin as such; "cmn" reads it as English.
_PINYIN_VOICE = "cmn-latn-pinyin"
#: Characters of Chinese and kanji of Japanese.
HAN = re.compile("[\u2e80-\u2fdf\u3005-\u3007\u3400-\u4dbf\u4e00-\u9fff\uf900-\ufaff\U00020000-\U0003ffff]")
#: Marks of espeak-ng's: where words of another language begin, tones, and retroflex consonants.
_MARKED = re.compile(r"\([a-z][\w-]*\)|[0-9.]")
#: The n of Japanese where espeak-ng has a nasal vowel: before p, b, m, and before others.
_N = re.compile("ũ(?=_[ˈˌ]?[pbm])"), re.compile("ũ")
#: The vowel of Japanese "desu" and "masu", which is whispered.
_DEVOICED = re.compile("(?<=(?:D EH|M AE) S) UH(?= K|$)")
#: Languages of India whose affricates espeak-ng writes as palatal stops, with or without breath behind them.
_INDIAN = frozenset("as bn bpy gu hi kn kok ml mr ne or pa sd te ur".split())
_AFFRICATES = {"c": "tʃ", "ɟ": "dʒ"}
_VOWELS = frozenset(VOWELS.split())

_INITIALS = {"b": "B", "p": "P", "m": "M", "f": "F", "d": "D", "t": "T", "n": "N", "l": "L", "g": "G", "k": "K",
             "h": "HH", "j": "JH", "q": "CH", "x": "SH", "zh": "JH", "ch": "CH", "sh": "SH", "r": "R", "z": "D Z",
             "c": "T S", "s": "S", "": ""}
#: Finals of pinyin as they are written behind an initial.
_FINALS = {"a": "AA", "o": "AO", "e": "AH", "ai": "AY", "ei": "EY", "ao": "AW", "ou": "OW", "an": "AA N", "en": "AH N",
           "ang": "AA NG", "eng": "AH NG", "ong": "UH NG", "er": "ER", "i": "IY", "ia": "Y AA", "ie": "Y EH",
           "iao": "Y AW", "iu": "Y OW", "ian": "Y EH N", "in": "IH N", "iang": "Y AA NG", "ing": "IH NG",
           "iong": "Y UH NG", "u": "UW", "ua": "W AA", "uo": "W AO", "uai": "W AY", "ui": "W EY", "uan": "W AA N",
           "un": "W AH N", "uang": "W AA NG", "ueng": "W AH NG", "ü": "UW", "üe": "Y EH", "üan": "Y EH N",
           "ün": "UW N"}
_SYLLABLE = re.compile(f"(zh|ch|sh|[bpmfdtnlgkhjqxrzcs]?)({'|'.join(sorted(_FINALS, key=len, reverse=True))})")
#: How finals without an initial are written, and what they are.
_WRITTEN = (("yi", "i"), ("yu", "ü"), ("yong", "iong"), ("you", "iu"), ("y", "i"), ("wu", "u"), ("wei", "ui"),
            ("wen", "un"), ("weng", "ueng"), ("w", "u"))


def pronounced(words: Sequence[str], language: str) -> List[Optional[List[str]]]:
    """The phonemes of words that follow each other; None for one that cannot be spoken, which is logged once. Raises
    LabialError for an unknown language, and where espeak-ng is missing."""
    if not words:
        return []
    if not _VOICE.fullmatch(language):
        raise LabialError(f"{language!r:.40} is no language of espeak-ng")
    language = "yue" if _CANTONESE.fullmatch(language) else language
    is_pinyin = bool(_CHINESE.fullmatch(language))
    given = [signs.worded(unicodedata.normalize("NFC", word), "cmn" if is_pinyin else language) for word in words]
    found: List[List[str]]
    if is_pinyin:
        found = [_by_pinyin(word) for word in given]
    elif _JAPANESE.fullmatch(language):
        found = [_DEVOICED.sub("", " ".join(phonemes)).split()
                 for phonemes in _by_espeak([_kana(word) for word in given], language)]
    else:
        found = _by_espeak(given, language)
    for word, phonemes in zip(words, found):
        if not phonemes:
            _say_unspeakable(word, language)
    return [phonemes or None for phonemes in found]


def is_chinese(language: str) -> bool:
    """Whether a language is written in characters that are a syllable each."""
    return language == "yue" or bool(_CANTONESE.fullmatch(language) or _CHINESE.fullmatch(language))


def speakable(text: str, voice: str) -> Tuple[str, str]:
    """A text as espeak-ng can say it aloud, and the voice that does: Chinese is written in pinyin, with tones, and
    Japanese in kana. Every other text and voice stays as it is. `voice` may have a variant ("cmn+f3")."""
    language, plus, variant = voice.partition("+")
    if _CANTONESE.fullmatch(language):
        return text, f"yue{plus}{variant}"
    if _CHINESE.fullmatch(language):
        return (" ".join(_pinyin(text).split()), _PINYIN_VOICE + plus + variant) if HAN.search(text) else (text, voice)
    if _JAPANESE.fullmatch(language):
        kana = _kana(text)
        if not kana.strip():
            _say_unspeakable(text, language)
        return kana, voice
    return text, voice


_unspeakable: Set[str] = set()


def _say_unspeakable(word: str, language: str) -> None:
    key = f"{language} {word}"
    if key in _unspeakable or len(_unspeakable) >= _SAID_MOST:
        return
    _unspeakable.add(key)
    is_kanji = _JAPANESE.fullmatch(language) and HAN.search(word)
    hint = f"; kanji need fugashi: {pip('japanese')}" if is_kanji else ""
    shown = "the lips move for its time alone" if re.search(r"[^\W_]", word) else "it is silent"
    _logger.warning("espeak-ng cannot speak %.40r in the language %r: %s%s", word, language, shown, hint)


# ---- espeak-ng


def _by_espeak(words: Sequence[str], language: str) -> List[List[str]]:
    """The phonemes of words, as they sound in their sentence where espeak-ng shows it.

    espeak-ng names a single letter, as "e acute" for the Portuguese for "is", unless another word follows.
    """
    single = [word for word in words if _LETTER.fullmatch(word)]
    found = _spoken([*words, *(f"{word} ta" for word in single)], language)
    for word, phonemes in zip(single, found[len(words) :]):
        if "T" in phonemes[1:]:
            found[words.index(word)] = phonemes[: -1 - phonemes[::-1].index("T")]
    del found[len(words) :]
    for first in range(0, len(words), _SENTENCE):
        places = [place for place in range(first, min(first + _SENTENCE, len(words))) if _WORD.fullmatch(words[place])]
        part = [words[place] for place in places]
        said = _spoken([" ".join(part)], language, " ")
        if len(part) < 2 or len(said) != len(part):
            continue
        for place, phonemes in zip(places, said):
            if difflib.SequenceMatcher(None, found[place], phonemes, autojunk=False).ratio() >= _ALIKE:
                found[place] = phonemes
    return found


def _spoken(texts: Sequence[str], language: str, between: str = "") -> List[List[str]]:
    """The phonemes of texts; with `between`, of the words of a single one."""
    lines = _ipa(texts, language)
    if between:
        lines = [word for word in lines[0].split(between) if word.strip("_")]
    if _JAPANESE.fullmatch(language):
        lines = [_N[1].sub("ɴ", _N[0].sub("m", line)) for line in lines]
    main = language.split("-")[0]
    if main in _INDIAN:
        lines = [re.sub("[cɟ]", lambda found: _AFFRICATES[found[0]], line) for line in lines]
    tonal = main in ("yue", "th", "vi", "my", "hak", "nan")
    result = [_phonemes(line, tonal) for line in lines]
    return [_with_vowels(phonemes) for phonemes in result] if main == "ar" else result


def _phonemes(line: str, tonal: bool) -> List[str]:
    """The phonemes of espeak-ng's IPA."""
    labels = (_MARKED.sub("", label) for label in re.split(r"[_\s]+", line))
    if tonal:  # a tone is written with this sign as well
        labels = (re.sub("(?<=.)ɜ$", "", label) for label in labels)
    found = (SPEECH.nearest(label, "ipa") for label in labels if label)
    return [phoneme for phoneme in found if phoneme != SPEECH.silence]


def _ipa(texts: Sequence[str], language: str) -> List[str]:
    """The IPA of each text, by espeak-ng's library, or its program where that is not found."""
    try:
        found = espeak.ipa(list(texts), language)
    except LabialError:
        return _by_program(texts, language)
    if found is None:
        raise LabialError(f"espeak-ng cannot speak {language!r:.40}: it has no such voice")
    return found


def _by_program(texts: Sequence[str], language: str) -> List[str]:
    program = shutil.which("espeak-ng")
    if program is None:
        raise missing(f"the language {language!r:.40}", "espeak-ng", apt("espeak-ng"))
    lines = _printed(program, "\n\n".join(texts), language)
    if len(lines) != len(texts):  # a text that is silent, or that makes two clauses
        lines = [" ".join(_printed(program, text, language)) for text in texts]
    return lines


def _printed(program: str, text: str, language: str) -> List[str]:
    done = subprocess.run([program, "-q", "-v", language, "--ipa", "--sep=_", "--stdin"],
                          input=text.encode("utf-8", "replace"), capture_output=True)
    if done.returncode != 0:
        problem = " ".join(done.stderr.decode("utf-8", "replace").split())
        raise LabialError(f"espeak-ng cannot speak {language!r:.40}: {problem[:200]}")
    return [line for line in done.stdout.decode("utf-8", "replace").splitlines() if line.strip("_ ")]


# ---- Arabic


def _with_vowels(phonemes: Sequence[str]) -> List[str]:
    """Arabic as it is usually written, without short vowels: AE where a syllable has none. A syllable is a consonant, a
    vowel and perhaps a second consonant; a word may end in two consonants. AE IY and AE UW are diphthongs."""
    phonemes = re.sub("AE IY(?! AE)", "AY", re.sub("AE UW(?! AE)", "AW", " ".join(phonemes))).split()
    result: List[str] = []
    place = 0
    while place < len(phonemes):
        is_open = bool(result) and result[-1] in _VOWELS
        run = next((n for n, item in enumerate(phonemes[place:]) if item in _VOWELS), len(phonemes) - place)
        ends = place + run == len(phonemes)
        taken, lacks = 1, False
        if is_open and run >= 2 and not (ends and run == 2):
            taken, lacks = 2, run > 2 or ends  # the first one closes the syllable before
        elif is_open and run and ends:
            taken = run
        elif run:
            lacks = run > 1 or (ends and not result)
        result += phonemes[place : place + taken] + ["AE"] * lacks
        place += taken
    return result


# ---- Chinese

#: Numbers as they are spoken; a digit behind a Latin letter is a tone of pinyin.
_NUMBER = re.compile(r"(?<![A-Za-z\u00c0-\u024f\u0300-\u036f])\d+(?:\.\d+)?|\d{2,}")
_THOUSANDS = re.compile(r"(?<=\d),(?=\d{3}(?!\d))")
_DIGITS, _TENS, _MYRIADS = "零一二三四五六七八九", ("", "十", "百", "千"), ("", "万", "亿", "万亿")


def _spelt_out(found: re.Match[str]) -> str:
    """A number in characters. What is longer than they tell, begins with 0 or may be a year is read digit by digit."""
    whole, point, part = found[0].partition(".")
    digits = "".join(_DIGITS[int(digit)] for digit in whole)
    if len(whole) <= 16 and whole[0] != "0" and not re.fullmatch(r"1[1-9]\d\d|20\d\d", found[0]):
        digits = ""
        for place, digit in zip(reversed(range(len(whole))), map(int, whole)):
            digits += _DIGITS[digit] + _TENS[place % 4] if digit else _DIGITS[0]
            if place % 4 == 0:
                group = whole[max(0, len(whole) - place - 4) : len(whole) - place]
                digits = digits.rstrip(_DIGITS[0]) + (_MYRIADS[place // 4] if int(group) else _DIGITS[0])
        digits = re.sub("^一十", "十", re.sub("零+", "零", digits).rstrip("零"))
    return digits + ("点" + "".join(_DIGITS[int(digit)] for digit in part) if point else "")


def _by_pinyin(word: str) -> List[str]:
    """The phonemes of Chinese characters or of pinyin, with or without tones; other Latin letters are English."""
    word = _NUMBER.sub(_spelt_out, _THOUSANDS.sub("", word))
    text = _pinyin(word) if HAN.search(word) else word
    found: List[str] = []
    for part in re.findall(r"[^\W\d_]+", _without_tones(text)):
        syllables = _syllables(part.lower())
        found += syllables if syllables is not None else read(part).phonemes
    return found


def _pinyin(word: str) -> str:
    """A word whose Chinese characters are written in pinyin."""
    try:
        from pypinyin import Style, lazy_pinyin
    except ImportError:
        return "".join(part if not HAN.match(part) else f" {_dictionary(part)} "
                       for part in re.findall(f"(?:{HAN.pattern})+|[^{HAN.pattern[1:]}+", word))
    return " ".join(lazy_pinyin(word, style=Style.TONE3, v_to_u=True))


def _dictionary(characters: str) -> str:
    try:
        return espeak.replacements(characters, "cmn")
    except LabialError:
        raise missing("Chinese", "espeak-ng's library, or pypinyin", pip("chinese")) from None


def _without_tones(text: str) -> str:
    """Pinyin without marks and digits of tones; the two dots of ü stay."""
    apart = unicodedata.normalize("NFD", re.sub("(?<=[A-Za-z\u0308])[1-5]", " ", text))
    return unicodedata.normalize("NFC", re.sub("[\u0300\u0301\u0304\u030c]", "", apart)).replace("v", "ü")


def _syllables(part: str) -> Optional[List[str]]:
    """The phonemes of syllables of pinyin that stand together; None if they are none."""
    found: List[str] = []
    place = 0
    while place < len(part):
        rest = part[place:]
        written, meant = next(((a, b) for a, b in _WRITTEN if rest.startswith(a)), ("", ""))
        match = _SYLLABLE.match(meant + rest[len(written) :])
        place += match.end() - len(meant) + len(written) if match else 0
        if not match or (part[place:] and not re.match(r"[a-zü]", part[place])):
            return None
        initial, final = match.groups()
        if final[0] == "u" and initial in ("j", "q", "x"):
            final = "ü" + final[1:]
        is_buzzed = final == "i" and initial in ("zh", "ch", "sh", "r", "z", "c", "s")
        found += [*_INITIALS[initial].split(), *("IH" if is_buzzed else _FINALS[final]).split()]
    return found


# ---- Japanese


def _kana(word: str) -> str:
    """A word in kana, by fugashi where it has kanji; without it kanji are left out, but for what is counted. は that
    ends a word is read as わ, and what is not kana stands apart, since espeak-ng would name the letters of "OKです"."""
    tagger = _tagger() if HAN.search(word) else None
    if tagger:
        said = (item.feature.pron or item.feature.kana or HAN.sub("", item.surface) for item in tagger(word))
        word = "".join(said).replace("ワタクシ", "ワタシ")  # which dictionaries have for "I", and few say
    word = _COUNTED.sub(lambda found: _COUNTERS.get(found[0], "") + " ", word)
    return _JOINT.sub(" ", _TOPIC.sub("わ", HAN.sub("", word))).strip()


#: What stands behind a number, as it is said.
_COUNTERS = dict(zip(
    "円年月日時分秒人個回度歳万億千百",
    "えん ねん がつ にち じ ふん びょう にん こ かい ど さい まん おく せん ひゃく".split()))
_COUNTED = re.compile(rf"(?<=\d){HAN.pattern}|(?<=\d[万億千百])円")
#: Where letters of the Latin alphabet and kana meet; and the particle of a topic, which is not the end of "haha".
_JOINT = re.compile("(?<=[A-Za-z])(?=[\u3041-\u30ff])|(?<=[\u3041-\u30ff])(?=[A-Za-z])")
_TOPIC = re.compile("(?<![はあ])は$")


@cache
def _tagger() -> Any:
    try:
        import fugashi

        return fugashi.Tagger()
    except (ImportError, RuntimeError):
        return None
