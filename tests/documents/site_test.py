# SPDX-License-Identifier: BSD-3-Clause
"""The site of docs/ builds without a warning, and every link and anchor of its pages leads somewhere."""

import html.parser
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.parse

import pages


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.ids, self.targets = set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name"):
                self.ids.add(value)
            elif name in ("href", "src") and value:
                self.targets.append(value)


def build(folder, config=pages.ROOT / "mkdocs.yml"):
    return subprocess.run(["mkdocs", "build", "--strict", "-f", config, "-d", folder],
                          capture_output=True, text=True)


def complaints(site):
    read = {path: Page(path.read_text()) for path in site.rglob("*.html") if path.name != "404.html"}
    for path, page in sorted(read.items()):
        for target in page.targets:
            if ":" in target:
                continue
            name, _, fragment = urllib.parse.unquote(target).partition("#")
            goal = (path.parent / name.partition("?")[0]).resolve() if name else path
            if goal.is_dir():
                goal = goal / "index.html"
            if not goal.exists():
                yield f"{path.relative_to(site)}: {target} does not exist"
            elif fragment and goal in read and fragment not in read[goal].ids:
                yield f"{path.relative_to(site)}: {target} has no such heading"


class Site(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory())).resolve()

    def test_it_builds_and_its_links_lead_somewhere(self):
        built = build(self.folder)
        self.assertEqual(built.returncode, 0, built.stdout + built.stderr)
        self.assertEqual(list(complaints(self.folder)), [])
        tutorial = (self.folder / "tutorial.html").read_text()
        self.assertIn("reference/scenario.html", tutorial)
        planted = tutorial.replace("targets.html#maps", "targets.html#no-such-heading")
        (self.folder / "tutorial.html").write_text(planted)
        self.assertEqual(list(complaints(self.folder)),
                         ["tutorial.html: targets.html#no-such-heading has no such heading"])

    def test_a_dead_link_fails(self):
        copy = self.folder / "tree"
        copy.mkdir()
        for path in pages.ROOT.iterdir():
            if path.name in ("docs", "packaging"):
                shutil.copytree(path, copy / path.name)
            elif path.suffix in (".md", ".yml"):
                shutil.copy(path, copy)
            elif path.name not in ("build", ".git"):
                (copy / path.name).symlink_to(path)
        tutorial = copy / "docs/tutorial.md"
        tutorial.write_text(tutorial.read_text() + "\n[gone](no_page.md)\n")
        built = build(self.folder / "site", copy / "mkdocs.yml")
        self.assertNotEqual(built.returncode, 0)
        warnings = [line for line in (built.stdout + built.stderr).split("\n") if "WARNING" in line]
        self.assertEqual(len(warnings), 1, warnings)
        self.assertIn("no_page.md", warnings[0])


if __name__ == "__main__":
    if shutil.which("mkdocs") is None:
        sys.exit("mkdocs is missing: apt-get install mkdocs-material")
    unittest.main()
