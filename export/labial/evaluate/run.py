"""An evaluation from the corpora to the files of its report."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Dict, List, Optional, Sequence

from labial.corpus import read_corpora
from labial.corpus.laughter import is_synthetic
from labial.evaluate import plots, report
from labial.evaluate.kept import remove_kept
from labial.evaluate.material import Options, Outcome
from labial.evaluate.methods import select
from labial.evaluate.protocol import evaluate
from labial.files.outputs import check_folder, folder
from labial.train.pipeline import check_jobs
from labial.train.talkers import check_variance
from labial.train.workers import Workers


def processor_time(outcomes: Sequence[Outcome]) -> str:
    """Processor seconds per split, for all methods and each; for the terminal, since they differ in each run."""
    total: Dict[str, float] = {}
    for item in outcomes:
        for method, seconds in item.seconds.items():
            total[method] = total.get(method, 0.0) + seconds / len(outcomes)
    each = ", ".join(f"{method} {seconds:.1f}" for method, seconds in total.items())
    return f"processor time per split: {sum(total.values()):.1f} s ({each})"


def run(
    corpora: Sequence[str], output: str, options: Options, *, jobs: int, engine: Optional[str], progress: bool
) -> List[Path]:
    """Evaluates and writes the report into the folder `output`; returns what was written. Finished splits are stored
    there until the report is written, and reused."""
    select(options.methods)  # before the corpora are read
    check_folder(output)
    check_jobs(jobs)
    check_variance(options.talker_variance)
    Workers(jobs, False, engine)
    options = replace(options, synthetic=is_synthetic(corpora[0]))
    first, *others = read_corpora(corpora, options.kind, distinct=True)
    further = [episode for corpus in others for episode in corpus]
    outcomes = evaluate(first, options, further=further, jobs=jobs, engine=engine, progress=progress,
                        folder=Path(output))
    with folder(output) as made:
        drawn = plots.write(outcomes, options, made)
        written = [path.name for path in report.write(outcomes, options, made, drawn)]
    remove_kept(Path(output))
    if options.leave_out_talkers:
        print(report.talkers_table(outcomes, report.methods_of(outcomes)))
    print(report.caption("Table 1", "diff", options))
    print(report.markdown_table(outcomes, report.methods_of(outcomes), report.TABLE_1))
    print(processor_time(outcomes))
    return [Path(output) / name for name in (*written, *drawn)]
