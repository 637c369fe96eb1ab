"""Rigs, formats of output, readers of timings, sets of labels and models: each is one list in each language. These
tests say which file lacks what another one has, and add a rig to a copy of the sources."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Iterable, List, Set

import numpy as np
import pytest

import test_npm_timings
import test_services
from labial import animation
from labial.aliases import LABEL_SETS
from labial.corpus import formats, services
from labial.defaults import KINDS
from labial.phonesets import AUTO, PHONE_SETS
from labial.rig import FACES
from labial.rig.description import read
from labial.runtime import BUNDLED
from npm import MISSING
from packages import CMAKE, SOURCE, run

SAY = os.environ.get("LABIAL_SAY", "")
needs_say = pytest.mark.skipif(not SAY, reason="LABIAL_SAY does not name the built labial-say")
NODE = shutil.which("node")
MODELS = {path.name[: -len("_names.c")] for path in (SOURCE / "lib" / "models").glob("*_names.c")}


def text_of(name: str) -> str:
    return (SOURCE / name).read_text(encoding="utf-8")


def found(name: str, pattern: str) -> Set[str]:
    """What the group of `pattern` is in a file of the sources."""
    names = set(re.findall(pattern, text_of(name), re.MULTILINE))
    assert names, f"{name} has nothing of the form {pattern}: this test is out of date"
    return names


def lacks(name: str, has: Iterable[str], wanted: Iterable[str]) -> List[str]:
    """Sentences about what a file should have and does not."""
    return [f"{name} lacks {item}" for item in sorted(set(wanted) - set(has))]


def same(one: str, ones: Iterable[str], other: str, others: Iterable[str]) -> List[str]:
    """Sentences about what only one of two files has."""
    return lacks(one, ones, others) + lacks(other, others, ones)


def choices(option: str) -> Set[str]:
    """What labial-say takes for an option, by what it says of a wrong one."""
    done = subprocess.run([SAY, option, "?"], capture_output=True, encoding="utf-8", timeout=60, check=False)
    message = re.fullmatch(rf"labial-say: {option} is (.*), not '\?'; see labial-say --help\n", done.stderr)
    assert done.returncode == 2 and message, done.stderr
    return set(re.split(", | or ", message[1]))


@needs_say
def test_programs_know_the_same() -> None:
    """Catches what was added to labial-say or to the exporter alone."""
    lines = set(formats.FORMATS) - set(services.SERVICES)
    problems = [
        *same("examples/say/frames.c", choices("--to"), "export/labial/animation.py", animation.FORMATS),
        *same("examples/say/timings_lines.c", choices("--from") - {AUTO}, "export/labial/corpus/formats.py", lines),
        *same("examples/say/main.c", choices("--labels") - {AUTO}, "export/labial/aliases.py", LABEL_SETS),
        *same("examples/say/mouth.c", choices("--model"), "lib/models", MODELS),
    ]
    assert not problems, "; ".join(problems)


def test_a_format_is_no_rig() -> None:
    """Catches a rig that takes another format's name, and one whose values no avatar knows."""
    for name in {"csv", "fap", "livelink", "jsonl", "faps", "frame", "time"} & set(FACES):
        pytest.fail(f"export/labial/rig/{name}.toml: {name} is taken in what is written; name the file otherwise")
    for name in FACES:
        unit = animation.face(name).unit.name
        assert unit == "weight", f"export/labial/rig/{name}.toml: the unit of a format of output is weight, not {unit}"


def test_the_package_of_npm_knows_the_same() -> None:
    """Catches a reader without a type or a counterpart, and a set of labels that JavaScript calls otherwise."""
    readers = found("packaging/npm/timings.js", r"^export function (from\w+)")
    sets = dict(re.findall(r"(\w+): (0x\w+)", *found("packaging/npm/index.js", r"^const LABELS = \{(.*)\};")))
    (types,) = found("packaging/npm/index.d.ts", r"^export type Labels = (.*);")
    problems = [
        *same("packaging/npm/timings.js", readers, "packaging/npm/index.d.ts",
              found("packaging/npm/index.d.ts", r"^    function (from\w+)")),
        *lacks("export/labial/corpus/formats.py", formats.FORMATS, (name[len("from"):].lower() for name in readers)),
        *lacks("docs/browser.md", found("docs/browser.md", r"`timings\.(from\w+)`"), readers),
        *lacks("docs/browser.md", found("docs/browser.md", r'^\| `"(\w+)"`'), FACES),
        *lacks("tests/python/test_npm_timings.py", test_npm_timings.READERS, readers),
        *same("packaging/npm/index.js", sets, "packaging/npm/index.d.ts", re.findall(r'"(\w+)"', types)),
    ]
    assert not problems, "; ".join(problems)
    assert {name: int(bits, 16) for name, bits in sets.items()} == {AUTO: sum(LABEL_SETS.values()), **LABEL_SETS}


def test_pages_and_samples_have_every_format() -> None:
    """Catches a format that no reader of the pages learns of, and a reader of JSON that no test reads with."""
    pages = found("docs/timings.md", r"\| `(\w+)` \|$") | found("docs/kiosk.md", r"\| `(\w+)` \|$")
    problems = [
        *lacks("docs/avatar.md", found("docs/avatar.md", r"^\| `(\w+)` \|"), animation.FORMATS),
        *lacks("docs/timings.md, or docs/kiosk.md,", pages, formats.FORMATS),
        *lacks("tests/python/services", {source for source, _ in test_services.WORDS.values()}, services.SERVICES),
    ]
    assert not problems, "; ".join(problems)


def test_models_and_kinds() -> None:
    """Catches a model that only a part of the packages has, and a phone set that no command can be asked for."""
    problems = [
        *same("export/labial/runtime/__init__.py", BUNDLED, "lib/models", MODELS),
        *same("export/labial/__init__.py", found("export/labial/__init__.py", r"^    (\w+): Model$"), "lib/models",
              MODELS),
        *lacks("library.json", json.loads(text_of("library.json"))["headers"], (f"{name}.h" for name in MODELS)),
        *lacks("export/models", (path.stem for path in (SOURCE / "export" / "models").glob("*.npz")), MODELS),
        *same("export/labial/defaults.py", KINDS, "export/labial/phonesets.py", PHONE_SETS),
    ]
    assert not problems, "; ".join(problems)


# ---- A rig that nobody has yet -------------------------------------------------------------------------------------

PUPPET = """unit = "weight"

[output.beak]
from = "opening"
neutral = 0
full = 1
reach = 500

[output.cheeks]
from = { rounding = 1.0 }
neutral = 0
full = 1
reach = 150
"""
WORD = "0 0.1 sil\n0.1 0.2 m\n0.2 0.5 AA\n0.5 0.7 UW\n0.7 0.8 sil\n"


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A copy of the sources in which puppet.toml was added, and nothing else."""
    root = tmp_path / "labial"
    for name in ("boards", "cmake", "include", "lib", "packaging", "examples", "export/labial"):
        shutil.copytree(SOURCE / name, root / name, ignore=shutil.ignore_patterns("__pycache__", "*.wav", "*.flac"))
    for name in ("CMakeLists.txt", "LICENSE"):
        shutil.copy(SOURCE / name, root)
    (root / "bench").mkdir()
    (root / "bench" / "CMakeLists.txt").touch()
    (root / "export" / "labial" / "rig" / "puppet.toml").write_text(PUPPET, encoding="ascii")
    return root


def python(root: Path, *arguments: str) -> str:
    """What Python prints with the package of the copy."""
    environment = {**os.environ, "PYTHONPATH": str(root / "export"), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run([sys.executable, *arguments], cwd=root, env=environment, capture_output=True, check=True,
                          encoding="utf-8", timeout=120).stdout


def write_table(root: Path) -> None:
    """What the sentence of CMake says is to be done."""
    python(root, "-m", "labial", "rig", "export/labial/rig/puppet.toml", "-o", "examples/faces", "--no-figure")


@pytest.mark.skipif(not CMAKE, reason="needs cmake")
def test_a_description_is_a_format_and_asks_for_its_table(copy: Path, tmp_path: Path) -> None:
    """Catches a rig that the exporter must be told of, and one that labial-say lacks without a word."""
    assert "puppet" in python(copy, "-m", "labial", "synth", "--help")
    done = subprocess.run([CMAKE, "-S", copy, "-B", tmp_path / "build", "-DLABIAL_BUILD_TESTS=OFF"], check=False,
                          capture_output=True, encoding="utf-8", timeout=120)
    assert done.returncode != 0
    assert "examples/faces lacks the table of export/labial/rig/puppet.toml: write it with `labial rig" in (
        " ".join(done.stderr.split()))


@pytest.mark.slow
@pytest.mark.skipif(not CMAKE, reason="needs cmake")
def test_a_table_is_a_format_of_labial_say(copy: Path, tmp_path: Path) -> None:
    """Catches a rig that labial-say must be told of, and names or weights that are another rig's."""
    write_table(copy)
    build = tmp_path / "build"
    run(CMAKE, "-S", copy, "-B", build, "-DLABIAL_BUILD_TESTS=OFF", "-DCMAKE_BUILD_TYPE=Debug")
    run(CMAKE, "--build", build, "--target", "labial-say", "--parallel", "2")

    def say(*options: str) -> str:
        return subprocess.run([build / "examples" / "labial-say", *options], input=WORD, capture_output=True,
                              check=True, encoding="utf-8", timeout=60).stdout

    assert "arkit, oculus, puppet, vrm" in say("--help")
    faps = np.array([[float(x) for x in line.split(",")[1:]] for line in say("--to", "csv").splitlines()[1:]])
    rows = [json.loads(line)["puppet"] for line in say("--to", "puppet").splitlines()]
    wanted = animation.outputs(read(copy / "export" / "labial" / "rig" / "puppet.toml", "puppet"), faps)
    assert len(rows) == 40 and [*rows[0]] == [*wanted] == ["beak", "cheeks"]
    for name, column in wanted.items():
        assert [row[name] for row in rows] == pytest.approx(column, abs=0.0011) and max(column) > 0.3


SCRIPT = """
const [, url, word] = process.argv;
const { Labial, timings } = await import(url);
const labial = await Labial.load();
const track = labial.render(timings.fromLab(word), { output: "puppet" });
process.stdout.write(JSON.stringify([...track].map((weights) => [Object.keys(weights).join(), weights.beak])));
"""


@pytest.mark.slow
@pytest.mark.skipif(not NODE, reason="needs node: install the Debian package nodejs")
@pytest.mark.skipif(bool(MISSING), reason=MISSING)
def test_the_package_of_npm_takes_a_rig(copy: Path, tmp_path: Path) -> None:
    """Catches a rig that the package must be told of: it is an output, and a word of the types."""
    write_table(copy)
    build = tmp_path / "build"
    run(CMAKE, "-S", copy, "-B", build, f"-DCMAKE_TOOLCHAIN_FILE={copy / 'boards' / 'toolchains' / 'wasm.cmake'}",
        "-DCMAKE_BUILD_TYPE=Release", "-DLABIAL_BUILD_EXAMPLES=OFF", "-DLABIAL_BUILD_TESTS=OFF")  # fmt: skip
    run(CMAKE, "--build", build, "--target", "npm", "--parallel", "2")
    assert '    puppet:\n        | "beak"' in (build / "npm" / "faces.d.ts").read_text(encoding="ascii")
    url = (build / "npm" / "index.js").as_uri()
    done = subprocess.run([str(NODE), "--input-type=module", "-e", SCRIPT, url, WORD], capture_output=True, check=True,
                          encoding="utf-8", timeout=60)
    frames = json.loads(done.stdout)
    assert {names for names, _ in frames} == {"beak,cheeks"} and max(beak for _, beak in frames) > 0.3
