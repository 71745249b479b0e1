# SPDX-License-Identifier: BSD-3-Clause
"""Our documents: which there are, their headings and their links."""

import html
import os
import pathlib
import re
import unicodedata

ROOT = pathlib.Path(__file__).resolve().parents[2]
FENCE = re.compile(r"^ {0,3}(```+|~~~+)")
LINK = re.compile(r"(!?)\[(?:[^\[\]]|\[[^\]]*\])*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
CODE = re.compile(r"(`+)(?!`).*?(?<!`)\1(?!`)")


def documents(root=ROOT):
    """Every Markdown file of the source tree."""
    found = []
    for folder, folders, names in os.walk(root):
        folders[:] = [name for name in folders if not name.startswith(".") and name not in ("build", "node_modules")]
        found += [pathlib.Path(folder, name) for name in names if name.endswith(".md")]
    return sorted(found)


def lines_outside_code(text):
    """(number, line) of what is no fenced or indented block."""
    fence, blank, indented = None, True, False
    for number, line in enumerate(text.split("\n"), 1):
        mark = FENCE.match(line)
        if fence:
            if mark and mark[1].startswith(fence):
                fence = None
            continue
        if mark:
            fence = mark[1]
            continue
        indented = line.startswith("    ") and (blank or indented)
        blank = not line.strip()
        if not indented:
            yield number, line


def anchor(heading):
    """GitHub's rule: lower case, no punctuation, hyphens for spaces."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    text = html.unescape(text.replace("`", "").replace("**", "")).strip().lower()
    kept = (c for c in text if c in " -_" or unicodedata.category(c)[0] in "LNM")
    return "".join(kept).replace(" ", "-")


def anchors(text):
    found, seen = set(), {}
    for _, line in lines_outside_code(text):
        heading = re.match(r"^ {0,3}#{1,6}\s+(.*?)\s*#*\s*$", line)
        if heading:
            name = anchor(heading[1])
            count = seen.get(name, 0)
            seen[name] = count + 1
            found.add(f"{name}-{count}" if count else name)
        found.update(re.findall(r"<a (?:id|name)=\"([^\"]+)\"", line))
    return found


def links(text):
    """(line number, target, whether it is a picture)."""
    for number, line in lines_outside_code(text):
        for picture, target in LINK.findall(CODE.sub(lambda code: "x" * len(code[0]), line)):
            yield number, target, bool(picture)


def words(text):
    """What has a letter or a digit; the bars of a table are none."""
    return sum(any(c.isalnum() for c in word) for word in text.split())
