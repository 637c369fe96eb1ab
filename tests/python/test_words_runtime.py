"""The Python interface of words: texts, words with times, characters with times, other languages, numbers; and words in
the npm packages, which must be the same phonemes at the same times, also of what services tell of them."""

from __future__ import annotations

import json
import random
import re
import shutil
import sys
import unicodedata
import warnings
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Dict, List, Optional, Tuple

import pytest

import labial
from labial.core import espeak
from labial.corpus import languages
from labial.corpus import words as spoken
from labial.corpus.formats import read_timings
from labial.corpus.words import PLAIN, Pronunciation, Word, pronunciation, timings_of, words_of_characters
from labial.errors import DataError, LabialError, StreamError
from messages import NAMES, PIECES, SAMPLES, drawn_messages
from npm import answered
from packages import SOURCE, needs_runtime
from test_npm import MALFORMED, drawn_json

pytestmark = needs_runtime
needs_espeak = pytest.mark.skipif(not shutil.which("espeak-ng"), reason="no espeak-ng: install the Debian package")


def total(timings: List[Tuple[str, int]]) -> int:
    return sum(milliseconds for _, milliseconds in timings)


def test_a_text_becomes_phonemes() -> None:
    assert labial.phonemes("Hello, world! 😀 [sighs]") == "HH EH L OW W ER L D".split()
    assert labial.phonemes("") == [] and labial.phonemes("Привет") == []
    with pytest.raises(TypeError, match="a text is a str"):
        labial.phonemes(7)  # type: ignore[arg-type]


def test_own_words_come_first() -> None:
    assert labial.phonemes("Kokoro!", own={"kokoro": "K OW K AO R OW"}) == "K OW K AO R OW".split()
    assert labial.phonemes("Zed’s", own={"Zed’s": ["Z", "EH", "D", "Z"]}) == ["Z", "EH", "D", "Z"]
    for own, problem in (({"a": "QQ"}, "'a': 'QQ' is no phoneme of ARPABET"), ({"a": ["AA"] * 97}, "97 phonemes")):
        with pytest.raises(LabialError, match=problem):
            labial.phonemes("a", own=own)
    many = {f"w{number}": "AA" for number in range(70_000)}
    with pytest.raises(LabialError, match="more than 65535"):
        labial.phonemes("a", own=many)


def test_seconds_are_told() -> None:
    """Catches a warning where times are milliseconds, and none where they are seconds."""
    with pytest.warns(UserWarning, match="no duration is longer than 0.3 ms: they are milliseconds"):
        labial.word_timings([("Mama", 0.0, 0.3), ("may", 0.3, 0.5)])
    with pytest.warns(UserWarning, match="milliseconds, not seconds"):
        labial.word_timings([("one", 0.1, None), ("two", 0.4, None)])
    with pytest.warns(UserWarning, match="no duration is longer than 0.2 ms"):
        labial.character_timings("ab", [0.0, 0.2], [0.2, 0.3])
    with pytest.warns(UserWarning, match="no duration is longer than 0.25 ms"):
        labial.render([("M", 0.07), ("AA", 0.25)])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        labial.word_timings([("Mama", 0, 300), ("may", 300, 301)])
        labial.word_timings([])
        labial.character_timings("", [], [])
        labial.render([("M", 4), ("AA", 5)])
        labial.render([])


def test_words_with_times_become_timings() -> None:
    """Silence until the first word; a gap under 150 ms belongs to the word before it, a longer one is silence."""
    timings = labial.word_timings([("Mama", 200, 500), ("may", 600.4, 800), ("go.", 1000, 1300)])
    assert timings[0] == ("SIL", 200) and total(timings) == 1300
    assert [label for label, _ in timings] == "SIL M AA M AH M EY SIL G OW".split()
    ends = [sum(ms for _, ms in timings[: n + 1]) for n in range(len(timings))]
    assert ends[4] == 600 and ends[6] == 800 and ends[7] == 1000
    assert len(labial.render(timings, exact=True)) == 65


@pytest.mark.parametrize("given, problem", [
    ([("a", 200, 100)], "'?a'?: a word or a character ends before it begins"),
    ([("a", 200, 300), ("b", 100, 300)], "begins before an earlier one"),
    ([("a", 0, 3_600_001)], "exceeds LABIAL_DURATION_MAX"), ([("a", -1, 2)], "-1 ms is no time"),
    ([("a", float("nan"), 2)], "nan ms is no time"), ([("a", 0, float("inf"))], "inf ms is no time")])
def test_times_that_cannot_be_are_errors(given: list, problem: str) -> None:
    with pytest.raises(LabialError, match=problem):
        labial.word_timings(given)


def test_wrong_types_are_errors() -> None:
    for given, problem in ((["word"], "word 1 is no text"), ([("word", 1)], "word 1 is no text"),
                           ([(1, 1, 2)], "word 1 is no text"), ([("a", "1", 2)], "a time is a number")):
        with pytest.raises(TypeError, match=problem):
            labial.word_timings(given)  # type: ignore[arg-type]
    with pytest.raises(LabialError, match="an offset of inf ms"):
        labial.word_timings([("a", 1, 20)], offset_ms=float("inf"))


def test_characters_with_times_become_timings() -> None:
    """Equal characters tell nothing of the phonemes; a long one makes its phoneme longer; tags are left out."""
    text = "Hi <b>there</b> [laughs out loud] you"
    even = labial.character_timings(text, [50 * i for i in range(len(text))], [50 * i + 50 for i in range(len(text))])
    words = labial.word_timings([("Hi", 0, 100), ("there", 300, 550), ("you", 1700, 1850)])
    assert even == words
    slow = labial.character_timings(["m", "y"], [0, 300], [300, 400])
    assert total(slow) == 400 and slow[0][1] > labial.word_timings([("my", 0, 400)])[0][1] + 50
    with pytest.raises(LabialError, match="2 characters have 1 beginnings and 2 ends"):
        labial.character_timings("my", [0], [1, 2])


def test_characters_become_words() -> None:
    """Items of several characters share their time, one that ends early ends with the one before; blanks and tags end
    words."""
    found = words_of_characters(["a", "bc", " ", "[x y]", "d", "e", "\n"], [0, 10, 50, 60, 70, 80, 90],
                                [10, 50, 60, 70, 80, 75, 99])
    assert found == [Word("abc", 0, 50, (10, 30, 50)), Word("de", 70, 80, (80, 80))]
    assert words_of_characters([], [], []) == []
    assert words_of_characters(["[", "a", "]"], [0, 1, 2], [1, 2, 3]) == []
    links = "go [by bus](a.b) [1](c) [2][3] [é][4] on"
    timings = labial.character_timings(links, *([50 * i + n for i in range(len(links))] for n in (0, 50)))
    assert [label for label, _ in timings if label != "SIL"] == labial.phonemes("go by bus é on")
    hearts = words_of_characters(list("a <3 [b"), list(range(7)), list(range(1, 8)))
    assert [word.text for word in hearts] == ["a", "<3", "[b"]
    long = timings_of([Word("a" * 300, 0, 900, tuple(3 * i + 3 for i in range(300)))])  # more than the library reads
    assert total(long) == 900


#: Texts of scripts without blanks, and their words: where they end, and where one of Japanese or a syllable of Thai
#: probably begins. tests/c/test_voice.c and tests/npm/words.test.mjs have some of them as well.
UNSPACED = [
    ("妈妈爸爸，朋友们……好——吗？「是」。", "妈妈爸爸|朋友们|好|吗|是"),
    ("你好,世界.再见!好吗?是:的;A,B", "你好|世界|再见|好吗|是|的|A,B"),
    ("今日は新聞を読みました。", "今日は|新聞を|読みまし|た"),
    ("コンピューターをつかってしゃっきんです", "コンピュー|ターをつ|かってしゃっ|きんです"),
    ("すごーいね・ァかヽかか゛か", "すごーい|ね|ァかヽか|か゛か"),
    ("แม่และพ่อไปซื้อปลา, ດີເດັກ!ก", "แม่|และพ่อ|ไปซื้อปลา|ດີ|ເດັກ|ก"),
    ("वह घर,गया 엄마와!아빠", "वह|घर,गया|엄마와!아빠"), ("o" * 130, f"{'o' * 60}|{'o' * 60}|{'o' * 10}"),
]  # fmt: skip


@pytest.mark.parametrize("text, words", UNSPACED)
def test_words_of_scripts_without_blanks(text: str, words: str) -> None:
    """Each with its own characters' times; a text without times has the same words."""
    found = words_of_characters(list(text), list(range(len(text))), list(range(1, len(text) + 1)))
    assert "|".join(word.text for word in found) == words == "|".join(filter(None, spoken.words_of(text)))
    for word in found:
        assert text[word.start : word.end] == word.text and word.ends == tuple(range(word.start + 1, word.end + 1))


def test_each_character_of_chinese_is_a_word() -> None:
    """For a voice as well, which gets blanks between them."""
    times = ([0, 100, 300, 400, 500], [100, 300, 400, 500, 600])
    for language in ("cmn", "zh-TW", "yue", "zh-HK"):
        found = words_of_characters(["我", "用PY", "写", "，", "吧"], *times, language=language)
        assert [(word.text, word.start, word.end) for word in found] == [
            ("我", 0, 100), ("用", 100, 166), ("PY", 166, 300), ("写", 300, 400), ("吧", 500, 600)]  # fmt: skip
    assert [word.text for word in words_of_characters(["我", "用PY", "写", "，", "吧"], *times, language="ja")] == [
        "我用PY写", "吧"]  # fmt: skip
    assert spoken.characters_apart([("我们", 1.0, 2.0), ("P", 2.0, None)]) == [
        (" ", 1.0, 1.0), ("我", 1.0, 1.5), (" ", 1.5, 1.5), ("们", 1.5, 2.0), (" ", 2.0, 2.0),
        ("P", 2.0, 2.0)]  # fmt: skip


@needs_espeak
def test_long_texts_are_not_cut(caplog: pytest.LogCaptureFixture) -> None:
    """A word of the library's has 96 phonemes at most: it says where words of others have more."""
    for text, language in (("妈妈爸爸明天不跑步，朋友们买苹果和面包。", "cmn"), ("ままとぱぱはぱんをたべます。", "ja")):
        one = labial.phonemes(text, language=language)
        assert labial.phonemes(text * 20, language=language) == one * 20
    assert not caplog.records
    timings = labial.word_timings([("妈" * 60, 0, 9000)], language="cmn")
    assert len(timings) == 96
    assert [message[40:] for message in caplog.messages] == [" has 120 phonemes: the lips move for the first 96"]


@needs_espeak
def test_other_languages_are_espeaks() -> None:
    """German, Russian and British words, as phonemes of English; own words and silent ones come first."""
    assert labial.phonemes("Mama", language="de") == ["M", "AA", "M", "AA"]
    assert labial.phonemes("Привет, мама", language="ru")[-4:-1] == ["M", "AA", "M"]
    assert labial.phonemes("bad - lot ... pub", language="en-gb")[0] == "B"
    assert labial.phonemes("Mama", language="de", own={"Mama": "P AA"}) == ["P", "AA"]
    timings = labial.word_timings([("Guten", 0, 300), ("Tag!", 300, 600)], language="de")
    assert total(timings) == 600 and timings[0][0] == "G"
    assert labial.phonemes("Mama", language="de_DE") == labial.phonemes("Mama", language="de")
    assert labial.phonemes("Mother's", language="en_US") == labial.phonemes("Mother's", language="en")
    with pytest.raises(LabialError, match="espeak-ng cannot speak 'xx-none'"):
        labial.phonemes("a", language="xx-none")
    with pytest.raises(LabialError, match="espeak-ng cannot speak 'xx-none'"):
        labial.Voice(language="xx-none")


VOWELS = "AA AE AH AO AW AY EH ER EY IH IY OW OY UH UW".split()
#: The sentences of docs/words.md, with their syllables and p, b, m.
SENTENCES = re.findall(r"^\| \w[^|]* \| `([\w-]+)` \| ([^|]+) \| (\d+) \| (\d+) \|$",
                       (SOURCE / "docs" / "words.md").read_text(encoding="utf-8"), re.MULTILINE)
assert len({language for language, *_ in SENTENCES}) >= 15


@needs_espeak
@pytest.mark.parametrize("language, sentence, syllables, closures", SENTENCES, ids=[item[0] for item in SENTENCES])
def test_languages_have_their_syllables_and_closures(language: str, sentence: str, syllables: str,
                                                     closures: str) -> None:
    """As many as a speaker hears, also where letters and marks come apart or words come one by one."""
    for text in (sentence, unicodedata.normalize("NFD", sentence)):
        found = labial.phonemes(text, language=language)
        assert sum(item in VOWELS for item in found) == int(syllables), found
        assert sum(item in ("P", "B", "M") for item in found) == int(closures), found
    words = [(word, 300.0 * n, 300.0 * n + 300) for n, word in enumerate(sentence.split())]
    timed = [label for label, _ in labial.word_timings(words, language=language) if label != "SIL"]
    assert timed == labial.phonemes(sentence, language=language)


@needs_espeak
def test_words_keep_their_phonemes_at_the_punctuation_of_their_script() -> None:
    """Words that touch it are those that are looked up, without it."""
    for language, text in (("hi", "प्रेम।"), ("mr", "प्रेम।"), ("ne", "प्रेम॥"), ("bn", "প্রেম।"), ("pa", "ਪਿਆਰ।"),
                           ("ar", "سلام،"), ("ar", "سلام؟"), ("fa", "سلام؛"), ("ur", "ہیں۔"), ("hy", "Հայ։"),
                           ("am", "ሰላም።"), ("my", "မြန်မာ။"), ("my", "မြန်မာ၊"), ("el", "γεια\u037e")):
        found = labial.phonemes(text, language=language)
        assert found and found == labial.phonemes(text[:-1], language=language), (language, text)


#: By what they show: language, text and phonemes.
SAID = {
    "Words of one letter, which espeak-ng alone calls e agudo, y grecque or ess": [
        ("pt-br", "é", "EH"), ("pt-br", "à", "AE"), ("fr", "y", "IY"), ("pl", "w", "F"), ("cs", "s", "S"),
        ("ru", "в", "V"), ("el", "η", "IY"), ("it", "è", "EH"), ("de", "q", "K UW")],
    "The n of Japanese: before p, b and m lips close; before vowels, w, y and h they do not round": [
        ("ja", "がんばる", "G AE M B AE L UH"), ("ja", "えんぴつ", "EH M P IY S UH"), ("ja", "さんま", "S AE M M AE"),
        ("ja", "ほんや", "HH OW NG Y AE"), ("ja", "でんわ", "D EH NG W AE"), ("ja", "パン", "P AE NG")],
    "は behind a word is wa; kana behind Latin letters are kana, where espeak-ng says Japanese letter": [
        ("ja", "こんにちは", "K OW N N IY CH IY W AE"), ("ja", "これは", "K OW L EH W AE"),
        ("ja", "はは", "HH AE HH AE"), ("ja", "OKです", "OW K EY D EH S"), ("ja", "Tシャツ", "T IY SH AE S UH")],
    "Pinyin, with tones as digits or marks, and words of several syllables": [
        ("zh", text, "N IY HH AW JH UH NG G W AO N UW")
        for text in ("ni3 hao3 zhong1guo2 nv3", "nǐ hǎo zhōngguó nǚ", "nihao Zhongguo nü")],
    "Chinese that is no Cantonese": [
        (language, "你好 媽媽", "N IY HH AW M AA M AA") for language in ("zh-TW", "zh-Hans", "cmn")],
    "Signs": [
        ("ja", "％", "P AE S EH N T OW"), ("fr", "5 €", "S EH K AH G OW"), ("ru", "№ 5", "N OW M EH L P AE T"),
        ("de", "5 $", "F UW N F D AO L AA"), ("en-gb", "€3", "TH R IY Y UH R OW Z")],
}  # fmt: skip


@needs_espeak
@pytest.mark.parametrize("shown", SAID)
def test_what_is_said_in_other_languages(shown: str) -> None:
    for language, text, phonemes in SAID[shown]:
        for form in (text, unicodedata.normalize("NFD", text)):
            assert labial.phonemes(form, language=language) == phonemes.split(), (language, text)


@needs_espeak
def test_parts_of_what_is_said_in_other_languages() -> None:
    assert labial.phonemes("O dia é", language="pt-br")[::4] == ["UH", "EH"]
    for language, text in (("hi", "चाँद जान छत झंडा"), ("mr", "चाँद छत झंडा"), ("ne", "चाँद जान छत झंडा"),
                           ("ur", "چاند جان چھت"), ("bn", "চাঁদ জান ছাতা ঝড়"), ("pa", "ਚੰਦ ਜਾਨ ਛੱਤ"), ("gu", "ચાંદ જાન છત")):
        for word in text.split():
            assert labial.phonemes(word, language=language)[0] in ("CH", "JH"), (language, word)
    assert labial.phonemes("gyár tyúk", language="hu")[::3] == ["G", "K"], "where they are the palatal stops they seem"
    assert labial.phonemes("20%", language="hi")[-7:] == "P AH T IH SH AH T".split()
    assert labial.phonemes("£5.50", language="en-gb")[-4:] == "P AW N D".split()
    assert labial.phonemes("20% (10-20)", language="de", own={"20%": "P"})[0] == "P"


@needs_espeak
def test_signs_are_said_in_the_language(caplog: pytest.LogCaptureFixture) -> None:
    """As its words are, with the number they stand at; what is said of none is silent, and logged once."""
    for language, text, same in (
            ("de", "20 %", "20 Prozent"), ("de", "20%", "20 Prozent"), ("de", "５％", "5 Prozent"),
            ("de", "5 €", "5 Euro"), ("de", "5,50 €", "5,50 Euro"), ("de", "$5", "5 $"), ("de", "A & B", "A und B"),
            ("de", "20 °C", "20 Grad C"), ("de", "20°C", "20 Grad C"), ("de", "20℃", "20 Grad C"),
            ("de", "−5", "minus 5"), ("de", "1+1=2", "1 plus 1 gleich 2"), ("fr", "5€", "5 €"), ("ru", "№5", "№ 5"),
            ("fr", "-5", "moins 5"), ("es", "5 €", "5 euro"), ("es", "20%", "20 porciento"),
            ("ru", "500 ₽", "500 рублей"), ("hi", "₹500", "500 रुपये"), ("hi", "500 ₹", "500 रुपये"),
            ("cmn", "20%", "百分之二十"), ("cmn", "$5", "五美元"), ("cmn", "20℃", "二十摄氏度"),
            ("ja", "¥500", "500 えん"), ("ko", "5 €", "5 유로"),
            ("ko", "5€입니다", "5 유로 입니다"), ("ko", "25°C입니다", "25 도 입니다"), ("ja", "25℃です", "25 ど です"),
            ("de", "3.10.2024", "3 10 2024"), ("fr", "14h30", "14 heures 30"), ("pt-br", "14h", "14 horas"),
            ("de", "14h", "14 h"), ("pt-br", "R$ 5", "reais 5"), ("fr", "1 000 amis", "1000 amis"),
            ("de", "10\u202f000 Amis", "10000 Amis"), ("pl", "(2 000 500,5)", "2000000 500,5"),
            ("es", "612 345 678", "612, 345, 678"), ("fr", "5 123 45", "5, 123, 45"),
            ("fr", "[1 000 amis](a.b)", "1000 amis")):
        assert labial.phonemes(text, language=language) == labial.phonemes(same, language=language), (language, text)
    thousand = [Word("2", 0, 300, (300,)), Word("000", 300, 600, (400, 500, 600))]
    spoken = timings_of(thousand, pronunciation(language="fr"))
    assert [label for label, _ in spoken] == labial.phonemes("2000", language="fr")
    assert not caplog.records
    for _ in range(2):
        assert labial.phonemes("5 ₽", language="fr") == labial.phonemes("5", language="fr")
    assert caplog.messages == ["espeak-ng cannot speak '₽' in the language 'fr': it is silent"]


@needs_espeak
def test_numbers_of_chinese() -> None:
    """As numbers; years, long ones and those that begin with 0 digit by digit. Tones of pinyin are not said."""
    for digits, spoken_so in {
            "0": "零", "5": "五", "10": "十", "15": "十五", "20": "二十", "105": "一百零五", "110": "一百一十",
            "1005": "一千零五", "1984": "一九八四", "2024": "二零二四", "2100": "二千一百", "10000": "一万",
            "10050": "一万零五十", "105000": "十万五千",
            "1234567": "一百二十三万四千五百六十七", "100000001": "一亿零一",
            "1000000000000": "一万亿", "007": "零零七", "3,500": "三千五百",
            "1,234,567": "一百二十三万四千五百六十七", "3.14": "三点一四", "１２": "十二",
            "12345678901234567": "一二三四五六七八九零一二三四五六七"}.items():  # fmt: skip
        assert labial.phonemes(digits, language="cmn") == labial.phonemes(spoken_so, language="cmn"), digits
    assert labial.phonemes("第3", language="cmn") == labial.phonemes("第三", language="cmn")
    assert labial.phonemes("ni3hao3", language="cmn") == "N IY HH AW".split()


@needs_espeak
def test_kanji_become_kana(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    """By fugashi, for which a stand-in has what it says; without it kana alone are spoken, and kanji alone logged."""
    said = {"私は": ("ワタクシ", "ワ"), "話します": ("ハナシ", "マス")}

    def tagger(text: str) -> List[SimpleNamespace]:
        return [SimpleNamespace(surface="", feature=SimpleNamespace(pron=kana, kana=kana)) for kana in said[text]]

    monkeypatch.setattr(languages, "_tagger", lambda: tagger)
    assert labial.phonemes("私は話します", language="ja") == "W AE T AE SH IY W AE HH AE N AE SH IY M AE S".split()
    monkeypatch.setattr(languages, "_tagger", lambda: None)
    assert labial.phonemes("話します", language="ja") == "SH IY M AE S".split()
    assert labial.phonemes("3時に10万円世界", language="ja") == labial.phonemes("3じ に10まん えん", language="ja")
    assert labial.phonemes("世界", language="ja") == []
    assert "kanji need fugashi: pip install '.[japanese]'" in caplog.text


@needs_espeak
def test_chinese_of_hong_kong_is_cantonese() -> None:
    for language in ("zh-yue", "zh-HK", "zh-Hant-MO"):
        assert labial.phonemes("你好 媽媽", language=language) == labial.phonemes("你好 媽媽", language="yue")
        assert languages.speakable("你好", f"{language}+f3") == ("你好", "yue+f3")
    assert labial.phonemes("Labial", language="zh") == labial.phonemes("Labial")


@needs_espeak
def test_words_that_cannot_be_spoken_are_said_once(monkeypatch: pytest.MonkeyPatch,
                                                   caplog: pytest.LogCaptureFixture) -> None:
    """They move the lips for their time, as words of other scripts do."""
    monkeypatch.setattr(languages, "_ipa", lambda texts, language: ["_" for _ in texts])
    for _ in range(2):
        assert labial.word_timings([("מהמה", 0, 300)], language="he") == labial.word_timings([("מהמה", 0, 300)])
    assert [record.getMessage() for record in caplog.records] == [
        "espeak-ng cannot speak 'מהמה' in the language 'he': the lips move for its time alone"]


@pytest.fixture
def no_library(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(*_: object) -> None:
        raise LabialError("no library")

    monkeypatch.setattr(espeak, "library", missing)


@needs_espeak
def test_espeaks_program_takes_the_place_of_its_library(request: pytest.FixtureRequest) -> None:
    by_library = labial.phonemes("Guten Tag, Bücher", language="de")
    request.getfixturevalue("no_library")
    assert labial.phonemes("Guten Tag, Bücher", language="de") == by_library


def test_languages_that_cannot_be_had_are_errors(no_library: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda _: None)
    with pytest.raises(LabialError, match="needs espeak-ng: apt-get install"):
        labial.phonemes("a", language="de")
    monkeypatch.setattr(shutil, "which", lambda _: "/bin/false")
    with pytest.raises(LabialError, match="is no language of espeak-ng"):
        labial.phonemes("a", language="-v")


def test_numbers_are_written_out(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    """By num2words, for which a stand-in records what it is asked; what it cannot write is logged once."""
    asked = []
    monkeypatch.setattr(spoken, "_unwritten", set())

    class Stub:
        @staticmethod
        def num2words(value: float, lang: str, to: str) -> str:
            asked.append((value, lang, to))
            if value == 13:
                raise NotImplementedError
            return "one hundred and one"

    monkeypatch.setitem(sys.modules, "num2words", Stub)
    got = labial.phonemes("In 1984, 101 or 2,300.5", numbers=True)
    assert asked == [(1984, "en", "year"), (101, "en", "cardinal"), (2300.5, "en", "cardinal")]
    words = labial.phonemes("one hundred one")
    assert got == [*labial.phonemes("in"), *words, *words, *labial.phonemes("or"), *words]
    assert labial.phonemes("2024-05-03 1,5", numbers=True) == labial.phonemes("2024-05-03 1,5") and len(asked) == 3
    for _ in range(2):  # a stream goes on
        assert labial.phonemes("13", numbers=True) == labial.phonemes("13")
    assert caplog.messages == ["num2words cannot write '13' in the language 'en': such digits are read as without "
                               "numbers=True"]
    monkeypatch.setitem(sys.modules, "num2words", None)
    with pytest.raises(LabialError, match="numbers in words needs"):
        labial.Voice(numbers=True)
    with pytest.raises(LabialError, match=r"numbers in words needs the package num2words: pip install '\.\[numbers\]'"):
        labial.phonemes("101", numbers=True)


@needs_espeak
def test_numbers_are_written_out_with_their_signs(monkeypatch: pytest.MonkeyPatch) -> None:
    """In other languages; where num2words does not know one, espeak-ng reads the digits."""

    class Stub:
        @staticmethod
        def num2words(value: float, lang: str, to: str) -> str:
            if lang == "hi":
                raise NotImplementedError
            assert value in (-25, 25)
            return "minus zwei" if value < 0 else "zwei"

    monkeypatch.setitem(sys.modules, "num2words", Stub)
    monkeypatch.setattr(spoken, "_unwritten", set())
    for text, same in (("$25", "zwei $"), ("25 %", "zwei Prozent"), ("25%", "zwei Prozent"), ("-25", "minus zwei"),
                       ("25", "zwei"), ("2,5 %", "2,5 Prozent"), ("2.500", "2500"), ("2,500", "2 Komma 5 null null")):
        assert labial.phonemes(text, language="de", numbers=True) == labial.phonemes(same, language="de"), text
    with labial.Voice(language="hi", numbers=True) as voice:
        voice.say("25", 0.1, 0.6)
        assert len(voice.played(0.5)) == 26
    assert labial.phonemes("25", language="hi", numbers=True) == labial.phonemes("25", language="hi")


def test_a_refused_word_is_named() -> None:
    with pytest.raises(StreamError, match="^over: "):
        timings_of([Word("over", 5, 4)], Pronunciation())
    assert spoken.PLAIN.language == "en"


# ---- Words in the npm packages against the exporter ------------------------------------------------------------------


OWN: Dict[str, Any] = {"kokoro": "K OW K AO R OW", "it's": ["IH", "T", "S"], "Zürich": "Z UH R IH K", "go": ""}


#: Each call by its name with its arguments: what it makes of them, or the sentence of its error.
CALL = """
const words = await labial.words();
answer(given.map(([name, ...rest]) => {
    try {
        return words[name](...rest);
    } catch (error) {
        if (error.name !== "LabialError" || error.message.includes("\\n")) throw error;
        return error.message;
    }
}));
"""
Rows = List[Tuple[float, float, str]]


def rows(found: List[Dict[str, Any]]) -> Rows:
    assert all(item["labels"] == "arpabet" for item in found)
    return [(item["start"], item["end"], item["label"]) for item in found]


def timed(timings: List[Tuple[str, int]]) -> Rows:
    """Python's phonemes and milliseconds as segments."""
    found, moment = [], 0
    for label, length in timings:
        found.append((moment / 1000, (moment + length) / 1000, "" if label == "SIL" else label))
        moment += length
    return found


def text_of(rng: random.Random) -> str:
    return "".join(rng.choice(PIECES) + rng.choice(["", " ", " ", "\n"]) for _ in range(rng.randrange(1, 8)))


def test_texts(tmp_path: Path) -> None:
    """Would catch tables of another build, and letters of any script that JavaScript passes on otherwise."""
    rng = random.Random(7)
    common = (Path(labial.__file__).parent / "words" / "common.txt").read_text(encoding="utf-8").splitlines()
    texts = [" ".join(line for line in common if line[:1].isalpha())] + [text_of(rng) for _ in range(300)]
    calls = [["phonemes", text, {"own": OWN} if number % 3 == 0 else {}] for number, text in enumerate(texts)]
    found = answered(CALL, calls, tmp_path)
    assert found == [labial.phonemes(text, own=OWN if number % 3 == 0 else None) for number, text in enumerate(texts)]
    assert len(found[0]) > 20000


def drawn_words(rng: random.Random) -> Tuple[List[Tuple[str, int, Optional[int]]], int]:
    """Words, mostly in order, with gaps, overlaps and unknown ends; and an offset."""
    found: List[Tuple[str, int, Optional[int]]] = []
    moment = 0
    for _ in range(rng.randrange(1, 12)):
        moment += rng.choice([0, 0, 40, 149, 150, 151, 700, -1 if rng.random() < 0.03 else 0])
        length = rng.choice([0, 3, 90, 320, 800, 3_600_001 if rng.random() < 0.02 else 200])
        found.append((rng.choice(PIECES), max(0, moment), rng.choice([max(0, moment) + length, None])))
        moment += rng.choice([length, length // 2])
    return found, rng.choice([0, 0, 35, -120, -5000])


def test_words_and_characters_with_times(tmp_path: Path) -> None:
    """Would catch another rounding, a gap or an end that is treated otherwise, and an error on one side alone."""
    rng = random.Random(8)
    calls: List[Any] = []
    wanted: List[Any] = []

    def add(call: List[Any], how: Dict[str, Any], make: Any) -> None:
        calls.append([*call, {"own": how["own"], "offset": how["offset_ms"] / 1000}])
        try:
            wanted.append(timed(make(**how)))
        except LabialError as error:
            wanted.append(str(error))

    for number in range(400):
        words, offset = drawn_words(rng)
        how = {"own": OWN if number % 2 else None, "offset_ms": offset}
        add(["wordTimings", [{"text": text, "start": start / 1000, "end": None if end is None else end / 1000}
                             for text, start, end in words]], how, lambda w=words, **how: labial.word_timings(w, **how))
        text = text_of(rng)
        items = [text[place : place + size] for size in [rng.choice([1, 1, 3])] for place in range(0, len(text), size)]
        steps = [rng.choice([30, 30, 70, 0, -20]) for _ in items]
        starts = [max(0, sum(steps[:place])) for place in range(len(items))]
        ends = [max(0, start + step) for start, step in zip(starts, steps)]
        add(["characterTimings", items, [t / 1000 for t in starts], [t / 1000 for t in ends]], how,
            lambda a=items, b=starts, c=ends, **how: labial.character_timings(a, b, c, **how))
    found = answered(CALL, calls, tmp_path)
    for call, one, other in zip(calls, found, wanted):
        assert isinstance(one, str) if isinstance(other, str) else rows(one) == other, call
    assert 10 < sum(isinstance(one, str) for one in wanted) < 200


def by_python(folder: Path, text: str, form: Optional[str], how: Pronunciation, offset: float) -> Any:
    path = folder / "a"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        return [(item.start, item.end, item.label, "" if item.labels == "auto" else item.labels)
                for item in read_timings(path, form, how, offset)]
    except DataError as error:
        return str(error)


def assert_alike(
    folder: Path, cases: List[Tuple[Optional[str], str]], own: Any = None, offset: float = 0.0
) -> List[Any]:
    """Reads each text, as JavaScript and Python do, in a format, or in the one that its content tells."""
    options = [{**({} if form is None else {"format": form}), "own": own, "offset": offset} for form, _ in cases]
    calls = [["read", text, option] for (_, text), option in zip(cases, options)]
    wanted = [by_python(folder, text, form, pronunciation(own) if own else PLAIN, offset) for form, text in cases]
    for case, found, other in zip(cases, answered(CALL, calls, folder / "npm"), wanted):
        if isinstance(other, str) or isinstance(found, str):
            assert isinstance(found, str) and isinstance(other, str), (case, found, other)
        else:
            segments = [(item["start"], item["end"], item["label"], item.get("labels", "")) for item in found]
            assert segments == other, case
    return wanted


def test_samples_of_services(tmp_path: Path) -> None:
    """Every sample, told by its content; text that is no JSON as well. Would catch a service taken for another."""
    cases = [(None, sample.text) for sample in SAMPLES.values()]
    cases += [(None, "0 .1 sil\n.1 .3 m\n"), ("lab", "0 .1 sil\n"), (None, "{}"), (None, "[]"), (None, "nothing")]
    wanted = assert_alike(tmp_path, cases)
    assert len(cases) > 24 and sum(isinstance(one, str) for one in wanted) == 3
    assert_alike(tmp_path, cases, {"maybe": "P AA"}, -0.2)


def test_drawn_messages(tmp_path: Path) -> None:
    """Would catch rules that agree on the samples alone: where messages join, what is left out, spellings, errors."""
    rng = random.Random(9)
    drawn = [drawn_messages(rng) for _ in range(600)]
    cases = [(service if number % 3 else None, text) for number, (service, text) in enumerate(drawn)]
    wanted = assert_alike(tmp_path, cases, OWN, 0.03)
    read = {service for (service, _), one in zip(drawn, wanted) if not isinstance(one, str)}
    assert read == set(NAMES) and 40 < sum(isinstance(one, str) for one in wanted) < 400
    others = [drawn_json(rng)[1] for _ in range(150)]
    assert_alike(tmp_path, [(None, text) for text in others])


def test_malformed_messages(tmp_path: Path) -> None:
    """Would catch what one side refuses and the other one reads."""
    cases = [(None, text if isinstance(text, str) else json.dumps(text)) for _, text in MALFORMED]
    cases += [(name, json.dumps(text)) for name in NAMES for text in ({}, [], [1], None, [[]], {"alignment": 3})]
    assert_alike(tmp_path, cases)
