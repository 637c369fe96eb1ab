"""What the Python tests share with pytest: which of them are left to .ci/run, since they take long, which run one after
the other, a browser, and a short measurement of ``labial export``."""

from __future__ import annotations

import os
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Dict, Iterator, List, Set

import pytest

from browser import CHROMIUM, REASON, Browser
from npm import MISSING, package

#: Whose modules tests import, behind those of this folder.
ROOT = Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / name) for name in
             ("bench", "tests/conformance", "tests/c", "tests/voices", "examples/pi", "examples/microphone",
              "examples/voices", "packaging")]

#: Modules whose fixtures take as long as their tests: each runs in one worker, so that these are made only once.
TOGETHER = ("test_adapters", "test_bundlers", "test_esp32_beside", "test_esp32_hear", "test_kiosk", "test_laughter",
            "test_packages", "test_packages_cmake", "test_speak_page", "test_train", "test_wheel",
            "test_workers")

#: Modules whose pages play sound in a browser, which a busy machine stops for a moment: each test has three tries.
REAL_TIME = ("test_adapters", "test_browser_hearing", "test_browser_voice", "test_demo", "test_kiosk",
             "test_speak_page")


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "slow: takes long; runs where LABIAL_REQUIRE_ALL is set, as in .ci/run")


def passed_modules(report: Path) -> Set[str]:
    """The modules of which a report of another run, as pytest's --junitxml, has tests, all of them passed."""
    passed: Dict[str, bool] = {}
    for case in ElementTree.parse(report).getroot().iter("testcase"):
        module = case.get("classname", "").rpartition(".")[2]
        passed[module] = passed.get(module, True) and not len(case)
    return {module for module, all_of_it in passed.items() if all_of_it}


@pytest.hookimpl(tryfirst=True)  # before pytest-xdist looks at the groups
def pytest_collection_modifyitems(config: pytest.Config, items: List[pytest.Item]) -> None:
    """Groups the tests of some modules (``--dist loadgroup``), and gives those of others more tries. Leaves the slow
    tests out, but where LABIAL_REQUIRE_ALL is set in the environment and LABIAL_SLOW is not OFF; there LABIAL_PASSED
    may name the report of a run without them, whose passed modules are left to it."""
    for item in items:
        if item.path.stem in TOGETHER:
            item.add_marker(pytest.mark.xdist_group(item.path.stem))
        if item.path.stem in REAL_TIME:
            item.add_marker(pytest.mark.flaky(reruns=2))
    every = os.environ.get("LABIAL_REQUIRE_ALL", "").upper() in ("ON", "1", "TRUE", "YES")
    report = os.environ.get("LABIAL_PASSED", "")
    passed = passed_modules(Path(report)) if every and report else set()
    slow = every and os.environ.get("LABIAL_SLOW") != "OFF"
    left_out = [item for item in items if (not slow if item.get_closest_marker("slow") else item.path.stem in passed)]
    config.hook.pytest_deselected(items=left_out)
    items[:] = [item for item in items if item not in set(left_out)]


@pytest.fixture
def few_streams(monkeypatch: pytest.MonkeyPatch) -> None:
    """``labial export`` measures the loss on two streams in place of 24, for tests of what it prints and writes."""
    from labial.tables import phones

    every = phones.drawn_streams
    monkeypatch.setattr(phones, "drawn_streams", lambda model: every(model, 2))


@pytest.fixture(scope="session")
def npm_package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the npm package; those of the others lie beside it."""
    if MISSING:
        pytest.skip(MISSING)
    return package(tmp_path_factory.mktemp("npm") / "build")


@pytest.fixture(scope="module")
def browser(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """A browser for the tests of a module, with the options that it names `BROWSER`."""
    if not CHROMIUM:
        pytest.skip(REASON)
    with Browser(tmp_path_factory.mktemp("browser") / "profile", getattr(request.module, "BROWSER", ())) as started:
        yield started
