"""What commands write is whole: the old file or the new one, whatever happens meanwhile."""

from __future__ import annotations

import json
import os
import shutil
import stat
import subprocess
import sys
import threading
from importlib.util import find_spec
from pathlib import Path
from typing import List

import pytest

from labial.__main__ import main
from labial.commands import COMMANDS
from labial.errors import LabialError
from labial.files import outputs
from labial.tables.model import save
from models import random_model
from packages import CC, run
from test_workers import folder as corpus  # noqa: F401, a fixture

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="files that are preloaded are those of Linux")

LAB = "0.00 0.20 SIL\n0.20 0.31 P1\n0.71 1.00 SIL\n"
HERE = Path(__file__).parent


@pytest.mark.slow
def test_interrupted_commands(tmp_path: Path, corpus: Path) -> None:  # noqa: F811
    """A full disk, SIGKILL, SIGTERM at 20 random writes: no half a file, none left behind, no wrong name told."""
    shutil.copytree(corpus, tmp_path / "corpus")
    library = tmp_path / "injector.so"
    run(CC, "-shared", "-fPIC", "-O1", "-o", library, HERE / "injector.c", "-ldl")
    done = subprocess.run([sys.executable, HERE / "injected.py", library, tmp_path, "20"], capture_output=True,
                          text=True, check=False, env={**os.environ, "LD_PRELOAD": str(library)})
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert {name.split(",")[0] for name in found} == set(COMMANDS) - {"check"}
    assert {name: wrong for name, wrong in found.items() if wrong} == {}


#: Begins to write, says so, and waits.
HOLDS = """
import sys
from labial.files import outputs
with getattr(outputs, sys.argv[1])(sys.argv[2]) as made:
    if sys.argv[1] == "folder":
        (made / "a.txt").write_text("begun")
    else:
        made.write(b"begun"), made.flush()
    print("begun", flush=True)
    sys.stdin.readline()
    if sys.argv[1] == "folder":
        (made / "a.txt").write_text("whole")
    else:
        made.seek(0), made.write(b"whole")
"""


@pytest.mark.parametrize(("way", "target"), [("writing", "x/a.txt"), ("folder", "x"), ("folder", "x/new")])
def test_what_dead_runs_left_is_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, way: str, target: str) -> None:
    """By the next run of the same output; what a process that runs, and others, have there stays."""
    monkeypatch.chdir(tmp_path)
    Path("x").mkdir()
    kept = [".b.txt.01234567.part", ".a.txt.0123456.part", ".a.txt.01234567.part.old", ".x.0123456g.part"]
    for name in kept:
        Path("x", name).write_text("mine")
    command = [sys.executable, "-c", HOLDS, way, target]
    dead = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert dead.stdout.readline() == b"begun\n"  # a new folder is there from now on
    runs = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert runs.stdout.readline() == b"begun\n"

    def parts() -> int:
        """How many temporary files and folders there are, but for those that must stay."""
        return sum(path.name.endswith(".part") and path.name not in kept for path in tmp_path.rglob(".*"))

    assert parts() == 2
    dead.kill()
    dead.wait()
    assert parts() == 2
    done = subprocess.run(command, input=b"\n", check=True, capture_output=True)
    assert done.stdout == b"begun\n" and parts() == 1
    out = Path(target) if way == "writing" else Path(target, "a.txt")
    assert out.read_text() == "whole"
    out.write_text("another")
    runs.communicate(b"\n")
    assert runs.returncode == 0 and parts() == 0
    assert out.read_text() == "whole"
    assert {path.name for path in Path("x").iterdir()} >= set(kept)


@pytest.fixture
def given(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    save(random_model(1), "model.npz")
    Path("a.lab").write_text(LAB)
    return tmp_path


@pytest.fixture
def idle(given: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder, in which no command may begin its work."""
    def late(*_: object, **__: object) -> None:
        raise AssertionError("the work began")

    for name in ("labial.train.train", "labial.corpus.read_corpora", "labial.sound.align.align_with_bar",
                 "labial.tables.model.load", "labial.corpus.formats.as_lab", "labial.see.motion.read_bands"):
        monkeypatch.setattr(name, late)
    return given


def test_what_is_replaced_keeps_its_permissions_and_its_links(given: Path) -> None:
    os.umask(0o022)
    Path("far").mkdir()
    Path("far/real.csv").write_text("old")
    os.chmod("far/real.csv", 0o640)
    os.symlink("far", "near")
    os.symlink("near/real.csv", "link.csv")
    for name in ("link.csv", "fresh.csv"):
        assert main(["synth", "model.npz", "a.lab", "-o", name]) == 0
    assert os.path.islink("link.csv") and stat.S_IMODE(os.stat("far/real.csv").st_mode) == 0o640
    assert Path("far/real.csv").read_bytes() == Path("fresh.csv").read_bytes()
    assert stat.S_IMODE(os.stat("fresh.csv").st_mode) == 0o644 and os.listdir("far") == ["real.csv"]


def test_what_is_no_file_is_written_directly(given: Path) -> None:
    """Standard output by its name, as far as another program has written it, and a pipe that somebody reads."""
    with open("all.txt", "ab") as out:
        out.write(b"first\n")
        out.flush()
        for _ in range(2):
            assert subprocess.run([sys.executable, "-m", "labial", "timings", "a.lab", "-o", "/dev/stdout"],
                                  stdout=out, check=True).returncode == 0
    text = Path("all.txt").read_text()
    assert text.startswith("first\n") and text.count(" P\n") == 2
    os.mkfifo("pipe")
    heard: List[str] = []
    listener = threading.Thread(target=lambda: heard.append(Path("pipe").read_text()))
    listener.start()
    assert main(["timings", "a.lab", "-o", "pipe"]) == 0
    listener.join()
    assert " P\n" in heard[0] and stat.S_ISFIFO(os.stat("pipe").st_mode)
    assert main(["timings", "a.lab", "-o", "/dev/null"]) == 0 and os.path.exists("/dev/null")


@pytest.mark.parametrize(("target", "complaint"), [
    ("nowhere/x", "there is no folder nowhere"), ("folder", "a folder, not a file"), ("", "not the name of a file"),
    ("a.lab/x", "Not a directory"), ("n" * 300, "File name too long"),
])
def test_outputs_are_checked_before_the_work(idle: Path, capsys: pytest.CaptureFixture, target: str,
                                             complaint: str) -> None:
    """Would catch a training of hours whose model has nowhere to go."""
    Path("folder").mkdir()
    for command in (["train", "corpus"], ["align", "a.wav"], ["synth", "model.npz", "a.lab"], ["timings", "a.lab"],
                    ["plot", "f.csv"], ["page", "f.csv"]):
        if not target and command[0] in ("align", "synth", "timings"):
            continue  # standard output
        assert main([*command, "-o", target]) == 1
        said = capsys.readouterr().err
        assert said.startswith(f"labial: {target}: ") and complaint in said, said


def test_models_are_not_written_over_recordings(given: Path, capsys: pytest.CaptureFixture) -> None:
    """Would catch `-o` followed by a file of the corpus, which the model would replace."""
    before = Path("a.lab").read_bytes()
    for command in ("train", "train-words", "landmarks", *["train-hear"] * bool(find_spec("torch"))):
        assert main([command, "corpus", "-o", "a.lab"]) == 1
        assert capsys.readouterr().err == "labial: a.lab: the name of the output ends in .npz\n"
    assert Path("a.lab").read_bytes() == before


def test_folders_and_options_are_checked_before_the_work(idle: Path, capsys: pytest.CaptureFixture) -> None:
    for command, complaint in (
        ("evaluate corpus -o a.lab", "a.lab: not a folder"), ("evaluate corpus -o a.lab/x", "a.lab/x: Not a directory"),
        ("export model.npz --name m -o a.lab", "a.lab: not a folder"),
        ("train corpus -o x.npz --codebook 5000", "codebook is 5000"),
        ("train corpus -o x.npz --jobs 5000", "jobs is 5000"), ("evaluate corpus -o x --jobs 5000", "jobs is 5000"),
        ("train corpus -o x.npz --engine ray", "not dask=ADDRESS"),
        ("evaluate corpus -o x --engine ray", "not dask=ADDRESS"),
    ):
        assert main(command.split()) == 1
        assert complaint in capsys.readouterr().err
    assert sorted(os.listdir()) == ["a.lab", "model.npz"]


def test_files_that_must_not_be_written(given: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file may be replaced where its folder may be written; one that is read-only is meant to stay."""
    os.chmod("a.lab", 0o444)
    if os.geteuid() == 0:  # who may write everything, but is asked as others are
        monkeypatch.setattr(os, "access", lambda path, mode, **_: not mode & os.W_OK)
    with pytest.raises(LabialError, match="a.lab: Permission denied"):
        outputs.check("a.lab")


def test_several_files_say_which_are_new(given: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a rename fails after another was done."""
    for name in ("a.c", "b.c", "c.c"):
        Path(name).write_text("old")
    real = os.replace

    def refused(source: object, target: str) -> None:
        if target.endswith("b.c"):
            raise OSError(5, "Input/output error", target)
        real(source, target)

    monkeypatch.setattr(os, "replace", refused)
    with pytest.raises(LabialError, match="b.c: Input/output error; a.c new, b.c, c.c as before"):
        with outputs.folder(".") as made:
            for name in ("a.c", "b.c", "c.c"):
                (made / name).write_text("new")
    assert [Path(name).read_text() for name in ("a.c", "b.c", "c.c")] == ["new", "old", "old"]
    assert sorted(os.listdir()) == ["a.c", "a.lab", "b.c", "c.c", "model.npz"]


@pytest.mark.parametrize("command", [["bake", "../a.lab", "-o", "talk.h"],
                                     ["export", "../model.npz", "--name", "m", "-o", "."]])
def test_the_current_folder_stays(
    given: Path, monkeypatch: pytest.MonkeyPatch, few_streams: None, command: List[str]
) -> None:
    """Would catch an empty folder that is replaced: the shell that stands in it would be nowhere."""
    Path("empty").mkdir(mode=0o770)
    before = os.stat("empty")
    monkeypatch.chdir("empty")
    for _ in range(2):
        assert main(command) == 0
        assert os.path.samestat(os.stat("."), before) and os.stat("../empty").st_ino == before.st_ino
        assert os.listdir() and not [name for name in os.listdir() if name.startswith(".")]


def test_nothing_is_left_of_what_fails(given: Path) -> None:
    """Neither a folder that was made for it nor a temporary file, and errors name the file that was meant."""
    with pytest.raises(LabialError, match="^new/deep/none/x: there is no folder"), outputs.folder("new/deep") as made:
        (made / "fine").write_text("fine")
        (made / "none" / "x").write_text("lost")
    with pytest.raises(KeyboardInterrupt), outputs.writing("a.lab", "utf-8") as out:
        out.write("half")
        raise KeyboardInterrupt
    assert Path("a.lab").read_text() == LAB and sorted(os.listdir()) == ["a.lab", "model.npz"]
