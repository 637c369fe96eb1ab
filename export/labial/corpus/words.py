"""Words and characters with their times to phonemes with theirs: English by the library's tables, other languages by
espeak-ng where it is installed.

Times are whole milliseconds from the beginning of the sound. A word that the caller pronounces otherwise comes before
everything else; then numbers, if they are to be written out by num2words; then the language.
"""

from __future__ import annotations

import logging
import re
import unicodedata
from itertools import accumulate
from typing import Container, Dict, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple, Union

from labial.core.words import CHARACTERS_MAX, PHONEMES_MAX, OwnWords, Spoken, WordStream, read, read_words
from labial.corpus import signs
from labial.corpus.languages import HAN, is_chinese, pronounced
from labial.errors import needs

_logger = logging.getLogger("labial")
#: The language of the library's tables.
ENGLISH = "en"
#: Latest time, milliseconds: the library counts in 32 bits.
LATEST = (1 << 32) - 2
#: What a text's words are looked up by: letters, digits and what may stand within a word; in other languages than
#: English signs, too.
_STRETCH = re.compile(r"[^\W_]+(?:['’\-.,][^\W_]+)*")
_SIGNED = re.compile(f"{signs.PATTERN}|{_STRETCH.pattern}")
_NUMBER = re.compile(r"-?\d+(?:,\d{3})*(?:\.\d+)?")
#: A number with blanks between its groups, each of these, and what is the number of a telephone rather.
_GROUPS = re.compile(r"(?<![\w.,])[1-9]\d{0,2}(?:[ \xa0\u2009\u202f]\d{3}){1,4}(?![ \xa0\u2009\u202f]?\d)")
_GROUP = re.compile(r"\d+")
_TELEPHONE = re.compile(r"\d{3}(?:\W\d{3}){2,}(?<!000)")
_GROUPED = re.compile(r"-?\d{1,3}(?:[.,]\d{3})+")
_TAGS = {"[": "]", "<": ">"}
#: The bracket of a link, [text](address) or [text][1], and what stands in it; a letter, which makes it a text that is
#: read.
_LINK = re.compile(r"\[(?=([^\[\]]*)\](?:\(|\[[0-9\]]))")
_LETTER = re.compile("[A-Za-z\x80-\U0010ffff]")
#: LABIAL_VOICE_LETTERS, characters of a word at most; and how many it has where another one of kana begins the next.
_LETTERS, _KANA_MOST = 60, 4
#: Where a word ends besides blanks: punctuation of Chinese and Japanese, and marks behind a script without blanks.
_BLANKS = frozenset("\u2014\u2015\u2025\u2026、。〈〉《》「」『』【】〔〕〖〗〘〙〚〛・！，：；？")
_STOPS = frozenset(",.!?:;")
_KANA = re.compile("[\u3041-\u30ff]")
_UNSPACED = re.compile(f"[\u0e01-\u0eff]|{_KANA.pattern}|{HAN.pattern}")
#: With what a word of kana goes on, also after so many; and vowels of Thai and Lao that begin a syllable.
_GOES_ON = frozenset("ぁぃぅぇぉすっゃゅょゎん\u3099\u309a\u309b\u309cゝゞゟァィゥェォスッャュョヮンーヹヺヽヾヿ")
_FIRST = frozenset("เแโใไເແໂໃໄ")


class Word(NamedTuple):
    """A word in time."""

    text: str
    start: int  #: milliseconds
    end: Optional[int]  #: None if unknown
    ends: Tuple[int, ...] = ()  #: of each character of the text, or none


class Pronunciation(NamedTuple):
    """How words are pronounced."""

    own: Mapping[str, Sequence[str]] = {}  #: word -> its phonemes in ARPABET
    language: str = ENGLISH  #: "en", or what espeak-ng calls a language or voice
    numbers: bool = False  #: digits are written out by num2words


def pronunciation(own: Optional[Mapping[str, Union[str, Sequence[str]]]] = None, language: str = ENGLISH,
                  numbers: bool = False) -> Pronunciation:
    """How words are pronounced, from arguments as callers have them: phonemes in one text, or a list; a language also
    as locales and services name it, "de_DE" and "en-US"."""
    language = re.sub("^([a-z]{2,3})_(?=[A-Z])", r"\1-", language)
    language = ENGLISH if language == "en-US" else language
    split = {word: sounds.split() if isinstance(sounds, str) else list(sounds) for word, sounds in (own or {}).items()}
    return Pronunciation(split, language, bool(numbers))


#: English, without words of one's own.
PLAIN = Pronunciation()


def phonemes_of(texts: Iterable[str], how: Pronunciation = PLAIN) -> List[Spoken]:
    """What words sound like. Raises LabialError for an unknown language or phoneme, and where a program or package that
    `how` asks for is not installed."""
    given = _written(list(texts), how.language)
    return read_words(given, own_words(given, how))


def timings_of(words: Sequence[Word], how: Pronunciation = PLAIN, offset: int = 0) -> List[Tuple[str, int]]:
    """The phonemes of words, in ARPABET with SIL for silence, and their milliseconds, from time 0 on. `offset`
    milliseconds are added to all times. Raises LabialError as :func:`phonemes_of`, and StreamError where a word ends
    before it begins, begins before an earlier one, or lasts more than an hour."""
    texts = _written([word.text for word in words], how.language)
    stream = WordStream(own_words(texts, how), offset)
    found: List[Tuple[str, int]] = []
    for text, word in zip(texts, words):
        if word.ends and len(text) == len(word.ends) <= CHARACTERS_MAX:
            stream.push_characters(text, word.start, word.ends)
        else:
            stream.push(text, word.start, word.end)
        found += stream.take()
    stream.end()
    return found + stream.take()


def words_of_characters(characters: Sequence[str], starts: Sequence[int], ends: Sequence[int],
                        language: str = ENGLISH) -> List[Word]:
    """The words of characters with their times: what stands between blanks, or where :func:`_ends` or :func:`_begins`
    says so, without [tags] and <tags>. A bracket that is not closed, or a link's, begins none. Each character of
    Chinese is a word. An item of several characters shares its time evenly among them. A character that ends before the
    one before it, as rounding and zero lengths make it, ends with that."""
    words: List[Word] = []
    text, start, times, closing = "", 0, [0], ""
    is_each = is_chinese(language)
    characters = _linked(characters, "")
    last = {mark: max((n for n, item in enumerate(characters) if mark in item), default=-1) for mark in _TAGS.values()}
    for number, (item, begin, end) in enumerate(zip([*characters, " "], [*starts, 0], [*ends, 0])):
        for place, character in enumerate(_whole(item), 1):
            mark = _TAGS.get(character, "")
            closing = closing or (mark if last.get(mark, -1) >= number else "")
            is_read = not closing and not _ends(text, character)
            if text and (not is_read or _begins(text, character) or is_each and HAN.search(text[-1] + character)):
                words.append(Word(text, start, times[-1], tuple(times[1:])))
                text = ""
            closing = "" if character == closing else closing
            if not is_read:
                continue
            if not text:
                start = begin + (end - begin) * (place - 1) // len(item)
                times = [start]
            text += character
            times.append(max(times[-1], begin + (end - begin) * place // len(item)))
    return words


def characters_apart(items: Iterable[Tuple[str, float, Optional[float]]]) -> List[Tuple[str, float, float]]:
    """The same for a voice, which is told characters one by one: with blanks of no length around those of Chinese."""
    found: List[Tuple[str, float, float]] = []
    before = ""
    for text, start, end in items:
        length = 0.0 if end is None else end - start
        for place, character in enumerate(text):
            begin, until = start + length * place / len(text), start + length * (place + 1) / len(text)
            if HAN.search(before + character):
                found.append((" ", begin, begin))
            found.append((character, begin, until))
            before = character
    return found


def _linked(items: Sequence[str], between: str) -> List[str]:
    """Parts of a text, which are as long afterwards: the brackets of links' texts are marks that are nothing, and those
    of other links as wide as ideographs, since the library knows what is silent behind them."""
    text = _LINK.sub(lambda link: "\u200b" if _LETTER.search(link[1]) else "\uff3b", between.join(items))
    return _cut(text, items, len(between))


def _cut(characters: Sequence[str], items: Sequence[str], gap: int) -> List[str]:
    """What has become of the characters of items, between which a gap is."""
    ends = accumulate(len(item) + gap for item in items)
    return ["".join(characters[end - gap - len(item) : end - gap]) for item, end in zip(items, ends)]


def _written(words: Sequence[str], language: str) -> List[str]:
    """Words without the brackets of links; in other languages than English a group of a number such as 12 500 is what
    it stands for, 12000 500, so that espeak-ng says no zeros."""
    found = _linked(words, " ")
    if language == ENGLISH:
        return found
    text = " ".join(found)
    parts = list(text)
    for number in _GROUPS.finditer(text):
        if not _TELEPHONE.fullmatch(number[0]):
            for group in _GROUP.finditer(text, number.start(), number.end()):
                zeros = "0" * (3 * ((number.end() - group.end()) // 4))
                kept = str(int(group[0])) + zeros if int(group[0]) else ""
                parts[group.start() : group.end()] = [kept, *[""] * (len(group[0]) - 1)]
    return _cut(parts, found, 1)


def words_of(text: str) -> List[str]:
    """The words of a text, as in :func:`words_of_characters`, and its tags; the last is empty if it cannot go on."""
    words = [""]
    for character in _whole(text):
        if _ends(words[-1], character):
            words.append("")
        else:
            words += [""] * _begins(words[-1], character)
            words[-1] += character
    return [*filter(None, words[:-1]), words[-1]]


def _whole(text: str) -> str:
    """A text as the library is given it: half surrogates have no UTF-8."""
    return text.encode("utf-8", "replace").decode("utf-8")


def _ends(word: str, character: str) -> bool:
    """Whether a word ends at a character, which belongs to none."""
    is_stop = character in _STOPS and bool(_UNSPACED.match(word[-1:]))
    return is_stop or character.isspace() or character in _BLANKS


def _begins(word: str, character: str) -> bool:
    """Whether a character begins another word, though no blank stands before it: where a word of Japanese probably
    ends, before Han or katakana behind hiragana; where kana go on for long; before a vowel that is written first in its
    syllable; and where the word is too long."""
    last = word[-1:]
    if not last or len(word) >= _LETTERS or character in _FIRST:
        return bool(last)
    if not _KANA.match(last) or character in _GOES_ON:
        return False
    is_kana = bool(_KANA.match(character))
    if last < "\u30a0" and (HAN.match(character) or (is_kana and character > "\u30a0")):
        return True
    return len(word) >= _KANA_MOST and is_kana


def own_words(texts: Iterable[str], how: Pronunciation) -> OwnWords:
    """What the library is told of the words of these texts."""
    return OwnWords(known_words(texts, how))


def known_words(texts: Iterable[str], how: Pronunciation) -> Dict[str, Sequence[str]]:
    """The phonemes of the caller's own words and, from these texts, of those that the library does not read itself."""
    known: Dict[str, Sequence[str]] = {}
    stretches = stretches_of(texts, how.own, how.language)
    if how.numbers:
        known = _numbers(stretches, how)
    if how.language != ENGLISH:
        asked = [item for item in stretches if item not in known]
        for word, phonemes in zip(asked, pronounced(asked, how.language)):
            if phonemes is not None or not re.search(r"[^\W_]", word):  # a sign that is not said is not English
                known[word] = phonemes or ()
    for word, sounds in known.items():
        if len(sounds) > PHONEMES_MAX:
            _logger.warning("%.40r has %d phonemes: the lips move for the first %d", word, len(sounds), PHONEMES_MAX)
            known[word] = sounds[:PHONEMES_MAX]
    return {**how.own, **longest_first(known)}


def longest_first(known: Mapping[str, Sequence[str]]) -> Dict[str, Sequence[str]]:
    """Words in the order in which the library looks for them: "20%" is not "20"."""
    return {word: known[word] for word in sorted(known, key=len, reverse=True)}


def stretches_of(texts: Iterable[str], known: Container[str], language: str) -> List[str]:
    """What these texts' words are looked up by, without those that are known."""
    pattern, found = _STRETCH if language == ENGLISH else _SIGNED, []
    for text in texts:
        # Marks and joiners belong to the letter before them: without them Hindi falls apart.
        plain = "".join("x" if unicodedata.category(character)[0] == "M" or character in "\u200c\u200d" else character
                        for character in text)
        found += [text[item.start() : item.end()] for item in pattern.finditer(plain)]
    return list(dict.fromkeys(item for item in found if item not in known))


def _numbers(stretches: Iterable[str], how: Pronunciation) -> Dict[str, Sequence[str]]:
    """The phonemes of the numbers among these stretches, without those that num2words cannot write."""
    with needs("numbers in words", "numbers"):
        import num2words  # noqa: F401
    known: Dict[str, Sequence[str]] = {}
    is_english = how.language == ENGLISH
    for item in stretches:
        text = item if is_english else signs.worded(item, how.language)
        digits = re.search(r"-?\d[\d.,]*", text)
        if not digits or not signs.NUMBER.fullmatch(item) or not _NUMBER.fullmatch(digits[0]) or (
                not is_english and _GROUPED.fullmatch(digits[0])):  # 3,500 or 3.500: espeak-ng knows which
            continue
        written = _written_out(digits[0], how.language)
        if written is not None:
            words = f"{text[: digits.start()]} {written} {text[digits.end() :]}".split()
            said = [read(word).phonemes for word in words] if is_english else pronounced(words, how.language)
            known[item] = [phoneme for found in said for phoneme in found or ()]
    return known


def _written_out(digits: str, language: str) -> Optional[str]:
    """A number in words, a year from 1100 to 2099; None for a language or a size that num2words does not know."""
    from num2words import num2words

    plain = digits.replace(",", "")
    is_year = digits == plain and re.fullmatch(r"1[1-9]\d\d|20\d\d", plain)
    try:
        value = float(plain) if "." in plain else int(plain)
        text = str(num2words(value, lang=language, to="year" if is_year else "cardinal"))
    except (NotImplementedError, OverflowError, ValueError):
        if language not in _unwritten:
            _unwritten.add(language)
            _logger.warning("num2words cannot write %.40r in the language %r: such digits are read as without "
                            "numbers=True", digits, language)
        return None
    return re.sub(r"\band\b", " ", text) if language == ENGLISH else text


#: Languages in which a number was not written out, which is logged once.
_unwritten: Set[str] = set()
