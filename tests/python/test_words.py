"""How words sound: the trainer, the packed tables, and the C decoder against the exporter's reference."""

from __future__ import annotations

import os
import random
import subprocess
from pathlib import Path
from typing import Dict, List, Sequence, Tuple

import numpy as np
import pytest
import words as cases

from labial.__main__ import main
from labial.corpus.phonesets import ARPABET
from labial.errors import DataError, ModelError
from labial.words import alignment, dictionary, packing, tables, text, times, training
from labial.words.trees import Asked, answer, features
from packages import CC, SOURCE, needs_runtime

TRAINED = SOURCE / "export" / "models" / "words_en.npz"
SPOKEN = Path(__file__).with_name("spoken.tsv")
#: A dictionary of one's own, for all of its words: LABIAL_CMUDICT=cmudict.dict.
CMUDICT = os.environ.get("LABIAL_CMUDICT", "")


@pytest.fixture(scope="module")
def trained() -> tables.WordTables:
    return tables.load(TRAINED)


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A dictionary of 2,500 words, and of others with x, which is rare, as the trained tables read them, with a second
    pronunciation here and there."""
    path = tmp_path_factory.mktemp("dictionary") / "small.dict"
    found = tables.load(TRAINED)
    lines = ["# a comment", ";;; another one"]
    common = dictionary.read_common(dictionary.COMMON)
    for number, word in enumerate([*common[:2500], *(word for word in common[2500:] if "x" in word)]):
        heard = tables.names(tables.phonemes(found, word)).split()
        sounds = [label + "1" * (label in "AA AE IY OW UW") for label in heard]
        lines.append(f"{word} {' '.join(sounds)} # note")
        if number % 40 == 0:
            lines.append(f"{word}(2) {' '.join([*sounds[:-1], 'AH0'])}")
    path.write_text("\n".join(lines) + "\naaa T R IH P AH L EY\n3d TH R IY D IY\n", encoding="utf-8")
    return path


# ---- The dictionary


def test_a_dictionary_is_read(tmp_path: Path) -> None:
    """Stress, comments and numbers of variants are dropped, equal pronunciations are one, other characters are left."""
    path = tmp_path / "d"
    path.write_text("Read R IY1 D # the verb\nread(2) R EH1 D\nread(3) R EH0 D\n;;; x Y\no'clock AH0 K L AA1 K\n"
                    "b4 B IY\n")
    entries = dictionary.read_dictionary(path)
    assert [(entry.word, tables.names(entry.phonemes), entry.variant) for entry in entries] == [
        ("read", "R IY D", 0), ("read", "R EH D", 1), ("o'clock", "AH K L AA K", 0)]
    assert entries[2].letters == (15, 27, 3, 12, 15, 3, 11)


@pytest.mark.parametrize("content, problem", [
    ("a AH0\nb QQ1\n", ":2: 'QQ' is not a phoneme of ARPABET"), ("a AH0\nb\n", ":2: 'b' has 0 phonemes, not 1 to 64"),
    ("a " + "AH0 " * 65, ":1: 'a' has 65 phonemes"),
    ("4 F AO R\n", ": no word of the letters a to z")])
def test_a_damaged_dictionary_is_refused(tmp_path: Path, content: str, problem: str) -> None:
    path = tmp_path / "d"
    path.write_text(content)
    with pytest.raises(DataError, match=problem):
        dictionary.read_dictionary(path)


# ---- Training


def test_alignment_of_a_worked_example() -> None:
    """Two letters, of which one is silent behind the other: learnt from words where it is alone."""
    def entry(word: str, phonemes: str) -> dictionary.Entry:
        numbers = tuple(dictionary.PHONEMES.index(label) for label in phonemes.split())
        return dictionary.Entry(word, dictionary.letters_of(word), numbers, 0)

    words = [entry("mat", "M AE T"), entry("tam", "T AE M"), entry("mate", "M EY T"), entry("tax", "T AE K S"),
             entry("at", "AE T"), entry("ma", "M AE"), entry("a", "AE"), entry("t", "T")]  # fmt: skip
    probability = alignment.learn(words * 100)
    assert np.allclose(probability[1:].sum(axis=1)[[0, 4, 12, 19]], 1.0)
    sounds = alignment.align(words, probability)
    assert [alignment.phonemes_of(sound) for sound in sounds[2]] == [(22,), (13,), (31,), ()]  # M EY T, and silence
    assert [alignment.phonemes_of(sound) for sound in sounds[3]] == [(31,), (2,), (20, 29)]
    assert alignment.align([entry("a", "AE T M K S")], probability) == [None]
    assert alignment.align([entry("am", "AE T")], probability) == [None]
    loose = alignment.loosened(probability, [0, 31])
    assert alignment.align([entry("am", "AE T")], loose) == [(2, 31)]


def test_questions_of_all_letters_at_once_are_those_of_one(trained: tables.WordTables) -> None:
    """The answers that trees are grown by are those that they are read by."""
    asked = Asked(trained.sounds)
    numbers = random.Random(5)
    for word in ("strengths", "o'clock", "a", "queueing", "extraordinary"):
        letters = dictionary.letters_of(word)
        labels = [numbers.randrange(len(trained.sounds)) for _ in letters]
        for place in range(len(letters)):
            values = features(letters, place, labels)
            for question in range(400):
                expected = answer(question, values, trained.sounds)
                assert asked.yes[question, values[asked.feature[question]]] == expected, (word, place, question)


@pytest.mark.slow
def test_training_is_the_same_each_time(small: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The command from a dictionary to C: equal bytes, words that are read as the dictionary says, C that compiles."""
    for name in "ab":
        assert main(["train-words", str(small), "-o", str(tmp_path / f"{name}.npz"), "--leaves", "1200", "--exceptions",
                     "150", "--quiet"]) == 0
        assert main(["export", str(tmp_path / f"{name}.npz"), "--name", "mine", "-o", str(tmp_path / name)]) == 0
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    assert (tmp_path / "a/mine.c").read_bytes() == (tmp_path / "b/mine.c").read_bytes()
    assert "150 exceptions" in capsys.readouterr().out
    found = tables.load(tmp_path / "a.npz")
    assert found.leaves <= 1200 and len(found.exceptions) == 150
    known = dictionary.pronunciations(dictionary.read_dictionary(small))
    assert all(tables.phonemes(found, word) in known[word] for word in found.exceptions if word not in training.SOUNDS)
    assert training.score(found, known)["phonemes"] > 90.0
    (tmp_path / "main.c").write_text('#include "mine.h"\n'
                                     "int main(void) { return mine.format != LABIAL_WORDS_FORMAT; }\n")
    subprocess.run([CC, "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", f"-I{SOURCE / 'include'}",
                    f"-I{tmp_path / 'a'}", tmp_path / "main.c", tmp_path / "a/mine.c", "-o", tmp_path / "main"],
                   check=True)
    subprocess.run([tmp_path / "main"], check=True)


@pytest.mark.slow
def test_held_out_words_are_measured(small: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["train-words", str(small), "-o", str(tmp_path / "w.npz"), "--leaves", "800", "--exceptions", "0",
                 "--held-out"]) == 0
    line = capsys.readouterr().out.splitlines()[0]
    assert "held-out words: " in line and "viseme classes" in line
    share = float(line.split(": ")[1].split(" %")[0])
    assert 60.0 < share < 95.0  # of so few words


def test_errors_are_counted_against_the_nearest_pronunciation(trained: tables.WordTables) -> None:
    """Worked by hand: "go" is G OW. K looks like G, and the second pronunciation is nearer."""
    g, k, ow, s = (dictionary.PHONEMES.index(label) for label in ("G", "K", "OW", "S"))
    found = training.score(trained, {"go": [(s, s, s), (k, ow)]})
    assert found == {"words": 1.0, "phonemes": 50.0, "viseme classes": 100.0, "whole words": 0.0}


def test_sizes_that_cannot_be_are_no_trouble(small: Path) -> None:
    """More leaves than there are samples; a letter that does not occur."""
    entries = dictionary.read_dictionary(small)[:300] + dictionary.read_dictionary(small)[-1500:]
    found = training.train(entries, [], leaves=100_000, exceptions=0)
    assert found.leaves < 5000  # all that there are
    with pytest.raises(ModelError, match="no word of the dictionary that could be aligned has the letter"):
        training.train(entries[:3], [], leaves=10)


# ---- Files


def test_tables_survive_a_file(trained: tables.WordTables, tmp_path: Path) -> None:
    tables.save(trained, tmp_path / "w.npz")
    again = tables.load(tmp_path / "w.npz")
    assert again.exceptions == trained.exceptions and again.sounds == trained.sounds
    assert again.multiplier == trained.multiplier and np.array_equal(again.question, trained.question)
    assert tables.is_tables(TRAINED) and not tables.is_tables(TRAINED.with_name("speech_en.npz"))
    assert not tables.is_tables(tmp_path / "none.npz")


@pytest.mark.parametrize("name, change", [
    ("question", lambda a: a + 400), ("label", lambda a: a + 60), ("yes", lambda a: a * 0),
    ("first", lambda a: a[::-1]), ("sounds", lambda a: a * 0), ("multiplier", lambda a: a * 2),
    ("multiplier", lambda a: a[:0]),
    ("patch_count", lambda a: a[:-1]), ("patch_letter", lambda a: a + 40), ("patch_label", lambda a: a + 60),
    ("format", lambda a: a + 1),
    ("about", lambda a: a[:-1]), ("words", lambda a: a + 128), ("no", lambda a: a[:-3]),
    ("question", lambda a: a.reshape(1, -1))])
def test_damaged_tables_are_refused(tmp_path: Path, name: str, change) -> None:
    """A file in which any array is out of range is an error that names the file."""
    with np.load(TRAINED) as file:
        content = {key: file[key] for key in file.files}
    content[name] = change(content[name])
    np.savez_compressed(tmp_path / "w.npz", **content)
    with pytest.raises(ModelError, match=r"w\.npz: "):
        tables.load(tmp_path / "w.npz")


def test_files_that_are_no_tables_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "w.npz").write_bytes(b"PK")
    for path in (tmp_path / "w.npz", tmp_path / "none.npz", TRAINED.with_name("speech_en.npz")):
        with pytest.raises(ModelError, match="npz: "):
            tables.load(path)
    assert main(["export", str(TRAINED), "--name", "words", "-o", str(tmp_path / "o"), "--blob"]) == 1
    assert "are for models" in capsys.readouterr().err and not (tmp_path / "o").exists()


def test_bundled_tables_are_those_that_were_trained(tmp_path: Path, trained: tables.WordTables) -> None:
    """Catches tables that were trained anew and not exported, and a packing that changed under them."""
    packed = packing.pack(trained)
    for path in packing.write(packed, "words_en", tmp_path):
        assert path.read_bytes() == (SOURCE / "lib/words" / path.name).read_bytes(), "run labial export"
    assert packed.size < 40_000
    assert "Copyright (C) 1993-2015 Carnegie Mellon University" in (tmp_path / "words_en.c").read_text()


def one_tree(sounds: int, question: List[int], yes: List[int], no: List[int], label: List[int]) -> tables.WordTables:
    """Tables with this tree for the letter a and a single leaf for every other letter."""
    others, size = 26, len(question)
    return tables.WordTables(tuple(range(sounds)), np.array([0, *range(size, size + others + 1)]),
                             np.array(question + [-1] * others), np.array(yes + [0] * others),
                             np.array(no + [0] * others), np.array(label + [0] * others), {})


def grown(labels: List[int]) -> tables.WordTables:
    """Tables whose tree for a halves these labels until one is left."""
    nodes: List[List[int]] = []

    def add(part: List[int]) -> int:
        number = len(nodes)
        nodes.append([-1, 0, 0, part[0]])
        if len(part) > 1:
            half = len(part) // 2
            nodes[number][:3] = [number % 400, add(part[:half]), add(part[half:])]
        return number

    add(labels)
    return one_tree(max(labels) + 1, *([row[i] for row in nodes] for i in range(4)))


def test_packing_has_limits() -> None:
    """What the format cannot hold is refused: 33 labels of a letter, a part for yes of 8 KB; so are trees that no
    trainer makes."""
    assert len(packing.pack(grown(list(range(32)))).leaves) == 32 + 26
    with pytest.raises(ModelError, match="the letter a has 33 labels"):
        packing.pack(grown(list(range(33))))
    assert len(packing.pack(grown([0, 1] * 2048)).trees) > 8191
    with pytest.raises(ModelError, match="a part of the tree of a has"):
        packing.pack(grown([0, 1] * 4096))
    deep = [0, -1] * 300 + [-1]
    with pytest.raises(ModelError, match="too deep"):
        one_tree(1, deep, [i + 2 for i in range(601)], [i + 1 for i in range(601)], [0] * 601)
    with pytest.raises(ModelError, match="below two others"):
        one_tree(1, [0, -1], [1, 0], [1, 0], [0, 0])
    with pytest.raises(ModelError, match="belongs to no tree"):
        one_tree(1, [0, -1, -1, -1], [1, 0, 0, 0], [2, 0, 0, 0], [0] * 4)


# ---- The C decoder


def test_the_c_suite_knows_the_cases() -> None:
    """Catches tables or rules that changed and are not written for test_words.c: run tests/c/words.py then."""
    assert (SOURCE / "tests/c/words_cases.h").read_text(encoding="ascii") == cases.header()


Read = Tuple[str, Tuple[str, ...], Tuple[int, ...], int]


def in_c(given: Sequence[Sequence[str]]) -> List[List[Read]]:
    """How the library reads texts of words: kind, phonemes, their characters, phonemes that the word before loses."""
    from labial.core.words import Reader
    found = []
    for words in given:
        reader = Reader()
        found.append([(*spoken, dropped) for spoken, dropped in map(reader.read, words)])
    return found


def by_reference(found: tables.WordTables, given: Sequence[Sequence[str]]) -> List[List[Read]]:
    result = []
    for words in given:
        context, part = None, []
        for word in words:
            reading = text.read(found, word, context)
            context = reading.context
            part.append((reading.kind, tuple(dictionary.PHONEMES[p] for p, _, _ in reading.phonemes),
                         tuple(place for _, place, _ in reading.phonemes), context.dropped))
        result.append(part)
    return result


def spoken(found: tables.WordTables, said: str) -> str:
    """The phonemes of a text by the reference."""
    phonemes: List[int] = []
    context = None
    for word in said.split():
        reading = text.read(found, word, context)
        context = reading.context
        del phonemes[len(phonemes) - context.dropped :]
        phonemes += [phoneme for phoneme, _, _ in reading.phonemes]
    return tables.names(phonemes)


def test_texts_are_read_as_a_voice_reads_them(trained: tables.WordTables) -> None:
    """Dates, sums, times, units, addresses and initials, of which no more than one in a hundred may be wrong; and texts
    that were read wrongly once, of which none may be."""
    lines = [line.split("\t") for line in SPOKEN.read_text(encoding="utf-8").splitlines() if line and line[0] != "#"]
    wrong = [given for given, said in lines if spoken(trained, given) not in
             [tables.names([p for word in one.replace("_", " ").split() for p in tables.phonemes(trained, word)])
              for one in said.split(" | ")]]
    assert len(lines) > 320 and len(wrong) <= len(lines) // 100, wrong
    assert len(cases.REPORTED) > 60 and not set(wrong) & set(cases.REPORTED)


def test_letters_have_the_names_that_people_say(trained: tables.WordTables) -> None:
    """Each letter by its name in CMUdict, "double u" but for its stress."""
    names = ("EY|B IY|S IY|D IY|IY|EH F|JH IY|EY CH|AY|JH EY|K EY|EH L|EH M|EH N|OW|P IY|K Y UW|AA R|EH S|T IY|Y UW|"
             "V IY|D AH B AH L Y UW|EH K S|W AY|Z IY").split("|")
    for letter, name in zip("ABCDEFGHIJKLMNOPQRSTUVWXYZ", names):
        assert spoken(trained, f"{letter}.B.") == f"{name} B IY", letter


def test_capitals_of_words_are_words() -> None:
    """Common words that are written in capitals are not spelt, as in "STOP THAT"."""
    words = dictionary.read_common(dictionary.COMMON)
    common = [word.upper() for word in words if 3 <= len(word) <= 5 and word.isalpha()]
    spelt = [word for word in common if not (word in text._WORDS or text.is_pronounceable(word))]
    assert len(spelt) < len(common) // 100, spelt


@needs_runtime
def test_c_reads_words_as_the_reference_does(trained: tables.WordTables) -> None:
    """Common words, and all of a dictionary where one is given: every letter of every one."""
    given = dictionary.read_common(dictionary.COMMON)[::3]
    if CMUDICT:
        given = sorted({entry.word for entry in dictionary.read_dictionary(CMUDICT)})
    assert in_c([given]) == by_reference(trained, [given])


if CMUDICT:

    def test_bundled_tables_are_those_of_the_dictionary(tmp_path: Path) -> None:
        """Catches a trainer that changed under the tables."""
        assert main(["train-words", CMUDICT, "-o", str(tmp_path / "w.npz"), "--quiet"]) == 0
        again, known = tables.load(tmp_path / "w.npz"), tables.load(TRAINED)
        assert np.array_equal(again.question, known.question) and again.exceptions == known.exceptions


#: What rules tell apart: characters, and parts of words.
ALPHABET = ("abeigxyzAEIXYZTVUSmrstndhkKMBGCF0123456789012345..,,''-–--/:://&%@+=[]<>()**_  $€£¥₹¢°²½¼¾×÷−#\" "
            "éñÆßœŁ’Жﬁëïç中😀\u0301\u0308\u200b\u00a0Ａµ⅓¾³₂℃‘`‑~^;≥″")
PARTS = """1999 2005 1990s 80s 5 1 12 0 007 3:30 9:00 15:00 10:30:15 2024-03-05 3/5/2024 3/5/24 5.3.2024 1/2 3/4 5/12
    555-1234 1-800-555-0199 10-20 5'10 22nd $5 $1 $5.50 $0.99 $.50 $1.5 €20 ¥5.50 ₹1,000 5€ 50¢ $2M $10k $5/hour
    1,234,567 1,00 999,999,999,999,999 1234567890123456 million billion a.m. p.m. am PM o'clock km kg m s h GB km/h
    m² °C
    °F ° 5km 16GB 5M 2bn 6in 3A March May Jan. Sept. Tues FBI CIA VIP NASA STOP IT US WHO AM I A PhDs TVs FBI's CEOs
    U.S. e.g. i.e. Ph.D. www.example.com https://a.org/b-c_d info@b.io .com (sighs) (pause) (laughing (softly)
    *smiles* *leans in* *really* **bold** [tag] <break <b> x<3 -5 −5
    -$5 – - # #1 #tag ½ 3½ 3x4
    café Zoë Noël naïve ﬁn œuvre AT&T Q&A A+
    No. Nos. 21 2023/10/05 6ft 6 ft ft. in 1h 30m sq w/o w/ C# .5 16:9 9am-5pm 5km-10km (555) II viii tbsp Mar May A.
    MP3 4K ’s Mr. Dr St. approx. Wi-Fi jpeg 50% ... ! ? . , ; :
    Satu seat gates Apt. fig. and or 14C 5M SW1A F-16s 747s 120s St Ave ln Main Elm then Jan Mar. Mon Mon, Sat. Sun
    Mon-Sat Tue Monday 9-5 no. Nos. ca. Gen. Rep. IV XVI XX chapter ⅓ 2⅔ ⅝lb ℃ m³ x³ –5 H₂O don`t 10%-20%
    1920s-1930s N/A BYE façade 1-800-FLOWERS 1-80-A 1-A (crying) *grinning* 3rds 1/4 www.gate-x.org/Sat/5
    [Click here](a.b) ](a [1] ][2] [ ] ( ) " 24" ″ hahaha hehe p. ch. Op. est. in. call dial us +44 0800 7946 (800)
    9-1-1 1-1/2 -min -km - x ~ ^ > ≥ ≤ ≈ ± &amp; &#39; &quot; &lt; &nbsp; & ; Rs. $ € &mdash; 7:00-9:00 .NET
    2024-03-05T T09:30:00Z 10:00:00""".split()


@needs_runtime
def test_c_reads_any_text_as_the_reference_does(trained: tables.WordTables) -> None:
    """Texts of these, in any order, word by word or at once."""
    numbers = random.Random(7)
    given: List[List[str]] = []
    for number in range(900):
        words = []
        for _ in range(numbers.randint(1, 5)):
            if number % 2:
                length = numbers.randint(0, numbers.choice([3, 6, 12, 40, 300]))
                words.append("".join(numbers.choice(ALPHABET) for _ in range(length)))
            else:
                words.append("".join(numbers.choice(PARTS) for _ in range(numbers.choice([1, 1, 1, 2, 3]))))
        given.append(words if number % 3 else [" ".join(words)])
    assert in_c(given) == by_reference(trained, given)


@needs_runtime
def test_c_shares_time_as_the_reference_does(trained: tables.WordTables) -> None:
    """All but the last word of a sentence, which no pause follows; of texts that are read as one word."""
    from labial.core.words import WordStream

    read = {word: text.read(trained, word).phonemes for word in dictionary.read_common(dictionary.COMMON)[:800]}
    given = [word for word, phonemes in read.items() if len(word) > 1 and sum(first for _, _, first in phonemes) == 1
             and tuple(p for p, _, _ in phonemes) == tables.phonemes(trained, word)]
    numbers = random.Random(3)
    stream, moment, got, expected = WordStream(), 0, [], []
    for word in given:
        length = numbers.randint(200, 900)
        stream.push(word, moment, moment + length)
        got += stream.take()
        heard = tables.phonemes(trained, word)
        ends = times.ends(times.weights(heard, word == given[-1]), length)
        expected += [(dictionary.PHONEMES[p], end - start) for p, start, end in zip(heard, [0, *ends], ends)]
        moment += length
    stream.end()
    assert got + stream.take() == expected


def test_weights_are_worked_by_hand() -> None:
    """"tie" and "bat" before a pause."""
    number: Dict[str, int] = {label: place for place, label in enumerate(dictionary.PHONEMES)}
    tie = times.weights([number["T"], number["AY"]], False)
    assert tie[0] == 64 * 68 * 302 >> 8  # first
    ay = 64 * 146
    for factor in (269, 259, 259, 259):  # the only vowel, so in the last and the first syllable; at the word's end
        ay = ay * factor >> 8
    assert tie[1] == ay
    pause = times.weights([number["B"], number["AE"], number["T"]], True)
    assert pause[2] == (64 * 68 * 266 >> 8) * 410 >> 8  # last; behind the last vowel before a pause
    assert times.ends([1, 1, 2], 401) == [100, 201, 401]
    assert set(ARPABET) == set(dictionary.PHONEMES[1:])
