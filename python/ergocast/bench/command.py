# SPDX-License-Identifier: BSD-3-Clause
"""`ergocast bench`: one study for each target, then the table. cli/study/bench.cc starts this."""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
from pathlib import Path

from ergocast.bench import table

HERE = Path(__file__).resolve().parent
DONE, BAD_INPUT, FAILED = 0, 2, 4


def main(arguments: list[str]) -> int:
    """The exit code. Arguments are as cli/study/bench.cc gives them, already complete."""
    parser = argparse.ArgumentParser(prog="ergocast bench")
    for name in ("program", "out", "targets", "agents", "seeds", "jobs"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--shard")
    for name in ("own", "published"):
        parser.add_argument(f"--{name}", action="store_true")
    for name in ("law", "add"):
        parser.add_argument(f"--{name}", action="append", default=[])
    options = parser.parse_args(arguments)
    try:
        bench = Bench(options)
        return bench.run()
    except table.BenchError as problem:
        print(f"ergocast bench: {problem}", file=sys.stderr)
        return BAD_INPUT


def laws_for(target: str) -> list[str]:
    """The laws of the bench that a target allows."""
    allowed = ["COVER", "MOW"]
    if target != "box":
        allowed.append("SEARCH")
    return allowed + [
        place for place, name in table.LAWS.items()
        if name != "HEDAC" or target not in ("box", "rooms")
    ]


def absolute(law: str) -> str:
    file, colon, name = law.rpartition(":")
    if not colon or not file.endswith(".py") or not Path(file).is_file():
        raise table.BenchError(f"--law {law}: there is no such file (give FILE.py:CLASS)")
    return f"{Path(file).resolve()}:{name}"


class Bench:
    """The studies of one call."""

    def __init__(self, options: argparse.Namespace) -> None:
        self.options = options
        known = table.targets()
        self.targets = options.targets.split(",") if options.targets else list(known)
        for target in self.targets:
            if target not in known:
                raise table.BenchError(
                    f"there is no target {target!r} (it has {', '.join(sorted(known))})"
                )
        self.scenarios = known
        self.own_laws = [absolute(law) for law in options.law]
        names = [*table.ORDER, *(table.name_of(law) for law in self.own_laws)]
        for name in names:
            if names.count(name) > 1:
                raise table.BenchError(f"--law: two laws are named {name} (rename your class)")
        self.added = options.add + [HERE / "published.csv"] * options.published
        for file in self.added:
            list(table.rows_added(file))  # a bad file ends the bench before its runs
        self.out = Path(options.out).resolve()
        self.failed = False
        self.stopped = False
        self.study: subprocess.Popen[bytes] | None = None

    def run(self) -> int:
        try:
            self.out.mkdir(parents=True, exist_ok=True)
        except OSError as problem:
            raise table.BenchError(f"--out {self.out}: {problem.strerror}") from problem
        # The terminal sends Ctrl-C to the study, too, which then ends in order.
        signal.signal(signal.SIGINT, lambda *_: self.stop(pass_on=False))
        signal.signal(signal.SIGTERM, lambda *_: self.stop(pass_on=True))
        for number, target in enumerate(self.targets, 1):
            laws = self.laws_of(target)
            if laws and not self.stopped:
                print(f"{target} ({number} of {len(self.targets)})", file=sys.stderr, flush=True)
                code, rows = self.run_study(target, laws)
                if code != DONE and not (code == FAILED and rows):
                    return code
                self.failed = self.failed or code == FAILED
        table.write(self.out, self.added, intervals=self.options.own)
        if self.stopped:
            print("stopped: the same command goes on")
        if self.failed:
            print("some runs failed; the table leaves them out, and the same command repeats them")
        return FAILED if self.failed else DONE

    def laws_of(self, target: str) -> list[str]:
        return ([] if self.options.own else laws_for(target)) + self.own_laws

    def stop(self, pass_on: bool) -> None:
        self.stopped = True
        if pass_on and self.study is not None:
            self.study.send_signal(signal.SIGTERM)

    def run_study(self, target: str, laws: list[str]) -> tuple[int, bool]:
        """Its exit code, and whether its table exists."""
        folder = self.out / target
        if self.options.shard:
            folder /= self.options.shard.replace("/", "-of-")
        folder.parent.mkdir(parents=True, exist_ok=True)
        said = folder.parent / f"{folder.name}.txt"
        words = [
            self.options.program, "study", os.fspath(self.scenarios[target]),
            "--vary", f"agents.random_count={self.options.agents}",
            "--vary", f"law.kind={','.join(laws)}",
            "--seeds", self.options.seeds, "--jobs", self.options.jobs, "--out", os.fspath(folder),
        ]
        if self.options.shard:
            words += ["--shard", self.options.shard]
        # Laws of the bench keep their names wherever the package lies.
        with said.open("wb") as file:
            self.study = subprocess.Popen(words, cwd=HERE, stdout=file)
            code = self.study.wait()
        self.study = None
        if code != DONE:
            sys.stdout.write(said.read_text())
        return code, (folder / "study.csv").exists()
