# SPDX-License-Identifier: BSD-3-Clause
"""Laws that a person writes in Python."""

from __future__ import annotations

import hashlib
import importlib.util
import inspect
import os
import sys
from pathlib import Path
from typing import Union

import numpy.typing as npt

from ergocast import _native
from ergocast._errors import LawError


class Law:
    """A law of your own: the velocities that all agents of a tick want, in one call.

    Derive a class, write wanted_mps(), and give an object or the class to simulate() or IdealTeam,
    or its file to `ergocast study --vary law.kind=COVER,FILE.py:CLASS`. An object is for one
    mission: it may keep what it wants from tick to tick. docs/laws.md is the introduction.

    Limits of vehicles, distances, walls, zones and pauses stay outside, as for every law. The
    mission must let every agent know the places of all others.
    """

    def wanted_mps(self, now: _native.LawInput) -> npt.ArrayLike:
        """The velocities that the agents want, one row each in the order of now.agents [m/s].

        The shape is that of now.x_m. Every number must be finite, and no row longer than its
        agent's now.u_max_mps; else the mission ends with LawError.
        """
        raise NotImplementedError(f"{type(self).__name__} has no wanted_mps()")


LawLike = Union[Law, type[Law], str, "os.PathLike[str]"]
"""An object, its class, or "FILE.py:CLASS"."""


def made(law: LawLike) -> tuple[Law, str]:
    """A law and its name."""
    if isinstance(law, Law):
        return law, type(law).__name__
    if inspect.isclass(law) and issubclass(law, Law):
        return law(), law.__name__
    if isinstance(law, (str, os.PathLike)):
        return class_in(os.fspath(law))(), os.fspath(law)
    raise LawError(f"law={law!r}: is no ergocast.Law (give an object, its class or FILE.py:CLASS)")


def class_in(place: str) -> type[Law]:
    """The class that FILE.py:CLASS names. Errors of the file itself stay what they are.

    While it is loaded, the file can import what lies beside it.
    """
    file, colon, name = place.rpartition(":")
    if not colon or not name.isidentifier():
        raise LawError(f"{place} is not FILE.py:CLASS, such as my_law.py:Spiral")
    path = Path(file).resolve()
    # Its own name could be that of another module.
    alias = "ergocast_law_" + hashlib.sha256(os.fsencode(path)).hexdigest()[:16]
    spec = importlib.util.spec_from_file_location(alias, path)
    if spec is None or spec.loader is None or not path.is_file():
        raise LawError(f"there is no Python file {file}")
    module = importlib.util.module_from_spec(spec)
    sys.modules[alias] = module
    sys.path.insert(0, str(path.parent))
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[alias]
        raise
    finally:
        sys.path.remove(str(path.parent))
    found = getattr(module, name, None)
    if not (inspect.isclass(found) and issubclass(found, Law)):
        laws = [each for each, value in vars(module).items()
                if inspect.isclass(value) and issubclass(value, Law) and value is not Law]
        raise LawError(f"{file} has no class {name} that derives from ergocast.Law "
                       f"(it has {', '.join(laws) or 'none'})")
    return found
