"""What docs/reproduction.md promises: the bundled models, and a table that is really compared."""

from __future__ import annotations

import dataclasses
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import reproduce
from labial.evaluate.methods import METHODS
from labial.evaluate.protocol import HUMAN
from labial.evaluate.report import title
from labial.tables.model import load, save
from packages import SOURCE, copy_sources
from pages import end_session


def test_the_page_has_the_table_that_is_compared() -> None:
    """Would catch a heading that no longer matches, which would compare with nothing, and a method without a row."""
    rows = reproduce.committed_split().splitlines()
    assert [re.match(r"\| ([^|]+) \|", row)[1] for row in rows[2:]] == [
        title(name) for name in (HUMAN, *(method.name for method in METHODS))]
    assert all(len(row.split("|")) == len(reproduce.COLUMNS) + 3 for row in rows)


def test_a_figure_that_differs_is_noticed(monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    table = reproduce.committed_split()
    monkeypatch.setattr(reproduce, "first_split", lambda: table)
    assert reproduce.split() and "the same figures" in capsys.readouterr().out
    digit = next(i for i in range(len(table) - 1, 0, -1) if table[i].isdigit())
    other = table[:digit] + str((int(table[digit]) + 1) % 10) + table[digit + 1 :]
    monkeypatch.setattr(reproduce, "first_split", lambda: other)
    assert not reproduce.split() and "DIFFERENT" in capsys.readouterr().out


def test_a_model_that_differs_is_noticed(tmp_path: Path) -> None:
    """In a number, in a word, in a bit of an exported file; but not in the last bits of trained numbers."""
    committed = SOURCE / "export" / "models" / "laughter_synthetic.npz"
    model = load(committed)

    def saved(**changed: object) -> str:
        save(dataclasses.replace(model, **changed), tmp_path / "made.npz")
        return reproduce.compared(tmp_path / "made.npz", committed)

    assert saved() == "the same bytes"
    assert saved(slope=model.slope * (1 + 1e-12)) == "the same to 1e-09"
    assert saved(slope=model.slope + np.eye(*model.slope.shape) * 1e-6) == "DIFFERENT"
    assert saved(attribution="another") == saved(training={**model.training, "frames": 1}) == "DIFFERENT"
    table = SOURCE / "lib" / "models" / "laughter_synthetic.c"
    (tmp_path / "made.c").write_bytes(table.read_bytes().replace(b"1", b"2", 1))
    assert reproduce.compared(tmp_path / "made.c", table) == "DIFFERENT"


@pytest.mark.slow
def test_the_two_commands_reproduce_models_and_table(tmp_path: Path) -> None:
    """As the page has them, in a copy of the sources in which nothing was built, and without the environment of these
    tests: would catch a step that needs another one's build."""
    text = (SOURCE / "docs" / "reproduction.md").read_text(encoding="utf-8")
    commands = re.findall(r"^```sh\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)[0]
    copy_sources(tmp_path / "clone")
    environment = {name: value for name, value in os.environ.items()
                   if not name.startswith("LABIAL_") and name not in ("PYTHONPATH", "OMP_NUM_THREADS")}
    python = Path(sys.executable).resolve().parent  # of this environment, whose packages it does not see
    path = f"{python}{os.pathsep}{environment['PATH']}"
    child = subprocess.Popen(["sh", "-eu", "-c", commands], cwd=tmp_path / "clone", start_new_session=True,
                             env={**environment, "PATH": path}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             encoding="utf-8")
    try:
        said, _ = child.communicate(timeout=900)
    finally:
        end_session(child.pid, 0.0)
    assert child.returncode == 0, said[-6000:]
    assert len(re.findall(r"^lib/models/\w+\.[ch]: the same bytes$", said, re.MULTILINE)) == 6
    assert len(re.findall(r"^export/models/\w+\.npz: the same ", said, re.MULTILINE)) == 2
    assert "the same figures" in said
