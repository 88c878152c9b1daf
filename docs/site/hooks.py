"""Makes pages of docs/ into pages of the site.

docs/ is read on plain Git hosts, too. So README.md becomes the site's front page, links are followed from where they
stand in the repository, and what leads out of docs/ becomes the path of a file. What the two readers of Markdown take
differently is a warning, which `mkdocs build --strict` fails on.
"""

import logging
import pathlib
import posixpath
import re

from mkdocs.structure.files import File

ROOT = pathlib.Path(__file__).resolve().parents[2]
log = logging.getLogger("mkdocs.hooks.selvedge")

# Pages whose source is outside of docs/, or is for the site alone: where they are in the site, and in the repository.
ADDED = {
    "index.md": "README.md",
    "changelog.md": "CHANGELOG.md",
    "python_api.md": "docs/site/python_api.md",
    "cpp_api.md": "docs/site/cpp_api.md",
    "site.css": "docs/site/site.css",
    "iframe-worker.js": "docs/site/iframe-worker.js",
}

FENCED = r"^ *(?:```|~~~).*?^ *(?:```|~~~) *$"
CODE_OR_LINK = re.compile(FENCED + r"|`[^`]*`|(!?)\[((?:[^\[\]`]|`[^`]*`)*)\]\(([^()\s]+)\)", re.M | re.S)


def on_files(files, config):
    for uri, source in ADDED.items():
        files.append(File.generated(config, uri, abs_src_path=str(ROOT / source)))
    return files


def on_page_markdown(markdown, page, config, files):
    source = ADDED.get(page.file.src_uri, "docs/" + page.file.src_uri)
    if page.file.src_uri.startswith(("results/", "decisions/")):
        page.meta["search"] = {"boost": 0.5}  # behind the users' pages
    for line, what in taken_differently(markdown):
        log.warning(f"{source}:{line}: {what}")

    def replaced(match):
        bang, text, target = match.groups()
        if target is None or re.match(r"[a-z]+:|#", target):
            return match[0]
        path, hash, anchor = target.partition("#")
        here = posixpath.normpath(posixpath.join(posixpath.dirname(source), path))
        uri = site_uri(here)
        if uri is not None:
            link = posixpath.relpath(uri, posixpath.dirname(page.file.src_uri) or ".")
            return f"{bang}[{text}]({link}{hash}{anchor})"
        if not (ROOT / here).exists():
            log.warning(f"{source}: leads nowhere: {target}")
        bracketed = markdown[: match.start()].endswith("(") and markdown.startswith(")", match.end())
        return f"{text}: `{here}`" if bracketed else f"{text} (`{here}`)"

    return CODE_OR_LINK.sub(replaced, markdown)


def on_post_page(output, page, config):
    for target in re.findall(r"<(?:script|link|img|iframe)\b[^>]*?(?:src|href)=\"?(https?:[^\s\">]+)", output):
        log.warning(f"{page.file.src_uri}: fetches {target}")


def site_uri(path):
    """Where a file of the repository is in the site; None where it is not."""
    for uri, source in ADDED.items():
        if path == source:
            return uri
    uri = path.removeprefix("docs/")
    return uri if uri != path and not uri.startswith("site/") else None


def taken_differently(markdown):
    """Lines, counted from 1, that Git hosts read as a list or as part of an item, and Python-Markdown does not."""
    item = re.compile(r"([*+-]|\d+\.) ")
    before, in_list, nested = "", False, False
    without_fenced = re.sub(FENCED, lambda m: "\n" * m[0].count("\n"), markdown, flags=re.M | re.S)
    for number, line in enumerate(without_fenced.split("\n"), 1):
        begins = re.match(r"([*+-]|1\.) ", line)
        if begins and before.strip() and (nested or not in_list and not re.match(r"[#<|]", before)):
            yield number, "a list needs an empty line before it"
        if in_list and re.match(r" {1,3}(| {4})\S", line) and (not before.strip() or item.match(line.lstrip())):
            yield number, "what belongs to an item of a list needs four spaces before it"
        goes_on = not line.strip() or line.startswith(" ") or bool(before.strip())
        in_list = bool(item.match(line)) or in_list and goes_on
        nested = in_list and line.startswith("    ") and (nested or not before.strip())
        before = line
