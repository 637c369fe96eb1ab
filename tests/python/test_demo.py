"""The demo page from outside: one file that needs nothing else. LABIAL_DEMO_PAGE holds the built page's path."""

from __future__ import annotations

import json
import os
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

import pytest

PAGE = os.environ.get("LABIAL_DEMO_PAGE", "")
pytestmark = pytest.mark.skipif(not PAGE, reason="LABIAL_DEMO_PAGE does not name the built page")

DEMO = Path(__file__).resolve().parents[2] / "examples" / "demo"


class _Page(HTMLParser):
    """Collects what the tests ask about: every attribute, and the data."""

    def __init__(self) -> None:
        super().__init__()
        self.attributes: List[Tuple[str, str, str]] = []  #: element, attribute, value
        self.data = ""
        self.data_elements = 0
        self.stack: List[str] = []
        self._within_data = False

    def handle_starttag(self, tag: str, attrs: List[Tuple[str, Optional[str]]]) -> None:  # noqa: D102
        self.attributes += [(tag, name, value or "") for name, value in attrs]
        if ("id", "labial-data") in attrs:
            assert tag == "script" and ("type", "application/json") in attrs
            self._within_data = True
            self.data_elements += 1

    def handle_endtag(self, tag: str) -> None:  # noqa: D102
        if tag == "script":
            self._within_data = False

    def handle_data(self, data: str) -> None:  # noqa: D102
        if self._within_data:
            self.data += data


@pytest.fixture(scope="module")
def text() -> str:
    """The page's source."""
    return Path(PAGE).read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def page(text: str) -> _Page:
    """The page, parsed."""
    parser = _Page()
    parser.feed(text)
    parser.close()
    return parser


@pytest.fixture(scope="module")
def data(page: _Page) -> Dict[str, Any]:
    """What the page plays."""
    assert page.data_elements == 1
    return json.loads(page.data)


def flite_milliseconds() -> int:
    """How long the sentence lasts: the last end time of each line."""
    lines = (DEMO / "sentence.flite").read_text().splitlines()
    return sum(round(float(line.split()[-1].split(":")[1]) * 1000) for line in lines if line.strip())


def lab_milliseconds() -> int:
    """How long the laugh lasts: the end of its last line."""
    return round(float((DEMO / "laugh.lab").read_text().split("\n")[-2].split()[1]) * 1000)


def test_frames_last_as_long_as_both_timings(data: Dict[str, Any]) -> None:
    """No frame is lost or added, not even where one model hands over to the other."""
    total = flite_milliseconds() + lab_milliseconds()
    assert len(data["frames"]) == int(total * data["fps"] / 1000 + 0.5)


def test_frames_are_13_integers_that_move(data: Dict[str, Any]) -> None:
    """Every frame has the 13 channels within FAP limits, and the jaw and the lips move in both parts."""
    assert data["channels"] == [f"fap{n}" for n in (3, 16, 17, *range(51, 61))]
    for frame in data["frames"]:
        assert len(frame) == 13
        assert all(type(value) is int and -1860 <= value <= 1860 for value in frame)
    middle = int(flite_milliseconds() * data["fps"] / 1000)
    for part in (data["frames"][:middle], data["frames"][middle:]):
        for channel in (0, 4):
            values = [frame[channel] for frame in part]
            assert max(values) - min(values) >= 20


def test_phonemes_tile_the_frames(data: Dict[str, Any]) -> None:
    """Phonemes follow each other from the first frame to the last, speech before laughter."""
    at = 0
    for phoneme in data["phonemes"]:
        assert phoneme["start_frame"] == at and phoneme["frames"] >= 1 and phoneme["label"]
        assert phoneme["kind"] in ("speech", "laughter", "silence")
        at += phoneme["frames"]
    assert at == len(data["frames"])
    kinds = [phoneme["kind"] for phoneme in data["phonemes"] if phoneme["kind"] != "silence"]
    assert kinds == sorted(kinds, reverse=True) and set(kinds) == {"speech", "laughter"}


def test_nothing_is_requested(text: str, page: _Page) -> None:
    """No address, no external source or link, no style import: the page works from a disk, offline."""
    assert not re.search(r"https?://", text)
    assert not re.search(r"@import|\bfetch\(|XMLHttpRequest|WebSocket|EventSource|sendBeacon|\bimport\(", text)
    for tag, name, value in page.attributes:
        if name in ("src", "srcset", "href", "xlink:href", "data", "poster", "action"):
            assert value.startswith(("data:", "#")), (tag, name, value)
    assert not re.search(r"url\((?!#)", text)
    contents = [value for tag, name, value in page.attributes if tag == "meta" and name == "content"]
    assert any("default-src 'none'" in value for value in contents)


def test_title_and_placeholder(text: str, data: Dict[str, Any]) -> None:
    """The title is set from the data, and the template's placeholder is gone."""
    assert data["title"]
    assert "document.title" in text and "window.labialPlayer" in text
    assert "@LABIAL_DATA@" not in text


def test_controls_have_names(page: _Page) -> None:
    """Drawing, button and scrubber have labels for those who do not see them."""
    labels = [value for _, name, value in page.attributes if name == "aria-label"]
    assert "Play" in labels and "Speed" in labels
    assert any(label.startswith("Position") for label in labels) and any("mouth" in label for label in labels)
