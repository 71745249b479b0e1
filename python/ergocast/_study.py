# SPDX-License-Identifier: BSD-3-Clause
"""The missions of `ergocast study` under a law in Python: cli/study/python_law.h starts this."""

from __future__ import annotations

import os
import traceback

from ergocast import _native
from ergocast._errors import LawError
from ergocast._law import class_in


def serve(place: str, answers: int) -> None:
    """Answers each plan that comes on standard input with the figures of its mission."""
    try:
        law = class_in(place)
        law()
    except Exception as problem:
        return _answer(answers, False, _text_of(problem, place).encode())
    _answer(answers, True, f"{_native.__version__} {_native.STUDY_FIGURES_BYTES}".encode())
    with os.fdopen(os.dup(0), "rb") as plans:
        while len(size := plans.read(8)) == 8:
            plan = plans.read(int.from_bytes(size, "little"))
            try:
                figures = _native.study_figures(plan, law())
            except Exception as problem:
                _answer(answers, False, _text_of(problem, place).encode())
            else:
                _answer(answers, True, figures)


def _answer(answers: int, good: bool, content: bytes) -> None:
    rest = (len(content) + 1).to_bytes(8, "little") + bytes([good]) + content
    while rest:
        rest = rest[os.write(answers, rest):]


def _text_of(problem: Exception, place: str) -> str:
    """One line: the error, and the last line of the law's file that led to it."""
    if isinstance(problem, LawError):
        return str(problem)
    file = os.path.realpath(place.rpartition(":")[0])
    lines = [
        frame.lineno
        for frame in traceback.extract_tb(problem.__traceback__)
        if os.path.realpath(frame.filename) == file
    ]
    where = f", line {lines[-1]}" if lines else ""
    return f"{type(problem).__name__}: {problem}{where}"
