"""The packages on pages with a strict policy, loaded twice, and the drawn face: as a visitor, a screen reader and a
keyboard find it."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any, Iterator

import pytest

from browser import Browser, Page, PageFailed, served
from npm import lay

pytestmark = pytest.mark.slow

#: Nothing but the page's own files, no text as script or markup.
STRICT = ("default-src 'none'; connect-src 'self'; style-src 'self'; script-src 'self'{}; media-src 'self'; "
          "require-trusted-types-for 'script'; trusted-types 'none'")
PAGE = """<!DOCTYPE html>
<html lang="de-AT">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<link rel="icon" href="data:,">
<labial-mouth></labial-mouth><labial-face id="face"></labial-face>
<script type="module" src="page.js"></script>
</html>
"""
SCRIPT = """
import { Labial } from "./node_modules/labial/index.js";
import { LabialFace } from "./node_modules/labial/labial-face.js";
import "./copy/labial/labial-face.js";

Object.assign(window, { LabialFace, face: document.getElementById("face"), refused: [] });
document.addEventListener("securitypolicyviolation", ({ violatedDirective, blockedURI }) => {
    if (blockedURI !== "data") refused.push(`${violatedDirective} ${blockedURI}`);
});
window.load = () => Labial.load({
    hearing: () => import("./node_modules/labial-hearing/index.js"),
    words: () => import("./node_modules/labial-words/index.js"),
});
window.ready = true;
"""


@pytest.fixture(scope="module")
def folder(npm_package: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The packages, and copies of them as another package brings them."""
    folder = tmp_path_factory.mktemp("elements") / "page"
    lay(npm_package, folder, "labial", "labial-hearing", "labial-words")
    shutil.copytree(folder / "node_modules", folder / "copy")
    (folder / "page.js").write_text(SCRIPT, encoding="utf-8")
    for name, wasm in (("strict", " 'wasm-unsafe-eval'"), ("without", "")):
        (folder / f"{name}.html").write_text(PAGE.format(policy=STRICT.format(wasm)), encoding="utf-8")
    return folder


@pytest.fixture
def opened(folder: Path, browser: Browser) -> Iterator[Any]:
    with served(folder) as site:

        def opened(name: str, before: str = "") -> Page:
            page = browser.page(f"{site}/{name}.html", before)
            page.wait_for("window.ready")
            return page

        yield opened


def test_strict_policies_and_two_copies(opened: Any) -> None:
    """Catches markup from text, styles in it, an AudioWorklet from a blob, and an element that is defined twice."""
    page = opened("strict")
    heard = page.evaluate("""(async () => {
        const labial = await load(), context = new AudioContext();
        await labial.words();
        const hearing = await labial.hear(new ConstantSourceNode(context), { context });
        for (const from = performance.now(); hearing.number < 5 && performance.now() - from < 20000;) {
            await new Promise((later) => setTimeout(later, 20));
            hearing.at();
        }
        hearing.close();
        return hearing.number;
    })()""")
    assert heard >= 5
    assert page.evaluate("refused") == []
    paths = "document.querySelector('{}').shadowRoot.querySelectorAll('path[d]').length"
    assert page.evaluate(paths.format("labial-mouth")) > 15 and page.evaluate(paths.format("labial-face")) > 15
    assert page.evaluate("face instanceof LabialFace && customElements.get('labial-face') === LabialFace")
    assert page.evaluate("getComputedStyle(face.shadowRoot.querySelector('.teeth')).fill") != "rgb(0, 0, 0)"
    assert [error for error in page.errors() if "data:" not in error] == []  # the icon is data, which is refused


def test_a_page_that_is_no_browsers(opened: Any) -> None:
    """jsdom, in which components are tested, has neither matchMedia() nor adopted style sheets: a face moves there."""
    page = opened("strict", "delete window.matchMedia; delete ShadowRoot.prototype.adoptedStyleSheets")
    assert page.evaluate("window.matchMedia === undefined")
    line = "face.shadowRoot.querySelector('path.line').getAttribute('d')"
    assert page.evaluate(f"const rest = {line}; face.show(new Array(13).fill(200)); rest !== {line}")
    assert [error for error in page.errors() if "data:" not in error] == []


def test_without_webassembly_the_policy_is_named(opened: Any) -> None:
    """Catches the browser's own error, which names another word."""
    page = opened("without")
    found = page.evaluate("load().then(() => null, ({ name, message, cause }) => [name, message, Boolean(cause)])")
    assert found[0] == "LabialError" and "'wasm-unsafe-eval'" in found[1] and found[2]


def test_screen_readers_and_keyboards_find_the_face(opened: Any) -> None:
    """Its role and its name in the page's language, which the page can replace; the focus, and what the keys do."""
    page = opened("strict")

    def named() -> Any:
        nodes = page.command("Accessibility.getFullAXTree")["nodes"]
        return [(node["role"]["value"], node["name"]["value"]) for node in nodes
                if not node.get("ignored") and node["role"]["value"] in ("image", "button")]

    assert ("image", "Ein sprechendes Gesicht") in named()
    page.evaluate("document.documentElement.removeAttribute('lang')")
    for language, name in (("nb", "Et snakkende ansikt"), ("no", "Et snakkende ansikt"), ("pt-BR", "Um rosto que fala"),
                           ("NB-no", "Et snakkende ansikt"), ("nn-NO", "Eit snakkande ansikt"),
                           ("tlh", "A speaking face")):
        page.evaluate(f"document.body.lang = '{language}', document.body.append(face), 0")
        assert ("image", name) in named(), language
    page.evaluate('''(() => {
        const [outer, inner] = [0, 1].map(() => document.createElement("div"));
        document.body.append(outer);
        outer.attachShadow({ mode: "open" }).append(inner);
        inner.attachShadow({ mode: "closed" }).append(face);
    })()''')
    for place, language, name in (("document.body", "de", "Ein sprechendes Gesicht"),
                                  ("outer", "fr", "Un visage qui parle")):
        page.evaluate(f"outer = face.getRootNode().host.getRootNode().host, {place}.lang = '{language}', "
                      "face.getRootNode().append(face), 0")
        assert ("image", name) in named(), place
    page.evaluate("document.body.append(face)")
    page.evaluate("face.role = 'button', face.ariaLabel = 'Bobby', 0")
    assert ("button", "Bobby") in named()
    assert page.evaluate("face.focus(), document.activeElement === face")
    page.evaluate("window.clicks = 0, face.onclick = () => { clicks++; }, 0")
    for key, code in (("Enter", 13), (" ", 32), ("a", 65)):
        for kind in ("keyDown", "keyUp"):
            page.command("Input.dispatchKeyEvent", {"type": kind, "key": key, "windowsVirtualKeyCode": code})
    assert page.evaluate("clicks") == 2


def test_eyes_blink_unless_motion_is_to_be_reduced(opened: Any) -> None:
    """Lids that come down, and none for a visitor who wants it still; its own colour in the dark; a wrong frame."""
    page = opened("strict")
    with pytest.raises(PageFailed, match="a frame has 13 FAPs"):
        page.evaluate("face.show([1, 2])")
    lids = "[...face.shadowRoot.querySelectorAll('.lid, .lash, .gaze')].flatMap((one) => one.getAnimations()).length"
    assert page.evaluate(lids) == 5
    down = page.evaluate("""(() => {
        const [lid] = face.shadowRoot.querySelectorAll(".lid"), [blink] = lid.getAnimations(), found = [];
        blink.pause();
        for (blink.currentTime = 0; blink.currentTime < 11000; blink.currentTime += 25) {
            found.push(new DOMMatrix(getComputedStyle(lid).transform).f);
        }
        return found;
    })()""")
    assert min(down) == -90 and max(down) > -20 and 0.01 < sum(one > -80 for one in down) / len(down) < 0.1
    skin = "getComputedStyle(face.shadowRoot.querySelector('.skin')).fill"
    light = page.evaluate(skin)
    page.evaluate("face.style.colorScheme = 'dark', 0")
    assert page.evaluate(skin) != light
    page.command("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-reduced-motion", "value": "reduce"}]})
    assert page.evaluate(lids) == 0


def test_captions_follow_the_words(opened: Any) -> None:
    """Lines that are broken where a sentence ends, the marked word, the end of the last line; the event at the end."""
    page = opened("strict")
    seen = page.evaluate("""(async () => {
        const labial = await load(), seen = [];
        const words = "Tap my mouth. I will laugh.".split(" ")
            .map((text, i) => ({ text, start: 0.1 * i, end: 0.1 * i + 0.1 }));
        const track = labial.render([{ start: 0, end: 2.5, label: "AA" }]);
        const over = new Promise((resolve) => { face.onended = resolve; face.addEventListener("ended", resolve); });
        face.words = words;
        const show = face.show;
        face.show = (faps) => {
            if (seen.length % 3 === 0) face.words = words; // again: the word is marked nevertheless
            show.call(face, faps);
            seen.push([face.position, face.caption, face.shadowRoot.querySelector("mark")?.textContent ?? ""]);
        };
        face.track = track;
        await over;
        face.caption = "Anything <b>";
        seen.push([0, face.caption, face.shadowRoot.querySelectorAll("b").length]);
        return seen;
    })()""")
    assert seen.pop()[1:] == ["Anything <b>", 0]
    for moment, caption, marked in seen:
        if abs(10 * moment - round(10 * moment)) < 1e-6:  # a word begins just there
            continue
        if moment < 1.55:
            assert caption == ("Tap my mouth." if moment < 0.3 else "I will laugh."), (moment, caption)
            number = min(5, int(moment * 10))
            assert marked == "Tap my mouth. I will laugh.".split()[number], (moment, marked)
        elif moment > 1.65:
            assert caption == "", (moment, caption)
    assert len(seen) > 10 and seen[-1][0] > 2.5


def test_a_microphone_that_is_gone_and_a_sound_that_ends(opened: Any) -> None:
    """The events of what is heard, on it and on the face that draws it."""
    page = opened("strict")
    found = page.evaluate("""(async () => {
        const labial = await load(), context = new AudioContext(), told = [];
        const note = (what) => (event) => told.push(`${what} ${event.type}`);
        const listen = (one, name) => ["ended", "lost"].forEach((type) => one.addEventListener(type, note(name)));
        listen(face, "face");
        const out = new MediaStreamAudioDestinationNode(context);
        const source = new ConstantSourceNode(context);
        source.connect(out);
        source.start();
        const microphone = await labial.hear(out.stream, { context, play: false });
        listen(microphone, "microphone");
        face.hearing = microphone;
        const [track] = out.stream.getTracks();
        track.stop(); // which tells nobody
        track.dispatchEvent(new Event("ended")); // as a browser does where the device is gone
        while (told.length < 2) await new Promise((later) => setTimeout(later, 20));
        microphone.close();
        const note2 = await labial.hear(source, { context });
        listen(note2, "node");
        face.hearing = note2;
        source.stop();
        while (told.length < 4) await new Promise((later) => setTimeout(later, 20));
        note2.close();
        return told;
    })()""")
    assert found == ["microphone lost", "face lost", "node ended", "face ended"]
