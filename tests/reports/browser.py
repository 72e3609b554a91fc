"""A headless browser as a measuring device: where things stand on a page, and how it looks as a picture."""

import json
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FLAGS = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--hide-scrollbars")
WIDTH, HEIGHT = 1280, 800
PHONE = 500  # pixels: the narrowest window that headless Chromium opens
PRINTED_WIDTH = 688  # pixels between the margins of A4: (210 - 2 x 14) mm at 96 to the inch

MEASURE = """
<script>
const box = e => { const b = e.getBoundingClientRect(); return [b.left, b.top, b.right, b.bottom]; };
const clipped = [];
for (const svg of document.querySelectorAll("figure svg")) {
  const outer = svg.getBoundingClientRect();
  for (const text of svg.querySelectorAll("text")) {
    const b = text.getBoundingClientRect();
    if (b.left < outer.left - 1 || b.right > outer.right + 1 || b.top < outer.top - 1 || b.bottom > outer.bottom + 1)
      clipped.push(text.textContent.trim());
  }
}
const first = document.querySelector("#worst tbody tr");
document.body.innerHTML = "<pre id=measured>" + JSON.stringify({
  headline: box(document.querySelector("h1")),
  questions: [...document.querySelectorAll(".answers h2")].map(box),
  answers: [...document.querySelectorAll(".answers p:not(figcaption p)")].map(box),
  worst: first ? box(first) : [],
  worst_text: first ? first.textContent : "",
  page_width: document.documentElement.scrollWidth,
  too_wide: [...document.querySelectorAll("table, th, td, p, li, dd, pre, figure svg")]
    .filter(e => e.getBoundingClientRect().right > innerWidth + 1 || e.scrollWidth > e.clientWidth + 1 && e.clientWidth)
    .map(e => e.tagName + " " + e.textContent.trim().slice(0, 60)),
  figures: document.querySelectorAll("figure svg").length,
  clipped: clipped,
}).replaceAll("<", "") + "</pre>";
</script>
"""


def browser() -> str:
    """The browser's command, empty when there is none."""
    return next((path for name in NAMES if (path := shutil.which(name))), "")


def measure(page: Path, *, width: int = WIDTH, printed: bool = False) -> dict:
    """Places and sizes on the page in a window; `printed` shows it with the style of paper, all details open."""
    text = page.read_text(encoding="utf-8").replace("<details>", "<details open>")
    text = text.replace("</body>", f"{MEASURE}</body>")
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "page.html"
        copy.write_text(text.replace("@media print", "@media all") if printed else text, encoding="utf-8")
        dumped = _run("--dump-dom", f"file://{copy}", folder, width=width)
    found = re.search(r'<pre id="measured">(.*?)</pre>', dumped, re.DOTALL)
    return json.loads(found[1].replace("&amp;", "&").replace("&gt;", ">"))


def picture(page: Path, target: Path, *, height: int = HEIGHT) -> None:
    """The page as PNG."""
    with tempfile.TemporaryDirectory() as folder:
        _run(f"--screenshot={target}", f"file://{page}", folder, height=height)


def _run(task: str, address: str, profile: str, *more: str, width: int = WIDTH, height: int = HEIGHT) -> str:
    command = [
        browser(),
        *FLAGS,
        *more,
        f"--user-data-dir={profile}/profile",
        f"--window-size={width},{height}",
        task,
        address,
    ]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=True).stdout
