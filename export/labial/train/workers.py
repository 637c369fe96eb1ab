"""Parallel work on processor cores or on a cluster, with results that do not depend on their number."""

from __future__ import annotations

import signal
import warnings
from concurrent.futures import CancelledError
from contextlib import ExitStack, contextmanager
from functools import partial
from multiprocessing import resource_tracker
from typing import Any, Callable, Dict, Iterable, Iterator, List, Optional, Sequence, Tuple, Type, TypeVar

from joblib import Parallel, delayed, parallel_config
from joblib.externals.loky import get_reusable_executor
from joblib.externals.loky.backend import resource_tracker as loky_tracker
from joblib.externals.loky.process_executor import TerminatedWorkerError
from threadpoolctl import threadpool_limits
from tqdm import tqdm

from labial.errors import LabialError, needs

Task = TypeVar("Task")
Result = TypeVar("Result")
#: Seconds to wait for a cluster's answer.
_PATIENCE = 20


def _alone(function: Callable[[Task], Result], place: int, task: Task) -> Tuple[int, Result]:
    """Runs the task with index `place`, with numerical libraries limited to one thread, since parallel sums depend on
    the number of cores. The limit stays in this process, which may run other tasks in other threads."""
    threadpool_limits(1)
    return place, function(task)


@contextmanager
def _without_interrupts() -> Iterator[None]:
    """Holds Ctrl-C back until the block ends. Processes that are started in the block never see it, nor print where
    they were: this one ends them."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    for tracker in (resource_tracker, loky_tracker):  # whose start would let Ctrl-C through
        tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class Workers:
    """joblib's processes, or a Dask cluster's workers; with one job everything runs in this process. Use it in a with
    statement."""

    def __init__(self, jobs: int, progress: bool, engine: Optional[str] = None) -> None:
        """`jobs` is the number of processes; `progress` shows a bar for each piece of work. `engine` is None for
        processes of this machine or ``dask=ADDRESS`` for a cluster, whose scheduler is at that address and whose
        workers take the place of `jobs`. Raises LabialError for another engine."""
        kind, _, self._address = (engine or "").partition("=")
        if engine is not None and (kind != "dask" or not self._address):
            raise LabialError(f"the engine {engine!r} is not dask=ADDRESS, such as dask=tcp://10.0.0.1:8786")
        self._client: Any = None
        self._jobs = jobs
        self._progress = progress
        self._open = ExitStack()

    def __enter__(self) -> Workers:
        """The workers themselves. Raises LabialError if there is no cluster or its package versions differ."""
        if self._address:
            self._client = self._open.enter_context(_client(self._address))
        elif self._jobs > 1:
            # Copies arrays: joblib would map large ones as read-only files.
            self._open.enter_context(parallel_config("loky", n_jobs=self._jobs, max_nbytes=None))
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], *_: Optional[object]) -> None:
        """Leaves the cluster or ends the processes, at once if the work was interrupted."""
        if kind is not None and not self._address and self._jobs > 1:
            get_reusable_executor(reuse=True).shutdown(wait=True, kill_workers=True)
        self._open.close()

    def run(self, what: str, function: Callable[[Task], Result], tasks: Sequence[Task],
            done: Optional[Callable[[Result], None]] = None) -> List[Result]:
        """Results of `function`, a module-level function, for all tasks, in their order. `done` receives each result as
        soon as it is ready. Raises LabialError if a process is killed or the cluster fails."""
        if self._address:
            with self._failing(what):
                return self._listed(what, self._of_cluster(function, tasks), len(tasks), done)
        if self._jobs > 1:
            calls = (delayed(partial(_alone, function, place))(task) for place, task in enumerate(tasks))
            with self._failing(what):
                with _without_interrupts():
                    results = Parallel(return_as="generator_unordered", batch_size=1)(calls)
                return self._listed(what, results, len(tasks), done)
        with threadpool_limits(1):
            return self._listed(what, ((place, function(task)) for place, task in enumerate(tasks)), len(tasks), done)

    def _listed(self, what: str, results: Iterable[Tuple[int, Result]], count: int,
                done: Optional[Callable[[Result], None]]) -> List[Result]:
        found: Dict[int, Result] = {}
        for place, result in tqdm(results, desc=what, total=count, disable=not self._progress, leave=False):
            found[place] = result
            if done is not None:
                done(result)
        return [found[place] for place in range(count)]

    def _of_cluster(self, function: Callable[[Task], Result], tasks: Sequence[Task]) -> Iterator[Tuple[int, Result]]:
        """Without joblib, whose Dask backend waits forever if the worker of a task dies."""
        from distributed import as_completed

        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Sending large graph", UserWarning)
            futures = [self._client.submit(_alone, function, place, task, pure=False)
                       for place, task in enumerate(tasks)]
        for future in as_completed(futures):
            yield future.result()

    @contextmanager
    def _failing(self, what: str) -> Iterator[None]:
        """Reports failures of the workers, not of their work, in one line."""
        try:
            yield
        except TerminatedWorkerError as error:
            how = next((name for name in ("SIGKILL", "SIGSEGV", "SIGTERM") if name in str(error)), "a signal")
            short = ", as happens when memory runs short; fewer --jobs take less" if how == "SIGKILL" else ""
            raise LabialError(f"{what}: a worker process was ended by {how}{short}") from None
        except (OSError, CancelledError) as error:
            if not self._address or getattr(error, "filename", None) is not None:
                raise
            raise self._lost(what, error) from None
        except Exception as error:
            if not self._address or type(error).__module__.partition(".")[0] != "distributed":
                raise
            raise self._lost(what, error) from None

    def _lost(self, what: str, error: BaseException) -> LabialError:
        text = " ".join(str(error).split())[:200]
        return LabialError(f"{what}: the Dask cluster at {self._address} failed: {type(error).__name__}"
                           + (f", {text}" if text else ""))


def _client(address: str) -> Any:
    """A client of the Dask scheduler at `address`, as a context."""
    with needs("a Dask cluster", "cluster"):
        from distributed import Client
    try:
        client = Client(address, timeout=_PATIENCE)
    except (OSError, ValueError) as error:
        raise LabialError(f"no Dask scheduler answers at {address}: {' '.join(str(error).split())}") from None
    try:
        client.wait_for_workers(1, timeout=_PATIENCE)
        different = {name for worker in client.run(versions).values() for name, version in versions().items()
                     if worker[name] != version}
    except Exception as error:
        client.close()
        raise LabialError(f"the Dask cluster at {address} cannot be used: {' '.join(str(error).split())}") from None
    if different:
        client.close()
        raise LabialError(f"the Dask cluster at {address} has other versions of {', '.join(sorted(different))} than "
                          "this machine: results would not be the same")
    return client


def versions() -> Dict[str, str]:
    """Versions of the packages that results depend on."""
    import numpy
    import scipy
    import sklearn

    from labial import __version__

    return {"labial": __version__, "numpy": numpy.__version__, "scipy": scipy.__version__,
            "scikit-learn": sklearn.__version__}
