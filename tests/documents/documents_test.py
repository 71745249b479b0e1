# SPDX-License-Identifier: BSD-3-Clause
"""Every link and anchor of our documents leads somewhere; long pages begin with a recipe; none grows without notice."""

import re
import unittest
import urllib.parse

import pages

# Pages that programs write.
GENERATED = re.compile(r"docs/(reference|results)/")
RECIPE_ABOVE_WORDS = 800
# Lists in which one looks things up.
LISTS = {"docs/wire.md"}
RECIPE_STEPS = 10
MOST_WORDS = {"README.md": 900, "ARCHITECTURE.md": 2200}
MOST_WORDS_IN_ALL = 42_000


def complaint_of(page, target, root=pages.ROOT):
    """What is wrong with a link, or None."""
    if re.match(r"[a-z]+:", target):
        return None if target.startswith(("https://", "http://", "mailto:")) else "is no address that we use"
    path, _, fragment = urllib.parse.unquote(target).partition("#")
    goal = (page.parent / path).resolve() if path else page
    if not goal.is_relative_to(root):
        return "leaves the source tree"
    if not goal.exists():
        return "does not exist"
    if fragment and goal.suffix == ".md" and fragment not in pages.anchors(goal.read_text()):
        return "has no such heading"
    return None


def complaints(root=pages.ROOT):
    for page in pages.documents(root):
        for number, target, _ in pages.links(page.read_text()):
            wrong = complaint_of(page, target, root)
            if wrong:
                yield f"{page.relative_to(root)}:{number}: {target} {wrong}"


class Documents(unittest.TestCase):
    def test_links_lead_somewhere(self):
        self.assertEqual(list(complaints()), [])

    def test_each_page_is_found_from_the_readme(self):
        reached, queue = set(), [pages.ROOT / "README.md"]
        while queue:
            page = queue.pop()
            if page in reached:
                continue
            reached.add(page)
            for _, target, _ in pages.links(page.read_text()):
                goal = (page.parent / urllib.parse.unquote(target).partition("#")[0]).resolve()
                if goal.suffix == ".md" and goal.exists():
                    queue.append(goal)
        ours = {page for page in pages.documents() if page.parent != pages.ROOT / "tests"}
        self.assertEqual(sorted(map(str, ours - reached)), [])

    def test_pictures_of_docs_are_shown(self):
        shown = set()
        for page in pages.documents():
            for _, target, _ in pages.links(page.read_text()):
                shown.add((page.parent / target.partition("#")[0]).resolve())
        pictures = {path for path in (pages.ROOT / "docs/images").iterdir() if path.suffix}
        self.assertEqual(sorted(map(str, pictures - shown)), [])

    def test_long_pages_begin_with_a_recipe(self):
        lacking = []
        for page in pages.documents():
            name, text = str(page.relative_to(pages.ROOT)), page.read_text()
            if not name.startswith("docs/") or GENERATED.match(name) or name in LISTS or \
                    pages.words(text) < RECIPE_ABOVE_WORDS:
                continue
            steps = re.search(r"^In short:\n\n((?:(?:\d+\.|   ?) .*\n)+)", text.split("\n## ")[0], re.MULTILINE)
            if steps is None or not 3 <= len(re.findall(r"^\d+\. ", steps[1], re.MULTILINE)) <= RECIPE_STEPS:
                lacking.append(name)
        self.assertEqual(lacking, [])

    def test_lengths(self):
        count = {str(page.relative_to(pages.ROOT)): pages.words(page.read_text()) for page in pages.documents()}
        for name, most in MOST_WORDS.items():
            self.assertLessEqual(count[name], most, name)
        read = [name for name in count if name in MOST_WORDS or
                name.startswith("docs/") and not GENERATED.match(name)]
        self.assertLessEqual(sum(count[name] for name in read), MOST_WORDS_IN_ALL)


class TheCheck(unittest.TestCase):
    """What it must find, in pages that are wrong."""

    PAGE = pages.ROOT / "docs/planted.md"

    def test_it_finds_what_is_wrong(self):
        for target in ("no_page.md", "../README.md#no-such-heading", "images/no_picture.png", "../../outside.md",
                       "ftp://example.org/", "targets.md#Maps"):
            self.assertIsNotNone(complaint_of(self.PAGE, target), target)

    def test_it_accepts_what_is_right(self):
        for target in ("targets.md#maps", "../README.md", "https://lcm-proj.github.io/", "images/team.gif"):
            self.assertIsNone(complaint_of(self.PAGE, target), target)

    def test_anchors(self):
        text = "# `ergocast watch`\n\n## By σ\n\n## Theorem 1: B·n is not 0\n\n## By σ\n\n```\n# no heading\n```\n"
        self.assertEqual(pages.anchors(text),
                         {"ergocast-watch", "by-σ", "theorem-1-bn-is-not-0", "by-σ-1"})

    def test_links_in_code_are_none(self):
        text = "`[a](b.md)` and [c](d.md)\n\n    [e](f.md)\n\n```\n[g](h.md)\n```\n![i](j.png)\n"
        self.assertEqual([target for _, target, _ in pages.links(text)], ["d.md", "j.png"])


if __name__ == "__main__":
    unittest.main()
