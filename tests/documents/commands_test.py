# SPDX-License-Identifier: BSD-3-Clause
"""The commands of README.md and the tutorial run as they stand, and print what stands below them.

   commands_test.py BUILD_FOLDER DOCUMENT...

Each ```sh block is run by one shell after the other, in a folder with links to the scenarios and the
build. A ```text block below it, before the next heading, has lines of its output, in their order, in which … stands for anything.
Comments in the document say what else to do with the block that follows:

   <!-- not run: why -->              leave it out
   <!-- codes 0 1 -->                 it may end with these codes
   <!-- background until "TEXT" -->   go on once it has printed TEXT, and end it by Ctrl-C at
   <!-- stop -->
"""

import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

import pages

BLOCK = re.compile(r"<!-- (?P<note>.*?) -->|^(?P<heading>#+ )|^```(?P<language>\w*)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
# A network of its own where that is allowed.
NETWORK = ["unshare", "-n", "sh", "-c", 'ip link set lo up; ip route add 224.0.0.0/4 dev lo; exec "$@"', "_"]


# What `ergocast run --watch` prints once its mission is over.
SHOWS_THE_RECORD = ", until Ctrl-C"


class Wrong(Exception):
    pass


def missing_line(output, expected):
    """The first line of `expected` that `output` does not have after those before it, or None."""
    lines = iter(output.split("\n"))
    for line in expected.rstrip().split("\n"):
        pattern = re.compile(".*".join(re.escape(part) for part in line.strip().split("…")) + "$")
        if not any(pattern.match(printed.strip()) for printed in lines):
            return line
    return None


class Session:
    """One document's commands: variables and folders last from block to block."""

    def __init__(self, folder):
        self.folder, self.background = folder, None
        self.state = folder / ".state"
        self.state.write_text("")

    def script(self, text):
        return f"set -e; . {self.state}; {{ {text}\n}}; export -p | grep -v ' _=' >{self.state}"

    def run(self, text, codes=(0,)):
        done = subprocess.run(["bash", "-c", self.script(text)], cwd=self.folder, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL)
        if done.returncode not in codes:
            raise Wrong(f"code {done.returncode}\n{done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def start(self, text, until):
        log = self.folder / ".background"
        with open(log, "w") as out:
            # exec: Ctrl-C reaches the command alone, and its exit code is seen.
            self.background = subprocess.Popen(["bash", "-c", f". {self.state}; exec {text.split('   #')[0].strip()}"],
                                               cwd=self.folder, stdout=out, stderr=subprocess.STDOUT)
        while until not in log.read_text():
            if self.background.poll() is not None:
                raise Wrong(f"it ended without {until!r}\n{log.read_text()}")
            time.sleep(0.1)
        return log.read_text()

    def stop(self):
        if self.background is None:
            return
        process, self.background = self.background, None
        log = self.folder / ".background"
        # The first Ctrl-C ends the mission. A page then shows its record until the second one.
        process.send_signal(signal.SIGINT)
        while process.poll() is None and SHOWS_THE_RECORD not in log.read_text():
            time.sleep(0.1)
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
            process.wait()
        if process.returncode != 0:
            raise Wrong(f"code {process.returncode} after Ctrl-C\n{(self.folder / '.background').read_text()}")


def run(document, build, folder):
    (folder / "build").mkdir()
    (folder / "build/release").symlink_to(build)
    (folder / "scenarios").symlink_to(pages.ROOT / "scenarios")
    session, note, output, count = Session(folder), "", None, 0
    try:
        for block in BLOCK.finditer(document):
            if block["heading"]:
                output = None
                continue
            if block["note"] is not None:
                note = block["note"]
                if note == "stop":
                    session.stop()
                    note = ""
                continue
            if block["language"] == "sh" and note.startswith("not run: "):
                output = None
            elif block["language"] == "sh":
                count += 1
                try:
                    until = re.fullmatch(r'background until "(.*)"', note)
                    codes = [int(code) for code in note.split()[1:]] if note.startswith("codes ") else (0,)
                    output = session.start(block["text"], until[1]) if until else session.run(block["text"], codes)
                except Wrong as wrong:
                    raise Wrong(f"{block['text']}{wrong}") from None
            elif block["language"] == "text" and output is not None:
                missing = missing_line(output, block["text"])
                if missing is not None:
                    raise Wrong(f"does not print {missing!r}, but\n{output}")
                output = None
            note = ""
    finally:
        if session.background is not None:
            session.background.kill()  # with it end the processes that it has started
            session.background.wait()
    return count


def complaint(document, build):
    # Commands choose the user's only live run, and other tests' runs must not count.
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as live_runs:
        os.environ["XDG_RUNTIME_DIR"] = live_runs
        try:
            return None if run(document, build, pathlib.Path(folder)) > 0 else "has no command"
        except Wrong as wrong:
            return str(wrong)


def planted_faults_are_found(build):
    """What the check must find."""
    for planted in ("```sh\nfalse\n```\n", "```sh\nno_such_program\n```\n", "nothing",
                    "```sh\necho one\n```\n\n```text\ntwo\n```\n",
                    '<!-- background until "x" -->\n```sh\necho y\n```\n',
                    '<!-- background until "x" -->\n```sh\nsh -c "echo x; sleep 9; exit 3"\n```\n<!-- stop -->\n'):
        if complaint(planted, build) is None:
            raise SystemExit(f"not found: {planted}")
    right = ("```sh\nexport A=1\n```\n<!-- not run: it fails -->\n```sh\nfalse\n```\n"
             "```sh\necho $A and 7 more\n```\n\n```text\n1 and … more\n```\n<!-- codes 0 3 -->\n```sh\nexit 3\n```\n")
    wrong = complaint(right, build)
    if wrong is not None:
        raise SystemExit(f"found in what is right: {wrong}")


def main():
    build, names = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
    if os.geteuid() == 0 and "ERGOCAST_OWN_NETWORK" not in os.environ:
        os.environ["ERGOCAST_OWN_NETWORK"] = "1"
        os.execvp(NETWORK[0], NETWORK + [sys.executable, "-B", *sys.argv])
    planted_faults_are_found(build)
    failed = 0
    for name in names:
        wrong = complaint((pages.ROOT / name).read_text(), build)
        print(f"{name}: {wrong or 'all commands run'}")
        failed += wrong is not None
    sys.exit(failed)


main()
