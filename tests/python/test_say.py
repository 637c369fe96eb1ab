"""labial-say from outside: text in, frames out. The environment variable LABIAL_SAY holds the program's path."""

from __future__ import annotations

import os
import queue
import random
import subprocess
import threading
from typing import Dict, List, Tuple

import pytest

SAY = os.environ.get("LABIAL_SAY", "")
pytestmark = pytest.mark.skipif(not SAY, reason="LABIAL_SAY does not name the built labial-say")

#: (label, duration in ms); the same phrase in each of the three formats must give the same motion.
PHRASE = [("pau", 220), ("m", 71), ("ay", 152), ("b", 90), ("ey", 197), ("b", 85), ("iy", 89), ("pau", 220)]
HEADER = "time,fap3,fap16,fap17,fap51,fap52,fap53,fap54,fap55,fap56,fap57,fap58,fap59,fap60"
EXPANDED = [*range(3, 14), 16, 17, *range(51, 61)]


def say(text: str | bytes, *options: str) -> subprocess.CompletedProcess:
    """Runs labial-say on `text`; its output as bytes."""
    data = text if isinstance(text, bytes) else text.encode()
    return subprocess.run([SAY, *options], input=data, capture_output=True, timeout=60, check=False)


def motion(text: str | bytes, *options: str) -> List[List[str]]:
    """The rows of the CSV that labial-say makes of `text`, without the header."""
    done = say(text, *options)
    assert done.returncode == 0, done.stderr
    assert done.stderr == b""
    header, *lines = done.stdout.decode().splitlines()
    assert header == HEADER
    return [line.split(",") for line in lines]


def frames_per_second(rows: List[List[str]]) -> float:
    """The rate that the time column tells."""
    return (len(rows) - 1) / float(rows[-1][0])


def flite(phrase: List[Tuple[str, int]]) -> str:
    """`phrase` as `flite -psdur` writes it."""
    ends = [sum(duration for _, duration in phrase[: i + 1]) for i in range(len(phrase))]
    return " ".join(f"{label}:{end / 1000:.3f}" for (label, _), end in zip(phrase, ends)) + " \n"


def lab(phrase: List[Tuple[str, int]]) -> str:
    """`phrase` as three-column lines, its silences left out as gaps."""
    lines, at = [], 0
    for i, (label, duration) in enumerate(phrase):
        if label != "pau" or i == len(phrase) - 1:
            lines.append(f"{at / 1000:.3f} {(at + duration) / 1000:.3f} {label}\n")
        at += duration
    return "".join(lines)


def pho(phrase: List[Tuple[str, int]]) -> str:
    """`phrase` as MBROLA writes it, with comments and pitch points."""
    text = "; a comment: with 0.5 numbers\n\n"
    for i, (label, duration) in enumerate(phrase):
        text += f"{'_' if label == 'pau' else label}\t{duration} 0 110 {i} 120.5\n"
    return text + "#\n"


def test_formats_are_told_apart() -> None:
    """Each format alone, and asked for by name, gives the same motion: none is taken for another."""
    expected = motion(flite(PHRASE), "--from", "flite")
    assert len({tuple(row[1:]) for row in expected}) > 3, "a mouth that does not move proves nothing"
    assert motion(flite(PHRASE)) == expected
    for name, text in (("lab", lab(PHRASE)), ("pho", pho(PHRASE))):
        assert motion(text) == expected, name
        assert motion(text, f"--from={name}") == expected, name


@pytest.mark.parametrize("lines", ["{a} {b} {l} {m}\n", "{a} {b} {l} {m} word\n", "\n  {a}\t{b}  {l}\n\n"])
def test_lab_variants(lines: str) -> None:
    """Apex, word, blank lines and other blanks change nothing."""
    text, at = "", 0
    for label, duration in PHRASE:
        text += lines.format(a=at / 1000, b=(at + duration) / 1000, l=label, m=(at + duration / 2) / 1000)
        at += duration
    assert motion(text) == motion(flite(PHRASE))


@pytest.mark.parametrize("write", [flite, lab, pho])
def test_carriage_returns_and_missing_line_feed(write) -> None:  # noqa: ANN001
    """CRLF lines, and a last line without an end, read as plain lines do."""
    text = write(PHRASE)
    assert motion(text.replace("\n", "\r\n")) == motion(text)
    assert motion(text.rstrip()) == motion(text)


def test_lines_of_flite_are_utterances() -> None:
    """Times of flite start from 0 with every line; a line that restarts is no error and follows the one before."""
    one, two = motion(flite(PHRASE)), motion(flite(PHRASE) * 2)
    total = 2 * sum(duration for _, duration in PHRASE)
    assert len(two) > len(one)
    assert len(two) == int(total * frames_per_second(two) / 1000 + 0.5)


def test_totals_are_exact() -> None:
    """Durations are not rounded one by one: 1,000 times 10.4 ms are 10.4 s, not 10."""
    labels = ["aa" if i % 2 else "b" for i in range(1000)]
    texts = {
        "pho": "".join(f"{label} 10.4\n" for label in labels),
        "flite": " ".join(f"{label}:{(i + 1) * 0.0104:.4f}" for i, label in enumerate(labels)),
        "lab": "".join(f"{i * 0.0104:.4f} {(i + 1) * 0.0104:.4f} {label}\n" for i, label in enumerate(labels)),
    }
    for name, text in texts.items():
        rows = motion(text)
        assert len(rows) == int(10.4 * frames_per_second(rows) + 0.5), name


def test_times_of_frames() -> None:
    """The time column is the frame's number over the rate, with three decimals, and FAPs are integers."""
    rows = motion(flite(PHRASE))
    rate = round(frames_per_second(rows))
    for i, row in enumerate(rows):
        assert row[0] == f"{i / rate:.3f}"
        assert [str(int(value)) for value in row[1:]] == row[1:] and len(row) == 14


def test_frames_leave_while_input_arrives() -> None:
    """Frames come out before the input has ended, within one long line, and in the end all of them."""
    phrase = PHRASE * 6
    text = flite(phrase)
    half = text[: len(text) // 2].encode()
    lines: queue.Queue[bytes] = queue.Queue()
    child = subprocess.Popen([SAY], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert child.stdin and child.stdout

    def read() -> None:
        for line in child.stdout:  # type: ignore[union-attr]
            lines.put(line)

    reader = threading.Thread(target=read, daemon=True)
    reader.start()
    try:
        child.stdin.write(half)
        child.stdin.flush()
        early = [lines.get(timeout=120) for _ in range(21)]
        assert child.poll() is None
        child.stdin.write(text[len(half) :].encode())
        child.stdin.close()
        reader.join(timeout=120)
        assert child.wait(timeout=120) == 0
    finally:
        child.kill()  # so that a failure above ends here instead of waiting for a program that waits
        child.wait()
        reader.join(timeout=120)
        child.stdout.close()
    while not lines.empty():
        early.append(lines.get())
    assert b"".join(early) == say(text).stdout


@pytest.mark.parametrize(
    ("text", "line", "told"),
    [
        ("pau:0.2 m:x\n", 1, "m:x"),
        ("pau:0.2\nm:0.1 b:nan\n", 2, "b:nan"),
        ("pau:0.2 m:-0.3\n", 1, "m:-0.3"),
        ("pau:0.2 m:1e-1\n", 1, "m:1e-1"),
        ("pau:0.2 m\n", 1, "'m'"),
        ("pau:0.2 m:0.1\n", 1, "m:0.1"),
        ("pau:0.2 m:5000.0\n", 1, "hour"),
        ("pau:0.2 m:99999999999999999999999999\n", 1, "m:9999"),
        ("0.0 0.2 sil\n0.1 0.3 b\n", 2, "0.1"),
        ("0.0 0.2 sil\n\n0.4 0.3 b\n", 3, "0.4"),
        ("0.0 0.2 sil\n0.2 0.3\n", 2, "2 fields"),
        ("0.0 0.2 sil\n0.2 inf b\n", 2, "inf"),
        ("0.0 0.2 sil 0.1 word more\n", 1, "five"),
        ("0.0 0.2 sil when\n", 1, "when"),
        ("0.0 2900000 sil\n", 1, "2900000"),
        ("_ 100\nb\n", 2, "'b'"),
        ("_ 100\nb -5\n", 2, "-5"),
        ("_ 100\n; fine\nb 50 0\n", 3, "pitch"),
        ("_ 100\nb 50 0 high\n", 2, "high"),
        ("_ 100\nb 3600001\n", 2, "hour"),
        ("hello world\n", 1, "flite"),
        ("hello\n", 1, "flite"),
        ("pau:0.2 " + "m" * 70 + ":0.3\n", 1, "63"),
        ("_ 100\nb\x1b[31m 20\n", 2, "0x1b"),
    ],
)
def test_malformed_lines_are_named(text: str, line: int, told: str) -> None:
    """An error says the line and what is wrong with it, and the exit status is 1."""
    done = say(text)
    message = done.stderr.decode()
    assert done.returncode == 1
    assert message.startswith(f"labial-say: line {line}: ") and message.count("\n") == 1
    assert told in message


@pytest.mark.parametrize(
    ("text", "line"),
    [("pau:0.1 xyzzy:0.2\n", 1), ("_ 9\nxyzzy 9\n", 2), ("pau:0.1\nxyzzy:0.2\n", 2)]
)
def test_unknown_labels_are_named_once(text: str, line: int) -> None:
    """A label that the model does not know moves as the nearest, and is named in one warning, whatever the format."""
    done = say(text + text)
    assert done.returncode == 0
    assert done.stderr.decode() == (
        f"labial-say: warning: line {line}: speech_en has no phoneme 'xyzzy', which moves as K\n")
    assert done.stdout == say((text + text).replace("xyzzy", "k")).stdout


@pytest.mark.parametrize("seed", range(20))
def test_garbage_is_refused(seed: int) -> None:
    """Bytes that are no text end in an error, not in a crash or in motion."""
    data = bytes(random.Random(seed).randrange(256) for _ in range(4096))
    done = say(data)
    assert done.returncode == 1
    assert done.stderr.startswith(b"labial-say: line ")


@pytest.mark.parametrize("text", ["", "\n", " \r\n\n", "; nothing\n"])
def test_empty_input_is_no_motion(text: str) -> None:
    """Nothing in is nothing out, and no error."""
    assert motion(text) == []
    assert say(text, "--to", "fap").stdout.split()[3:] == [b"0"]


def parse_fap(text: str) -> Tuple[List[str], List[Dict[int, int]]]:
    """A reader of MPEG-4 text of its own: the header's fields, and each frame as FAP number to value."""
    header, *lines = text.splitlines()
    assert len(lines) % 2 == 0
    frames = []
    for number, (mask, values) in enumerate(zip(lines[0::2], lines[1::2])):
        bits = mask.split(" ")
        assert len(bits) == 68 and set(bits) <= {"0", "1"}
        first, *rest = (int(value) for value in values.split(" "))
        assert first == number
        present = [i + 1 for i, bit in enumerate(bits) if bit == "1"]
        assert len(present) == len(rest)
        frames.append(dict(zip(present, rest)))
    return header.split(" "), frames


def test_fap_holds_the_same_motion() -> None:
    """The fap file has the CSV's frames, the count in its header, and inner lips that move as the outer ones."""
    rows = motion(flite(PHRASE))
    done = say(flite(PHRASE), "--to", "fap")
    assert done.returncode == 0
    header, frames = parse_fap(done.stdout.decode())
    assert header == ["2.1", "speech_en", str(round(frames_per_second(rows))), str(len(rows))]
    names = [int(name[3:]) for name in HEADER.split(",")[1:]]
    for row, frame in zip(rows, frames):
        assert sorted(frame) == EXPANDED
        assert [frame[fap] for fap in names] == [int(value) for value in row[1:]]
        assert [frame[fap] for fap in range(4, 14)] == [frame[fap] for fap in range(51, 61)]


def test_articulation_is_the_streams() -> None:
    """Half of every frame, and nothing at 0, but for FAP 17, which follows from the corners; contact does not differ up
    to 100 percent."""
    plain, half, still = ([int(value) for row in motion(flite(PHRASE), "--articulation", percent)
                           for value in [*row[1:3], *row[4:]]] for percent in ("100", "50", "0"))
    assert max(plain) > 200 and all(abs(a - b / 2) <= 1 for a, b in zip(half, plain)) and not any(still)


def test_fap_of_malformed_input_is_not_written() -> None:
    """A fap file that would hold a part of the motion under a header of its own is not written at all."""
    done = say("pau:0.5 m:0.6 b:x\n", "--to", "fap")
    assert done.returncode == 1 and done.stdout == b""


def test_laughter() -> None:
    """The other model has other phonemes, and says so."""
    rows = motion("0 0.1 silence\n0.1 0.2 a\n0.2 0.3 fricative\n0.3 0.4 a\n", "--model=laughter_synthetic")
    assert len(rows) == int(0.4 * frames_per_second(rows) + 0.5)
    done = say("0 0.1 ey\n", "--model", "laughter_synthetic")
    assert done.returncode == 0 and b"laughter_synthetic has no phoneme 'ey', which moves as e" in done.stderr


@pytest.mark.parametrize(
    "options",
    [["--from"], ["--from", "wav"], ["--to=x"], ["--model", "x"], ["--nonsense"], ["x.lab"], ["--to", "csv", "x"],
     *(["--articulation", percent] for percent in ("", "201", "-1", "50.5", "1e2", "50 ", "4294967396"))],
)
def test_usage_errors(options: List[str]) -> None:
    """Options that mean nothing end with status 2 before anything is read or written."""
    done = say("pau:0.2\n", *options)
    assert done.returncode == 2 and done.stdout == b"" and done.stderr.startswith(b"labial-say: ")


def test_help_and_version() -> None:
    """Both are answered on standard output with status 0."""
    done = say("", "--help")
    assert done.returncode == 0 and b"usage: labial-say" in done.stdout and b"--from" in done.stdout
    done = say("", "--version")
    assert done.returncode == 0 and done.stdout.startswith(b"labial-say ")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full")
def test_a_full_disk_is_an_error() -> None:
    """Motion that could not be written is not success."""
    data = flite(PHRASE).encode()
    with open("/dev/full", "wb") as full:
        done = subprocess.run([SAY], input=data, stdout=full, stderr=subprocess.PIPE, timeout=60, check=False)
    assert done.returncode == 1 and b"cannot write" in done.stderr
