# SPDX-License-Identifier: BSD-3-Clause
"""The errors of the package, with the sentences of the command."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from ergocast import _native


class ErgocastError(ValueError):
    """An argument or a file cannot be used; the text has the error, the place and the remedy."""


class RecordError(ErgocastError):
    """A run directory that cannot be read, or cannot be written.

    The text names the file, the line, the field and the remedy.
    """


class ScenarioError(ErgocastError):
    """A scenario with problems, or a field of `set` that cannot be set.

    problems: one line for each, as `ergocast check` prints them.
    """

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.problems: list[str] = text.split("\n")


class LawError(ErgocastError):
    """A law of your own that cannot be found, or that wants what no agent may want."""


class TeamError(ErgocastError):
    """No team is found, LCM cannot be used, or the team was not seen to obey."""


@contextmanager
def raised_as(kind: type[ErgocastError]) -> Iterator[None]:
    """Turns a refusal of the C++ part into `kind`, with the same text."""
    try:
        yield
    except _native.Refused as refused:
        raise kind(str(refused)) from None
