"""The measuring's own arithmetic: what a worse figure is, how deep a call graph is, what closures.py and heads.py
count; and figures of pages: each is that of its source, and the generator finds those that are not."""

from __future__ import annotations

import dataclasses
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Dict, List

import numpy as np
import pytest

import closures
import heads
from labial.fit.solve import Motion
from labial.tables.model import load
from measure import baseline, figures, pages, records, sizes, table
from measure.core import Bench, Figure
from measure.pages import Sentence, row, sentence, share, updated
from measure.profile import cycles
from measure.sources import Results, number, tables
from measure.stack import CallGraph, _machine_code, public_functions
from packages import CC, LIBRARIES, SOURCE, needs_runtime

MEAN = Figure("m0", "speech: mean", 1000.0, "instructions/frame", "run it", "gcc 12.2.1")


def with_value(value: float, **other: str) -> Figure:
    return dataclasses.replace(MEAN, value=value, **other)


def test_worse_than_two_percent_fails_and_is_named() -> None:
    # Catches a tolerance that is too wide, a comparison the wrong way round, a sentence without the numbers.
    assert baseline.compare([MEAN], [with_value(1020.0)]) == ([], [])
    assert baseline.compare([MEAN], [with_value(500.0)]) == ([], [])
    (sentence,), passed_over = baseline.compare([MEAN], [with_value(1021.0)])
    assert all(part in sentence for part in ("m0", "speech: mean", "1000", "1021", "+2.1 %"))
    assert passed_over == []


def test_nothing_may_become_something() -> None:
    # Catches a tolerance that is a share of zero, by which any .bss would pass or the comparison divide by it.
    assert baseline.compare([with_value(0.0)], [with_value(0.0)]) == ([], [])
    assert len(baseline.compare([with_value(0.0)], [with_value(4.0)])[0]) == 1


def test_timings_corpora_and_ratios_to_others_are_not_held() -> None:
    # Catches a check that fails on a slower machine, on one without somebody's corpus, or when Labial gets faster than
    # another program by more.
    speed = with_value(5.0, unit="frames/s")
    ratio = with_value(4.0, unit="times Labial's instructions")
    loss = with_value(5.0, target="accuracy", figure="speech, corpus: MLPG error, largest")
    assert baseline.checked([MEAN, speed, ratio, loss]) == [MEAN]
    assert baseline.compare([ratio, speed, loss], [dataclasses.replace(ratio, value=5.0)]) == ([], [])


def test_other_tools_and_missing_figures_are_said() -> None:
    # Catches a compiler's progress taken for the library's, and a figure that vanishes silently.
    worse, passed_over = baseline.compare([MEAN], [with_value(2000.0, tool="gcc 13.1.0")])
    assert worse == [] and "gcc 12.2.1" in passed_over[0] and "gcc 13.1.0" in passed_over[0]
    worse, passed_over = baseline.compare([MEAN], [])
    assert worse == [] and "speech: mean" in passed_over[0]


def test_baseline_survives_its_file(tmp_path: Path) -> None:
    # Catches fields lost on the way, and a damaged file that ends in a traceback without its name.
    path = tmp_path / "baseline.json"
    baseline.write(path, [MEAN, with_value(2.5)])
    assert baseline.read(path) == [MEAN, with_value(2.5)]
    path.write_text('[{"target": "m0"}]')
    with pytest.raises(ValueError, match="baseline.json"):
        baseline.read(path)


def node(name: str, size: int, kind: str = "static") -> str:
    return f'node: {{ title: "{name}" label: "{name}\\nlib/x.c:1:1\\n{size} bytes ({kind})\\n0 dynamic objects" }}\n'


def edge(caller: str, callee: str) -> str:
    return f'edge: {{ sourcename: "{caller}" targetname: "{callee}" label: "lib/x.c:2:2" }}\n'


def test_the_page_has_every_figure() -> None:
    # Catches a figure that belongs to no section.
    bench = Bench(SOURCE, SOURCE)
    bench.figures = baseline.read(SOURCE / "bench" / "baseline.json")
    page = table.markdown(bench, [])
    assert bench.figures and all(f"| {figure.figure} |" in page for figure in bench.figures)


def test_deepest_chain_of_calls() -> None:
    # Catches a sum over all calls, the callee with the largest frame instead of the deepest, a callback counted in.
    graph = CallGraph()
    graph.add_ci(node("top", 8) + node("wide", 100) + node("a", 60) + node("b", 70))
    graph.add_ci(edge("top", "wide") + edge("top", "a") + edge("a", "b") + edge("top", "__indirect_call"))
    assert graph.missing() == set()
    assert graph.deepest("top") == (138, ("top", "a", "b"))


def test_what_has_no_bound_is_refused() -> None:
    # Catches a bound that leaves out what it does not know.
    graph = CallGraph()
    graph.add_ci(node("top", 8) + node("again", 8) + edge("top", "unknown") + edge("again", "again"))
    assert graph.missing() == {"unknown"}
    with pytest.raises(RuntimeError, match="unknown"):
        graph.deepest("top")
    with pytest.raises(RuntimeError, match="recursion"):
        graph.deepest("again")
    with pytest.raises(RuntimeError, match="dynamic"):
        graph.add_ci(node("alloca", 8, "dynamic"))


@pytest.mark.parametrize("listing, expected", [
    ("  0:\tb5f0 \tpush\t{r4, r5, r6, r7, lr}\n  2:\tb082 \tsub\tsp, #8\n", 28),
    ("  0:\te92d 43f0 \tstmdb\tsp!, {r4-r9, lr}\n", 28),
    ("  0:\t1141 \taddi\tsp,sp,-16\n  2:\t0141 \taddi\tsp,sp,16\n", 16),
    ("  0:\t2200 \tmovs\tr2, #0\n", 0),
])
def test_frames_of_machine_code(listing: str, expected: int) -> None:
    # Catches a register or a range of them that is not counted, and stack that is given back counted as taken.
    assert _machine_code(listing)[0] == expected


def test_calls_of_machine_code() -> None:
    # Catches a helper of a helper left out of the bound.
    listing = " 4:\tf7ff fffe \tbl\t0 <x>\n\t\t\t4: R_ARM_THM_CALL\t__aeabi_idiv0\n"
    assert _machine_code(listing)[1] == {"__aeabi_idiv0"}


@pytest.mark.parametrize("mnemonic, operands, expected", [
    ("adds", "r0, r1, r2", 1), ("muls", "r0, r1", 1), ("ldr", "r0, [pc, #8]", 2), ("strb", "r0, [r1, r2]", 2),
    ("ldrsh", "r0, [r1, r2]", 2), ("push", "{r4, r5, lr}", 4), ("ldmia", "r0!, {r1, r2}", 3), ("pop", "{r4, pc}", 5),
    ("bl", "0 <x>", 4), ("bx", "lr", 3), ("b.n", "0 <x>", 3), ("beq.n", "0 <x>", 1), ("bics", "r0, r1", 1),
    ("mov", "pc, r1", 3),
])
def test_cycles_are_those_of_the_manual(mnemonic: str, operands: str, expected: int) -> None:
    # Catches instructions that one pattern takes for another: bics for a branch, ldrsh for a word of data processing.
    assert cycles(mnemonic, operands) == expected


@pytest.mark.parametrize("mnemonic, operands, m3, m4", [
    ("add.w", "r0, r1, r2", 1, 1), ("umull", "r0, r1, r2, r3", 5, 1), ("smlal", "r0, r1, r2, r3", 7, 1),
    ("mla", "r0, r1, r2, r3", 2, 1), ("mul.w", "r0, r1, r2", 1, 1), ("udiv", "r0, r1, r2", 12, 12),
    ("ldrd", "r0, r1, [sp, #8]", 3, 3), ("strd", "r0, r1, [r2]", 3, 3), ("ldrsh.w", "r0, [r1, #2]", 2, 2),
    ("stmdb", "sp!, {r4, r5, r6, lr}", 5, 5), ("ldmia.w", "sp!, {r4, pc}", 5, 5), ("push", "{r4-r7, lr}", 6, 6),
    ("cbz", "r0, 0 <x>", 1, 1), ("beq.w", "0 <x>", 1, 1), ("bl", "0 <x>", 3, 3), ("tbb", "[pc, r0]", 4, 4),
    ("it", "eq", 1, 1), ("blt.n", "0 <x>", 1, 1),
])
def test_cycles_of_larger_cores(mnemonic: str, operands: str, m3: int, m4: int) -> None:
    # Catches a long product counted as a short one, and a pair of words as one.
    assert (cycles(mnemonic, operands, "m3"), cycles(mnemonic, operands, "m4")) == (m3, m4)


def test_commands_name_the_preset_whatever_was_built_where(tmp_path: Path) -> None:
    # Catches folders of one machine in the committed baseline.
    for build in (tmp_path / "src" / "build" / "bench", tmp_path / "elsewhere"):
        bench = Bench(tmp_path / "src", build)
        command = [build / "bench" / "labial-bench", "speech", "20", "<", tmp_path / "src" / "lib" / "units.c"]
        assert bench.shown(command) == "build/bench/bench/labial-bench speech 20 < lib/units.c"


def test_functions_of_every_header_are_found() -> None:
    # Catches a stack bound that leaves functions out because their declarations are not recognised.
    bench = Bench(SOURCE, SOURCE)
    assert {"labial_init", "labial_tick", "labial_latency", "labial_workspace_size"} <= set(public_functions(bench))
    without = {"config.h", "private.h", "hear_private.h", "hear_model.h"}
    headers = {path.name for path in (SOURCE / "include" / "labial").glob("*.h")} - without
    assert all(public_functions(bench, name) for name in headers)


def test_parts_are_the_members_of_the_headers(tmp_path: Path) -> None:
    # Catches a part of the workspace that was forgotten or grew: the parts must add up to the macro.
    parts = " + ".join(size for part, size in sizes.PARTS.items() if part.startswith("workspace"))
    source = (f'#include "labial/labial.h"\n#define STRIDE {sizes.STRIDE}\n#define COUNT {sizes.COUNT}\n'
              f"typedef char equal[(({parts}) + 3u) / 4u * 4u == LABIAL_WORKSPACE_SIZE(STRIDE, COUNT) ? 1 : -1];\n")
    (tmp_path / "parts.c").write_text(source, encoding="ascii")
    command = [CC, "-std=c99", f"-I{SOURCE / 'include'}", "-fsyntax-only", str(tmp_path / "parts.c")]
    assert subprocess.run(command).returncode == 0


@pytest.mark.slow
def test_the_latest_frame_is_that_of_the_rules(tmp_path: Path) -> None:
    # Catches a clock that is off by a tick, a frame that counts though it is not the latest, and malformed input. A
    # phoneme's first frame waits until the next one begins, or the end, and then for the stream's delay of 6 frames.
    includes = [f"-I{SOURCE / folder}" for folder in ("include", "lib/models", "lib")]
    program = tmp_path / "delay"
    subprocess.run([CC, "-std=c99", *includes, SOURCE / "bench" / "delay.c", *LIBRARIES, "-o", program], check=True)

    def latest(text: str) -> subprocess.CompletedProcess:
        return subprocess.run([str(program), "-"], input=text, capture_output=True, text=True)

    silence = load(str(SOURCE / "export" / "models" / "speech_en.npz")).phonemes.index("SIL")
    vowel = silence + 1
    assert latest(f"{vowel} 400 {vowel} 60").stdout.split() == ["520"]
    assert latest(f"{vowel} 60 {silence} 5000 {vowel} 60\n{vowel} 200\n").stdout.split() == ["240", "320"]
    for text in (f"{vowel}", f"{vowel} 60 x", "999 60", f"{vowel} 99999999"):
        assert latest(text).returncode == 1


TESTS = SOURCE / "tests" / "python"


def test_shares_of_closures() -> None:
    """Two p, b, m: one that a slow jaw reaches only if it looks ahead, and one after a rest."""
    frames = np.zeros((60, 13), dtype=np.int64)
    frames[5:30, 4] = frames[40:55, 4] = -480  # 400 us open
    said = [closures.Said(frames, [(31, 33), (56, 58)], [])]
    assert closures.measure(said, closures.jaw(None, None), 1) == (1.0, 1.0)
    assert closures.measure(said, closures.jaw(50, None), 1)[0] == 0.0
    assert closures.measure(said, closures.jaw(50, None), 2)[0] == 0.0
    for limits in ((50, None), (60, 20)):
        assert closures.measure(said, closures.jaw(*limits), 32)[0] == 1.0


@needs_runtime
def test_timings_become_motion() -> None:
    """A closure is where its phoneme is, a frame wider, and so is an f or v; blanks are silence."""
    said = closures.moving([("", 100.0), ("M", 80.0), ("AA", 200.0), ("B", 60.0), ("AA", 100.0), ("F", 100.0)])
    assert said.closures == [(4, 11), (18, 24)] and said.labiodentals == [(26, 32)] and len(said.frames) == 32
    assert all((said.frames[begin:end, 3] + said.frames[begin:end, 4]).max() > -72 for begin, end in said.closures)


def test_motions_are_joined() -> None:
    """Phonemes keep their frames."""
    frames = np.arange(26.0).reshape(2, 13)
    joined = heads.joined([Motion(frames, [("m", 0, 1)]), Motion(frames + 1, [("aa", 1, 2)])])
    assert joined.phonemes == [("m", 0, 1), ("aa", 3, 4)] and joined.frames[3, 0] == frames[1, 0] + 1


@needs_runtime
def test_rows_of_a_head() -> None:
    """ICT's head with the built-in rig, to what docs/avatar.md says."""
    from labial.fit.head import read_table
    from labial.fit.solve import read_sentences

    head, motion = read_table(TESTS / "heads" / "ict_lips.csv"), read_sentences(TESTS / "sentences.flite")
    assert heads.built_in(head, "oculus", motion) == {}
    cells = heads.row("ict", head, heads.built_in(head, "arkit", motion), motion).split(" | ")
    assert float(cells[1]) == pytest.approx(0.99, abs=0.02) and float(cells[6]) == 1.0 and float(cells[9]) < 0.85


# ---- Figures of pages ------------------------------------------------------------------------------------------------


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


def test_a_wrong_figure_is_named_with_its_line_and_mended() -> None:
    # Catches a match that ends at a line break, a figure written into another's place, a wrong line.
    assert updated("p.md", TEXT, SENTENCES) == (TEXT, [])
    text, complaints = updated("p.md", TEXT, changed("17,431", "-.05", "thirteen"))
    assert text == TEXT.replace("7,431", "17,431").replace(".68", "-.05").replace("six", "thirteen")
    assert [one[: one.index(", in")] for one in sorted(complaints)] == [
        "p.md:3: 7,431 should be 17,431", "p.md:4: .68 should be -.05", "p.md:4: six should be thirteen"]


@pytest.mark.parametrize("text, sentences, times", [
    *((text, SENTENCES, "[02]") for text in (TEXT.replace("of code", "of tables"), TEXT + TEXT, "",
                                             TEXT.replace("| 1 |", "| |"))),
    ("It has 7,431 bytes.", [sentence("{} bytes of code", "431")], "0"),
])
def test_a_sentence_is_there_once(text: str, sentences: List[Sentence], times: str) -> None:
    # Catches figures that nothing checks any more because somebody rewrote their sentence, and 431 found in 7,431.
    with pytest.raises(ValueError, match=rf"p\.md: found {times} times instead of once"):
        updated("p.md", text, sentences)


def test_figures_as_pages_have_them() -> None:
    # Catches a part of a figure that is replaced, and a zero before the point.
    assert updated("p.md", "It has 7,431 bytes.", [sentence("{} bytes", "12")])[0] == "It has 12 bytes."
    assert [share(value, digits) for value, digits in ((0.683, 2), (1.0, 2), (-0.05, 2), (0.0586, 3), (0.0, 2))] == [
        ".68", "1.00", "-.05", ".059", ".00"]


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
    # Part has commands of its own, and keeps a table that One's report has, too.
    longer = PAGE.replace("| x | 3 | 4 |\n", "| x | 3 | 4 |\n\n| method | c | d |\n|---|---|---|\n| x | 0 | 0 |\n")
    assert records.with_tables(longer, "One", report) == longer.replace("| 1 | 2 |", "| 5 | 6 |")


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
    assert len(by_lips) == 4
    for name in (*records.MOTION, *records.HEARD):
        before = (tmp_path / name).read_bytes()
        changed = before + b" " if name != records.FRAMES else re.sub(rb"(^laugh\n)\d", rb"\g<1>9", before, flags=re.M)
        (tmp_path / name).write_bytes(changed)
        assert changed != before
        assert records.outdated(tmp_path, records.read(tmp_path)) == (by_lips if name in records.HEARD else names)
        (tmp_path / name).write_bytes(before)
    frames = (SOURCE / records.FRAMES).read_bytes()
    (tmp_path / records.FRAMES).write_bytes(re.sub(rb"(^turns\n)\d", rb"\g<1>9", frames, flags=re.M))
    assert records.outdated(tmp_path, records.read(tmp_path)) == []  # which nothing measures


@pytest.mark.slow
def test_measured_figures_take_the_place_of_the_baselines() -> None:
    # Catches a bench that compares pages with an old baseline, and figures of another compiler taken for changes.
    measured = baseline.read(SOURCE / "bench" / "baseline.json")
    assert pages.refresh(SOURCE, figures.of(SOURCE, measured), write=False) == []
    grown = [dataclasses.replace(one, value=one.value + 1000.0) if one.figure == "labial_t" else one
             for one in measured]
    complaints = pages.refresh(SOURCE, figures.of(SOURCE, grown), write=False)
    (size,) = {one.value for one in grown if one.figure == "labial_t" and one.target == "m0"}
    assert any(complaint.startswith("docs/figures.md:") for complaint in complaints)
    assert all(f"should be {size:,.0f}" in complaint for complaint in complaints)
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
    openings = "paper: least opening in each p, b, m: M 124 B -7\nspeech_en: least opening in each p, b, m: M 20\n"
    assert records.COMMANDS["side by side"].read(openings) == {
        "paper least": -7.0, "paper most": 124.0, "paper count": 2, "speech_en least": 20.0, "speech_en most": 20.0,
        "speech_en count": 1}
    assert records.COMMANDS["search"].read("| a |\n|---|\n| 0 | 8 | 27.60 | 0.91 |\n") == {
        "0 8 states": 27.6, "0 8 motion": 0.91}
