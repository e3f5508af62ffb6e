#!/usr/bin/env python3
"""Checks the links of all Markdown files that git tracks or would add.

    docs/check_links.py     status 1 and a line for each dead link

A relative link has to lead to a file that git tracks or would add, or to a folder with such files. An anchor has to be
that of a heading, both as code hosts and as mkdocs make them, or an explicit id. Links with a scheme (https:, mailto:)
are not followed.
"""
import pathlib
import re
import subprocess
import sys
import unicodedata
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[1]

FENCE = re.compile(r"^\s*(```+|~~~+)")
LIST_ITEM = re.compile(r"^\s*([-*+]|\d+[.)])\s")
HEADING = re.compile(r"^(#{1,6})\s+(.*?)\s*#*\s*$")
CODE_SPAN = re.compile(r"(`+)(?!`).*?(?<!`)\1(?!`)", re.S)
INLINE_LINK = re.compile(r"\]\(\s*(<[^>]*>|[^\s()]*(?:\([^\s()]*\)[^\s()]*)*)(?:\s+(?:\"[^\"]*\"|'[^']*'))?\s*\)")
DEFINITION = re.compile(r"^\s{0,3}\[[^\]]+\]:\s*(<[^>]*>|\S+)", re.M)
HTML_LINK = re.compile(r"<(?:a|img|source)\b[^>]*?\b(?:href|src)\s*=\s*[\"']([^\"']+)[\"']", re.I)
HTML_ID = re.compile(r"\b(?:id|name)\s*=\s*[\"']([^\"']+)[\"']", re.I)


def known_files():
    """Paths from the root that git tracks or would add, and that exist."""
    listing = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True,
                             stdout=subprocess.PIPE).stdout.decode()
    return {name for name in listing.split("\0") if name and (ROOT / name).exists()}


def without_code(text):
    """The text with code blocks and code spans blanked; lines stay where they are."""
    lines, fence, block, in_list, after_blank = [], None, False, False, True
    for line in text.split("\n"):
        found = FENCE.match(line)
        if fence:
            if found and found.group(1).startswith(fence):
                fence = None
            lines.append("")
            continue
        if found:
            fence = found.group(1)
            lines.append("")
            continue
        if line.strip() and not line.startswith("    "):
            in_list = bool(LIST_ITEM.match(line)) or (in_list and line.startswith(" "))
            block = False
        elif line.startswith("    ") and line.strip() and not in_list and after_blank:
            block = True
        after_blank = not line.strip() or block
        lines.append("" if block else line)
    blank = lambda span: re.sub(r"[^\n]", " ", span.group(0))
    return CODE_SPAN.sub(blank, "\n".join(lines))


def host_slug(heading):
    """As code hosts make it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def mkdocs_slug(heading):
    """As mkdocs makes it (markdown.extensions.toc)."""
    plain = unicodedata.normalize("NFKD", heading).encode("ascii", "ignore").decode()
    return re.sub(r"[-\s]+", "-", re.sub(r"[^\w\s-]", "", plain).strip().lower())


def anchors_of(text):
    """Anchors that lead to a place under both ways of making them."""
    host, mkdocs = {}, {}
    host_anchors, mkdocs_anchors = set(), set()
    fence = None
    for line in text.split("\n"):
        found = FENCE.match(line)
        if found and (fence is None or found.group(1).startswith(fence)):
            fence = None if fence else found.group(1)
            continue
        match = None if fence else HEADING.match(line)
        if not match:
            continue
        heading = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", match.group(2))  # a link is its text
        heading = re.sub(r"[*`]", "", heading)
        slug = host_slug(heading)
        host_anchors.add(slug if slug not in host else f"{slug}-{host[slug]}")
        host[slug] = host.get(slug, 0) + 1
        slug = mkdocs_slug(heading)
        mkdocs_anchors.add(slug if slug not in mkdocs else f"{slug}_{mkdocs[slug]}")
        mkdocs[slug] = mkdocs.get(slug, 0) + 1
    return (host_anchors & mkdocs_anchors) | set(HTML_ID.findall(without_code(text)))


def links_of(text):
    """Pairs of line and target."""
    text = without_code(text)
    for pattern in (INLINE_LINK, DEFINITION, HTML_LINK):
        for match in pattern.finditer(text):
            yield text.count("\n", 0, match.start(1)) + 1, match.group(1).strip("<>")


def fault_of(name, target, files, folders, anchors):
    """What is wrong with a link of the file `name`; None if nothing is."""
    parts = urllib.parse.urlsplit(target)
    if parts.scheme or parts.netloc:
        return None
    path = urllib.parse.unquote(parts.path)
    if path.startswith("/"):
        return "is not relative"
    found = name
    if path:
        parent = (ROOT / name).parent
        try:
            found = pathlib.Path(*_normal((parent / path).parts)).relative_to(ROOT).as_posix()
        except ValueError:
            return "leads out of the repository"
        if found in folders:
            return "is a folder, which has no anchors" if parts.fragment else None
        if found not in files:
            return "leads nowhere"
    if not parts.fragment or not found.endswith(".md"):
        return None
    if found not in anchors:
        anchors[found] = anchors_of((ROOT / found).read_text(encoding="utf-8"))
    return None if urllib.parse.unquote(parts.fragment) in anchors[found] else f"has no heading in {found}"


def _normal(parts):
    """Parts without . and .., by name: links are not resolved."""
    out = []
    for part in parts:
        if part == "..":
            out.pop()
        elif part != ".":
            out.append(part)
    return out


def main():
    files = known_files()
    folders = {"."} | {parent.as_posix() for name in files for parent in pathlib.PurePosixPath(name).parents}
    anchors, faults, count = {}, [], 0
    for name in sorted(files):
        if not name.endswith(".md"):
            continue
        for line, target in links_of((ROOT / name).read_text(encoding="utf-8")):
            count += 1
            fault = fault_of(name, target, files, folders, anchors)
            if fault:
                faults.append(f"{name}:{line}: {target} {fault}")
    for fault in faults:
        print(fault)
    print(f"{count} links, {len(faults)} dead", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
