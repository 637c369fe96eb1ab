#!/usr/bin/env python3
"""Builds the Python package's wheels for Linux on x86-64 and aarch64, on any machine that zig runs on.

    packaging/wheels.py -o DIR [--platform x86_64 aarch64]

The compiler is zig's, from PyPI, with the C library of 2.17, so that the wheels are manylinux_2_17 ones: they need a
Linux of 2014 or newer and no compiler. wheels.txt names the versions of all that builds. The same sources give the same
bytes, whatever the machine, the folder and the time: the files' time is SOURCE_DATE_EPOCH, else 1980.

Needs cmake and make or ninja; fetches what wheels.txt names into a folder that it removes again.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Dict, List, Optional

from source import ROOT, PackError, exit_status

PLATFORMS = ("x86_64", "aarch64")
GLIBC = "2.17"
#: What the build reads, beside what `sdist.include` of pyproject.toml leaves out of it.
SOURCES = ("pyproject.toml", "README.md", "LICENSE", "NOTICE", "include", "lib", "flat",
           "cmake/BundledModels.cmake", "cmake/LabialTarget.cmake", "export/labial", "export/models")
#: Seconds since 1970: the first time that a zip file can name.
EARLIEST = "315532800"
#: Run by the environment's Python in the sources' folder, with the platform, the compiler's script and the folder. The
#: library calls nothing but the C library; with -nostdlib zig does not first build its compiler's run-time library,
#: which takes half a minute.
BUILD = """
import sys
from scikit_build_core.build import build_wheel
platform, compiler, folder = sys.argv[1:]
print(build_wheel(folder, {
    "cmake.define.CMAKE_SYSTEM_NAME": "Linux", "cmake.define.CMAKE_SYSTEM_PROCESSOR": platform,
    "cmake.define.CMAKE_C_COMPILER": compiler, "cmake.define.CMAKE_SHARED_LINKER_FLAGS": "-s -nostdlib",
    "cmake.define.CMAKE_C_STANDARD_LIBRARIES": "-lc", "cmake.define.CMAKE_TRY_COMPILE_TARGET_TYPE": "STATIC_LIBRARY",
    "install.strip": "false"}))
"""


def run(command: List[object], env: Dict[str, str], folder: Path) -> str:
    """Standard output of a command. PackError holds the last lines of what a failing one said."""
    words = [str(part) for part in command]
    done = subprocess.run(words, cwd=folder, env=env, capture_output=True, encoding="utf-8", check=False)
    if done.returncode:
        raise PackError(f"{words[0]}: " + "\n".join((done.stdout + done.stderr).strip().splitlines()[-20:]))
    return done.stdout


def environment(folder: Path) -> Path:
    """The interpreter of a new environment with what wheels.txt names."""
    run([sys.executable, "-m", "venv", folder], dict(os.environ), ROOT)
    python = folder / "bin" / "python"
    wanted = ROOT / "packaging" / "wheels.txt"
    run([python, "-m", "pip", "install", "-q", "--disable-pip-version-check", "--no-deps", "--require-hashes", "-r",
         wanted], dict(os.environ), ROOT)
    return python


def sources(tree: Path) -> None:
    """Copies what the build reads into `tree`."""
    for name in SOURCES:
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copyfile(ROOT / name, tree / name)


def built(python: Path, platform: str, folder: Path) -> Path:
    """The wheel as scikit-build-core makes it, which does not know what the compiler builds for."""
    tree, out = folder / "tree", folder / "out"
    out.mkdir(parents=True)
    sources(tree)
    compiler = folder / "cc"
    compiler.write_text(f'#!/bin/sh\nexec "{python}" -m ziglang cc -target {platform}-linux-gnu.{GLIBC} "$@"\n')
    compiler.chmod(0o755)
    env = {"ZIG_GLOBAL_CACHE_DIR": str(folder / "zig"), **os.environ, "ZIG_LOCAL_CACHE_DIR": str(folder / "zig")}
    run([python, "-c", BUILD, platform, compiler, out], env, tree)
    (found,) = out.glob("*.whl")
    return found


def tagged(python: Path, wheel: Path, platform: str, output: Path) -> Path:
    """Moves the wheel into `output` with the tag of its platform."""
    tag = f"manylinux_{GLIBC.replace('.', '_')}_{platform}"
    command = [python, "-m", "wheel", "tags", "--python-tag", "py3", "--abi-tag", "none", "--platform-tag", tag, wheel]
    name = run(command, dict(os.environ), wheel.parent).split()[-1]
    return Path(shutil.move(wheel.with_name(name), output / name))


def wheels(platforms: List[str], output: Path) -> List[Path]:
    """Builds a wheel for each platform into the folder `output`; returns them."""
    os.environ["SOURCE_DATE_EPOCH"] = os.environ.get("SOURCE_DATE_EPOCH") or EARLIEST
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="labial-wheels-") as temporary:
        python = environment(Path(temporary) / "environment")
        return [tagged(python, built(python, platform, Path(temporary) / platform), platform, output)
                for platform in platforms]


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs the command; returns its exit status: 0, or 1 when a wheel could not be built."""
    parser = argparse.ArgumentParser(prog="wheels.py", description="Builds the Python package's wheels for Linux.")
    parser.add_argument("-o", "--output", required=True, metavar="DIR")
    parser.add_argument("--platform", nargs="+", choices=PLATFORMS, default=list(PLATFORMS), help="default: both")
    options = parser.parse_args(arguments)

    def work() -> None:
        for path in wheels(options.platform, Path(options.output).resolve()):
            print(path)

    return exit_status("wheels.py", work)


if __name__ == "__main__":
    sys.exit(main())
