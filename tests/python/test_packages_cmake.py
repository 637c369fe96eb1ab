"""Labial in other people's builds: installed, found by CMake and by pkg-config, or as a part of their own project."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

import labial
from packages import CC, CMAKE, PROGRAM, SOURCE, expected_frames, run

pytestmark = pytest.mark.skipif(not CMAKE, reason="no cmake")

HEAD = "cmake_minimum_required(VERSION 3.22)\nproject(theirs C)\n"
LINK = "add_executable(program main.c)\ntarget_link_libraries(program PRIVATE labial::speech_en)\n"
INSIDE = {
    "add_subdirectory": f'add_subdirectory("{SOURCE.as_posix()}" labial)\n',
    "FetchContent": "include(FetchContent)\n"
    f'FetchContent_Declare(labial SOURCE_DIR "{SOURCE.as_posix()}")\nFetchContent_MakeAvailable(labial)\n',
}


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An installed tree, moved after it was installed, with one limit overridden."""
    folder = tmp_path_factory.mktemp("install")
    run(CMAKE, "-S", SOURCE, "-B", folder / "build", "-DLABIAL_BUILD_TESTS=OFF", "-DLABIAL_BUILD_EXAMPLES=OFF",
        "-DCMAKE_BUILD_TYPE=Debug", "-DLABIAL_QUEUE=33", f"-DCMAKE_INSTALL_PREFIX={folder / 'first'}")
    run(CMAKE, "--build", folder / "build")
    run(CMAKE, "--install", folder / "build")
    shutil.rmtree(folder / "build")
    return (folder / "first").rename(folder / "moved")


def build(folder: Path, lists: str, *options: str) -> str:
    """Configures and builds a project; the output of its program."""
    (folder / "CMakeLists.txt").write_text(lists)
    (folder / "main.c").write_text(PROGRAM)
    run(CMAKE, "-S", folder, "-B", folder / "build", *options)
    run(CMAKE, "--build", folder / "build", "--target", "program")
    return run(folder / "build" / "program")


@pytest.mark.slow
def test_find_package(installed: Path, tmp_path: Path) -> None:
    """The target brings headers, the library below the model and its limit; the attributions are installed."""
    find = f"find_package(labial {labial.__version__} REQUIRED COMPONENTS speech_en laughter_synthetic)\n"
    assert build(tmp_path, HEAD + find + LINK, f"-DCMAKE_PREFIX_PATH={installed}") == expected_frames()
    (tmp_path / "main.c").write_text('#include "speech_en.h"\nint main(void) { return LABIAL_QUEUE != 33; }\n')
    run(CMAKE, "--build", tmp_path / "build")
    run(tmp_path / "build" / "program")
    assert sorted(path.name for path in (installed / "share" / "doc" / "labial").iterdir()) == ["LICENSE", "NOTICE"]


@pytest.mark.slow
def test_what_a_program_defines_is_no_part_of_a_build(tmp_path: Path) -> None:
    """Labial's own programs define neither locks nor sums, and would not link."""
    for options in (["-DLABIAL_LOCKS=2"], ["-ULABIAL_LOCKS", "-DLABIAL_HEAR_SUMS=1"], ["-DLABIAL_LOCKS=2"]):
        out = run(CMAKE, "-S", SOURCE, "-B", tmp_path, "-DLABIAL_BUILD_TESTS=OFF", *options)
        assert "labial-say and the other programs are left out" in out
    run(CMAKE, "--build", tmp_path)  # with both


def test_the_published_method_has_a_variable_of_its_own(tmp_path: Path) -> None:
    out = run(CMAKE, "-S", SOURCE, "-B", tmp_path, "-DLABIAL_BUILD_TESTS=OFF", "-DLABIAL_PAPER=1", status=1)
    assert "LABIAL_METHOD=paper selects the published method here" in " ".join(out.split())


@pytest.mark.slow
@pytest.mark.parametrize(("asked", "complaint"), [
    ("labial 99.1 REQUIRED", "99.1"), ("labial REQUIRED COMPONENTS french", "french")])
def test_find_package_refuses(installed: Path, tmp_path: Path, asked: str, complaint: str) -> None:
    """Another minor version and a model that there is not end with an error that names it."""
    (tmp_path / "CMakeLists.txt").write_text(HEAD + f"find_package({asked})\n")
    out = run(CMAKE, "-S", tmp_path, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={installed}", status=1)
    assert complaint in out


@pytest.mark.skipif(not shutil.which("pkg-config"), reason="no pkg-config: install pkgconf")
def test_pkg_config(installed: Path, tmp_path: Path) -> None:
    """Flags from pkg-config alone compile and link a program, with the limit of the build."""
    folders = [path.parent for path in installed.rglob("labial.pc")]
    assert len(folders) == 1
    env = {"PKG_CONFIG_PATH": str(folders[0])}
    flags = run("pkg-config", "--cflags", "--libs", "labial_speech_en", env=env).split()
    assert "-DLABIAL_QUEUE=33" in flags
    (tmp_path / "main.c").write_text(PROGRAM)
    run(CC, tmp_path / "main.c", *flags, "-o", tmp_path / "program")
    assert run(tmp_path / "program") == expected_frames()
    assert run("pkg-config", "--modversion", "labial", env=env).count(".") == 2


@pytest.mark.slow
@pytest.mark.parametrize("way", sorted(INSIDE))
def test_inside_another_project(tmp_path: Path, way: str) -> None:
    """The project keeps its own flags, build type, tests and installation; every cache entry bears Labial's name."""
    lists = HEAD + "enable_testing()\n{}" + LINK + "install(TARGETS program)\n"
    bare = tmp_path / "bare"
    bare.mkdir()
    (bare / "CMakeLists.txt").write_text(HEAD + "include(FetchContent)\nFetchContent_Declare(none SOURCE_DIR .)\n")
    run(CMAKE, "-S", bare, "-B", bare / "build")
    frames = build(tmp_path, lists.format(INSIDE[way]), "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
    assert frames == expected_frames()

    def cache(folder: Path) -> dict:
        lines = (folder / "build" / "CMakeCache.txt").read_text().splitlines()
        return dict(line.split("=", 1) for line in lines if line and not line.startswith(("//", "#")))

    names = {entry.split(":")[0] for entry in set(cache(tmp_path)) - set(cache(bare))}
    # CMake itself adds the last two, for any project with a version and for the option above.
    expected = ("labial_", "fetchcontent_", "cmake_project_version", "cmake_export")
    assert {name for name in names if not name.lower().startswith(expected)} == set()
    assert cache(tmp_path)["CMAKE_BUILD_TYPE:STRING"] == ""
    commands = json.loads((tmp_path / "build" / "compile_commands.json").read_text())
    own = [entry["command"] for entry in commands if entry["file"].endswith("main.c")]
    assert len(own) == 1 and " -W" not in own[0] and " -f" not in own[0] and "-std=" not in own[0]
    assert "Total Tests: 0" in run("ctest", "-N", cwd=tmp_path / "build")
    run(CMAKE, "--install", tmp_path / "build", "--prefix", tmp_path / "prefix")
    assert [path.name for path in (tmp_path / "prefix").rglob("*") if path.is_file()] == ["program"]
