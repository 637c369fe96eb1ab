"""Work on several processor cores with results that do not depend on how many."""

from __future__ import annotations

import multiprocessing
import warnings
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from typing import Callable, Iterable, List, Optional, Sequence, TypeVar

from threadpoolctl import threadpool_limits
from tqdm import tqdm

Task = TypeVar("Task")
Result = TypeVar("Result")


def usable_jobs(jobs: int) -> int:
    """`jobs`; or 1, with a warning, where the system refuses the shared memory that processes need."""
    if jobs > 1:
        try:
            multiprocessing.Lock()
        except OSError as error:
            warnings.warn(f"working in one process, since the system refuses more: {error}", stacklevel=2)
            return 1
    return jobs


def _alone(function: Callable[[Task], Result], task: Task) -> Result:
    """Runs the task with numerical libraries held to one thread: sums in parallel depend on the number of cores."""
    with threadpool_limits(1):
        return function(task)


class Workers:
    """A pool of `jobs` processes; with one job everything runs in this process. Use it in a with statement."""

    def __init__(self, jobs: int, progress: bool) -> None:
        """`jobs` is the number of processes; `progress` shows a bar for each piece of work."""
        jobs = usable_jobs(jobs)
        self._pool: Optional[ProcessPoolExecutor] = ProcessPoolExecutor(jobs) if jobs > 1 else None
        self._progress = progress

    def __enter__(self) -> Workers:
        """The pool itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Ends the processes; what has not begun is dropped."""
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)

    def run(self, what: str, function: Callable[[Task], Result], tasks: Sequence[Task]) -> List[Result]:
        """Results of `function`, which must be a module's own, for all tasks, in their order."""
        call = partial(_alone, function)
        results: Iterable[Result] = map(call, tasks) if self._pool is None else self._pool.map(call, tasks)
        return list(tqdm(results, desc=what, total=len(tasks), disable=not self._progress, leave=False))
