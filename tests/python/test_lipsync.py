"""``labial.evaluate.lipsync`` on a head of one shape, whose figures can be worked out on paper."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Dict, List

import numpy as np
import pytest

from labial.evaluate import lipsync
from labial.files.faps import FAP_COLUMNS
from models import write_motion

#: Opening in 20 frames, mm: at rest, a vowel, a closure, at rest.
MEANT = np.array([0, 0, 0, 0, 0, 4, 8, 10, 8, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], dtype=float)


def weights(path: Path, times: np.ndarray, values: Dict[str, np.ndarray]) -> None:
    """Lines as `labial synth --to arkit` writes them."""
    path.write_text("".join(json.dumps({"frame": k, "time": float(time), "arkit":
                                        {name: float(column[k]) for name, column in values.items()}}) + "\n"
                            for k, time in enumerate(times)))  # fmt: skip


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A head whose lower lip falls by 20 mm at weight 1, of viseme_aa too, and an utterance with three lip-syncs."""
    points = {"nose": (0, 20.48, 0), "corner_left": (25.6, 0, 0), "corner_right": (-25.6, 0, 0),
              "inner_upper": (0, 0, 0), "inner_lower": (0, 0, 0)}
    rows = [["shape", *(f"{name}_{axis}" for name in points for axis in "xyz")],
            ["neutral", *(str(value) for point in points.values() for value in point)]]
    rows += [[name, *("0" for _ in range(13)), "-20", "0"] for name in ("jawOpen", "viseme_aa")]
    (tmp_path / "head.csv").write_text("\n".join(",".join(row) for row in rows) + "\n")
    out = tmp_path / "folder"
    out.mkdir()
    (out / "a.lab").write_text("0 0.1 sil\n0.1 0.2 AA\n0.2 0.3 B\n0.3 0.4 sil\n")
    times, faps = np.arange(20) / 50, np.zeros((20, 13))
    faps[:, FAP_COLUMNS.index("fap52")] = -MEANT / 0.02  # a unit is 20.48 / 1024 mm
    write_motion(out / "a.csv", times, faps)
    weights(out / "a.right.jsonl", times, {"jawOpen": MEANT / 20, "tongueOut": MEANT})
    weights(out / "a.still.jsonl", times[:2] * 30, {"aa": np.full(2, 0.5)})
    weights(out / "a.late.jsonl", times + 0.04, {"jawOpen": MEANT / 20})
    return out


def run(folder: Path, capsys: pytest.CaptureFixture[str]) -> List[str]:
    """What is printed, by lines."""
    assert lipsync.main([str(folder.parent / "head.csv"), str(folder)]) == 0
    return capsys.readouterr().out.splitlines()


def test_figures_worked_out_by_hand(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What follows the FAPs, what is half open all the time, and what comes two frames late. The 95th percentile of 20
    values lies .05 of the way from the second largest, 8, to the largest, 10."""
    lines = run(folder, capsys)
    third = np.sqrt(np.mean(np.diff(MEANT, 3) ** 2)) * 125
    assert lines[0].startswith("1 utterances, 0 s, 1 p, b, m; the FAPs mean an opening of 8.1 mm")
    assert lines[0].endswith(f"a jerk of {third:.0f} m/s\u00b3")
    table = {cells[1]: cells[2:] for cells in ([cell.strip() for cell in line.split("|")] for line in lines[4:])}
    assert table["right"] == ["8.1 (1.00)", "0.00", "1.00", "0.0", "0.0", f"{third:.0f}", "1.00", ""]
    assert table["still"] == ["10.0 (1.23)", f"{np.sqrt(np.mean((10 - MEANT) ** 2)):.2f}", "0.00", "10.0", "10.0", "0",
                              "nan", ""]
    late = np.concatenate([[0, 0], MEANT[:-2]])
    assert table["late"] == ["8.1 (1.00)", f"{np.sqrt(np.mean((late - MEANT) ** 2)):.2f}", "1.00", "0.0", "0.0",
                             f"{third:.0f}", f"{np.corrcoef(late, MEANT)[0, 1]:.2f}", ""]


@pytest.mark.parametrize(("name", "text", "message"), [
    ("a.new.jsonl", '{"time": 0, "arkit": {"beak": 1}}\n', "a.new.jsonl:1: none of these weights"),
    ("a.new.jsonl", '{"time": 0, "arkit": {"jawOpen": 1}}\n{"time": 0, "arkit": {"jawOpen": 1}}\n', ":2: expected"),
    ("a.new.jsonl", '{"time": 0, "arkit": {"jawOpen": "x"}}\n', "a.new.jsonl:1: expected"),
    ("a.new.jsonl", '{"time": 0, "arkit": {"jawOpen": NaN}}\n', "a.new.jsonl:1: expected"),
    ("a.new.jsonl", '{"time": 0}\n', "a.new.jsonl:1: expected"),
    ("a.new.jsonl", "[]\n", "a.new.jsonl:1: expected"),
    ("a.new.jsonl", "\n", "a.new.jsonl: no frames"),
    ("a.lab", "0 0.4 AA\n", "no p, b or m"),
])
def test_errors(folder: Path, capsys: pytest.CaptureFixture[str], name: str, text: str, message: str) -> None:
    """One line, and status 1."""
    (folder / name).write_text(text)
    assert lipsync.main([str(folder.parent / "head.csv"), str(folder)]) == 1
    error = capsys.readouterr().err
    assert message in error and error.count("\n") == 1


def test_lip_syncs_have_every_utterance(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Otherwise they would be judged on different sentences."""
    for suffix in ("lab", "csv", "right.jsonl"):
        (folder / f"b.{suffix}").write_bytes((folder / f"a.{suffix}").read_bytes())
    assert lipsync.main([str(folder.parent / "head.csv"), str(folder)]) == 1
    assert "no b.late.jsonl with the weights of late" in capsys.readouterr().err
