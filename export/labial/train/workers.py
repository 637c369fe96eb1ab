"""Work on several processor cores, or on a cluster's machines, with results that do not depend on how many."""

from __future__ import annotations

from contextlib import ExitStack
from functools import partial
from typing import Callable, Dict, Iterable, List, Optional, Sequence, TypeVar

from joblib import Parallel, delayed, parallel_config
from threadpoolctl import threadpool_limits
from tqdm import tqdm

from labial.errors import LabialError, needs

Task = TypeVar("Task")
Result = TypeVar("Result")

#: Seconds that a cluster has to answer.
_PATIENCE = 20


def _alone(function: Callable[[Task], Result], task: Task) -> Result:
    """Runs the task with numerical libraries held to one thread: sums in parallel depend on the number of cores. They
    stay so in this process, for a cluster's may run other tasks in other threads meanwhile."""
    threadpool_limits(1)
    return function(task)


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
        self._jobs = jobs
        self._progress = progress
        self._open = ExitStack()

    def __enter__(self) -> Workers:
        """The workers themselves. Raises LabialError when there is no cluster or its packages are others."""
        if self._address:
            self._open.enter_context(_client(self._address))
            self._open.enter_context(parallel_config("dask", n_jobs=-1))
        elif self._jobs > 1:
            # Arrays are copied: as files, joblib's way for large ones, they could not be written to.
            self._open.enter_context(parallel_config("loky", n_jobs=self._jobs, max_nbytes=None))
        return self

    def __exit__(self, *_: object) -> None:
        """Leaves the cluster or the processes."""
        self._open.close()

    def run(self, what: str, function: Callable[[Task], Result], tasks: Sequence[Task]) -> List[Result]:
        """Results of `function`, which must be a module's own, for all tasks, in their order."""
        if self._address or self._jobs > 1:
            call = delayed(partial(_alone, function))
            results: Iterable[Result] = Parallel(return_as="generator", batch_size=1)(map(call, tasks))
            return self._listed(what, results, len(tasks))
        with threadpool_limits(1):
            return self._listed(what, map(function, tasks), len(tasks))

    def _listed(self, what: str, results: Iterable[Result], count: int) -> List[Result]:
        return list(tqdm(results, desc=what, total=count, disable=not self._progress, leave=False))


def _client(address: str):  # type: ignore[no-untyped-def]
    """A client of the Dask scheduler at `address`, as a context."""
    with needs("a Dask cluster", "cluster"):
        from distributed import Client
    try:
        client = Client(address, timeout=_PATIENCE)
    except (OSError, ValueError) as error:
        raise LabialError(f"no Dask scheduler answers at {address}: {' '.join(str(error).split())}") from None
    try:
        client.wait_for_workers(1, timeout=_PATIENCE)
        different = {name for worker in client.run(_versions).values() for name, version in _versions().items()
                     if worker[name] != version}
    except Exception as error:
        client.close()
        raise LabialError(f"the Dask cluster at {address} cannot be used: {' '.join(str(error).split())}") from None
    if different:
        client.close()
        raise LabialError(f"the Dask cluster at {address} has other versions of {', '.join(sorted(different))} than "
                          "this machine: results would not be the same")
    return client


def _versions() -> Dict[str, str]:
    """Versions of what results depend on."""
    import numpy
    import scipy
    import sklearn

    from labial import __version__

    return {"labial": __version__, "numpy": numpy.__version__, "scipy": scipy.__version__,
            "scikit-learn": sklearn.__version__}
