"""examples/kiosk in a real browser, with the npm package as it is built: what is drawn, held to the sound and to the C
library's frames."""

from __future__ import annotations

import csv
import functools
import json
import os
import shutil
import subprocess
import threading
import time
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Iterator, List

import numpy as np
import pytest

from browser import CHROMIUM, REASON, Browser, Page
from packages import CMAKE, SOURCE, run

SAY = os.environ.get("LABIAL_SAY", "")
KIOSK = SOURCE / "examples" / "kiosk"
pytestmark = [
    pytest.mark.skipif(not CHROMIUM, reason=REASON),
    pytest.mark.skipif(not (shutil.which("clang") and shutil.which("wasm-ld")),
                       reason="needs clang and wasm-ld: install the Debian packages clang and lld"),
]  # fmt: skip

PERIOD = 0.02
#: The line that is drawn between closed lips is 1.8 drawing units thick; lips that are nearer look closed.
CLOSED = 1.2

#: Takes down, in every animation frame, the sound's time before and after the element draws, whether it stands, the lips'
#: inner contours as drawn and the FAPs. Functions for a frame are called in the order in which they ask for it.
WATCH = """(() => {
  const face = document.getElementById("face"), voice = document.getElementById("voice"), seen = window.seen = [];
  const inner = face.shadowRoot.querySelector("path[data-d=inner]");
  let before = 0;
  (function first() {
    before = voice.currentTime;
    requestAnimationFrame(() => {});
    if (window.seen === seen) requestAnimationFrame(first);
  })();
  window.watch = () => (function second() {
    seen.push([before, voice.currentTime, voice.paused, inner.getAttribute("d"), ...face.faps, performance.now()]);
    if (window.seen === seen) requestAnimationFrame(second);
  })();
})()"""
