"""packaging/wheels.py: wheels for two processors, the same bytes wherever they are built, that play the conformance
streams; the one for aarch64 under qemu."""

from __future__ import annotations

import base64
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path
from typing import Dict

import pytest

import labial
from packages import CMAKE, SOURCE, run
from runtime import conformance_frames, conformance_scripts
from scripts import digest

LIBRARY = "labial/core/labial_runtime.so"
#: ELF's numbers of the processors.
MACHINES = {"x86_64": 62, "aarch64": 183}
#: What the library is built with (flat/CMakeLists.txt).
LIMITS = ("-DLABIAL_QUEUE=32", "-DLABIAL_MODELS=64")
QEMU = shutil.which("qemu-aarch64")
ROOT = Path("/usr/aarch64-linux-gnu")

pytestmark = [pytest.mark.slow,
              pytest.mark.skipif(not CMAKE or sys.platform != "linux", reason="needs cmake, on Linux")]  # fmt: skip


@pytest.fixture(scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where zig keeps what it made of its C library."""
    return tmp_path_factory.mktemp("zig")


def build(folder: Path, cache: Path, *platforms: str) -> Dict[str, Path]:
    """The wheels by platform, built in a temporary folder below `folder`."""
    (folder / "temporary").mkdir(parents=True)
    env = {"ZIG_GLOBAL_CACHE_DIR": str(cache), "TMPDIR": str(folder / "temporary"), "SOURCE_DATE_EPOCH": "1700000001"}
    command = [sys.executable, SOURCE / "packaging" / "wheels.py", "-o", folder / "dist", "--platform", *platforms]
    done = subprocess.run(command, env={**os.environ, **env, "PYTHONDONTWRITEBYTECODE": "1"}, capture_output=True,
                          encoding="utf-8", timeout=1500, check=False)  # fmt: skip
    assert done.returncode == 0, done.stderr
    return dict(zip(platforms, map(Path, done.stdout.splitlines())))


@pytest.fixture(scope="module")
def wheels(tmp_path_factory: pytest.TempPathFactory, cache: Path) -> Dict[str, Path]:
    """The wheel of each platform."""
    return build(tmp_path_factory.mktemp("wheels"), cache, *MACHINES)


def test_wheels_are_what_their_names_say(wheels: Dict[str, Path]) -> None:
    """Catches a library of another processor or a newer system, a damaged list of files, and files that are missing."""
    for platform, wheel in wheels.items():
        assert wheel.name == f"labial-{labial.__version__}-py3-none-manylinux_2_17_{platform}.whl"
        files = {name: data for name, data in _contents(wheel).items()}
        info = f"labial-{labial.__version__}.dist-info"
        assert re.findall(r"^Tag: (.*)$", files[f"{info}/WHEEL"].decode(), re.M) == [
            f"py3-none-manylinux_2_17_{platform}"]  # fmt: skip
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


def test_the_same_sources_give_the_same_bytes(wheels: Dict[str, Path], cache: Path, tmp_path: Path) -> None:
    """Catches times, paths and orders of files that come from the machine."""
    again = build(tmp_path / "elsewhere", cache, "aarch64")
    assert again["aarch64"].read_bytes() == wheels["aarch64"].read_bytes()


@pytest.mark.skipif(os.uname().machine != "x86_64", reason="the machine is none that the wheel is for")
def test_the_wheel_for_this_machine_plays_the_conformance_streams(wheels: Dict[str, Path], tmp_path: Path) -> None:
    """As an installed package, without numpy."""
    own = tmp_path / "own"
    run(sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--no-index", "--target", own, wheels["x86_64"])
    done = subprocess.run([sys.executable, "-S", SOURCE / "tests" / "python" / "runtime_player.py"],
                          env={"PYTHONPATH": str(own), "PATH": ""}, cwd=tmp_path, capture_output=True, timeout=300,
                          input=json.dumps(conformance_scripts()), encoding="utf-8", check=False)  # fmt: skip
    assert done.returncode == 0, done.stderr
    wanted = {name: [len(frames), digest(frames)] for name, frames in conformance_frames().items()}
    assert set(map(json.dumps, json.loads(done.stdout).values())) == {json.dumps(wanted)}


@pytest.mark.skipif(not QEMU or not ROOT.is_dir(), reason="needs an emulator: install qemu-user and libc6-arm64-cross")
def test_the_wheel_for_aarch64_plays_the_conformance_streams(wheels: Dict[str, Path], cache: Path,
                                                             tmp_path: Path) -> None:
    """The wheel's own library under qemu, called by the program that every board runs."""
    (tmp_path / "labial_runtime.so").write_bytes(_contents(wheels["aarch64"])[LIBRARY])
    run(sys.executable, "-m", "venv", "--without-pip", tmp_path / "zig")
    site = tmp_path / "zig" / "lib" / Path(sysconfig.get_path("purelib")).parent.name / "site-packages"
    wanted = re.findall(r"^ziglang==.*$", (SOURCE / "packaging" / "wheels.txt").read_text(), re.M)
    run(sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--target", site, *wanted)
    conformance = SOURCE / "tests" / "conformance"
    includes = [f"-I{SOURCE / name}" for name in ("include", "lib", "lib/models", "boards", "tests/conformance",
                                                  "tests/c")]  # fmt: skip
    run(tmp_path / "zig" / "bin" / "python", "-m", "ziglang", "cc", "-target", "aarch64-linux-gnu.2.17", "-O1", *LIMITS,
        '-DBOARD_NAME="aarch64"', *includes,
        *(conformance / f"{name}.c" for name in ("conformance", "player", "vectors")),
        SOURCE / "boards" / "text.c", SOURCE / "boards" / "host" / "host.c", "labial_runtime.so", "-Wl,-rpath,$ORIGIN",
        "-o", "conformance", cwd=tmp_path, env={"ZIG_GLOBAL_CACHE_DIR": str(cache),
                                                "ZIG_LOCAL_CACHE_DIR": str(tmp_path / "local")})  # fmt: skip
    said = run(QEMU, "-L", ROOT, tmp_path / "conformance")
    assert re.search(r"^\d\d streams, 0 failures$", said, re.M)
