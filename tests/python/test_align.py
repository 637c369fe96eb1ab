"""labial align: times against those of the synthesiser that spoke, and sounds and texts that do not go together."""

from __future__ import annotations

import csv
import io
import os
import subprocess
import warnings
from pathlib import Path
from typing import List, Sequence, Tuple

import numpy as np
import pytest

pytest.importorskip("pocketsphinx")
soundfile = pytest.importorskip("soundfile")
pytest.importorskip("soxr")

from labial.__main__ import main  # noqa: E402
from labial.corpus.episode import Segment  # noqa: E402
from labial.corpus.phonesets import ARPABET  # noqa: E402
from labial.errors import DataError, LabialError  # noqa: E402
from labial.sound import align as module  # noqa: E402
from labial.sound.align import phrases_of, pronunciations  # noqa: E402
from labial.sound.recogniser import LONGEST_CLOSURE, Recogniser, with_silences  # noqa: E402
from labial.sound.samples import RATE, prepared, read_sound, silences  # noqa: E402
from models import write_wav  # noqa: E402
from test_speak import speak  # noqa: E402

#: What is spoken here; the first in sounds that show on lips, the second with stops behind pauses and between vowels.
TEXTS = ("My baby may be happy when we play by the pool.", "Put the butter on the table, and pour me a cup of coffee.",
         "Thank you very much for your visit, and have a pleasant journey home.")


@pytest.fixture(scope="module")
def recogniser() -> Recogniser:
    return Recogniser()


def opening(text: str) -> np.ndarray:
    """The lips' opening of frames as labial-say prints them."""
    return np.array([-float(row["fap51"]) - float(row["fap52"]) for row in csv.DictReader(io.StringIO(text))])


def say(lab: Path) -> np.ndarray:
    program = os.environ.get("LABIAL_SAY", "")
    if not program:
        pytest.skip("LABIAL_SAY does not name the built labial-say")
    done = subprocess.run([program, "--from", "lab"], input=lab.read_bytes(), capture_output=True, check=True)
    return opening(done.stdout.decode())


def speech(program: str, folder: Path, text: str, name: str = "a") -> Tuple[Path, np.ndarray]:
    """A sound file, and the opening of the synthesiser's own timings."""
    done = speak(program, str(folder / f"{name}.wav"), text)
    assert done.returncode == 0
    return folder / f"{name}.wav", opening(done.stdout.decode())


def correlation(one: np.ndarray, other: np.ndarray) -> float:
    count = min(len(one), len(other))
    assert abs(len(one) - len(other)) <= 2
    return float(np.corrcoef(one[:count], other[:count])[0, 1])


@pytest.mark.parametrize(("program", "median"), [("flite", 0.93), ("espeak", 0.88)])
def test_motion_is_that_of_the_true_times(program: str, median: float, tmp_path: Path) -> None:
    """Catches times that are shifted or of other words. Loudness in the place of phonemes correlates by .47."""
    found = []
    for text in TEXTS:
        sound, true = speech(program, tmp_path, text)
        assert main(["align", str(sound), "--text", text, "-o", str(tmp_path / "a.lab")]) == 0
        found.append(correlation(say(tmp_path / "a.lab"), true))
    assert np.median(found) >= median, found


def test_without_text(tmp_path: Path) -> None:
    """Catches a search that finds no words, and a word list that is left in the decoder by what was followed before."""
    sound, true = speech("flite", tmp_path, TEXTS[2])
    assert main(["align", str(sound), "-o", str(tmp_path / "a.lab")]) == 0
    assert correlation(say(tmp_path / "a.lab"), true) >= 0.8


@pytest.mark.slow
def test_long_sounds_go_piece_by_piece(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Catches words that are lost, said twice or shifted where pieces meet."""
    parts = [speech("flite", tmp_path, text, str(number))[0] for number, text in enumerate(TEXTS)]
    samples = np.concatenate([soundfile.read(part)[0] for part in parts] * 2)
    soundfile.write(tmp_path / "long.wav", samples, RATE)
    text = " ".join(TEXTS * 2)
    whole = module.aligned(tmp_path / "long.wav", text).segments
    told: List[Tuple[float, float]] = []
    monkeypatch.setattr(module, "LONGEST_PIECE", 6.0)
    monkeypatch.setattr(module, "OVERLAP", 1.5)
    cut = module.aligned(tmp_path / "long.wav", text, lambda done, length: told.append((done, length))).segments
    assert len(told) >= 4 and told[-1][0] == told[-1][1] == pytest.approx(len(samples) / RATE)
    moments = np.arange(0, told[-1][1], 0.01)
    at = [np.array([item.label for item in found])[np.searchsorted([item.end for item in found], moments)]
          for found in (whole, cut)]
    assert np.mean(at[0] == at[1]) > 0.95
    for found in (whole, cut):
        assert all(before.end == after.start for before, after in zip(found, found[1:])) and found[0].start == 0


def test_any_rate_and_channels(tmp_path: Path) -> None:
    sound, _ = speech("flite", tmp_path, TEXTS[0])
    samples, rate = soundfile.read(sound)
    times = np.arange(0, len(samples) / rate, 1 / 44100)
    raised = np.interp(times, np.arange(len(samples)) / rate, samples)
    soundfile.write(tmp_path / "b.flac", np.stack([raised, 0.5 * raised], axis=1), 44100)
    ends = []
    for path in (sound, tmp_path / "b.flac"):
        found = module.aligned(path, TEXTS[0]).segments
        ends.append([item.end for item in found if item.label != "SIL"])
    assert np.abs(np.array(ends[0]) - np.array(ends[1])).max() <= 0.03
    assert len(read_sound(tmp_path / "b.flac")) == pytest.approx(len(samples), abs=2)


def sounds(folder: Path) -> List[Path]:
    """Noise, music and silence, and 20 samples."""
    times = np.arange(5 * RATE) / RATE
    chord = sum(np.sin(2 * np.pi * tone * times) for tone in (220, 277, 330, 440)) * np.exp(-3 * (times % 0.5))
    made = {"noise": np.random.default_rng(0).normal(0, 0.1, 3 * RATE), "music": 0.1 * chord,
            "silence": np.zeros(3 * RATE), "click": np.full(20, 0.5)}
    for name, samples in made.items():
        soundfile.write(folder / f"{name}.wav", samples, RATE)
    return [folder / f"{name}.wav" for name in made]


@pytest.mark.slow
def test_what_is_no_speech_is_told(tmp_path: Path) -> None:
    """No crash, and a warning or an error, with a text and without."""
    for path in sounds(tmp_path):
        for text in (None, "Hello my friend."):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                try:
                    found = module.aligned(path, text).segments
                except DataError as error:
                    assert "does not fit" in str(error)
                    continue
            # What is wrong with the whole, with parts and with the text, where there is something to tell of these.
            assert 1 <= len(caught) <= 3, (path, text)
            assert all(str(path) in str(item.message) for item in caught), (path, text)
            assert found[0].start == 0 and found[-1].end == pytest.approx(len(read_sound(path)) / RATE)


@pytest.mark.slow
def test_text_of_another_sound(tmp_path: Path) -> None:
    sound, _ = speech("flite", tmp_path, TEXTS[0])
    for text in (TEXTS[2], "Hello."):
        with pytest.warns(UserWarning, match="does not fit the sound"):
            module.aligned(sound, text)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        module.aligned(sound, TEXTS[0])


@pytest.mark.parametrize("text", ["", " . , !", "it is 1984", "Привет"])
def test_texts_that_are_none(text: str, tmp_path: Path) -> None:
    soundfile.write(tmp_path / "a.wav", np.zeros(RATE), RATE)
    with pytest.raises(LabialError, match="text"):
        module.aligned(tmp_path / "a.wav", text)


def test_bad_files(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    (tmp_path / "text.wav").write_text("hello")
    soundfile.write(tmp_path / "empty.wav", np.zeros(0), RATE)
    soundfile.write(tmp_path / "nan.wav", np.array([0.1, np.nan]), RATE, subtype="FLOAT")
    for name in ("text.wav", "empty.wav", "nan.wav", "none.wav", "."):
        assert main(["align", str(tmp_path / name), "--text", "a"]) == 1
        lines = capsys.readouterr().err.splitlines()
        assert len(lines) == 1 and lines[0].startswith(f"labial: {tmp_path / name}: ")
    assert main(["align", str(tmp_path / "empty.wav"), "--text-file", str(tmp_path / "none")]) == 1


def test_text_file_and_words_that_are_guessed(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    write_wav(tmp_path / "a.wav", np.zeros(RATE), RATE)
    (tmp_path / "a.txt").write_text("\ufeffZyxxo\n", encoding="utf-8")
    assert main(["align", str(tmp_path / "a.wav"), "--text-file", str(tmp_path / "a.txt")]) in (0, 1)
    assert "spelt: zyxxo" in capsys.readouterr().err


# ---- Its steps -----------------------------------------------------------------------------------------------------


def test_silences_are_where_nothing_is_heard() -> None:
    samples = np.concatenate([np.zeros(1600), np.full(3200, 0.3), np.zeros(1120), np.full(1600, 0.3), np.zeros(3200)])
    assert np.array(silences(samples)) == pytest.approx(np.array([(0, 0.1), (0.47, 0.67)]))  # 70 ms are none
    assert silences(samples[:100]) == []
    assert np.abs(prepared(samples)).max() < 32767 and len(prepared(np.zeros(10))) == 10


def segments(*rows: Tuple[float, float, str]) -> List[Segment]:
    return [Segment(*row) for row in rows]


def told(found: Sequence[Segment]) -> List[Tuple[float, float, str]]:
    return [(round(item.start, 3), round(item.end, 3), item.label) for item in found]


@pytest.mark.parametrize(("given", "silent", "expected"), [
    # A pause that the recogniser gave to the phonemes beside it.
    ([(0, 0.6, "AA"), (0.6, 1, "M")], [(0.4, 0.6)], [(0, 0.4, "AA"), (0.4, 0.6, "SIL"), (0.6, 1, "M")]),
    ([(0, 0.4, "AA"), (0.4, 1, "M")], [(0.4, 0.6)], [(0, 0.4, "AA"), (0.4, 0.6, "SIL"), (0.6, 1, "M")]),
    # The silence before a stop is the stop's own, as far as a closure lasts.
    ([(0, 0.6, "AA"), (0.6, 1, "P")], [(0.5, 0.6)], [(0, 0.5, "AA"), (0.5, 1, "P")]),
    ([(0, 0.4, "AA"), (0.4, 1, "P")], [(0.3, 0.6)],
     [(0, 0.3, "AA"), (0.3, 0.6 - LONGEST_CLOSURE, "SIL"), (0.6 - LONGEST_CLOSURE, 1, "P")]),
    # A pause that is none.
    ([(0, 0.4, "AA"), (0.4, 0.6, "SIL"), (0.6, 1, "M")], [], [(0, 0.6, "AA"), (0.6, 1, "M")]),
    # Both ends of the sound.
    ([(0.1, 0.4, "AA"), (0.4, 0.9, "M")], [(0, 0.2), (0.8, 1)],
     [(0, 0.2, "SIL"), (0.2, 0.4, "AA"), (0.4, 0.8, "M"), (0.8, 1, "SIL")]),
])  # fmt: skip
def test_segments_are_brought_to_silences(given: list, silent: list, expected: list) -> None:
    assert told(with_silences(segments(*given), silent, 1.0)) == expected


def test_no_gap_whatever_the_silences() -> None:
    rng = np.random.default_rng(5)
    for _ in range(300):
        times = np.sort(rng.uniform(0, 3, 13))
        labels = rng.choice(["SIL", "P", "AA", "M", "K"], 12)
        edges = np.sort(rng.uniform(0, 3, 8)).reshape(4, 2)
        found = with_silences([Segment(a, b, str(label)) for a, b, label in zip(times, times[1:], labels)],
                              [(float(a), float(b)) for a, b in edges], 3.0)
        assert found[0].start == 0 and found[-1].end == 3.0
        assert all(a.end == b.start and a.end > a.start for a, b in zip(found, found[1:]))


def test_phrases_of_a_text() -> None:
    """At marks, in even parts where they are long."""
    assert phrases_of("Don\u2019t 'go', Zoë \u2014 my well-known friend!") == [
        ["don't", "go'"], ["zoe", "my", "well", "known", "friend"]]  # fmt: skip
    text = "Well, here we are now:\nthe quick brown fox jumps over the lazy dog. It's ten"
    assert phrases_of(text) == [["well"], ["here", "we", "are", "now"], ["the", "quick", "brown", "fox"],
                                ["jumps", "over", "the", "lazy", "dog"], ["it's", "ten"]]
    with pytest.raises(LabialError, match="'42'"):
        phrases_of("for 42 years")


def test_words_that_the_dictionary_lacks_are_read(recogniser: Recogniser) -> None:
    """By the library, whatever letters follow each other; what comes of it are phonemes that the models know."""
    found = pronunciations(["hello", "rainboat", "labial's"], recogniser.lookup)
    assert found == {"rainboat": "R EY N B OW T", "labial's": "L EY B IY AH L Z"}
    rng = np.random.default_rng(2)
    words = ["".join(rng.choice(list("abcdefghijklmnopqrstuvwxyz'"), rng.integers(1, 12))) for _ in range(300)]
    found = pronunciations(words, recogniser.lookup)
    assert found.keys() == {word for word in words if recogniser.lookup(word) is None}
    assert all(sounds and set(sounds.split()) <= set(ARPABET) for sounds in found.values())
    recogniser.learn(found)
    assert all(recogniser.lookup(word) == sounds for word, sounds in found.items())


def spoken(folder: Path) -> Path:
    """The three sentences in one file."""
    parts = [soundfile.read(speech("flite", folder, text, str(n))[0])[0] for n, text in enumerate(TEXTS)]
    soundfile.write(folder / "all.wav", np.concatenate(parts), RATE)
    return folder / "all.wav"


@pytest.mark.slow
def test_confidence_is_low_where_the_text_is_wrong(tmp_path: Path) -> None:
    """High all through where the text fits; low, and said, where it lacks sentences or has another one."""
    path = spoken(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        whole = module.aligned(path, " ".join(TEXTS))
    assert len(whole.stretches) >= 3 and min(item.confidence for item in whole.stretches) > 0.7
    other = "Nobody could ever guess which of those green windows had been shut."
    for text in (TEXTS[0], f"{TEXTS[0]} {other} {TEXTS[2]}"):
        with pytest.warns(UserWarning, match="low confidence from"):
            found = module.aligned(path, text)
        assert 0 <= min(item.confidence for item in found.stretches) < 0.6


@pytest.mark.slow
def test_what_the_text_lacks_is_heard(tmp_path: Path) -> None:
    """What is said and not in the text has the phonemes that are heard, with low confidence; what is in the text and
    not said is left out, wherever it is. Both failed, or smeared the words over the sound."""
    sound, true = speech("flite", tmp_path, " ".join(TEXTS))
    other = "Nobody could ever guess which of those green windows had been shut."
    for text, least in ((f"{' '.join(TEXTS[1:])} Zyxxo.", 0.7), (TEXTS[0], 0.7),
                        (f"{TEXTS[0]} {other} {TEXTS[2]}", 0.7),
                        (f"{TEXTS[0]} {other} {other} {' '.join(TEXTS[1:])}", 0.85)):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = module.aligned(sound, text)
        (tmp_path / "a.lab").write_text(found.lab())
        assert correlation(say(tmp_path / "a.lab"), true) >= least, text
        lacks = not all(item in text for item in TEXTS)
        assert (min(item.confidence for item in found.stretches) < 0.6) == lacks, text


def test_confidence_is_told(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """In the file, as comments that every reader passes over, and on the terminal."""
    path, lab = spoken(tmp_path), tmp_path / "a.lab"
    assert main(["align", str(path), "--text", " ".join(TEXTS), "-o", str(lab)]) == 0
    assert "all.wav: confidence 0." in capsys.readouterr().err
    rows = [line.split() for line in lab.read_text().splitlines() if line.startswith("# ")][1:]
    assert len(rows) >= 3 and all(0.6 < float(row[3]) <= 1 and float(row[1]) < float(row[2]) for row in rows)
    assert main(["timings", str(lab), "-o", str(tmp_path / "b.lab")]) == 0
    assert (tmp_path / "b.lab").read_text() == "".join(
        f"{line}\n" for line in lab.read_text().splitlines() if not line.startswith("#"))
    assert len(say(lab)) > 100


@pytest.mark.slow
def test_a_sentence_too_many_is_left_out(tmp_path: Path) -> None:
    """It failed the whole. What is there is aligned as without it."""
    path = spoken(tmp_path)
    expected = module.aligned(path, " ".join(TEXTS)).segments
    with pytest.warns(UserWarning, match="goes on behind the sound"):
        text = " ".join(TEXTS) + " And after that nobody ever came back to this house again."
        found = module.aligned(path, text).segments
    moments = np.arange(0, expected[-1].end, 0.01)
    at = [np.array([item.label for item in each])[np.searchsorted([item.end for item in each], moments)]
          for each in (expected, found)]
    assert np.mean(at[0] == at[1]) > 0.95
