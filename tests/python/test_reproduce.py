"""What docs/reproduction.md promises: the bundled models byte for byte, and a table that is really compared."""

from __future__ import annotations

import importlib.util
import re
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest

from labial.evaluate.methods import METHODS
from labial.evaluate.protocol import HUMAN
from labial.evaluate.report import title
from packages import SOURCE

PINNED = dict(re.findall(r"^([a-z-]+)==(\S+)$", (SOURCE / "export" / "requirements-reproduce.txt").read_text(),
                         re.MULTILINE))


@pytest.fixture(scope="module")
def reproduce():
    spec = importlib.util.spec_from_file_location("reproduce", SOURCE / "export" / "reproduce.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_page_has_the_table_that_is_compared(reproduce) -> None:
    """Would catch a heading that no longer matches, which would compare with nothing, and a method without a row."""
    rows = reproduce.committed_split().splitlines()
    assert [re.match(r"\| ([^|]+) \|", row)[1] for row in rows[2:]] == [
        title(name) for name in (HUMAN, *(method.name for method in METHODS))]
    assert all(len(row.split("|")) == len(reproduce.COLUMNS) + 3 for row in rows)


def test_a_figure_that_differs_is_noticed(reproduce, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    table = reproduce.committed_split()
    monkeypatch.setattr(reproduce, "first_split", lambda: table)
    assert reproduce.split() and "the same figures" in capsys.readouterr().out
    digit = next(i for i in range(len(table) - 1, 0, -1) if table[i].isdigit())
    other = table[:digit] + str((int(table[digit]) + 1) % 10) + table[digit + 1 :]
    monkeypatch.setattr(reproduce, "first_split", lambda: other)
    assert not reproduce.split() and "DIFFERENT" in capsys.readouterr().out


@pytest.mark.slow
def test_the_bundled_models_are_reproduced(reproduce, tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """Byte for byte with the packages that the page names; with other ones the median of the shapes agrees within a
    hundredth."""
    same = reproduce.models(tmp_path)
    if all(version(name) == pinned for name, pinned in PINNED.items() if name in ("numpy", "scipy", "scikit-learn")):
        assert same, capsys.readouterr().out
    from labial.tables.model import load

    for name in reproduce.MODELS:
        made, committed = load(tmp_path / f"{name}.npz"), load(SOURCE / "export" / "models" / f"{name}.npz")
        assert made.phonemes == committed.phonemes and made.attribution == committed.attribution
        np.testing.assert_allclose(np.median(np.abs(made.shape)), np.median(np.abs(committed.shape)), rtol=0.01)
