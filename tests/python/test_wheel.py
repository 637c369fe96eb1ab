"""The Python package as a user gets it: a wheel built in a bare environment, installed where there is nothing else; and
the wheels of a release."""

from __future__ import annotations

import base64
import contextlib
import hashlib
import io
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from pathlib import Path
from typing import Dict, Iterator, List

import pytest

import labial
import wheels
from labial.core import library
from packages import CC, CMAKE, SOURCE, attributions, run
from scripts import digest
from test_runtime import conformance_frames, conformance_scripts

#: What a build needs beside the compiler; a bare environment has nothing else, and no ninja.
TOOLS = ("cmake", "make", "sh", "as", "ld")

pytestmark = [pytest.mark.slow,
              pytest.mark.skipif(not (CMAKE and all(map(shutil.which, TOOLS))), reason="no cmake or no make")]


def tools(folder: Path) -> Dict[str, str]:
    """An environment whose PATH has `TOOLS` alone."""
    folder.mkdir()
    for name in TOOLS:
        (folder / name).symlink_to(shutil.which(CMAKE if name == "cmake" else name) or name)
    return {"PATH": str(folder), "HOME": str(folder), "PIP_NO_INDEX": "1", "PIP_DISABLE_PIP_VERSION_CHECK": "1"}


def call(command: List[object], env: Dict[str, str], cwd: Path, text: str = "") -> subprocess.CompletedProcess:
    """Runs a command with this environment and no other variable."""
    return subprocess.run([str(part) for part in command], env=env, cwd=cwd, input=text, capture_output=True,
                          encoding="utf-8", timeout=300, check=False)


def plays(python: List[object], env: Dict[str, str], cwd: Path) -> None:
    """Asserts that an interpreter has the package, which plays the conformance streams in every way."""
    player = SOURCE / "tests" / "python" / "runtime_player.py"
    done = call([*python, player], env, cwd, json.dumps(conformance_scripts()))
    assert done.returncode == 0, done.stderr
    wanted = {name: [len(frames), digest(frames)] for name, frames in conformance_frames().items()}
    assert json.loads(done.stdout) == dict.fromkeys(("fill", "single", "hungry", "whole"), wanted)


def venv(folder: Path, *sites: str) -> Path:
    """The interpreter of a new environment without pip; with the packages of `sites`."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(folder)], check=True)
    python = folder / "bin" / "python"
    if sites:
        site = next((folder / "lib").glob("python*")) / "site-packages"
        (site / "tests.pth").write_text("\n".join(sites) + "\n")
    return python


@pytest.fixture(scope="module")
def packed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the source distribution, and an environment with what the tests' own has to build it."""
    folder = tmp_path_factory.mktemp("wheel")
    tree = folder / "tree"
    unwanted = shutil.ignore_patterns("__pycache__", "build", "*.egg-info")
    for name in ("include", "lib", "flat", "cmake", "export/labial", "export/models"):
        shutil.copytree(SOURCE / name, tree / name, ignore=unwanted)
    for name in ("pyproject.toml", "README.md", "LICENSE", "NOTICE"):
        shutil.copyfile(SOURCE / name, tree / name)
    (tree / "export" / "labial" / "__pycache__").mkdir()
    (tree / "export" / "labial" / "__pycache__" / "left.pyc").touch()
    python = venv(folder / "builder", sysconfig.get_path("purelib"), sysconfig.get_path("platlib"))
    packing = "import sys; from scikit_build_core.build import build_sdist; build_sdist(sys.argv[1])"
    done = call([python, "-c", packing, folder], tools(folder / "bin"), tree)
    assert done.returncode == 0, done.stdout + done.stderr
    shutil.rmtree(tree)
    return folder


def build_wheel(packed: Path, env: Dict[str, str]) -> subprocess.CompletedProcess:
    """``pip wheel`` of the source distribution."""
    (archive,) = packed.glob("labial-*.tar.gz")
    return call([packed / "builder" / "bin" / "python", "-m", "pip", "wheel", archive, "--no-deps",
                 "--no-build-isolation", "--no-cache-dir", "-w", packed / "dist"], env, packed)


@pytest.fixture(scope="module")
def wheel(packed: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    done = build_wheel(packed, {**tools(tmp_path_factory.mktemp("tools") / "bin"), "CC": str(shutil.which(CC))})
    assert done.returncode == 0, done.stdout + done.stderr
    (found,) = (packed / "dist").iterdir()
    return found


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The interpreter of an environment that holds the wheel and nothing else, not even numpy."""
    folder = tmp_path_factory.mktemp("installed")
    python = venv(folder / "venv")
    subprocess.run([sys.executable, "-m", "pip", "--python", str(python), "install", "-q", "--no-deps", "--no-index",
                    str(wheel)], check=True)
    return python


def test_wheel_serves_every_python(wheel: Path) -> None:
    """Nothing of Python's is compiled in, so the tag names the platform alone; all files and no others are there."""
    python, abi, platform = wheel.stem.split("-")[-3:]
    assert (python, abi) == ("py3", "none") and platform != "any"
    names = zipfile.ZipFile(wheel).namelist()
    assert [name for name in names if name.endswith((".so", ".dll", ".dylib"))] == ["labial/core/labial_runtime.so"]
    wanted = {f"labial/{path.relative_to(SOURCE / 'export' / 'labial').as_posix()}"
              for path in (SOURCE / "export" / "labial").rglob("*") if path.is_file() and path.suffix != ".pyc"}
    wanted |= {f"labial/models/{path.name}" for path in (SOURCE / "export" / "models").glob("*.npz")}
    rest = {name for name in names if ".dist-info/" not in name} - wanted
    assert rest == {"labial/core/labial_runtime.so"} and wanted <= set(names)
    carried = " ".join(zipfile.ZipFile(wheel).read(
        f"labial-{labial.__version__}.dist-info/licenses/{name}").decode() for name in ("LICENSE", "NOTICE"))
    carried = " ".join(carried.split())
    assert "MIT License" in carried and all(text in carried for text in attributions().values())


def test_installed_wheel_needs_nothing(installed: Path, tmp_path: Path) -> None:
    """The same frames as everywhere, timings and a rig without numpy; the exporter says what it needs."""
    plays([installed], {"PATH": str(tmp_path)}, tmp_path)
    (tmp_path / "word.lab").write_text("0 0.1 M\n0.1 0.3 AY\n")
    program = ("import sys, labial\n"
               "motion = labial.render(labial.read_timings('word.lab'))\n"
               "assert len(motion) == 15 + 12\n"
               "assert 'numpy' not in sys.modules\n")
    if sys.version_info >= (3, 11):  # before that the package asks for a TOML parser, which is not installed here
        program += "assert labial.Frame(0, motion[5]).rig('arkit')['jawOpen'] > 0\n"
    done = call([installed, "-c", program], {"PATH": ""}, tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    done = call([installed.with_name("labial"), "synth", "x.npz", "word.lab"], {"PATH": ""}, tmp_path)
    assert done.returncode == 1
    assert done.stderr == ("labial: labial synth needs the package numpy: "
                           "pip install '.[tools]' in Labial's folder (docs/install.md)\n")
    done = call([installed.with_name("labial"), "--version"], {"PATH": ""}, tmp_path)
    assert (done.returncode, done.stdout) == (0, f"labial {labial.__version__}\n")


def test_installed_exporter_brings_the_library(installed: Path, tmp_path: Path) -> None:
    """With numpy, ``labial check`` has the library that came with the package, ``labial bake`` has its models."""
    env = {"PATH": "", "OPENBLAS_NUM_THREADS": "1",
           "PYTHONPATH": os.pathsep.join((sysconfig.get_path("purelib"), sysconfig.get_path("platlib")))}
    (tmp_path / "word.lab").write_text("0 0.1 SIL\n0.1 0.2 M\n0.2 0.4 AY\n0.4 0.5 W\n0.5 0.6 IY\n0.6 0.7 L\n"
                                       "0.7 0.9 OW\n0.9 1 SIL\n")
    done = call([installed.with_name("labial"), "check", SOURCE / "export" / "models" / "speech_en.npz", "word.lab"],
                env, tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("50 frames") and os.sep not in done.stdout
    done = call([installed.with_name("labial"), "bake", "word.lab", "-o", "word.h"], env, tmp_path)
    assert (done.returncode, done.stdout.split()) == (0, ["word.h", "labial_player.h"]), done.stderr


def test_without_a_compiler_the_build_says_so(packed: Path, tmp_path: Path) -> None:
    """One sentence on one line, instead of CMake's guesses."""
    done = build_wheel(packed, tools(tmp_path / "bin"))
    assert done.returncode != 0
    lines = [line.strip() for line in (done.stdout + done.stderr).splitlines()]
    assert ("The run-time is C and there is no C compiler: install one (Debian, Raspberry Pi OS: apt-get install "
            "build-essential) or name it in the variable CC.") in lines


LIBRARY = "labial/core/labial_runtime.so"
#: ELF's numbers of the processors.
MACHINES = {"x86_64": 62, "aarch64": 183}
#: What the library is built with (flat/CMakeLists.txt).
LIMITS = ("-DLABIAL_QUEUE=32", "-DLABIAL_MODELS=64")
QEMU = shutil.which("qemu-aarch64")
ROOT = Path("/usr/aarch64-linux-gnu")


# ---- packaging/wheels.py: for two processors, the same bytes wherever they are built; for aarch64 under qemu


@pytest.fixture(scope="module")
def builder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The interpreter of an environment with zig, which keeps its cache, and what else the wheels are built with."""
    if sys.platform != "linux":
        pytest.skip("needs Linux")
    folder = tmp_path_factory.mktemp("builder")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ZIG_GLOBAL_CACHE_DIR", str(folder / "zig"))  # what it makes of its C library
        yield wheels.environment(folder / "environment")


def build(folder: Path, builder: Path, *platforms: str) -> Dict[str, Path]:
    """The wheels by platform, built by the command in a temporary folder below `folder`."""
    (folder / "temporary").mkdir(parents=True)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(wheels, "environment", lambda _: builder)  # which takes long to install
        patch.setattr(tempfile, "tempdir", str(folder / "temporary"))
        patch.setenv("SOURCE_DATE_EPOCH", "1700000001")
        patch.setenv("PYTHONDONTWRITEBYTECODE", "1")
        patch.delenv("CMAKE_C_COMPILER_LAUNCHER", raising=False)  # which would remember the first build in the second
        with contextlib.redirect_stdout(io.StringIO()) as said:
            assert wheels.main(["-o", str(folder / "dist"), "--platform", *platforms]) == 0
    return dict(zip(platforms, map(Path, said.getvalue().splitlines())))


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory, builder: Path) -> Dict[str, Path]:
    return build(tmp_path_factory.mktemp("wheels"), builder, *MACHINES)


def test_wheels_are_what_their_names_say(built: Dict[str, Path]) -> None:
    """Catches a library of another processor or a newer system, a damaged list of files, and files that are missing."""
    for platform, wheel in built.items():
        assert wheel.name == f"labial-{labial.__version__}-py3-none-manylinux_2_17_{platform}.whl"
        files = _contents(wheel)
        info = f"labial-{labial.__version__}.dist-info"
        assert re.findall(r"^Tag: (.*)$", files[f"{info}/WHEEL"].decode(), re.M) == [
            f"py3-none-manylinux_2_17_{platform}"]
        rows = dict(line.split(",", 1) for line in files[f"{info}/RECORD"].decode().splitlines())
        assert set(rows) == set(files)
        for name, row in rows.items():
            own = base64.urlsafe_b64encode(hashlib.sha256(files[name]).digest()).rstrip(b"=").decode()
            assert row == ("," if name.endswith("/RECORD") else f"sha256={own},{len(files[name])}"), name
        library = files[LIBRARY]
        assert library[:4] == b"\x7fELF" and int.from_bytes(library[18:20], "little") == MACHINES[platform]
        needed = {tuple(map(int, version.split(b"."))) for version in re.findall(rb"GLIBC_([\d.]+)", library)}
        assert needed and max(needed) <= (2, 17)
        assert {"labial/__main__.py", "labial/models/speech_en.npz"} <= set(files)


def _contents(wheel: Path) -> Dict[str, bytes]:
    with zipfile.ZipFile(wheel) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_the_same_sources_give_the_same_bytes(built: Dict[str, Path], builder: Path, tmp_path: Path) -> None:
    """Catches times, paths and orders of files that come from the machine."""
    again = build(tmp_path / "elsewhere", builder, "aarch64")
    assert again["aarch64"].read_bytes() == built["aarch64"].read_bytes()


@pytest.mark.skipif(os.uname().machine != "x86_64", reason="the machine is none that the wheel is for")
def test_the_wheel_for_this_machine_plays_the_conformance_streams(built: Dict[str, Path], tmp_path: Path) -> None:
    """As an installed package, without numpy."""
    own = tmp_path / "own"
    run(sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--no-index", "--target", own, built["x86_64"])
    plays([sys.executable, "-S"], {"PYTHONPATH": str(own), "PATH": ""}, tmp_path)


@pytest.mark.skipif(not QEMU or not ROOT.is_dir(), reason="needs an emulator: install qemu-user and libc6-arm64-cross")
def test_the_wheel_for_aarch64_plays_the_conformance_streams(built: Dict[str, Path], builder: Path,
                                                             tmp_path: Path) -> None:
    """Its library exports the flat interface; its sources, in the program of all boards, play the streams."""
    (tmp_path / "labial_runtime.so").write_bytes(_contents(built["aarch64"])[LIBRARY])
    (tmp_path / "flat.c").write_text("#include <stdio.h>\nextern int flat_interface(void);\n"
                                     "int main(void)\n{\n    return printf(\"%d\", flat_interface()) < 0;\n}\n")
    zig = [builder, "-m", "ziglang", "cc", "-target", "aarch64-linux-gnu.2.17", "-O1"]
    environment = {"ZIG_LOCAL_CACHE_DIR": str(tmp_path / "local")}
    run(*zig, "flat.c", "labial_runtime.so", "-Wl,-rpath,$ORIGIN", "-o", "flat", cwd=tmp_path, env=environment)
    assert int(run(QEMU, "-L", ROOT, tmp_path / "flat")) == library._INTERFACE
    conformance = SOURCE / "tests" / "conformance"
    includes = [f"-I{SOURCE / name}" for name in ("include", "lib", "lib/models", "boards", "tests/conformance",
                                                  "tests/c")]
    run(*zig, *LIMITS, '-DBOARD_NAME="aarch64"', *includes,
        *(conformance / f"{name}.c" for name in ("conformance", "player", "vectors")),
        *sorted((SOURCE / "lib").glob("*.c")),
        *(SOURCE / "lib" / "models" / f"{name}.c" for name in ("speech_en", "laughter_synthetic")),
        SOURCE / "boards" / "text.c", SOURCE / "boards" / "host" / "host.c", "-o", "conformance", cwd=tmp_path,
        env=environment)
    said = run(QEMU, "-L", ROOT, tmp_path / "conformance")
    assert re.search(r"^\d\d streams, 0 failures$", said, re.M)
