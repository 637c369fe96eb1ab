"""A headless Chromium over the devtools protocol, for tests that look at pages.

The protocol's messages go through a pipe (``--remote-debugging-pipe``): JSON, each ended by a null byte. No port is
opened.
"""

from __future__ import annotations

import functools
import itertools
import json
import os
import select
import shutil
import subprocess
import threading
import time
from contextlib import contextmanager
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Sequence

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), "")
REASON = "needs chromium: install the Debian package chromium"

#: No sandbox, for tests run as root; sound that nobody hears plays, and may begin by itself. A page that nobody sees is
#: drawn as one that somebody does.
_OPTIONS = (
    "--headless=new", "--no-sandbox", "--remote-debugging-pipe", "--mute-audio", "--no-first-run", "--disable-gpu",
    "--autoplay-policy=no-user-gesture-required", "--disable-dev-shm-usage", "--disable-background-networking",
    "--disable-renderer-backgrounding", "--hide-scrollbars", "--window-size=1200,900",
)
#: More of them, for pages that draw in three dimensions: without a graphics card.
THREE_D = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
_PATIENCE = 60.0  # seconds for an answer; a machine may be busy otherwise


class _Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_: Any) -> None:
        pass


@contextmanager
def served(folder: Path) -> Iterator[str]:
    """Serves a folder; its address."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(_Quiet, directory=str(folder)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}"
    finally:
        server.shutdown()
        server.server_close()


class PageFailed(AssertionError):
    """A page threw, or the browser refused a command."""


class Browser:
    """A browser of its own, with its profile in `folder`; a context manager."""

    def __init__(self, folder: Path, options: Sequence[str] = ()) -> None:
        read, theirs_out = os.pipe()
        theirs_in, write = os.pipe()
        for fd in (theirs_in, theirs_out):
            os.set_inheritable(fd, True)
        command = [CHROMIUM, *_OPTIONS, *options, f"--user-data-dir={folder}", "about:blank"]
        # The browser reads from 3 and writes to 4.
        script = f'exec "$@" 3<&{theirs_in} 4>&{theirs_out}'
        self._log = open(folder.parent / f"{folder.name}.log", "wb")  # noqa: SIM115
        self._process = subprocess.Popen(["bash", "-c", script, "browser", *command], pass_fds=(theirs_in, theirs_out),
                                         stdin=subprocess.DEVNULL, stdout=self._log, stderr=self._log)
        os.close(theirs_in)
        os.close(theirs_out)
        self._read, self._write = read, write
        self._buffer = b""
        self._numbers = itertools.count(1)
        self.events: List[Dict[str, Any]] = []

    def __enter__(self) -> Browser:
        return self

    def __exit__(self, *_: object) -> None:
        try:
            self.command("Browser.close")
            self._process.wait(10)
        except (OSError, PageFailed, subprocess.TimeoutExpired):
            self._process.kill()
            self._process.wait()
        os.close(self._read)
        os.close(self._write)
        self._log.close()

    def command(self, method: str, parameters: Optional[Dict[str, Any]] = None, session: str = "") -> Dict[str, Any]:
        """The result of a command; events that come before it are kept."""
        number = next(self._numbers)
        message = {"id": number, "method": method, "params": parameters or {}}
        if session:
            message["sessionId"] = session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + _PATIENCE
        while True:
            answer = self._message(end)
            if answer.get("id") != number:
                self.events.append(answer)
            elif "error" in answer:
                raise PageFailed(f"{method}: {answer['error']['message']}")
            else:
                return answer["result"]

    def _message(self, end: float) -> Dict[str, Any]:
        while b"\0" not in self._buffer:
            if not select.select([self._read], [], [], max(end - time.monotonic(), 0.0))[0]:
                raise PageFailed("the browser does not answer")
            received = os.read(self._read, 1 << 20)
            if not received:
                raise PageFailed("the browser has ended")
            self._buffer += received
        text, _, self._buffer = self._buffer.partition(b"\0")
        return json.loads(text)

    def page(self, address: str, before: str = "") -> Page:
        """A new page that has loaded `address`; the script `before` runs in it before its own."""
        target = self.command("Target.createTarget", {"url": "about:blank"})["targetId"]
        session = self.command("Target.attachToTarget", {"targetId": target, "flatten": True})["sessionId"]
        return Page(self, session, address, before)


class Page:
    """A loaded page."""

    def __init__(self, browser: Browser, session: str, address: str, before: str) -> None:
        self._browser, self._session = browser, session
        for domain in ("Page", "Runtime", "Log"):
            self.command(f"{domain}.enable")
        if before:
            self.command("Page.addScriptToEvaluateOnNewDocument", {"source": before})
        self.command("Page.navigate", {"url": address})
        self.wait_for("document.readyState === 'complete' && location.href !== 'about:blank'")

    def command(self, method: str, parameters: Optional[Dict[str, Any]] = None) -> Dict[str, Any]:
        """A command for this page."""
        return self._browser.command(method, parameters, self._session)

    def evaluate(self, expression: str) -> Any:
        """The value of an expression, awaited when it is a promise."""
        result = self.command("Runtime.evaluate", {"expression": expression, "awaitPromise": True,
                                                   "returnByValue": True, "userGesture": True})
        if "exceptionDetails" in result:
            details = result["exceptionDetails"]
            raise PageFailed(details.get("exception", {}).get("description") or details["text"])
        return result["result"].get("value")

    def wait_for(self, expression: str, seconds: float = 30.0) -> None:
        """Returns as soon as an expression is true."""
        end = time.monotonic() + seconds
        while not self.evaluate(expression):
            if time.monotonic() > end:
                raise PageFailed(f"never true: {expression}")
            time.sleep(0.02)

    def errors(self) -> List[str]:
        found = []
        for event in self._browser.events:
            if event.get("sessionId") == self._session:
                if event["method"] == "Runtime.exceptionThrown":
                    details = event["params"]["exceptionDetails"]
                    found.append(details.get("exception", {}).get("description") or details["text"])
                elif event["method"] == "Log.entryAdded" and event["params"]["entry"]["level"] == "error":
                    found.append(event["params"]["entry"]["text"])
        return found

    def click(self, x: float, y: float) -> None:
        for kind in ("mousePressed", "mouseReleased"):
            self.command("Input.dispatchMouseEvent", {"type": kind, "x": x, "y": y, "button": "left", "clickCount": 1})
