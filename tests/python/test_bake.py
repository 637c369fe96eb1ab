"""``labial bake``: headers that C compiles and plays, held to the library itself, and every error in a line."""

from __future__ import annotations

import re
import shutil
from fractions import Fraction
from pathlib import Path
from typing import List, Sequence

import numpy as np
import pytest

from labial.__main__ import main
from labial.bake.source import Source, read_track
from labial.bake.track import AVR_LARGEST, FORMAT
from labial.core.library import DURATION_MAX
from labial.corpus.formats import SOUNDS
from labial.files.faps import FAP_COLUMNS
from labial.reference.fade import EASE
from models import write_motion
from packages import CC, CXX, LIBRARIES, SOURCE, needs_runtime, run, warnings

pytestmark = needs_runtime

TALK = SOURCE / "examples" / "talk"
PLAYER = SOURCE / "export" / "labial" / "bake" / "labial_player.h"

#: A face with all that a track can hold: two directions, a slew limit, plain numbers below zero.
FACE = """
[output.jaw]
from = "opening"
neutral = 1900
full = 1300
[output.brow]
from = "jaw"
neutral = 1500
full = 1700
slew = 20
"""


def frames_file(path: Path, times: Sequence[float], openings: Sequence[float]) -> Path:
    """A frames file in which the lower lip alone moves, so that the opening is what is given."""
    frames = np.zeros((len(openings), len(FAP_COLUMNS)))
    frames[:, FAP_COLUMNS.index("fap52")] = -np.array(openings)
    return write_motion(path, times, frames)


def data(header: Path) -> List[int]:
    """The bytes of a track, read from the header's text."""
    table = re.search(r"_bytes\[(\d+)\][^{]*\{([^}]*)\}", header.read_text())
    assert table
    found = [int(number) for number in re.findall(r"\d+", table[2])]
    assert len(found) == int(table[1])
    return found


def same_but_version(one: Path, other: Path) -> bool:
    def plain(path: Path) -> str:
        return re.sub(r"labial bake \d+\.\d+\.\d+", "", path.read_text()).replace("\n *", "").replace(" ", "")

    return plain(one) == plain(other)


# ---- Both kinds of header, in C --------------------------------------------------------------------------------------

PROGRAM = """\
#include <stdio.h>
#include "labial/face.h"
#include "talk.h"
#include "talk_phonemes.h"

static labial_t stream;
static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];
static labial_player_t player;
static const labial_rig_output_t output = LABIAL_RIG_SERVO(1400, 1900, 60);
static const labial_rig_t jaw = { &output, 1 };
static labial_face_t face;
static int32_t room[LABIAL_FACE_SIZE(1, 12) / 4];

int main(void)
{
    int32_t pulse;
    uint32_t next = 0;
    unsigned shown = 0;
    int result = labial_init(&stream, &speech_en, workspace, sizeof workspace, labial_face_frame, &face), moves;
    if (labial_face_init(&face, &jaw, 50, 12, room, sizeof room) != LABIAL_OK)
        return 1;
    talk_init(&player);
    do {
        if (result >= 0 && result != LABIAL_DONE)
            result = talk_phonemes_feed(&stream, &next);
        if (result == LABIAL_OK)
            result = labial_tick(&stream);
        moves = labial_face_tick(&face, &pulse);
        if (moves == LABIAL_OK) {
            const uint8_t *baked = talk_next(&player);
            printf("%u %d %d\\n", shown++, (int)pulse, baked ? (int)talk_jaw(baked) : -1);
        }
    } while (result >= 0 && (result != LABIAL_DONE || moves != LABIAL_DONE));
    printf("end %d %d\\n", result, talk_next(&player) != NULL);
    return 0;
}
"""


def test_committed_headers_are_what_the_command_writes(tmp_path: Path) -> None:
    """A change of the model, of the rig or of the header's text that the examples' headers do not have."""
    assert main(["bake", str(TALK / "talk.lab"), "-o", str(tmp_path / "talk.h")]) == 0
    assert main(["bake", str(TALK / "talk.lab"), "--as", "phonemes", "-o", str(tmp_path / "talk_phonemes.h")]) == 0
    for name in ("talk.h", "talk_phonemes.h"):
        assert same_but_version(tmp_path / name, TALK / name), name
    assert (tmp_path / "labial_player.h").read_bytes() == PLAYER.read_bytes()


@pytest.mark.parametrize("language", ["c", pytest.param("c++", marks=pytest.mark.slow)])
def test_both_kinds_play_what_the_library_computes(tmp_path: Path, language: str) -> None:
    """The phonemes through the stream and its rig, the track through the player: the same pulses, frame by frame, but
    for what a byte and the exported tables round."""
    if language == "c++" and not CXX:
        pytest.skip("no C++ compiler")
    program = tmp_path / ("main.c" if language == "c" else "main.cpp")
    program.write_text(PROGRAM)
    folders = [TALK, PLAYER.parent, SOURCE / "lib" / "models", SOURCE / "include"]
    options = [CC, "-std=c99"] if language == "c" else [CXX, "-std=c++11"]
    run(*options, *warnings(language), *(f"-I{folder}" for folder in folders), program, *LIBRARIES,
        "-o", tmp_path / "main")
    *lines, last = run(tmp_path / "main").splitlines()
    rows = np.array([[int(field) for field in line.split()] for line in lines])
    assert last == "end 3 0"  # LABIAL_DONE, and no frame of the track is left
    assert len(rows) == 168 and (rows[:, 0] == np.arange(168)).all()  # 3.125 s, and 12 frames of rest
    difference = np.abs(rows[:, 1] - rows[:, 2])
    assert difference.max() <= 3, difference  # a FAP unit is .83 microseconds, half a byte 1
    assert np.ptp(rows[:, 1]) > 400


@pytest.mark.slow
def test_sound_is_aligned_first(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """The text of the wrong option, times in other units: the motion of the sound itself is that of its timings."""
    for package in ("pocketsphinx", "soundfile", "soxr"):
        pytest.importorskip(package)
    out = tmp_path / "talk.h"
    assert main(["bake", str(TALK / "talk.wav"), "--text-file", str(TALK / "talk.txt"), "-o", str(out)]) == 0
    assert "warning" not in capsys.readouterr().err
    found, kept = data(out), data(TALK / "talk.h")
    assert len(found) == len(kept) and np.corrcoef(found, kept)[0, 1] > 0.95
    assert main(["bake", str(TALK / "talk.wav"), "-o", str(out)]) == 0
    assert "without its text" in capsys.readouterr().err
    assert ".wav" in SOUNDS


# ---- Bytes -----------------------------------------------------------------------------------------------------------


def test_frames_by_hand(tmp_path: Path) -> None:
    """25 frames a second from .04 s: the first pose is held before, every second frame lies between two, the last frame
    is held for as long as it lasts. 600 FAP units of opening are 255."""
    frames_file(tmp_path / "ramp.csv", [0.04, 0.08, 0.12], [0.0, 300.0, 600.0])
    rig = SOURCE / "examples" / "faces" / "jaw.toml"
    assert main(["bake", str(tmp_path / "ramp.csv"), "--rig", str(rig), "-o", str(tmp_path / "ramp.h")]) == 0
    assert data(tmp_path / "ramp.h") == [0, 0, 0, 64, 128, 191, 255, 255]
    # Without a rig the jaw moves by 60 microseconds a frame.
    assert main(["bake", str(tmp_path / "ramp.csv"), "-o", str(tmp_path / "ramp.h")]) == 0
    assert data(tmp_path / "ramp.h") == [0, 0, 0, 31, 61, 92, 122, 153]


def test_outputs_follow_sounds(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """A tongue that stays at rest: it is out in TH; frames do not tell their sounds, and the command says so."""
    (tmp_path / "face.toml").write_text('unit = "weight"\n[output.tongue]\nneutral = 0\nfull = 1\n'
                                        "visemes = { TH = 1.0 }\n")
    (tmp_path / "th.flite").write_text("pau:0.1 th:0.3 ih:0.5 th:0.7 pau:0.9\n")
    options = ["--rig", str(tmp_path / "face.toml"), "-o", str(tmp_path / "th.h")]
    assert main(["bake", str(tmp_path / "th.flite"), *options]) == 0
    tongue = data(tmp_path / "th.h")
    assert min(tongue[7:13]) > 240 and max(tongue[17:23]) < 60 and tongue[-1] == 0
    assert capsys.readouterr().err == ""
    frames_file(tmp_path / "still.csv", [0.0, 0.02], [0.0, 0.0])
    assert main(["bake", str(tmp_path / "still.csv"), *options]) == 0
    assert "frames do not tell their sounds, which tongue of" in capsys.readouterr().err
    assert data(tmp_path / "th.h") == [0, 0]


def test_limits_and_directions(tmp_path: Path) -> None:
    """Bytes go from minimum to maximum however the servo is mounted, a slew limit holds them back."""
    (tmp_path / "face.toml").write_text(FACE)
    frames = frames_file(tmp_path / "open.csv", [0.0, 0.02, 0.04], [0.0, 2000.0, 300.0])
    assert main(["bake", str(frames), "--rig", str(tmp_path / "face.toml"), "-o", str(tmp_path / "f.h")]) == 0
    assert data(tmp_path / "f.h") == [255, 0, 0, 0, 128, 0]
    text = (tmp_path / "f.h").read_text()
    assert "#define F_JAW_AT_0 1300\n" in text and "#define F_JAW_AT_255 1900\n" in text and "F_BROW = 1" in text


@pytest.mark.parametrize("option, pulses", [("AT_255=1700", "1400 1700"), ("AT_0=1500", "1500 1900")])
def test_either_pulse_can_be_set_alone(tmp_path: Path, option: str, pulses: str) -> None:
    """A header that overrides the one drives the servo beyond its limit."""
    (tmp_path / "main.c").write_text(
        '#include <stdio.h>\n#include "talk.h"\nint main(void)\n{\n'
        '    const uint8_t ends[] = { 0, 255 };\n'
        '    printf("%d %d", (int)talk_jaw(ends), (int)talk_jaw(ends + 1));\n    return 0;\n}\n')
    run(CC, "-std=c99", *warnings("c"), f"-I{TALK}", f"-I{PLAYER.parent}", f"-DTALK_JAW_{option}",
        tmp_path / "main.c", "-o", tmp_path / "main")
    assert run(tmp_path / "main") == pulses


def test_bytes_mean_what_the_formula_says(tmp_path: Path) -> None:
    """All bytes between limits near and far, in both directions, against exact fractions."""
    limits = [(1400, 1900), (1900, 1400), (0, 1), (-500, 500), (7, 7), (-16000000, -8000000), (400, 2600)]
    cases = ", ".join(f"{{ {a}, {b} }}" for a, b in limits)
    (tmp_path / "main.c").write_text(f"""
#include <stdio.h>
#include "labial_player.h"
static const int32_t limits[][2] = {{ {cases} }};
int main(void)
{{
    unsigned i, byte;
    for (i = 0; i < {len(limits)}; i++)
        for (byte = 0; byte < 256; byte++) {{
            const uint8_t frame[2] = {{ 99, (uint8_t)byte }};
            printf("%ld\\n", (long)labial_player_value(frame, 1, limits[i][0], limits[i][1]));
        }}
    return 0;
}}
""")
    run(CC, "-std=c99", *warnings("c"), f"-I{PLAYER.parent}",
        tmp_path / "main.c", "-o", tmp_path / "main")
    found = [int(line) for line in run(tmp_path / "main").split()]
    exact = [low + Fraction((high - low) * byte, 255) for low, high in limits for byte in range(256)]
    assert len(found) == len(exact) and max(abs(a - b) for a, b in zip(found, exact)) <= Fraction(1, 2)


def test_numbers_that_c_has_too() -> None:
    """A change on one side alone: baked headers would be refused, or phonemes too late."""
    assert re.search(r"^#define LABIAL_PLAYER_FORMAT (\d+)$", PLAYER.read_text(), re.MULTILINE)[1] == str(FORMAT)
    manual = (SOURCE / "include" / "labial" / "labial.h").read_text()
    assert re.search(r"^#define LABIAL_DURATION_MAX (\d+)u$", manual, re.MULTILINE)[1] == str(DURATION_MAX)


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("avr-gcc"), reason="no avr-gcc: install gcc-avr and avr-libc")
def test_avr_takes_what_fits(tmp_path: Path) -> None:
    """A track that no array of an AVR holds is refused in words; one of the largest size compiles, in flash."""
    times = np.arange(AVR_LARGEST + 1) / 50
    frames_file(tmp_path / "fits.csv", times[:-1], times[:-1])
    frames_file(tmp_path / "over.csv", times, times)
    for name in ("fits", "over"):
        assert main(["bake", str(tmp_path / f"{name}.csv"), "-o", str(tmp_path / f"{name}.h")]) == 0
        (tmp_path / f"{name}.c").write_text(f"""#include "{name}.h"
labial_player_t player;
int main(void) {{ {name}_init(&player); return *{name}_next(&player); }}
""")
    command = ["avr-gcc", "-mmcu=atmega1284p", "-std=c99", "-Os", *warnings("c")]
    assert "an array of an AVR holds 32767: bake it with --parts 655" in run(*command, "-c", "over.c", cwd=tmp_path,
                                                                             status=1)
    assert main(["bake", str(tmp_path / "over.csv"), "-o", str(tmp_path / "parts.h"), "--parts", "655"]) == 0
    (tmp_path / "parts.c").write_text((tmp_path / "over.c").read_text().replace("over", "parts").replace(
        "&player);", "&player, 1);", 1))
    run(*command, "parts.c", "-o", "parts.elf", cwd=tmp_path)
    run(*command, "fits.c", "-o", "fits.elf", cwd=tmp_path)
    ram = run("avr-size", "fits.elf", cwd=tmp_path).splitlines()[1].split()[1:3]
    assert [int(size) for size in ram] == [0, 4]


@pytest.mark.skipif(not shutil.which("avr-gcc"), reason="no avr-gcc: install gcc-avr and avr-libc")
@pytest.mark.parametrize("options", [[], ["--parts", "pauses"]])
def test_the_program_for_an_uno_takes_both_headers(options: List[str], tmp_path: Path) -> None:
    """Catches a player of the page on Arduino boards that does not compile with the motion in parts."""
    (tmp_path / "a.lab").write_text(SENTENCES)
    assert main(["bake", str(tmp_path / "a.lab"), "-o", str(tmp_path / "talk.h"), *options]) == 0
    run("avr-gcc", "-mmcu=atmega328p", "-std=gnu99", "-Os", *warnings("c"), "-I.", f"-I{SOURCE}/examples/talk",
        SOURCE / "examples" / "uno" / "main.c", "-o", "jaw.elf", cwd=tmp_path)


# ---- Parts -----------------------------------------------------------------------------------------------------------

#: Sentences of 1.5, 2 and 1 s, with pauses of half a second and of 2 s between, and one of .3 s within the second.
SENTENCES = """0 0.5 SIL
0.5 2.0 AA
2.0 2.5 SIL
2.5 3.5 OW
3.5 3.8 SIL
3.8 4.5 AE
4.5 6.5 SIL
6.5 7.5 IY
"""

PARTS_PROGRAM = """\
#include <stdio.h>
#include "cut.h"
#include "whole.h"

static labial_player_t player, parts;

int main(void)
{
    unsigned part;
    whole_init(&player);
    for (part = 0; part < CUT_PARTS; part++) {
        const uint8_t *frame;
        cut_init(&parts, part);
        printf("%lu", (unsigned long)cut_milliseconds(part));
        for (frame = cut_next(&parts); frame != NULL; frame = cut_next(&parts))
            if (whole_next(&player) == NULL || cut_jaw(frame) != whole_jaw(player.next - WHOLE_OUTPUTS))
                printf(" differs");
        printf("\\n");
    }
    cut_init(&parts, CUT_PARTS);
    printf("%lu %d %d\\n", (unsigned long)cut_milliseconds(CUT_PARTS), whole_next(&player) != NULL,
           cut_next(&parts) != NULL);
    return 0;
}
"""


@pytest.mark.parametrize(("parts", "begins"), [
    ("pauses", [0, 2.24, 6.2]),  # in the middle of a short pause, .3 s before the end of a long one
    pytest.param("5", [0, 2.24, 6.2], marks=pytest.mark.slow),  # 6.2 s do not fit, and then not 5.5 either
    pytest.param("6.5", [0, 6.2], marks=pytest.mark.slow),
    ("2", [0, 2.0, 2.24, 4.24, 6.2]),  # has to be cut twice where there is no pause
    pytest.param("60", [0], marks=pytest.mark.slow),
])  # fmt: skip
def test_parts_are_the_track_cut_in_pauses(parts: str, begins: List[float], tmp_path: Path, capsys) -> None:
    """Catches a frame that is lost or played twice at a cut, cuts within speech, and parts that are too long. The track
    lasts 7.74 s, with the rest at its end."""
    (tmp_path / "a.lab").write_text(SENTENCES)
    assert main(["bake", str(tmp_path / "a.lab"), "-o", str(tmp_path / "whole.h")]) == 0
    capsys.readouterr()
    assert main(["bake", str(tmp_path / "a.lab"), "-o", str(tmp_path / "cut.h"), "--parts", parts]) == 0
    ends = [*begins[1:], 7.74]
    assert capsys.readouterr().out.splitlines()[2:] == [
        f"part {number}: {begin:.2f} to {end:.2f} s" for number, (begin, end) in enumerate(zip(begins, ends))]
    (tmp_path / "main.c").write_text(PARTS_PROGRAM)
    run(CC, "-std=c99", *warnings("c"), f"-I{tmp_path}", tmp_path / "main.c", "-o", tmp_path / "main")
    assert run(tmp_path / "main").splitlines() == [*(f"{1000 * begin:.0f}" for begin in begins), "7740 0 0"]
    if CXX:
        run(CXX, "-std=c++11", "-x", "c++", *warnings("c++"), "-c", tmp_path / "main.c", "-o", tmp_path / "main.o")


def test_frames_have_pauses_where_they_rest(tmp_path: Path) -> None:
    """Of frames without phonemes: where they hardly move for long enough."""
    times = np.arange(200) / 50
    moving = (times < 1) | (times > 2)
    frames_file(tmp_path / "a.csv", times, np.where(moving, 100 + 50 * np.sin(20 * times), 0.0))
    pauses = read_track(Source(str(tmp_path / "a.csv"))).pauses
    assert not pauses[:50].any() and pauses[52:99].all() and not pauses[102:].any()


# ---- Errors ----------------------------------------------------------------------------------------------------------

LAB = "0.0 0.2 SIL\n0.2 0.5 AA\n"


@pytest.mark.parametrize(("arguments", "complaint"), [
    (["none.lab"], "none.lab: No such file"),
    (["bad.lab"], "bad.lab:2: "),
    (["bad.csv"], "bad.csv:2: 3 columns, not 14"),
    (["bad.wav"], "bad.wav: "),
    (["past.csv"], "past.csv: its last time, -1 s, lies before 0"),
    (["far.csv"], "far.csv: 80000 s are too long"),
    (["good.lab", "--text", "ah"], "good.lab: a text goes with a sound"),
    (["good.csv", "--text", "ah"], "good.csv: frames need neither a text nor a model"),
    (["good.csv", "--as", "phonemes"], "good.csv: holds frames, which have no phonemes"),
    (["good.lab", "--as", "phonemes", "--rig", "face.toml"], "--rig goes with --as track"),
    (["good.lab", "--rig", "wide.toml"], "wide.toml: output.x.maximum: more than 8000000"),
    (["good.lab", "--rig", "taken.toml"], "taken.toml: output.next: this name is taken"),
    (["good.lab", "--rig", "broken.toml"], "broken.toml: output.x.full"),
    (["good.lab", "--model", "good.lab"], "good.lab: "),
    (["good.lab", "--name", "int"], "'int' is no name for a header"),
    (["good.lab", "--name", "Labial"], "'Labial' is no name for a header"),
    (["good.lab", "--name", "EOF"], "'EOF' is no name for a header"),
    (["good.lab", "-o", "x.c"], "x.c: what is written is a C header"),
    (["good.lab", "-o", "labial_player.h"], "labial_player.h: this is the name of the player"),
    (["good.lab", "-o", "1st.h"], "'1st' is no name for a header"),
    (["pause.lab", "--as", "phonemes"], "pause.lab:2: 'AA' lasts 3601 s, more than the 3600 s"),
    (["good.lab", "--text-file", "good.lab"], "good.lab: a text goes with a sound"),
    (["good.lab", "--parts", "0.5"], "--parts: '0.5' is neither a number of seconds within 1 .. 86400"),
    (["good.lab", "--parts", "nan"], "--parts: 'nan' is neither a number of seconds"),
    (["good.lab", "--parts", "5", "--as", "phonemes"], "--parts goes with --as track"),
])  # fmt: skip
def test_errors_name_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture,
                              arguments: List[str], complaint: str) -> None:
    """One line, status 1, and nothing is written."""
    if "bad.wav" in arguments:
        pytest.importorskip("pocketsphinx")
    monkeypatch.chdir(tmp_path)
    head = ",".join(("time", *FAP_COLUMNS))
    for name, text in {
        "good.lab": LAB, "bad.lab": "0.0 0.2 SIL\n0.2 AA\n", "bad.wav": "no sound",
        "pause.lab": "0 1 SIL\n1 3602 AA\n3602 3603 SIL\n",
        "bad.csv": f"{head}\n0,1,2\n", "face.toml": FACE,
        "wide.toml": '[output.x]\nfrom = "jaw"\ngain = 1\nneutral = 0\nminimum = -8000000\nmaximum = 1\n',
        "taken.toml": FACE.replace("brow", "next"), "broken.toml": '[output.x]\nfrom = "jaw"\nneutral = 1\n',
    }.items():
        Path(name).write_text(f'unit = "plain"\n{text}' if name == "wide.toml" else text)
    frames_file(Path("good.csv"), [0.0, 0.02], [0.0, 1.0])
    frames_file(Path("past.csv"), [-2.0, -1.0], [0.0, 1.0])
    frames_file(Path("far.csv"), [0.0, 80000.0], [0.0, 1.0])
    before = sorted(tmp_path.iterdir())
    assert main(["bake", *arguments, *([] if "-o" in arguments else ["-o", "out.h"])]) == 1
    told = capsys.readouterr().err
    assert told.startswith(f"labial: {complaint}") and told.count("\n") == 1, told
    assert sorted(tmp_path.iterdir()) == before


def test_mouth_comes_to_rest_at_the_end(tmp_path: Path) -> None:
    """A recording that is cut behind its last vowel would leave the jaw hanging."""
    for name, end, count in (("cut", "", 25), ("short", "0.5 0.6 SIL\n", 30), ("long", "0.5 2 SIL\n", 100)):
        (tmp_path / f"{name}.lab").write_text(f"0 0.2 SIL\n0.2 0.5 AA\n{end}")
        assert main(["bake", str(tmp_path / f"{name}.lab"), "--name", "x", "-o", str(tmp_path / "x.h")]) == 0
        found = data(tmp_path / "x.h")
        assert len(found) == count + EASE and max(found) > 150 and found[-1] == 0, name


def test_models_are_chosen_by_the_phonemes(tmp_path: Path) -> None:
    """A laugh needs the laughter model; a name that C cannot have becomes one that it can."""
    laugh = SOURCE / "examples" / "demo" / "laugh.lab"
    assert main(["bake", str(laugh), "--as", "phonemes", "-o", str(tmp_path / "my-laugh.h")]) == 0
    text = (tmp_path / "my-laugh.h").read_text()
    assert '#include "laughter_synthetic.h"' in text and "my_laugh_feed" in text
    assert main(["bake", str(laugh), "--model", "speech_en", "-o", str(tmp_path / "s.h")]) == 0
