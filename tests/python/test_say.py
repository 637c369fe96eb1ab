"""labial-say from outside: text in, frames out; and what all programs have in common. Environment variables such as
LABIAL_SAY hold their paths.

What lines of timings mean and which are refused is the library's; test_timings.py and tests/c/test_timings.c have it.
"""

from __future__ import annotations

import os
import subprocess
import threading
from itertools import accumulate
from pathlib import Path
from typing import Callable, Dict, List, Tuple

import numpy as np
import pytest

import labial
from labial.__main__ import main
from labial.corpus.timings import read_segments
from labial.errors import DataError
from labial.see.motion import read_bands
from models import lab
from packages import SOURCE, needs_runtime
from test_hearing import voice
from test_timings import PHRASE, SEEDS, SENTENCE

HEADER = "time,fap3,fap16,fap17,fap51,fap52,fap53,fap54,fap55,fap56,fap57,fap58,fap59,fap60"
FORMATS = {".psdur": "flite", ".pho": "pho", ".realised_durations": "mary", ".phseg": "phseg", ".TextGrid": "textgrid"}
TEXT = lab(PHRASE)


def command(name: str, *arguments: str) -> List[str]:
    """A program with arguments; skips where it is not built."""
    variable = name.upper().replace("-", "_")
    if not os.environ.get(variable):
        pytest.skip(f"{variable} does not name the built {name}")
    return [os.environ[variable], *arguments]


def run(name: str, *arguments: str, data: bytes = b"") -> subprocess.CompletedProcess:
    return subprocess.run(command(name, *arguments), input=data, capture_output=True, timeout=60, check=False)


def say(text: str | bytes, *options: str) -> subprocess.CompletedProcess:
    """Runs labial-say on `text`."""
    return run("labial-say", *options, data=text if isinstance(text, bytes) else text.encode())


def motion(text: str | bytes, *options: str) -> List[List[str]]:
    """The rows of the CSV that labial-say makes of `text`, without the header."""
    done = say(text, *options)
    assert done.returncode == 0, done.stderr
    assert done.stderr == b""
    header, *lines = done.stdout.decode().splitlines()
    assert header == HEADER
    return [line.split(",") for line in lines]


@pytest.mark.parametrize("name", SENTENCE)
def test_one_sentence_in_every_format(name: str) -> None:
    """Catches a unit, an inclusive end, a tier or a phone set that is misread, and a format taken for another."""
    data = (SEEDS / name).read_bytes()
    expected = motion(TEXT)
    assert len({tuple(row[1:]) for row in expected}) > 20, "a mouth that does not move proves nothing"
    assert motion(data) == expected
    named = "htk" if name in ("htk.lab", "hts.lab") else FORMATS.get(Path(name).suffix, "lab")
    assert motion(data, "--from", named) == expected


@pytest.mark.parametrize("name", ["sentence.pho", "aligned.TextGrid"])
def test_utf_16_is_read(name: str) -> None:
    """Catches half a character that is lost; tests/grammar has line ends and the mark of UTF-8."""
    text = (SEEDS / name).read_text(encoding="utf-8")
    for encoding in ("utf-16-le", "utf-16-be"):
        assert motion(f"\ufeff{text}".encode(encoding)) == motion(text)


def test_a_tier_is_taken_by_name() -> None:
    """Catches a tier that is not the one asked for, and a wish that is passed over in silence."""
    grid = (SEEDS / "aligned.TextGrid").read_text(encoding="utf-8")
    assert motion(grid, "--tier", "phones") == motion(grid)
    done = say(grid, "--tier", "words")
    assert done.returncode == 0 and b"no phoneme '\"baby\"'" in done.stderr
    done = say(grid, "--tier", "letters")
    assert done.returncode == 1 and done.stderr == b"labial-say: line 69: there is no interval tier 'letters'\n"


def test_totals_are_exact() -> None:
    """Durations are not rounded one by one: 1,000 times 10.4 ms are 10.4 s, not 10."""
    labels = ["aa" if i % 2 else "b" for i in range(1000)]
    for text in ("".join(f"{label} 10.4\n" for label in labels),
                 " ".join(f"{label}:{(i + 1) * 0.0104:.4f}" for i, label in enumerate(labels)),
                 "".join(f"{i * 0.0104:.4f} {(i + 1) * 0.0104:.4f} {label}\n" for i, label in enumerate(labels))):
        assert len(motion(text, "--exact")) == 520


@pytest.mark.parametrize(("seconds", "told"), [(3590, False), (3610, True)])
def test_motion_of_hours_is_told(seconds: int, told: bool) -> None:
    """Would catch a program that works for minutes on a small file and does not say why."""
    done = say(f"0 1800 SIL\n1800 {seconds} SIL\n")
    assert done.returncode == 0
    assert (b"the motion lasts for more than an hour" in done.stderr) == told


@pytest.mark.parametrize(("text", "line", "told"), [
    ("0.0 0.2 sil\n\n0.4 0.3 b\n", 3, "0.4"), ("_ 100\nb 3600001\n", 2, "hour"),
    ("pau:0.1 <laugh 4000>\n", 1, "hour"), ("_ 100\nb\x1b[31m 20\n", 2, "0x1b"),
])
def test_malformed_lines_are_named(text: str, line: int, told: str) -> None:
    """An error says the line and what is wrong with it, the exit status is 1, and no part of a file is written."""
    done = say(text, "--to", "fap")
    message = done.stderr.decode()
    assert done.returncode == 1 and done.stdout == b""
    assert message.startswith(f"labial-say: line {line}: ") and message.count("\n") == 1
    assert told in message


@pytest.mark.parametrize(("text", "line"), [("pau:0.1 xyzzy:0.2\n", 1), ("_ 9\nxyzzy 9\n", 2)])
def test_unknown_labels_are_named_once(text: str, line: int) -> None:
    """A label that the model does not know moves as the nearest, and is named in one warning, whatever the format."""
    done = say(text + text)
    assert done.returncode == 0
    assert done.stderr.decode() == (
        f"labial-say: warning: line {line}: speech_en has no phoneme 'xyzzy', which moves as K\n")
    assert done.stdout == say((text + text).replace("xyzzy", "k")).stdout


SHORT = "every sound is shorter than 5 ms"


@pytest.mark.parametrize(("text", "asked"), [
    ("0 12 sil\n12 30 b\n30 50 aa\n", "line 2: 'b' lasts 18 s"),
    ("_ 90000\nb 10001\nb 10001\n", "line 2: 'b' lasts 10 s"),
    ("pau:12.0 b:22.0\n", ""), ("_ 90\nm .08\n", SHORT), ("_ 90\nm 4\na 4.4\n", SHORT), ("m 4\na 5\n", ""),
    ("_ 4\n", ""), ("<laugh:1> 2\n", ""),
])
def test_times_of_another_unit_are_asked_about(text: str, asked: str) -> None:
    """The first sound that is too long for speech is named, or that all are too short; no silences, no laughs."""
    done = say(text)
    assert done.returncode == 0
    assert done.stderr.decode() == (f"labial-say: warning: {asked}: is the unit of time right?\n" if asked else "")


@pytest.mark.parametrize("text", ["", "\n", " \r\n\n", "; nothing\n"])
def test_empty_input_is_an_error(text: str, tmp_path: Path) -> None:
    """Catches a motion of no frames that nobody notices; the exporter says the same."""
    done = say(text)
    assert done.returncode == 1 and done.stderr == b"labial-say: no segments\n"
    path = tmp_path / "empty.lab"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(DataError, match=f"^{path}: no segments$"):
        read_segments(path)


@pytest.mark.parametrize("wrong", [
    b"\xe9", b"\xff", b"\x80", b"\xc1\x81", b"\xe0\x80\x81", b"\xed\xa0\x80", b"\xf4\x90\x80\x80",
    b"\xf0\x8f\xbf\xbf", b"\xf5", b"\xe2\x82", b"\xc3",
])
def test_other_encodings_are_refused_with_their_line(wrong: bytes, tmp_path: Path) -> None:
    """Latin-1, and forms that UTF-8 forbids; the exporter names the same line."""
    text = "0 0.1 \u0259\n0.1 0.2 \uffff\U00010000\n".encode() + b"0.2 0.3 a" + wrong + b"\n0.3 0.4 b\n"
    done = say(text)
    assert done.returncode == 1 and done.stderr.splitlines()[-1] == b"labial-say: line 3: not UTF-8 text"
    path = tmp_path / "other.lab"
    path.write_bytes(text)
    with pytest.raises(DataError, match=f"^{path}:3: not UTF-8 text$"):
        read_segments(path)


def test_articulation_is_the_streams() -> None:
    """Half of every frame, and nothing at 0, but for FAP 17, which follows from the corners."""
    plain, half, still = ([int(value) for row in motion(TEXT, "--articulation", percent)
                           for value in [*row[1:3], *row[4:]]] for percent in ("100", "50", "0"))
    assert max(plain) > 200 and all(abs(a - b / 2) <= 1 for a, b in zip(half, plain)) and not any(still)


def test_laughter() -> None:
    """The other model has other phonemes, and says so."""
    text = "0 0.1 silence\n0.1 0.2 a\n0.2 0.3 fricative\n0.3 0.4 a\n"
    assert len(motion(text, "--model=laughter_synthetic", "--exact")) == 20
    done = say("0 0.1 ey\n", "--model", "laughter_synthetic")
    assert done.returncode == 0 and b"laughter_synthetic has no phoneme 'ey', which moves as e" in done.stderr


@pytest.mark.parametrize("data", [b"\xff\xfea", b"\xfe\xff\xd8\x00\x00a", b"\xff\xfe\x00\xdc", b"\xff\xfe\x3d\xd8",
                                  b"\xff\xfe\x00\x00", b"\xef\xbb"])
def test_broken_encodings_are_errors(data: bytes) -> None:
    """Catches half characters of UTF-16 that become labels."""
    done = say(data)
    assert done.returncode == 1 and done.stderr.startswith(b"labial-say: line 1: ")


def test_labels_are_read_as_the_format_means_them() -> None:
    """Catches X-SAMPA's S and N read as ARPABET's in a format of X-SAMPA, or the other way round."""
    phrase = [("a", 100), ("S", 90), ("N", 100), ("i", 100)]
    sampa = motion("a 100\nS 90\nN 100\ni 100\n")
    assert sampa == motion(lab([("AE", 100), ("SH", 90), ("NG", 100), ("IY", 100)]))
    assert motion(lab(phrase), "--labels=xsampa") == sampa != motion(lab(phrase))
    assert motion("pau 100\nay 90\n") == motion(lab([("pau", 100), ("ay", 90)])), "what is no X-SAMPA is any set's"


def jaw(rows: List[List[str]], start: float, end: float) -> List[int]:
    """FAP 3 between two times."""
    return [int(row[1]) for row in rows if start <= float(row[0]) < end]


def openings(values: List[int]) -> int:
    """How often the jaw opens past the middle of its range, which is 0 when it hardly moves."""
    middle = (min(values) + max(values)) / 2
    return sum(a < middle <= b for a, b in zip(values, values[1:])) if max(values) - min(values) > 40 else 0


@pytest.mark.parametrize(("text", "start"), [
    ("<laugh 2.0>\npau:0.200 m:0.300 ay:0.500\n", 0.0), ("_ 200\n<laugh:0.7> 2000\nm 100\nAI 200\n", 0.2),
])
def test_laughs_take_their_time(text: str, start: float) -> None:
    """Catches a laugh that is not one, takes another time than its two seconds, or does not shift what follows."""
    rows = motion(text)
    assert len(rows) == 50 * 2.5 + 12 and rows[: len(rows) - 12] == motion(text, "--exact")
    assert openings(jaw(rows, start, start + 2)) >= 3, "pulses every 210 ms open the jaw"
    silent = motion(lab([("SIL", 2500)]))
    assert openings(jaw(silent, start + 0.4, start + 2)) == 0, "once the mouth has come to rest"
    assert motion(text) == rows


def test_intensity_of_laughs() -> None:
    """Catches an intensity that is not passed on, another default, and a toy that always laughs the same laugh."""
    texts = {name: motion(f"pau:0.1 {name} pau:0.2\n") for name in
             ("<laugh 4>", "<laugh 4 0.5>", "<laugh 4 1>", "<laugh 4 0>", "<laugh 4.0 0.500>")}
    assert texts["<laugh 4>"] == texts["<laugh 4 0.5>"] == texts["<laugh 4.0 0.500>"]
    assert texts["<laugh 4 0>"] != texts["<laugh 4 0.5>"] != texts["<laugh 4 1>"]
    assert sum(jaw(texts["<laugh 4 0>"], 0, 9)) < sum(jaw(texts["<laugh 4 1>"], 0, 9))
    rows = motion("<laugh:0.5> 2000\n_ 1000\n<laugh:0.5> 2000\n_ 1000\n")
    assert jaw(rows, 0.5, 1.5) != jaw(rows, 3.5, 4.5)


def test_a_label_means_what_its_set_means() -> None:
    """Catches an option that changes nothing, and a set that takes another one's labels without a word."""
    rows = lab([("sil", 100), ("y", 150), ("th", 90), ("sil", 100)])
    assert motion(rows, "--labels", "ipa") == motion(rows.replace("y", "uw").replace("th", "t"))
    assert motion(rows, "--labels", "arpabet") == motion(rows, "--labels", "auto") == motion(rows)
    for labels, label in (("ipa", "hh"), ("ipa", "2"), ("ipa", "ʲ"), ("ipa", "@"), ("arpabet", "ə"), ("xsampa", "ʃ"),
                          ("auto", "2"), ("auto", "ː")):
        done = say(lab([("sil", 100), (label, 100), ("sil", 100)]), "--labels", labels)
        assert done.returncode == 0 and f"no phoneme '{label}'" in done.stderr.decode(), (labels, label)
    assert say(rows, "--labels", "sampa").returncode == 2


def test_the_exporter_reads_labels_as_labial_say_does(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Catches a set of labels that only one of the two knows, and an option of `labial` that is not handed on."""
    model, phones = SOURCE / "export/models/speech_en.npz", tmp_path / "a.lab"
    phones.write_text("0 0.1 sil\n0.1 0.3 y\n0.3 0.4 sil\n", encoding="utf-8")
    moved = {}
    for labels in ("auto", "arpabet", "ipa", "xsampa"):
        assert main(["synth", str(model), str(phones), "--labels", labels]) == 0
        moved[labels] = capsys.readouterr().out
    assert moved["auto"] == moved["arpabet"] != moved["ipa"] == moved["xsampa"]
    assert [band.label for band in read_bands(phones, "ipa")] == ["SIL", "UW", "SIL"]
    assert [band.label for band in read_bands(phones)] == ["SIL", "Y", "SIL"]


# ---- What it has in common with labial-hear, labial-say-flite and labial-say-espeak ----------------------------------

SOUND = voice(0.7).astype("<i2").tobytes()
PHRASES = " ".join(f"{label}:{end / 1000:.3f}" for (label, _), end in
                   zip(PHRASE * 6, accumulate(length for _, length in PHRASE * 6))).encode() + b"\n"


def known(sound: bytes) -> int:
    """How many lines labial-hear can write when it has heard so much: the head, and frames."""
    with labial.Hearing(model="hear_small") as hearing:
        return 1 + len(hearing.push(np.frombuffer(sound, "<i2")))


@pytest.mark.parametrize(("name", "options", "data", "size", "lines"), [
    ("labial-say", [], PHRASES, len(PHRASES) // 2, lambda _: 21),
    pytest.param("labial-hear", ["-"], SOUND, 12800, known, marks=needs_runtime),
    ("labial-hear", ["-", "--classes"], SOUND, 12800, lambda _: 1),
], ids=["say", "hear", "classes"])
def test_frames_leave_while_input_arrives(name: str, options: List[str], data: bytes, size: int,
                                          lines: Callable[[bytes], int]) -> None:
    """Catches lines that are kept back, also of a long line of timings that goes on; in the end there are all."""
    count = lines(data[:size])
    assert count > 11 or "--classes" in options
    with subprocess.Popen(command(name, *options), stdin=subprocess.PIPE, stdout=subprocess.PIPE) as child:
        late = threading.Timer(120, child.kill)  # so that a failure ends instead of waiting for a program that waits
        late.start()
        child.stdin.write(data[:size])
        child.stdin.flush()
        early = [child.stdout.readline() for _ in range(count)]
        assert child.poll() is None
        child.stdin.write(data[size:])
        child.stdin.close()
        rest = child.stdout.read()
        late.cancel()
    assert child.returncode == 0 and b"".join([*early, rest]) == run(name, *options, data=data).stdout


SPEAK = [[], ["a.wav"], ["--to", "x", "a", "b"], ["--what"], ["a", "b", "c"]]
#: Arguments that mean nothing, and what standard input holds.
USAGE: Dict[str, Tuple[bytes, List[List[str]]]] = {
    "labial-say": (b"pau:0.2\n", [
        ["--from"], ["--from", "wav"], ["--to=x"], ["--model", "x"], ["--nonsense"], ["x.lab"], ["--to", "csv", "x"],
        *(["--articulation", percent] for percent in ("", "201", "-1", "50.5", "1e2", "50 ", "4294967396"))]),
    "labial-hear": (SOUND, [
        [], ["--to"], ["-", "--to", "wav"], ["-", "--model", "x"], ["-", "--model=hear_small"], ["-", "--nonsense"],
        ["a.wav", "b.wav"], ["a.wav", "--rate", "16000"], ["a.wav", "--channels=1"], ["-", "--classes", "--to", "csv"],
        *(["-", "--rate", rate] for rate in ("", "0", "-1", "16k", "16000.0", "4294983296")),
        *(["-", "--channels", channels] for channels in ("", "0", "3", "mono"))]),
    "labial-say-flite": (b"", SPEAK),
    "labial-say-espeak": (b"", SPEAK),
}


@pytest.mark.parametrize(("name", "arguments"), [(name, row) for name, (_, rows) in USAGE.items() for row in rows])
def test_usage_errors(name: str, arguments: List[str]) -> None:
    """Arguments that mean nothing end with status 2 before anything is read or written."""
    done = run(name, *arguments, data=USAGE[name][0])
    assert done.returncode == 2 and done.stdout == b""
    assert done.stderr.startswith(f"{name}: ".encode()) and done.stderr.count(b"\n") == 1


@pytest.mark.parametrize(("name", "says"), [("labial-say", b"--from"), ("labial-hear", b"small (default)"),
                                            ("labial-say-flite", b""), ("labial-say-espeak", b"")])
def test_help_and_version(name: str, says: bytes) -> None:
    """Both are answered on standard output with status 0."""
    done = run(name, "--help")
    assert done.returncode == 0 and f"usage: {name}".encode() in done.stdout and says in done.stdout
    if says:
        done = run(name, "--version")
        assert done.returncode == 0 and done.stdout.startswith(f"{name} ".encode())


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full")
@pytest.mark.parametrize(("name", "options", "data"), [
    ("labial-say", [], TEXT.encode()), ("labial-hear", ["-"], SOUND), ("labial-hear", ["-", "--classes"], SOUND),
    ("labial-hear", ["-", "--to", "fap"], SOUND),
], ids=["say", "hear", "classes", "fap"])
def test_a_full_disk_is_an_error(name: str, options: List[str], data: bytes) -> None:
    """Motion that could not be written is not success."""
    with open("/dev/full", "wb") as full:
        done = subprocess.run(command(name, *options), input=data, stdout=full, stderr=subprocess.PIPE, timeout=60,
                              check=False)
    assert done.returncode == 1 and b"cannot write" in done.stderr
