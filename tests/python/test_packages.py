"""What packaging/pack.py lays out, and the manifests that ESP-IDF, PlatformIO and Zephyr read from the source tree."""

from __future__ import annotations

import configparser
import functools
import json
import os
import re
import shutil
import zipfile
from pathlib import Path
from typing import Callable, Dict, List, Set

import numpy as np
import pytest

import labial
from labial.__main__ import main
from labial.rig.description import read
from labial.rig.table import convert, expected
from packages import CC, CMAKE, CXX, PROGRAM, SOURCE, attributions, expected_frames, needs_runtime, pack, run, warnings
from source import notices

STUB = SOURCE / "tests" / "packages" / "arduino_stub"
SKETCHES = sorted(path.parent.name for path in (SOURCE / "examples" / "arduino").glob("*/*.ino"))


def bundled() -> List[str]:
    """The models that every build bundles: those of phonemes, and those of hearing, which have no names."""
    found = {path.name[: -len("_names.c")] for path in (SOURCE / "lib" / "models").glob("*_names.c")}
    return sorted(found | {path.stem for path in (SOURCE / "lib" / "models").glob("hear_*.h")})


def header_version(root: Path) -> str:
    text = (root / "include" / "labial" / "labial.h").read_text(encoding="utf-8")
    return ".".join(re.findall(r"^#define LABIAL_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)$", text, re.MULTILINE))


def manifest_versions(root: Path) -> Set[str]:
    """What each file that holds the version says, read in its own way."""
    component = (root / "idf_component.yml").read_text(encoding="utf-8")
    python = (root / "export" / "labial" / "__init__.py").read_text(encoding="utf-8")
    return {json.loads((root / "library.json").read_text(encoding="utf-8"))["version"],
            *re.findall(r'^version: "(.*)"$', component, re.MULTILINE),
            *re.findall(r'^__version__ = "(.*)"$', python, re.MULTILINE), pack("version", root=root).strip()}


def test_every_manifest_has_the_headers_version() -> None:
    """A release with a forgotten file would be announced under two numbers."""
    version = header_version(SOURCE)
    assert re.fullmatch(r"\d+\.\d+\.\d+", version)
    assert manifest_versions(SOURCE) == {version} == {labial.__version__}
    project = (SOURCE / "pyproject.toml").read_text(encoding="utf-8")
    assert 'dynamic = ["version"]' in project and 'input = "export/labial/__init__.py"' in project
    assert re.search(rf"^## {re.escape(version)}\b", (SOURCE / "CHANGELOG.md").read_text("utf-8"), re.MULTILINE)


def test_version_is_set_everywhere(tmp_path: Path) -> None:
    for name in ("include", "packaging", "export/labial/__init__.py", "library.json", "idf_component.yml"):
        target = tmp_path / name
        target.parent.mkdir(parents=True, exist_ok=True)
        (shutil.copytree if (SOURCE / name).is_dir() else shutil.copyfile)(SOURCE / name, target)
    assert len(pack("version", "12.3.45", root=tmp_path).splitlines()) == 4
    assert header_version(tmp_path) == "12.3.45"
    assert manifest_versions(tmp_path) == {"12.3.45"}
    before = (tmp_path / "library.json").read_bytes()
    assert "X.Y.Z" in pack("version", "1.2", root=tmp_path, status=1)
    assert (tmp_path / "library.json").read_bytes() == before


def test_build_lists_every_source() -> None:
    """The packages take all of lib/; the CMake build names its files, and one forgotten there would be missing."""
    text = (SOURCE / "lib" / "CMakeLists.txt").read_text(encoding="utf-8")
    listed = re.findall(r"^  (\w+\.c)\b", text, re.MULTILINE)
    assert sorted(listed) == sorted(path.name for path in (SOURCE / "lib").glob("*.c"))
    assert bundled() and sorted(bundled()) == sorted(path.stem for path in (SOURCE / "lib" / "models").glob("*.h"))


def test_notice_is_current() -> None:
    """`pack.py notice` writes NOTICE; a model that was trained anew may have another attribution."""
    headers = [path for name in ("models", "words") for path in sorted((SOURCE / "lib" / name).glob("*.h"))]
    assert (SOURCE / "NOTICE").read_text(encoding="utf-8") == notices(headers), "run packaging/pack.py notice"


Packed = Callable[[str], Path]


@pytest.fixture(scope="module")
def packed(tmp_path_factory: pytest.TempPathFactory) -> Packed:
    """The folder that pack.py lays out for a build system; for the Arduino IDE with its archive beside it."""

    @functools.cache
    def of(kind: str) -> Path:
        folder = tmp_path_factory.mktemp(kind) / "Labial"
        pack(kind, "-o", folder, *(["--zip"] if kind == "arduino" else []))
        return folder

    return of


def files_of(folder: Path) -> Dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("kind", ["amalgamation", "arduino", "platformio", "esp-idf", "zephyr"])
def test_packages_carry_every_attribution(packed: Packed, kind: str) -> None:
    """The licences of the training data ask for their notices in whatever passes the models on."""
    files = files_of(packed(kind))
    carried = " ".join((files["LICENSE"] + files.get("NOTICE", b"")).decode().split())
    assert "MIT License" in carried
    assert {Path(name).stem for name in files if name.endswith(".h")} >= set(attributions())
    for name, text in attributions().items():
        assert text in carried, name


# ---- Amalgamation --------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_amalgamation_is_clean_c_and_cxx(packed: Packed, tmp_path: Path) -> None:
    """No warning in either language, nothing else of Labial is needed, and every global name begins with labial_."""
    folder = shutil.copytree(packed("amalgamation"), tmp_path / "two")
    files = {path.name for path in folder.iterdir()}
    assert {"labial.c", "labial.h", "LICENSE"} <= files
    for path in folder.glob("*.[ch]"):
        for name in re.findall(r'^#include "(.*)"', path.read_text(encoding="utf-8"), re.MULTILINE):
            assert name in files and (path.name != "labial.c" or name == "labial.h")
    (folder / "main.c").write_text(PROGRAM)
    sources = ["labial.c", "speech_en.c", "speech_en_names.c", "main.c"]
    run(CC, "-std=c99", "-O2", *warnings("c"), *sources, "-o", "program", cwd=folder)
    assert run(folder / "program") == expected_frames()
    if CXX:
        run(CXX, "-std=c++11", "-O0", *warnings("c++"), "-x", "c++", *sources, "-o", "program", cwd=folder)
        assert run(folder / "program") == expected_frames()
    for limits in (["-DLABIAL_PAPER=1"], ["-DLABIAL_PAPER=1", "-DLABIAL_LOCKS=2"], ["-DLABIAL_LOCKS=1"]):
        run(CC, "-std=c99", "-O0", *warnings("c"), *limits, "-c", "labial.c", cwd=folder)
    if shutil.which("nm"):
        names = re.findall(r" [A-TV-Z] (\w+)$", run("nm", "labial.o", cwd=folder), re.MULTILINE)
        assert len(names) > 10 and all(name.startswith("labial_") for name in names)


def test_amalgamation_takes_exported_models(tmp_path: Path) -> None:
    """A folder that ``labial export`` wrote to replaces the bundled models, an empty one is refused."""
    own = tmp_path / "own"
    own.mkdir()
    for path in (SOURCE / "lib" / "models").glob("laughter_synthetic*"):
        shutil.copyfile(path, own / path.name)
    pack("amalgamation", "--models", own, "-o", tmp_path / "two")
    assert not list((tmp_path / "two").glob("speech_en*")) and len(list((tmp_path / "two").glob("laughter*"))) == 3
    assert "not an empty folder" in pack("amalgamation", "-o", tmp_path / "two", status=1)
    (own / "laughter_synthetic_names.c").unlink()
    assert "laughter_synthetic_names.c" in pack("arduino", "--models", own, "-o", tmp_path / "a", status=1)
    (tmp_path / "none").mkdir()
    assert "holds no exported model" in pack("zephyr", "--models", tmp_path / "none", "-o", tmp_path / "z", status=1)


# ---- Arduino -------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def arduino(packed: Packed) -> Path:
    return packed("arduino")


@pytest.fixture(scope="module")
def objects(arduino: Path, tmp_path_factory: pytest.TempPathFactory) -> List[Path]:
    """The packed library and what runs sketches on the host, compiled as C++."""
    if not CXX:
        pytest.skip("no C++ compiler")
    folder = tmp_path_factory.mktemp("objects")
    sources = [*sorted((arduino / "src").rglob("*.c")), STUB / "host.cpp"]
    run(CXX, *arduino_options(arduino), "-x", "c++", "-c", *sources, cwd=folder)
    return sorted(folder.glob("*.o"))


def sketch_files(arduino: Path, sketch: str) -> List[Path]:
    folder = next(arduino.glob(f"*/{sketch}"))
    return [folder / f"{sketch}.ino", *sorted(folder.glob("*.c"))]


def arduino_options(arduino: Path) -> List[str]:
    return ["-std=gnu++11", "-Os", *warnings("c++"), f"-I{arduino / 'src'}", f"-I{STUB}", "-include", "Arduino.h"]


def test_arduino_layout(arduino: Path) -> None:
    """What the IDE reads, and that the archive holds the same files in one folder."""
    lines = (arduino / "library.properties").read_text(encoding="utf-8").splitlines()
    properties = dict(line.split("=", 1) for line in lines)
    assert properties["version"] == header_version(SOURCE) and properties["name"] == "Labial"
    for key in ("author", "maintainer", "sentence", "paragraph", "category", "url", "architectures", "includes"):
        assert properties[key]
    for header in properties["includes"].split(","):
        assert (arduino / "src" / header).is_file()
    every = "".join(f"#include <{header}>\n" for header in properties["includes"].split(","))
    (arduino.parent / "every.cpp").write_text(every + "const void *models[] = { &speech_en, &hear_small };\n")
    run(CXX or "c++", f"-I{arduino / 'src'}", "-fsyntax-only", arduino.parent / "every.cpp")
    assert {"hear_small.h", "speech_en.h", "words_en.h"} <= set(properties["includes"].split(","))
    assert not {"hear_host.h", "hear_ahead.h"} & set(properties["includes"].split(","))  # too large for sketches
    uno = ["UnoJaw"]  # does not use the library, whose architectures are others: no example of it
    assert len(SKETCHES) >= 2 and sorted(path.name for path in (arduino / "examples").iterdir()) == [
        name for name in SKETCHES if name not in uno]
    assert [path.name for path in (arduino / "extras").iterdir()] == uno and "avr" not in properties["architectures"]
    rows = [line.split("\t") for line in (arduino / "keywords.txt").read_text(encoding="utf-8").splitlines()]
    assert {"labial_tick": "KEYWORD2", "labial_t": "KEYWORD1", "LABIAL_DONE": "LITERAL1"}.items() <= dict(rows).items()
    with zipfile.ZipFile(arduino.with_name("Labial.zip")) as archive:
        zipped = {name: archive.read(name) for name in archive.namelist()}
    assert zipped == {f"Labial/{name}": content for name, content in files_of(arduino).items()}


Lines = Callable[..., List[str]]


@pytest.fixture(scope="module")
def lines_of(arduino: Path, objects: List[Path], tmp_path_factory: pytest.TempPathFactory) -> Lines:
    """What a sketch does on the host: `lines_of(sketch, milliseconds, press, text=SERIAL)`, pressed at `press` ms."""

    @functools.cache
    def program(sketch: str) -> Path:
        target = tmp_path_factory.mktemp(sketch) / sketch
        run(CXX, *arduino_options(arduino), "-x", "c++", *sketch_files(arduino, sketch), "-x", "none", *objects,
            "-o", target)
        return target

    return lambda sketch, *arguments, text="": run(program(sketch), *arguments, text=text).splitlines()


@pytest.mark.slow
def test_arduino_sketches_run(lines_of: Lines) -> None:
    """Library and sketches as C++ on the host: the plotter draws 50 frames a second, the servo follows the line."""
    lines = lines_of("PlotFace", 5000)
    assert 150 < len(lines) < 250
    jaws = [int(re.fullmatch(r"jaw:(-?\d+),upper_lip:(-?\d+),lower_lip:(-?\d+)", line)[1]) for line in lines]
    assert max(jaws) - min(jaws) > 100
    out = lines_of("JawServo", 9000, text="HH 70 AH 60 L 80 OW 250\nAA 200 m 80 zz AA 200\n")
    out.remove("no phoneme of this name is known")
    # Attached with the first angle, written before and after, for cores differ in which of them counts.
    assert out[:3] == ["servo 1 80", "attach 1 9", "servo 1 80"]
    assert all(line.startswith("servo ") for line in out[2:])
    times, angles = np.array([line.split()[1:] for line in out[2:] if line.startswith("servo ")], int).T
    assert times.tolist() == list(range(1, 9000, 20)) and 80 <= angles.min() and angles.max() <= 110
    assert np.abs(np.diff(angles)).max() <= 10 and angles[:25].max() == angles[-300:].max() == 80
    wide = np.flatnonzero(angles > 104)  # in both vowels of the second line
    assert angles[wide[0]:wide[-1]].min() <= 82


@pytest.mark.slow
def test_jaw_sketch_loses_nothing_of_a_long_line(lines_of: Lines) -> None:
    """Longer than a board's buffers: every vowel opens the jaw. What is beyond the sketch's limit is left out, once."""
    for count, least, most, said in ((60, 61, 61, []), (200, 128, 150, ["too long: the rest of the line is left out"])):
        text = "SIL 600 " + "AA 200 M 100 " * count + ("\n" if said else "\nAA 200\n")
        lines = lines_of("JawServo", 5000 + 300 * most, 0, 64, text=text)
        assert [line for line in lines[3:] if not line.startswith("servo ")] == said
        wide = np.array([int(line.split()[2]) > 100 for line in lines[3:] if line.startswith("servo ")])
        assert least <= np.count_nonzero(wide[1:] > wide[:-1]) <= most and not wide[-50:].any()


@pytest.mark.slow
def test_jaw_sketch_stops_at_a_word(lines_of: Lines) -> None:
    """In the midst of a vowel, with more behind it: the mouth closes at once, and the next line opens it again."""
    text = "AA 3000 M 100 AA 3000\n" + " " * 28800 + "stop\n" + " " * 17280 + "AA 200\n"  # after 2.5 s, and 1.5 s later
    lines = lines_of("JawServo", 6000, 0, 64, text=text)
    angles = np.array([int(line.split()[2]) for line in lines[2:]])  # every 20 ms
    assert angles[60:125].min() > 100 and angles[145:200].max() == 80 and angles[200:240].max() > 95
    assert angles[-20:].max() == 80


@pytest.mark.slow
def test_calibration_sketch(arduino: Path, objects: List[Path], tmp_path: Path) -> None:
    """``labial rig --calibrate``: one servo moves at a time, within what servos take; lines of a description."""
    (tmp_path / "face.toml").write_text('[output.jaw]\nfrom = "opening"\nclosed = 1400\nfull = 1900\n'
                                        '[output.lip]\nfrom = "upper_lip"\nneutral = 1500\nfull = 1700\n')
    assert main(["rig", str(tmp_path / "face.toml"), "--calibrate", "-o", str(tmp_path)]) == 0
    source = tmp_path / "face_calibrate" / "face_calibrate.ino"
    run(CXX, *arduino_options(arduino), "-x", "c++", source, "-x", "none", *objects, "-o", tmp_path / "sketch")
    text = "+>+cm0\n++m125 1---<f0" + "+" * 200 + "hg\np"
    lines = run(tmp_path / "sketch", 1005 + len(text), text=text).splitlines()
    pulses = [int(line.split()[-1]) for line in lines if line.startswith("pulse")]
    assert pulses[:4] == [1400, 1400, 1500, 1500]  # before and after attach()
    assert pulses[7:9] == [1431, 1441] and lines.count("jaw open 125") == 1
    pulses[7:9] = []
    assert pulses[4:11] == [1410, 1411, 1421, 1490, 1480, 1470, 1469]
    assert max(pulses) == 2600 and pulses[-1] == 1400
    assert "jaw closed = 1421" in lines and "lip full = 1469" in lines
    assert lines[-6:] == ["[output.jaw]", "closed = 1421", "maximum = 2600", "curve = [[1421, 0], [1441, 125]]",
                          "[output.lip]", "full = 1469"]
    (tmp_path / "face.toml").write_text('unit = "weight"\n[output.a]\nfrom = "opening"\nneutral = 0\nfull = 1\n')
    assert main(["rig", str(tmp_path / "face.toml"), "--calibrate", "-o", str(tmp_path)]) == 1


#: The command that starts file 1 of folder 1, checksum included.
PLAY = "7e ff 06 0f 00 01 01 fe ea ef"
#: When the sound of the sketches is heard: 3 s until the module is ready, the command, 11 ms, and the module's delay.
HEARD = 3000 + 11 + 200


def talk_frames() -> np.ndarray:
    """(T, 13) FAPs of the sketches' sentence and the way to rest after it."""
    return np.array(labial.render(labial.read_timings(SOURCE / "examples" / "talk" / "talk.lab")))


@pytest.mark.slow
def test_uno_sketch_plays_the_track(lines_of: Lines) -> None:
    """At reset and when the button is pressed: the module's command, then a pulse every 20 ms with the sound."""
    lines = lines_of("UnoJaw", 12000, 8000)
    assert [line for line in lines if line.startswith("serial")] == [f"serial 3000 {PLAY}", f"serial 8000 {PLAY}"]
    pulses = [tuple(map(int, line.split()[1:])) for line in lines if line.startswith("pulse")]
    text = (SOURCE / "examples" / "talk" / "talk.h").read_text()
    data = [int(x) for x in re.findall(r"\d+", re.search(r"_bytes\[\d+\][^{]*\{([^}]*)\}", text)[1])]
    wanted = [round(1400 + 500 * byte / 255) for byte in data]
    first, *talking = pulses
    assert first == (0, wanted[0]) and [pulse for _, pulse in talking] == 2 * wanted
    assert lines.index("attach 0 9") == lines.index(f"pulse 0 {wanted[0]}") + 1  # the first pulse is known
    starts = [3000, 8000]
    due = [start + HEARD - 3000 + 20 * n for start in starts for n in range(len(data))]
    assert [time for time, _ in talking] == due


@pytest.mark.slow
@needs_runtime
def test_face_sketch_moves_five_servos(lines_of: Lines) -> None:
    """Servo after servo begins; then every frame is on the wire with its sound, as the float64 rig has it; at rest."""
    lines = lines_of("FaceServos", 14000, 8000)
    assert [line for line in lines if line.startswith("serial")] == [f"serial 3000 {PLAY}", f"serial 8000 {PLAY}"]
    sleep, prescale, wake, *shown = [line.split()[1:] for line in lines if line.startswith("wire")]
    assert [words[1:] for words in (sleep, prescale, wake)] == [["40", "00", "10"], ["40", "fe", "79"],
                                                               ["40", "00", "20"]]
    assert all(words[1:3] == ["40", "06"] for words in shown)
    assert [(len(words) - 3) / 4 for words in shown] == [min(1 + tick // 25, 5) for tick in range(1, len(shown) + 1)]
    times = [int(words[0]) for words in shown]
    assert times == list(range(2, 14000, 20))  # a millisecond goes to the PCA9685's oscillator first
    ticks = np.zeros((len(shown), 5), int)
    for row, words in zip(ticks, shown):
        numbers = [int(word, 16) for word in words[3:]]
        row[:len(numbers) // 4] = [low + 256 * high for low, high in zip(numbers[2::4], numbers[3::4])]
    rig = read(SOURCE / "examples" / "faces" / "servos.toml", "servos")
    frames = talk_frames()
    wanted = expected(rig, convert(rig), frames)
    rest, count = [output.rest for output in convert(rig)], len(frames)
    first, second = (next(number for number, time in enumerate(times) if time >= start + HEARD - 3000)
                     for start in (3000, 8000))
    assert (ticks[100:first] == rest).all()
    assert np.abs(ticks[first:first + count, 1:] - wanted[:, 1:]).max() <= 1.5
    assert np.abs(ticks[first:first + count, 0] - wanted[:, 0]).mean() < 3 and np.ptp(ticks[first:, 0]) > 30
    assert (ticks[second - 10:second] == rest).all() and (ticks[-40:] == rest).all()
    # The second time begins at rest as well, where the first one ends.
    assert np.abs(ticks[second + 20:second + count, 1:] - wanted[20:, 1:]).max() <= 1.5


@pytest.mark.slow
@needs_runtime
def test_avatar_sketch_opens_the_mouth(lines_of: Lines) -> None:
    """The lips' opening over 600 FAP units: 0 up to 72 units, and between there and 136 in proportion."""
    lines = [line.split() for line in lines_of("AvatarMouth", 10000, 5000)]
    assert {words[0] for words in lines} == {"mouth"}
    assert [int(words[1]) for words in lines] == list(range(1, 10000, 20))
    frames = talk_frames()
    count = len(frames)
    ratios = np.array([float(words[2]) for words in lines])
    opening = -(frames[:, 3] + frames[:, 4])
    wanted = np.clip(opening / 600, 0, 1) * np.clip((opening - 72) / 64, 0, 1)
    assert np.abs(ratios[:count] - wanted).max() < 0.005 and np.ptp(wanted) > 0.8
    again = ratios[250:250 + count]  # the button was pressed at 5000 ms
    assert np.abs(again[20:] - wanted[20:]).max() < 0.005
    assert (ratios[count + 20:250] == 0).all() and (ratios[250 + count + 20:] == 0).all()


#: The core that the Arduino IDE has for its boards with an AVR, where Debian puts it.
CORE = Path("/usr/share/arduino/hardware/arduino/avr")


@pytest.mark.skipif(not shutil.which("avr-g++") or not CORE.is_dir(),
                    reason="no Arduino core: install gcc-avr, avr-libc and arduino-core-avr")
def test_uno_sketch_compiles_for_an_uno(arduino: Path, tmp_path: Path) -> None:
    """With Arduino's own core, and the stub's Servo: the track stays in flash, and is all that is large."""
    shutil.copyfile(STUB / "Servo.h", tmp_path / "Servo.h")
    sketch = arduino / "extras" / "UnoJaw"
    run("avr-g++", "-mmcu=atmega328p", "-DF_CPU=16000000L", "-DARDUINO=10819", "-DARDUINO_AVR_UNO",
        "-DARDUINO_ARCH_AVR", "-std=gnu++11", "-Os", "-Wall", "-Wextra", "-Werror", f"-I{CORE / 'cores' / 'arduino'}",
        f"-I{CORE / 'variants' / 'standard'}", f"-I{tmp_path}", "-include", "Arduino.h", "-x", "c++", "-c",
        sketch / "UnoJaw.ino", "-o", tmp_path / "sketch.o")
    text, data, bss = map(int, run("avr-size", tmp_path / "sketch.o").splitlines()[1].split()[:3])
    assert text < 1200 and data == 0 and bss < 40


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("arm-none-eabi-g++"),
                    reason="no arm-none-eabi-g++: install gcc-arm-none-eabi and libstdc++-arm-none-eabi-newlib")
def test_sketches_compile_for_arm(arduino: Path, tmp_path: Path) -> None:
    """Where uint32_t is another type than on the host. The preset m0 compiles the library itself."""
    files = [file for sketch in SKETCHES for file in sketch_files(arduino, sketch)]
    files.sort(key=lambda path: path.suffix != ".ino")  # g++ forgets -x behind a file whose suffix it knows
    run("arm-none-eabi-g++", "-mcpu=cortex-m0plus", "-mthumb", "-fno-exceptions", *arduino_options(arduino), "-x",
        "c++", "-c", *files, cwd=tmp_path)
    assert len(list(tmp_path.glob("*.o"))) == len(files)


# ---- PlatformIO, ESP-IDF, Zephyr: the tree as they see it ----------------------------------------------------------


@pytest.mark.slow
def test_platformio(packed: Packed, tmp_path: Path) -> None:
    """All sources below srcDir with the flags of library.json; the source tree has the same files there."""
    folder = packed("platformio")
    described = json.loads((folder / "library.json").read_text(encoding="utf-8"))
    build = described["build"]
    sketches = [sketch for name in described["export"]["include"] for sketch in (SOURCE / name).glob("*.ino")]
    assert len(sketches) == 2 and not any('#include "' in sketch.read_text(encoding="utf-8") for sketch in sketches)
    (tmp_path / "main.c").write_text(PROGRAM)
    sources = sorted((folder / build["srcDir"]).rglob("*.c"))
    assert files_of(folder / build["srcDir"]).items() <= files_of(SOURCE / build["srcDir"]).items()
    assert len(sources) == len(list((SOURCE / build["srcDir"]).rglob("*.c")))
    run(CC, *build["flags"], "-I", build["includeDir"], *sources, tmp_path / "main.c", "-o", tmp_path / "program",
        cwd=folder)
    assert run(tmp_path / "program") == expected_frames()


#: Stand-ins for the build functions of ESP-IDF and Zephyr: a static library with the given sources and folders.
ESP_IDF = """\
function(idf_component_register)
  cmake_parse_arguments(x "" "" "SRCS;INCLUDE_DIRS" ${ARGN})
  add_library(component STATIC ${x_SRCS})
  target_include_directories(component PUBLIC ${x_INCLUDE_DIRS})
endfunction()
set(ESP_PLATFORM 1)
"""
ZEPHYR = """\
set(CONFIG_LABIAL y)
set(CONFIG_LABIAL_SPEECH_EN y)
macro(zephyr_library_named name)
  add_library(component STATIC)
endmacro()
macro(zephyr_library_sources)
  target_sources(component PRIVATE ${ARGN})
endmacro()
macro(zephyr_include_directories)
  target_include_directories(component PUBLIC ${ARGN})
endmacro()
"""


@pytest.mark.slow
@pytest.mark.skipif(not CMAKE, reason="no cmake")
@pytest.mark.parametrize(("kind", "functions", "below"), [("esp-idf", ESP_IDF, ""), ("zephyr", ZEPHYR, "zephyr")],
                         ids=["esp-idf", "zephyr"])
def test_component_builds(packed: Packed, tmp_path: Path, kind: str, functions: str, below: str) -> None:
    """The component's CMakeLists.txt names files that suffice, and are those of the source tree."""
    files = files_of(packed(kind))
    assert {name for name in files if (SOURCE / name).read_bytes() != files[name]} <= {"NOTICE"}
    (tmp_path / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.20)\nproject(check C)\n{functions}"
        f'add_subdirectory("{(packed(kind) / below).as_posix()}" component)\n'
        "add_executable(program main.c)\ntarget_link_libraries(program component)\n"
        "get_target_property(sources component SOURCES)\n"
        'file(WRITE "${CMAKE_BINARY_DIR}/sources" "${sources}")\n')
    (tmp_path / "main.c").write_text(PROGRAM)
    run(CMAKE, "-S", tmp_path, "-B", tmp_path / "build")
    run(CMAKE, "--build", tmp_path / "build")
    assert run(tmp_path / "build" / "program") == expected_frames()
    assert ("laughter" in (tmp_path / "build" / "sources").read_text()) == (kind == "esp-idf")


@pytest.mark.slow
@pytest.mark.skipif(not CMAKE, reason="no cmake")
@pytest.mark.skipif("LABIAL_UNITY_SOURCE" not in os.environ, reason="no source of Unity: set LABIAL_UNITY_DIR")
def test_device_tests_run_as_apps_of_frameworks(tmp_path: Path) -> None:
    """As there, Unity has a unity_config.h behind the app's folders, and opens its port when the tests begin."""
    unity = Path(os.environ["LABIAL_UNITY_SOURCE"])
    (tmp_path / "port").mkdir()
    (tmp_path / "port" / "unity_config.h").write_text(
        "#include <stdio.h>\n#include <stdlib.h>\nextern int port_is_open;\n"
        "#define UNITY_OUTPUT_START() (void)(port_is_open = 1)\n"
        "#define UNITY_OUTPUT_CHAR(c) (void)(port_is_open ? putchar(c) : (abort(), 0))\n")
    (tmp_path / "port" / "port.c").write_text("extern int port_is_open;\nint port_is_open;\n")
    framework = [unity / "src" / "unity.c", tmp_path / "port" / "port.c"]
    app = SOURCE / "tests" / "device" / "esp-idf" / "main"
    (tmp_path / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.20)\nproject(check C)\nset(IDF_TARGET host)\nset(COMPONENT_LIB component)\n"
        f'{ESP_IDF}add_subdirectory("{app.as_posix()}" component)\n'
        f'add_executable(program main.c "{framework[0].as_posix()}" "{framework[1].as_posix()}")\n'
        f'target_include_directories(component PUBLIC "{(unity / "src").as_posix()}" port)\n'
        "target_compile_definitions(component PUBLIC UNITY_INCLUDE_CONFIG_H)\n"
        "target_link_libraries(program component)\n")
    (tmp_path / "main.c").write_text("void app_main(void);\nint main(void) { app_main(); return 0; }\n")
    run(CMAKE, "-S", tmp_path, "-B", tmp_path / "build")
    run(CMAKE, "--build", tmp_path / "build")
    assert run(tmp_path / "build" / "program").splitlines()[-1] == "OK"

    project = SOURCE / "tests" / "device" / "platformio"
    settings = configparser.ConfigParser(interpolation=None)
    settings.read(project / "platformio.ini", encoding="utf-8")
    root = (project / settings["platformio"]["src_dir"]).resolve()
    kept = re.findall(r"\+<(.*?)>", settings["env"]["build_src_filter"])
    flags = [flag.replace('\\"$PIOENV\\"', '"native"') for flag in settings["env"]["build_flags"].split()]
    sources = [path for name in kept for path in sorted(root.glob(name))]
    assert all(any(root.glob(name)) for name in kept)
    main = (project / "test" / "test_device" / "test_main.cpp")
    (tmp_path / "main.c").write_text(main.read_text(encoding="utf-8").replace('extern "C" ', ""))
    flags += ["-DUNITY_INCLUDE_CONFIG_H", f"-I{unity / 'src'}", f"-I{tmp_path / 'port'}"]
    run(CC, "-std=gnu99", *flags, *sources, tmp_path / "main.c", *framework, "-o", tmp_path / "native", cwd=project)
    assert run(tmp_path / "native").splitlines()[-1] == "OK"


def test_component_of_esp_idf_has_what_it_builds_from(packed: Packed) -> None:
    """What idf_component.yml does not exclude is what pack.py lays out, and README.md: catches a new file."""
    text = (SOURCE / "idf_component.yml").read_text(encoding="utf-8")
    excluded = {path for name in re.findall(r"^    - (\S+)$", text, re.MULTILINE) for path in SOURCE.glob(name)}
    own = ("build", ".git", ".pytest_cache", ".ruff_cache", ".venv", "CMakeUserPresets.json")  # in no clone
    left = {path.relative_to(SOURCE).as_posix() for entry in SOURCE.iterdir() if entry.name not in own
            for path in ([entry] if entry.is_file() else entry.rglob("*")) if path.is_file() and path not in excluded}
    assert left == {*files_of(packed("esp-idf")), "README.md"}


def test_zephyr_module_offers_every_model() -> None:
    """A model without an option could never be linked; module.yml names what exists."""
    options = re.findall(r"^config (\w+)$", (SOURCE / "zephyr" / "Kconfig").read_text(encoding="utf-8"), re.MULTILINE)
    words = [path.stem for path in (SOURCE / "lib" / "words").glob("*.h")]
    tables = sorted(f"LABIAL_{name.upper()}" for name in [*bundled(), *words])
    assert sorted(options) == tables, "zephyr/Kconfig, lib/models and lib/words"
    module = (SOURCE / "zephyr" / "module.yml").read_text(encoding="utf-8")
    assert (SOURCE / re.findall(r"^  cmake: (.*)$", module, re.MULTILINE)[0] / "CMakeLists.txt").is_file()
    assert (SOURCE / re.findall(r"^  kconfig: (.*)$", module, re.MULTILINE)[0]).is_file()
