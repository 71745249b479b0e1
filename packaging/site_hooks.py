# SPDX-License-Identifier: BSD-3-Clause
"""The site of docs/ also has the pages of the top folder; of links to source files their text is left."""

import pathlib
import posixpath
import re

from mkdocs.structure.files import File

ROOT = pathlib.Path(__file__).resolve().parent.parent
TOP = ("README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md")
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s#]+)(#[^)\s]*)?\)")
CODE = re.compile(r"^ {0,3}(```+)[\s\S]*?^ {0,3}\1[ \t]*$|(`+)(?!`)[^\n]*?(?<!`)\2(?!`)", re.MULTILINE)


def on_files(files, config):
    for name in TOP:
        # README.md would become the index, which docs/ has.
        page = File(name, str(ROOT), config["site_dir"], config["use_directory_urls"])
        if name == "README.md":
            page.name, page.dest_path, page.url = "README", "README.html", "README.html"
            page.abs_dest_path = posixpath.join(config["site_dir"], "README.html")
        files.append(page)
    return files


def on_page_markdown(markdown, page, config, files):
    folder = "" if page.file.src_path in TOP else posixpath.join("docs", posixpath.dirname(page.file.src_path))

    def moved(link):
        picture, text, target, fragment = link[1], link[2], link[3], link[4] or ""
        if ":" in target:
            return link[0]
        path = posixpath.normpath(posixpath.join(folder, target))
        name = path[len("docs/"):] if path.startswith("docs/") else path
        if files.get_file_from_path(name) is not None and (path.startswith("docs/") or path in TOP):
            here = posixpath.dirname(page.file.src_path)
            return f"{picture}[{text}]({posixpath.relpath(name, here or '.')}{fragment})"
        if not (ROOT / path).exists():
            return link[0]  # mkdocs names it
        return text

    # Code is no link, but a link's text may be code.
    codes = []

    def hidden(code):
        codes.append(code[0])
        return f"\0{len(codes) - 1}\0"

    return re.sub("\0(\\d+)\0", lambda mark: codes[int(mark[1])], LINK.sub(moved, CODE.sub(hidden, markdown)))
