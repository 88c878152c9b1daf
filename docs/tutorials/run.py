"""Runs pages of docs/ whose commands can be run: run.py PROGRAM PACKAGE [PAGE.md ...]; by default all of them.

PACKAGE is the folder of the Python package. Each page is run in an empty folder, out/tutorials/NAME, in its own order:

* A fenced block with a title is a file. It is written.
* A block `sh` is run by bash, with the program on the path; $SELVEDGE is the folder of the sources. It must end with
  the status that the page names (`# ends with status 1`), else with 0. Where the block says `# needs NAME`, and there
  is neither a program nor a Python module of that name, the page ends there.
* A block `text` has lines that the block before it printed. Only numbers may differ.
* A picture `![what](NAME.jpg "view.html#frame=3")` is taken of that page of a run and stored where the link leads. With
  `size=1400x600` among the options it has that size. A picture that looks as it did before stays as it is.

The first thing that is not as the page says ends the run with status 1.
"""

import importlib.util
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

from PIL import Image, ImageChops, ImageStat

ROOT = pathlib.Path(__file__).resolve().parents[2]
BLOCK = re.compile(
    r'^```(?P<kind>\w+)(?: title="(?P<file>[^"]+)")?\n(?P<text>.*?)^```$'
    r'|^!\[[^\]]*\]\((?P<picture>\S+\.jpg)\s"(?P<view>[^"]+)"\)',
    re.M | re.S,
)
CHROMIUM = (
    "chromium --headless --no-sandbox --use-angle=swiftshader-webgl --disable-background-networking"
    " --disable-component-update --disable-sync --no-first-run --hide-scrollbars"
).split()
SHOWN, FINER, MOST_BYTES = (800, 500), 1.5, 80_000  # the window is that much larger than the picture
SAME = 2.0  # mean difference of two pictures that look alike, of 255


def environment(program, package):
    first = [str(program.parent), str(pathlib.Path(sys.executable).parent)]
    path = os.pathsep.join([*first, os.environ["PATH"]])
    return dict(os.environ, PATH=path, PYTHONPATH=str(package), SELVEDGE=str(ROOT))


def absent(text, path):
    """The first thing that a block needs and that is not here, or None."""
    for name in re.findall(r"# needs (\w+)", text):
        if not shutil.which(name, path=path) and importlib.util.find_spec(name) is None:
            return name
    return None


def run_block(text, folder, env):
    """What the block printed; an error where its status is not the one that it names."""
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=folder, env=env, capture_output=True, text=True)
    named = re.search(r"# ends with status (\d+)", text)
    wanted, printed = int(named[1]) if named else 0, done.stdout + done.stderr
    if done.returncode != wanted:
        raise ValueError(f"status {done.returncode}, and not {wanted}:\n{printed}")
    return printed


def plain(line):
    """A line without its numbers and its spaces."""
    return re.sub(r"\s+", " ", re.sub(r"\d[\d.,]*(e[-+]?\d+)?", "#", line)).strip()


def compare_printed(text, printed):
    lines = {plain(line) for line in re.split(r"[\r\n]+", printed)}
    for line in text.splitlines():
        if line.strip() not in ("", "...") and plain(line) not in lines:
            raise ValueError(f"`{line}` was not printed:\n{printed}")


def picture_of(view, folder):
    """The page of a run, as `view` names it below the folder, with its options."""
    file, _, options = view.partition("#")
    if not (folder / file).is_file():
        raise ValueError(f"there is no {file} to take a picture of")
    size = re.search(r"\bsize=(\d+)x(\d+)", options)
    shown = (int(size[1]), int(size[2])) if size else SHOWN
    with tempfile.TemporaryDirectory() as profile:
        shot = pathlib.Path(profile) / "shot.png"
        window = "--window-size={:.0f},{:.0f}".format(*(FINER * pixels for pixels in shown))
        address = f"file://{folder / file}#theme=light&{options}"
        command = [*CHROMIUM, f"--user-data-dir={profile}", window, f"--screenshot={shot}", address]
        subprocess.run(command, check=True, capture_output=True)
        return Image.open(shot).convert("RGB").resize(shown, Image.Resampling.LANCZOS)


def difference(one, other):
    """The mean difference of two pictures in the colour in which they differ most, of 255; None for other sizes."""
    if one.size != other.size:
        return None
    return max(ImageStat.Stat(ImageChops.difference(one, other)).mean)


def take_picture(view, folder, target):
    picture = picture_of(view, folder)
    if target.is_file():
        off = difference(Image.open(target), picture)
        if off is not None and off < SAME:
            return
    for quality in range(90, 30, -5):
        packed = io.BytesIO()
        picture.save(packed, "JPEG", quality=quality, optimize=True)
        if packed.tell() <= MOST_BYTES:
            break
    target.parent.mkdir(exist_ok=True)
    target.write_bytes(packed.getvalue())


def run_page(page, folder, env):
    """What came of the page, in words."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    text, printed = page.read_text(), ""
    for match in BLOCK.finditer(text):
        block, line = match["text"], text.count("\n", 0, match.start()) + 1
        try:
            if match["picture"]:
                take_picture(match["view"], folder, page.parent / match["picture"])
            elif match["file"]:
                (folder / match["file"]).write_text(block)
            elif match["kind"] == "text":
                compare_printed(block, printed)
            elif match["kind"] != "sh":
                raise ValueError(f"a block `{match['kind']}` without a title is not run")
            elif name := absent(block, env["PATH"]):
                return f"skipped from its line {line} on: there is no {name}"
            else:
                printed = run_block(block, folder, env)
        except ValueError as error:
            sys.exit(f"{page}:{line}: {error}")
    return "as it says"


def main():
    program, package, *pages = map(pathlib.Path, sys.argv[1:])
    env = environment(program.resolve(), package.resolve())
    tutorials = sorted((ROOT / "docs/tutorials").glob("*.md"))
    for page in pages or [*tutorials, ROOT / "docs/gallery.md"]:
        begun = time.monotonic()
        verdict = run_page(page.resolve(), ROOT / "out/tutorials" / page.stem, env)
        print(f"{page.name:20} {time.monotonic() - begun:6.0f} s  {verdict}", flush=True)


if __name__ == "__main__":
    main()
