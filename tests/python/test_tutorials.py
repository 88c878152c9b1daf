"""The runner of docs/tutorials holds a page to what it says; `make tutorials` runs the pages themselves."""

import importlib.util
import os
import pathlib

import pytest

pytest.importorskip("PIL")
ROOT = pathlib.Path(__file__).resolve().parents[2]
SPEC = importlib.util.spec_from_file_location("run_tutorials", ROOT / "docs/tutorials/run.py")
runner = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(runner)
PAGES = [*sorted((ROOT / "docs/tutorials").glob("*.md")), ROOT / "docs/gallery.md"]


def verdict_of(text, folder):
    """What the runner says of a page."""
    page = folder / "page.md"
    page.write_text(text)
    try:
        return runner.run_page(page, folder / "out", os.environ)
    except SystemExit as end:
        return str(end)


def block(kind, text):
    return f"Some text.\n\n```{kind}\n{text}\n```\n\n"


def test_a_page_that_does_what_it_says(tmp_path):
    page = block('json title="two.json"', "[1, 2]") + block("sh", "cat two.json; exit 3   # ends with status 3")
    assert verdict_of(page + block("text", "[7, 8]\n..."), tmp_path) == "as it says"  # only numbers may differ


@pytest.mark.parametrize(
    "blocks, line, what",
    [
        (block("sh", "exit 1"), 3, "status 1, and not 0"),
        (block("sh", "true   # ends with status 2"), 3, "status 0, and not 2"),
        (block("sh", "false\ntrue"), 3, "status 1, and not 0"),
        (block("sh", "echo one pair") + block("text", "no pair"), 9, "`no pair` was not printed"),
        (block("yaml", "a: 1"), 3, "without a title"),
        ('![a](a.jpg "out/view.html#frame=1")\n', 1, "there is no out/view.html"),
    ],
)
def test_what_is_not_as_the_page_says_is_named_with_its_line(blocks, line, what, tmp_path):
    verdict = verdict_of(blocks, tmp_path)
    assert verdict.startswith(f"{tmp_path / 'page.md'}:{line}: ") and what in verdict


def test_a_page_ends_where_a_program_is_absent(tmp_path):
    assert "there is no absent_program" in verdict_of(block("sh", "# needs absent_program\nfalse"), tmp_path)


@pytest.mark.parametrize("page", PAGES, ids=[page.stem for page in PAGES])
def test_pages_have_pictures_of_modest_size(page):
    pictures = [match["picture"] for match in runner.BLOCK.finditer(page.read_text()) if match["picture"]]
    assert pictures and "![" in page.read_text()
    assert page.read_text().count("![") == len(pictures)  # none is made by hand
    for picture in pictures:
        assert (page.parent / picture).stat().st_size <= runner.MOST_BYTES
