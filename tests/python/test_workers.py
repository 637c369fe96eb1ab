"""The same results from one core, from several, and from a Dask cluster."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Iterator, List, Tuple

import numpy as np
import pytest
from threadpoolctl import threadpool_info

from labial.__main__ import main
from labial.errors import LabialError
from labial.train.workers import Workers
from models import write_episode
from packages import SOURCE
from test_train import OPTIONS, episode

SETTING = ["--codebook", str(OPTIONS["codebook"]), "--components", str(OPTIONS["components"]), "--quiet"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small corpus."""
    made = tmp_path_factory.mktemp("corpus")
    for seed in range(8):
        write_episode(made, episode(seed))
    return made


@pytest.fixture(scope="module")
def cluster() -> Iterator[str]:
    """The address of a Dask scheduler with two workers, each a process of its own."""
    distributed = pytest.importorskip("distributed", reason="the Dask cluster needs the package distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None,
                                  host="127.0.0.1", silence_logs=50) as local:
        yield local.scheduler_address


def trained(folder: Path, out: Path, *options: str) -> bytes:
    assert main(["train", str(folder), "-o", str(out), *SETTING, *options]) == 0
    return out.read_bytes()


def where(number: int) -> Tuple[int, int, int]:
    """The number's square, the process, and the most threads that numerical libraries use there."""
    np.ones((4, 4)) @ np.ones((4, 4))
    return number**2, os.getpid(), max((item["num_threads"] for item in threadpool_info()), default=1)


@pytest.mark.parametrize("jobs", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_results_are_in_order_and_libraries_keep_to_one_thread(jobs: int) -> None:
    """Catches results in the order in which they were ready, and sums whose order depends on the cores."""
    with Workers(jobs, False) as workers:
        found = workers.run("squares", where, range(20))
    assert [square for square, _, _ in found] == [number**2 for number in range(20)]
    assert {threads for _, _, threads in found} == {1}
    assert (os.getpid() in {process for _, process, _ in found}) == (jobs == 1)


@pytest.mark.slow
def test_a_cluster_trains_the_same_bytes(folder: Path, cluster: str, tmp_path: Path) -> None:
    """Catches work that is done here after all, an order that depends on who is first, and floats that were rounded on
    their way."""
    with Workers(1, False, f"dask={cluster}") as workers:
        found = workers.run("squares", where, range(20))
    assert [square for square, _, _ in found] == [number**2 for number in range(20)]
    assert os.getpid() not in {process for _, process, _ in found} and {threads for _, _, threads in found} == {1}
    one = trained(folder, tmp_path / "one.npz", "--jobs", "1")
    assert trained(folder, tmp_path / "two.npz", "--jobs", "2") == one
    assert trained(folder, tmp_path / "many.npz", "--engine", f"dask={cluster}") == one


@pytest.mark.slow
def test_a_cluster_evaluates_the_same_bytes(folder: Path, cluster: str, tmp_path: Path,
                                            capsys: pytest.CaptureFixture) -> None:
    arguments = ["evaluate", str(folder), "--splits", "2", "--methods", "mean,paper", "--quiet"]
    for name, more in (("one", ["--jobs", "1"]), ("many", ["--engine", f"dask={cluster}"])):
        assert main([*arguments, "-o", str(tmp_path / name), *more]) == 0
    names = sorted(file.name for file in (tmp_path / "one").iterdir())
    assert "report.md" in names and names == sorted(file.name for file in (tmp_path / "many").iterdir())
    for name in names:
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "many" / name).read_bytes(), name


#: Runs `labial train` with work that does what the last argument says, in two processes.
WORKING = """
import sys
import labial.corpus, labial.train, working
from labial.__main__ import main
from labial.train.workers import Workers
def train(*_, jobs, engine, **__):
    with Workers(jobs, False, engine) as workers:
        workers.run("the work", getattr(working, sys.argv[1]), range(4))
labial.train.train, labial.corpus.read_corpora = train, lambda *_, **options: []
sys.exit(main(["train", "corpus", "-o", "m.npz", "--quiet", *sys.argv[2:]]))
"""
WORK = """
import os, signal, time
def killed(number):
    os.kill(os.getpid(), signal.SIGKILL) if number == 2 else time.sleep(.1)
def waits(number):
    open(f"{os.getpid()}.pid", "w").close()
    time.sleep(600)
"""


@pytest.fixture
def working(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> List[str]:
    """What runs `WORKING`, in an empty folder."""
    monkeypatch.chdir(tmp_path)
    Path("working.py").write_text(WORK)
    Path("main.py").write_text(WORKING)
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}:{SOURCE / 'export'}")
    monkeypatch.syspath_prepend(tmp_path)  # a cluster's scheduler runs in this process
    return [sys.executable, "main.py"]


@pytest.mark.slow
def test_a_killed_worker_is_said_in_one_line(working: List[str]) -> None:
    """What the kernel does when memory runs out is no defect of Labial's."""
    done = subprocess.run([*working, "killed", "--jobs", "2"], capture_output=True, text=True, timeout=120)
    lines = [line for line in done.stderr.splitlines() if line.startswith("labial: ")]
    assert done.returncode == 1 and len(lines) == 1, done.stderr
    assert lines[0] == ("labial: the work: a worker process was ended by SIGKILL, as happens when memory runs short; "
                        "fewer --jobs take less")


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc and /dev/shm")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_the_workers(working: List[str], number: signal.Signals) -> None:
    """No process goes on working for nobody, and no semaphore stays."""
    shared = set(os.listdir("/dev/shm"))
    command = subprocess.Popen([*working, "waits", "--jobs", "2"], stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60
    while len(list(Path().glob("*.pid"))) < 2 and time.monotonic() < deadline:
        time.sleep(0.05)
    workers = [path.stem for path in Path().glob("*.pid")]
    own = {name for name in set(os.listdir("/dev/shm")) - shared if name.startswith(("sem.loky-", "joblib"))
           and str(command.pid) in name}
    command.send_signal(number)
    _, said = command.communicate(timeout=60)
    assert command.returncode == 128 + number and len(workers) == 2
    lines = said.splitlines()  # joblib's tracker of semaphores may add a warning of its own
    assert lines[0] == {signal.SIGTERM: "labial: ended by SIGTERM", signal.SIGINT: "labial: interrupted"}[number]
    assert all("resource_tracker" in line or line.startswith("  warnings.warn(") for line in lines[1:]), said
    deadline = time.monotonic() + 10
    while any(os.path.exists(f"/proc/{worker}") for worker in workers) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not [worker for worker in workers if os.path.exists(f"/proc/{worker}")]
    assert not own & set(os.listdir("/dev/shm"))


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="needs masks of signals")
def test_workers_do_not_hear_ctrl_c(tmp_path: Path) -> None:
    """A terminal sends it to them too: those that just start would print where they were."""
    script = tmp_path / "script.py"
    script.write_text("""
import signal
from labial.train.workers import Workers
def hears(_):
    return signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, [])
if __name__ == "__main__":
    with Workers(2, False) as workers:
        print(hears(0), *workers.run("x", hears, range(2)), hears(0))
""")
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=120,
                          env={**os.environ, "PYTHONPATH": str(SOURCE / "export")})
    assert done.stdout == "True False False True\n", done.stdout + done.stderr


@pytest.mark.slow
def test_a_cluster_that_is_lost_is_named(working: List[str]) -> None:
    """Not the output, and no defect. The cluster gives up a task with the first worker that it kills, not the
    fourth."""
    distributed = pytest.importorskip("distributed", reason="the Dask cluster needs the package distributed")
    dask = pytest.importorskip("dask")
    with dask.config.set({"distributed.scheduler.allowed-failures": 0}), \
         distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None,
                                  host="127.0.0.1", silence_logs=50) as local:
        engine = f"dask={local.scheduler_address}"
        done = subprocess.run([*working, "killed", "--engine", engine], capture_output=True, text=True, timeout=300)
    lines = [line for line in done.stderr.splitlines() if line.startswith("labial: ")]
    assert done.returncode == 1 and len(lines) == 1, done.stderr
    assert lines[0].startswith(f"labial: the work: the Dask cluster at {engine[5:]} failed: KilledWorker")


@pytest.mark.slow
def test_an_evaluation_goes_on_where_it_was(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                            capsys: pytest.CaptureFixture) -> None:
    """Splits that were finished are not worked on again, the report has the same bytes, and nothing of another corpus
    or other options is taken for finished."""
    from labial.evaluate import protocol

    real, worked = protocol.run_split, []

    def breaking(corpus: object, split: protocol.Split, options: object) -> object:
        worked.append(split.number)
        if split.number == broken:
            raise KeyboardInterrupt
        return real(corpus, split, options)  # type: ignore[arg-type]

    def run(out: str, *options: str) -> int:
        worked.clear()
        return main(["evaluate", str(folder), "--splits", "3", "--methods", "mean", "--jobs", "1", "--quiet", "-o",
                     str(tmp_path / out), *options])

    monkeypatch.setattr(protocol, "run_split", breaking)
    broken = 3
    assert run("whole") == 0 and worked == [0, 1, 2]
    broken = 2
    assert run("broken") == 130 and worked == [0, 1, 2]
    broken = 3
    assert run("broken", "--seed", "1") == 0 and worked == [0, 1, 2]  # other splits
    broken = 2
    assert run("again") == 130
    kept = tmp_path / "again" / ".splits"
    assert sorted(path.name for path in kept.iterdir()) == ["0.zip", "1.zip"]
    (kept / "1.zip").write_bytes((kept / "1.zip").read_bytes()[:-20])  # damaged
    broken = 3
    capsys.readouterr()
    assert run("again") == 0 and worked == [1, 2]
    assert "again: 1 of 3 splits were finished before" in capsys.readouterr().out
    names = sorted(path.name for path in (tmp_path / "whole").iterdir())
    assert names == sorted(path.name for path in (tmp_path / "again").iterdir()) and "trajectories.png" in names
    for name in names:
        assert (tmp_path / "whole" / name).read_bytes() == (tmp_path / "again" / name).read_bytes(), name


def test_engines_that_cannot_be_used(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """One line each, and no model."""
    pytest.importorskip("distributed", reason="the Dask cluster needs the package distributed")
    for engine, message in (("ray", "not dask=ADDRESS"), ("dask", "not dask=ADDRESS"), ("dask=", "not dask=ADDRESS"),
                            ("dask=nowhere", "no Dask scheduler answers at nowhere"),
                            ("dask=ftp://127.0.0.1:1", "no Dask scheduler answers at ftp://127.0.0.1:1")):
        assert main(["train", str(folder), "-o", str(tmp_path / "no.npz"), *SETTING, "--engine", engine]) == 1
        error = capsys.readouterr().err
        assert message in error and error.count("\n") == 1, error
    assert not (tmp_path / "no.npz").exists()


@pytest.mark.slow
def test_other_versions_are_refused(cluster: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Catches a cluster whose numbers differ in the last digit."""
    import labial

    monkeypatch.setattr(labial, "__version__", "99")
    with pytest.raises(LabialError, match="other versions of labial"):
        Workers(1, False, f"dask={cluster}").__enter__()


@pytest.mark.slow
def test_works_where_the_system_refuses_shared_memory(tmp_path: Path) -> None:
    """Catches a training that fails on a machine without semaphores: it goes on in one process."""
    script = tmp_path / "alone.py"
    script.write_text("""
import _multiprocessing, os, sys
class Refused(_multiprocessing.SemLock):
    def __new__(cls, *_, **__):
        raise PermissionError(13, "Permission denied")
_multiprocessing.SemLock = Refused
from labial.train.workers import Workers
with Workers(2, False) as workers:
    assert workers.run("numbers", abs, [-1, 2]) == [1, 2]
print("done")
""")
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": str(SOURCE / "export")})
    assert done.returncode == 0 and done.stdout == "done\n", done.stderr
