"""Draws mouth.webp, the moving face of README.md: the demo's sentence, drawn by the face of Labial's pages.

    cmake --workflow --preset demo
    python3 docs/images/mouth.py build/demo/labial-demo.html docs/images/mouth.webp

Or a sheet of voices, voices.webp: ten sounds of each, by the mouth of Labial's pages and on a head with ARKit's shapes.

    python3 docs/images/mouth.py HEAD.glb "the bundled voice=speech_en" NAME=MODEL.npz ... docs/images/voices.webp

It needs Pillow and Chromium (``$LABIAL_CHROMIUM`` names another program than ``chromium``), a sheet the exporter with
its extra `fit` on the path, too. All frames are drawn in one page, side by side, of which Chromium takes one picture.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import List, Sequence

from PIL import Image, ImageDraw

#: Pixels of a frame, frames in a row of the picture that is cut up.
WIDTH, HEIGHT, ROW = 200, 230, 10

#: Every second frame of 50 per second is shown; browsers show pictures for no less than 20 ms.
STEP = 2

#: Sounds of a sheet: a caption, phonemes with milliseconds, the place of the one that is drawn.
SOUNDS = (
    ("m (may)", (("M", 100), ("EY", 200)), 0),
    ("f (fee)", (("F", 120), ("IY", 200)), 0),
    ("ah (father)", (("F", 100), ("AA", 250), ("DH", 70), ("ER", 150)), 1),
    ("aw (saw)", (("S", 120), ("AO", 250)), 1),
    ("ee (see)", (("S", 120), ("IY", 250)), 1),
    ("oo (do)", (("D", 80), ("UW", 300)), 1),
    ("o (go)", (("G", 80), ("OW", 300)), 1),
    ("w (away)", (("AH", 80), ("W", 90), ("EY", 200)), 1),
    ("n (any)", (("EH", 120), ("N", 80), ("IY", 150)), 1),
    ("sh (ashore)", (("AH", 80), ("SH", 130), ("AO", 200), ("R", 80)), 1),
)

#: Pixels of a cell of a sheet, and of the lines with text.
CELL, LINE = 120, 16

MOUTH = Path(__file__).parents[2] / "export" / "labial" / "see" / "mouth.js"


def frames_of(page: Path) -> List[List[int]]:
    """The frames (T, 13), FAP, that a page plays: of its first motion, to the end of what is spoken."""
    text = re.search(r'id="labial-data">(.*?)</script>', page.read_text(encoding="utf-8"), re.DOTALL)
    if text is None:
        raise SystemExit(f"{page}: no page of Labial's")
    data = json.loads(text.group(1))
    spoken = [item for item in data["phonemes"] if item["kind"] == "speech"]
    last = spoken[-1]["start_frame"] + spoken[-1]["frames"]
    for one, other in zip(data["phonemes"], data["phonemes"][1:]):
        if other["kind"] == "laughter":
            last = one["start_frame"] + one["frames"]
            break
    return data["frames"][: last + 10]


def picture(frames: Sequence[Sequence[float]], folder: Path) -> Image.Image:
    """All frames in rows of ROW, as Chromium draws them."""
    rows = -(-len(frames) // ROW)
    page = folder / "mouths.html"
    page.write_text(f"""<!DOCTYPE html><meta charset="utf-8">
<style>body{{margin:0;width:{ROW * WIDTH}px;font-size:0}}
div{{display:inline-block;width:{WIDTH}px;height:{HEIGHT}px}}</style>
<body><script type="module">{MOUTH.read_text(encoding="utf-8")}
{json.dumps(frames)}.forEach((frame, number, frames) => {{
  const place = document.createElement("div");
  document.body.append(place);
  const draw = createFace(place);
  frames.slice(0, number + 1).forEach(draw); // brows follow slowly
  for (const animation of place.getAnimations({{ subtree: true }})) {{
    animation.pause();
    animation.currentTime = 2000 + {20 * STEP} * number; // it blinks in the second second
    animation.effect.updateTiming({{ delay: 0 }});
  }}
}});
</script>""", encoding="utf-8")
    drawn = folder / "mouths.png"
    subprocess.run([os.environ.get("LABIAL_CHROMIUM", "chromium"), "--headless=new", "--no-sandbox", "--disable-gpu",
                    "--hide-scrollbars", "--virtual-time-budget=10000", f"--user-data-dir={folder / 'profile'}",
                    f"--window-size={ROW * WIDTH},{rows * HEIGHT}", f"--screenshot={drawn}", page.as_uri()],
                   check=True, capture_output=True, timeout=300)  # fmt: skip
    with Image.open(drawn) as image:
        return image.convert("RGB")


def cut(image: Image.Image, number: int) -> Image.Image:
    """A frame of such a picture."""
    left, top = number % ROW * WIDTH, number // ROW * HEIGHT
    return image.crop((left, top, left + WIDTH, top + HEIGHT))


def voices(head: str, models: Sequence[str], output: str) -> None:
    """Draws a sheet: two rows for each of the models, NAME=MODEL."""
    import numpy as np

    from labial.fit.avatar import read
    from labial.fit.landmarks import read_head
    from labial.reference.synthesis import delivered
    from labial.rig.animation import face
    from labial.see.picture import said, sheet
    from labial.tables.model import load

    names, paths = zip(*(model.split("=", 1) for model in models))
    frames = []
    for path in paths:
        model = load(path)
        frames.append(said(SOUNDS, lambda phonemes, model=model: np.concatenate(list(
            delivered(model, [(model.phonemes.index(label), length) for label, length in phonemes]))))[1])
    found, count = read_head(read(head), head, {}), len(SOUNDS)
    made = Image.new("RGB", (count * CELL, LINE + len(names) * (2 * CELL + LINE)), "white")
    text = ImageDraw.Draw(made)
    with tempfile.TemporaryDirectory() as folder:
        mouths = picture(np.rint(np.concatenate(frames)).astype(int).tolist(), Path(folder))
        place = Path(folder) / "heads.png"
        sheet(face("arkit"), found, place, [""] * (len(names) * count), np.concatenate(frames), count, 1.5)
        heads = Image.open(place).convert("RGB")
    for column, (caption, _, _) in enumerate(SOUNDS):
        text.text((column * CELL + 4, 2), caption, fill="black")
    wide, high = heads.width / count, heads.height / len(names)
    for row, name in enumerate(names):
        top = LINE + row * (2 * CELL + LINE)
        text.text((4, top + 2), name, fill="black")
        for column in range(count):
            drawn = cut(mouths, row * count + column).crop((45, 95, 155, 205))
            shown = heads.crop((round(column * wide), round((row + 1) * high - wide), round((column + 1) * wide),
                                round((row + 1) * high)))
            for line, cell in enumerate((drawn, shown)):
                made.paste(cell.resize((CELL, CELL)), (column * CELL, top + LINE + line * CELL))
    made.save(output, quality=70, method=6)
    print(f"{output}: {len(names)} voices, {os.path.getsize(output)} bytes")


def main(page: str, output: str) -> None:
    """Draws the page's frames into `output`."""
    frames = frames_of(Path(page))[::STEP]
    with tempfile.TemporaryDirectory() as folder:
        sheet = picture(frames, Path(folder))
    pictures = [cut(sheet, number) for number in range(len(frames))]
    pictures[0].save(output, save_all=True, append_images=pictures[1:], duration=20 * STEP, loop=0, quality=50,
                     method=6)  # fmt: skip
    print(f"{output}: {len(frames)} frames, {os.path.getsize(output)} bytes")


if __name__ == "__main__":
    if len(sys.argv) == 3:
        main(*sys.argv[1:])
    elif len(sys.argv) > 3 and all("=" in model for model in sys.argv[2:-1]):
        voices(sys.argv[1], sys.argv[2:-1], sys.argv[-1])
    else:
        raise SystemExit("usage: mouth.py PAGE.html OUT.webp, or mouth.py HEAD.glb NAME=MODEL ... OUT.webp")
