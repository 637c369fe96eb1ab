"""Draws mouth.webp, the moving face of README.md: the demo's sentence, drawn by the face of Labial's pages.

    cmake --workflow --preset demo
    python3 docs/images/mouth.py build/demo/labial-demo.html docs/images/mouth.webp

It needs Pillow and Chromium (``$LABIAL_CHROMIUM`` names another program than ``chromium``). All frames are drawn in one
page, side by side, of which Chromium takes one picture.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import List

from PIL import Image

#: Pixels of a frame, frames in a row of the picture that is cut up.
WIDTH, HEIGHT, ROW = 200, 230, 10

#: Every second frame of 50 per second is shown; browsers show pictures for no less than 20 ms.
STEP = 2

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


def picture(frames: List[List[int]], folder: Path) -> Image.Image:
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


def main(page: str, output: str) -> None:
    """Draws the page's frames into `output`."""
    frames = frames_of(Path(page))[::STEP]
    with tempfile.TemporaryDirectory() as folder:
        sheet = picture(frames, Path(folder))
    pictures = []
    for number in range(len(frames)):
        left, top = number % ROW * WIDTH, number // ROW * HEIGHT
        pictures.append(sheet.crop((left, top, left + WIDTH, top + HEIGHT)))
    pictures[0].save(output, save_all=True, append_images=pictures[1:], duration=20 * STEP, loop=0, quality=50,
                     method=6)  # fmt: skip
    print(f"{output}: {len(frames)} frames, {os.path.getsize(output)} bytes")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit("usage: mouth.py PAGE.html OUT.webp")
    main(*sys.argv[1:])
