"""Figures of pages: each is that of its source, and the generator finds those that are not."""

from __future__ import annotations

import dataclasses
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Dict, List

import pytest
from measure import baseline, figures, pages, records
from measure.pages import Sentence, row, sentence, share, updated
from measure.sources import Results, number, tables

from packages import SOURCE

TEXT = """\
# Page

The library has 7,431 bytes of code and
.68 of something, for six people.

| what | a | b |
|---|---|---|
| speed | 1 | 2.50 |
"""
SENTENCES = [sentence("has {} bytes of code and {} of something, for {} people", "7,431", ".68", "six"),
             row("speed", "1", "2.50")]


def changed(*figures_: str) -> List[Sentence]:
    return [dataclasses.replace(SENTENCES[0], figures=figures_), SENTENCES[1]]


def test_every_figure_is_that_of_its_source() -> None:
    # Catches a page that tells what an earlier version measured, a sentence that the list no longer finds, and a
    # command whose output is that of other models.
    done = subprocess.run([sys.executable, str(SOURCE / "bench" / "figures.py"), "--check"], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, check=False)
    assert done.returncode == 0, done.stdout


def test_a_page_that_is_right_is_left_alone() -> None:
    assert updated("p.md", TEXT, SENTENCES) == (TEXT, [])


def test_a_wrong_figure_is_named_with_its_line_and_mended() -> None:
    # Catches a match that ends at a line break, a figure written into another's place, a wrong line.
    text, complaints = updated("p.md", TEXT, changed("17,431", "-.05", "thirteen"))
    assert text == TEXT.replace("7,431", "17,431").replace(".68", "-.05").replace("six", "thirteen")
    assert [one[: one.index(", in")] for one in sorted(complaints)] == [
        "p.md:3: 7,431 should be 17,431", "p.md:4: .68 should be -.05", "p.md:4: six should be thirteen"]


@pytest.mark.parametrize("text", [TEXT.replace("of code", "of tables"), TEXT + TEXT, "", TEXT.replace("| 1 |", "| |")])
def test_a_sentence_is_there_once(text: str) -> None:
    # Catches figures that nothing checks any more because somebody rewrote their sentence.
    with pytest.raises(ValueError, match=r"p\.md: found [02] times instead of once"):
        updated("p.md", text, SENTENCES)


def test_a_figure_is_matched_whole() -> None:
    # Catches 431 found in 7,431, which would then be written into its middle.
    with pytest.raises(ValueError, match="found 0 times"):
        updated("p.md", "It has 7,431 bytes.", [sentence("{} bytes of code", "431")])
    text, _ = updated("p.md", "It has 7,431 bytes.", [sentence("{} bytes", "12")])
    assert text == "It has 12 bytes."


@pytest.mark.parametrize("value, digits, expected", [(0.683, 2, ".68"), (1.0, 2, "1.00"), (-0.05, 2, "-.05"),
                                                     (0.0586, 3, ".059"), (0.0, 2, ".00")])
def test_shares_have_no_zero_before_the_point(value: float, digits: int, expected: str) -> None:
    assert share(value, digits) == expected


def test_results_are_read_by_their_heads() -> None:
    # Catches a cell taken from the second of two columns of one name, or with its deviation.
    page = "# All\n\n## One\n\n| method | of | of |\n|---|---|---|\n| paper | 0.5 (0.1) | 2 |\n\n## Two\n"
    table = Results(page).table("One")
    assert table["paper"] == {"method": "paper", "of": "0.5 (0.1)", "of #2": "2"}
    assert number(table["paper"]["of"]) == 0.5 and tables("no table") == []
    with pytest.raises(ValueError, match="no table 1 under 'Two'"):
        Results(page).table("Two")


PAGE = """\
## One

    labial corpus C
    labial evaluate C -o report/

Measured on 1 May 2026.

| method | a | b |
|---|---|---|
| x | 1 | 2 |

### Part

    labial evaluate D -o report/

Measured on 1 May 2026.

| method | a | b |
|---|---|---|
| x | 3 | 4 |

## Two

No command.
"""


def test_sections_of_results_get_their_tables() -> None:
    # Catches a table that goes into another section, or into the place of one with other columns.
    assert records.section_commands(PAGE) == {"One": ["labial corpus C", "labial evaluate C -o report/"],
                                              "Part": ["labial evaluate D -o report/"]}
    report = "| method | a | b |\n|---|---|---|\n| x | 5 | 6 |\n\n| method | c | d |\n|---|---|---|\n| x | 7 | 8 |\n"
    assert records.with_tables(PAGE, "Part", report) == PAGE.replace("| 3 | 4 |", "| 5 | 6 |")
    assert records.with_tables(PAGE, "One", report) == PAGE.replace("| 1 | 2 |", "| 5 | 6 |")


def test_a_section_tells_when_it_is_older_than_the_models() -> None:
    # Catches results that are taken for those of models that were changed since.
    made: Dict[str, Dict[str, object]] = {"One": {"of": "new", "measured": "2026-05-01"},
                                          "Part": {"of": "old", "measured": "2026-05-02"}}
    marked = records.marked(PAGE, made, "new")
    assert "\nMeasured on 1 May 2026.\n" in marked
    assert "\nMeasured on 2 May 2026, before the latest change of the bundled models or their frames.\n" in marked
    assert records.marked(marked, made, "old").count("before the latest change") == 1
    with pytest.raises(ValueError, match="under the commands of 'Part'"):
        records.marked(PAGE[::-1].replace("Measured on 1 May 2026."[::-1], "", 1)[::-1], made, "new")


def test_a_model_outdates_its_records(tmp_path: Path) -> None:
    # Catches a record that stays valid although a model, or the frames that it makes, are others.
    for name in (*records.MOTION, *records.HEARD, str(records.FILE), str(records.RESULTS)):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(SOURCE / name, tmp_path / name)
    names = [*records.COMMANDS, *records.section_commands(PAGE)]
    (tmp_path / records.RESULTS).write_text(PAGE, encoding="utf-8")
    records.write(tmp_path, {name: {"of": records.digest(tmp_path, name)} for name in names})
    assert records.outdated(tmp_path, records.read(tmp_path)) == []
    by_lips = [name for name in names if name.startswith("real lips")]
    assert len(by_lips) == 2
    for name in (*records.MOTION, *records.HEARD):
        before = (tmp_path / name).read_bytes()
        (tmp_path / name).write_bytes(before + b" ")
        assert records.outdated(tmp_path, records.read(tmp_path)) == (by_lips if name in records.HEARD else names)
        (tmp_path / name).write_bytes(before)


def test_measured_figures_take_the_place_of_the_baselines() -> None:
    # Catches a bench that compares pages with an old baseline, and figures of another compiler taken for changes.
    measured = baseline.read(SOURCE / "bench" / "baseline.json")
    assert pages.refresh(SOURCE, figures.of(SOURCE, measured), write=False) == []
    grown = [dataclasses.replace(one, value=one.value + 1000.0) if one.figure == "labial_t" else one
             for one in measured]
    (complaint,) = pages.refresh(SOURCE, figures.of(SOURCE, grown), write=False)
    assert complaint.startswith("README.md:") and "should be 1,6" in complaint
    others = [dataclasses.replace(one, tool="another compiler") for one in grown]
    assert pages.refresh(SOURCE, figures.of(SOURCE, others), write=False) == []


def test_records_are_read_as_their_programs_print() -> None:
    # Catches a program whose output changed without what reads it.
    closures = ("306 p, b, m in 96 sentences: at most 65 FAP units open\n180 f, v: at least 28 in 95 %, 101 in half\n"
                "without `closed`: 31 us short in the median, 32 % reach it\n"
                "slew acceleration | closed, opening with 1, 6, 10, 32 frames in sight\n"
                "   -            - | 1.000 1.00  1.000 1.00  1.000 1.00  1.000 1.00\n"
                "  90           30 | 0.797 0.99  1.000 0.96  1.000 0.96  1.000 0.95\n")
    found = records.COMMANDS["closures"].read(closures)
    assert found["stops: most"] == 65 and found["f, v: half"] == 101 and found["reach"] == 32
    assert found["90 30 1: closed"] == 0.797 and found["90 30 32: opening"] == 0.95 and found["- - 6: closed"] == 1.0
    window = "correlation 0.9992 .. 0.9998, mean 0.9996; difference up to 0.041 of a FAP's standard deviation\n109 s\n"
    assert list(records.COMMANDS["window"].read(window).values()) == [0.9992, 0.9998, 0.9996, 0.041, 109.0]
    laughs = "intensity 0: 68 50 88 98 36\nspeech: 628\n"
    assert records.COMMANDS["laughs"].read(laughs) == {"speech": 628.0, "0 largest": 68.0, "0 least": 50.0,
                                                       "0 most": 88.0, "0 jaw": 98.0, "0 corner": 36.0}
    distances = "published: least distance of the lips in each closure, FAP units: M 124 B -7\nfirm contact: 61\n"
    assert records.COMMANDS["side by side"].read(distances) == {
        "published least": -7.0, "published most": 124.0, "published count": 2, "contact": 61.0}
    assert records.COMMANDS["search"].read("| a |\n|---|\n| 0 | 8 | 27.60 | 0.91 |\n") == {
        "0 8 states": 27.6, "0 8 motion": 0.91}
