"""Prints what .ci/run ran: for each workflow how many tests ran and passed, its seconds, those of all processors
together, and what was left out and why.

    python3 .ci/table.py WORKFLOW=STATUS=SECONDS=PROCESSOR_SECONDS ...

Reads build/WORKFLOW/junit.xml, which ctest writes, and build/ci/WORKFLOW.log. A line below a workflow is for tests that
consist of many, such as pytest. What failed is printed below the table, at the end where it is found.
"""

from __future__ import annotations

import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Dict, List, NamedTuple

BUILD = Path(__file__).resolve().parents[1] / "build"
#: How cmocka, a device test and pytest report a test that they leave out.
LEFT_OUT = re.compile(r"^(?:\[  SKIPPED \]|SKIPPED \[\d+\]) (.*)$", re.MULTILINE)
#: How many characters of a failed test's output are printed: its end, where frameworks say what went wrong.
SHOWN = 6000


class Row(NamedTuple):
    """A line of the table."""

    suite: str
    ran: str
    passed: str
    left_out: List[str]
    seconds: str
    processor: str


def counts(output: str) -> Dict[str, int]:
    """What pytest's last line counts, as `passed`, `failed`, `skipped` and so on; empty for other output."""
    lines = re.findall(r"^=+ (.*) in [\d.]+s.*=+$", output, re.MULTILINE)
    return {word: int(count) for count, word in re.findall(r"(\d+) (\w+)", lines[-1])} if lines else {}


def warnings_of(log: Path) -> List[str]:
    """What configuring says that it leaves out."""
    text = log.read_text(encoding="utf-8", errors="replace")
    blocks = (" ".join(block.split()) for block in re.findall(r"^CMake Warning .*\n((?:  .*\n)+)", text, re.MULTILINE))
    return [block for block in blocks if "left out" in block]


def cases(name: str) -> List[ElementTree.Element]:
    """What ctest reports of a workflow's tests; nothing where there are none."""
    report = BUILD / name / "junit.xml"
    return list(ElementTree.parse(report).getroot().iter("testcase")) if report.exists() else []


def workflow_rows(name: str, status: str, seconds: str, processor: str) -> List[Row]:
    """A workflow's row and those of its tests that count their own."""
    reported, left_out = cases(name), warnings_of(BUILD / "ci" / f"{name}.log")
    times = (f"{float(seconds):.0f}", f"{float(processor):.0f}")
    if not reported:
        return [Row(name, "-", "yes" if status == "0" else "failed", left_out, *times)]
    ran, passed, rows = 0, 0, []
    for case in reported:
        test, output = case.get("name", ""), case.findtext("system-out") or ""
        if case.get("status") != "run" and case.get("status") != "fail":
            left_out.append(f"{test}: {case.get('status')}")
            continue
        ran += 1
        passed += case.get("status") == "run"
        if case.get("status") == "fail":
            left_out.append(f"failed: {test}")
        own, within = counts(output), [f"{test}: {why}" for why in LEFT_OUT.findall(output)]
        if own:
            done = sum(own.get(word, 0) for word in ("passed", "failed", "error", "errors"))
            time = f"{float(case.get('time', 0)):.0f}"
            rows.append(Row(f"  {test}", str(done), str(own.get("passed", 0)), within, time, ""))
        else:
            left_out += within
    if name == "bare":  # which compares what it leaves out with a list of its own
        left_out, rows = ["as .ci/bare.skipped lists"], [row._replace(left_out=[]) for row in rows]
    left_out += ["failed"] * (status != "0" and ran == passed)
    return [Row(name, str(ran), str(passed), left_out, *times), *rows]


def main() -> int:
    """Runs the command; returns its exit status."""
    rows = [Row("suite", "ran", "passed", ["left out, or failed"], "seconds", "processor")]
    for argument in sys.argv[1:]:
        rows += workflow_rows(*argument.split("="))
    for row in rows:
        first, *others = row.left_out or [""]
        print(f"{row.suite:<12} {row.ran:>6} {row.passed:>8} {row.seconds:>8} {row.processor:>10}  {first}".rstrip())
        print("".join(" " * 50 + f"{reason}\n" for reason in others), end="")
    for name in (argument.split("=")[0] for argument in sys.argv[1:]):
        for case in cases(name):
            if case.get("status") == "fail":
                print(f"\n---- {name}: {case.get('name')}\n{(case.findtext('system-out') or '').strip()[-SHOWN:]}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
