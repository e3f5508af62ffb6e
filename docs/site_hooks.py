"""Hook of mkdocs: the site holds what documents link outside docs/, too.

Experiments, models, the licence and source files stand beside docs/, and documents link them by their paths in the
repository. Here every such file becomes a file of the site: Markdown a page, everything else a copy. Its path in the
site is its path from the root of the repository, and links are rewritten accordingly. A folder stands for its README.
The README of the root gets another name: to mkdocs it would be the site's first page, which docs/index.md is.
"""
import os
import pathlib
import re
import urllib.parse

from mkdocs.structure.files import File

ROOT = pathlib.Path(__file__).resolve().parents[1]
ROOT_README = "repository.md"
LINK = re.compile(r"(\]\(\s*)([^\s()<>]+)((?:\s+\"[^\"]*\")?\s*\))")
FENCED = re.compile(r"^(```+|~~~+).*?^\1\s*$|`[^`\n]+`", re.M | re.S)


def in_site(path):
    """Where a file of the repository stands in the site, from the site's root."""
    if path == ROOT / "README.md":
        return ROOT_README
    try:
        return path.relative_to(ROOT / "docs").as_posix()
    except ValueError:
        return path.relative_to(ROOT).as_posix()


def in_repository(src_path):
    """The file of the repository that a path of the site stands for."""
    if src_path == ROOT_README:
        return ROOT / "README.md"
    inside = ROOT / "docs" / src_path
    return inside if inside.exists() else ROOT / src_path


def target_of(page_file, link):
    """The file of the repository that a link leads to; None where there is none."""
    path = urllib.parse.unquote(urllib.parse.urlsplit(link).path)
    if not path or path.startswith("/") or "://" in link or link.startswith("mailto:"):
        return None
    target = pathlib.Path(os.path.normpath(page_file.parent / path))
    if target.is_dir():
        target = target / "README.md"
    return target if target.is_file() and ROOT in target.parents else None


def outside_code(text, change):
    """Applies `change` to all of the text that is not code."""
    out, end = [], 0
    for code in FENCED.finditer(text):
        out += [change(text[end:code.start()]), code.group(0)]
        end = code.end()
    return "".join(out + [change(text[end:])])


def on_files(files, config):
    """Adds what pages link, and what that links; takes programs out."""
    for file in [file for file in files if file.src_path.endswith(".py")]:
        files.remove(file)
    known = {file.src_path for file in files}
    waiting = [in_repository(file.src_path) for file in files if file.src_path.endswith(".md")]

    def add(path):
        if in_site(path) in known:
            return
        known.add(in_site(path))
        file = File(in_site(path), str(ROOT), config["site_dir"], config["use_directory_urls"])
        file.abs_src_path = str(path)
        files.append(file)
        if path.suffix == ".md":
            waiting.append(path)

    for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md"):
        add(ROOT / name)
    while waiting:
        page, links = waiting.pop(), []
        outside_code(page.read_text(encoding="utf-8"), lambda text: links.extend(m.group(2) for m in LINK.finditer(text)) or text)
        for target in filter(None, (target_of(page, link) for link in links)):
            add(target)
    return files


def on_page_markdown(markdown, page, config, files):
    """Rewrites links to where their targets stand in the site; one that leads nowhere becomes its text."""
    here = in_repository(page.file.src_path)
    folder = pathlib.PurePosixPath(in_site(here)).parent.as_posix()

    def rewrite(match):
        target = target_of(here, match.group(2))
        if target is None:
            return match.group(0)
        path = os.path.relpath(in_site(target), folder).replace(os.sep, "/")
        fragment = urllib.parse.urlsplit(match.group(2)).fragment
        return match.group(1) + path + ("#" + fragment if fragment else "") + match.group(3)

    return outside_code(markdown, lambda text: LINK.sub(rewrite, text))
