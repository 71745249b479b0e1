# SPDX-License-Identifier: BSD-3-Clause
"""python3 -m ergocast: simulates one mission, as `ergocast simulate`, under a law in Python."""

from __future__ import annotations

import argparse
import sys

from ergocast._errors import ErgocastError
from ergocast._simulate import simulate


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m ergocast", description=__doc__)
    parser.add_argument("scenario", metavar="SCENARIO", help="a file, or the name of a shipped one")
    parser.add_argument("--law", metavar="FILE.py:CLASS", help="a law of your own")
    parser.add_argument("--set", action="append", default=[], metavar="FIELD=VALUE")
    parser.add_argument("--duration", metavar="S", help="mission time [s]")
    parser.add_argument("--seed", type=int)
    parser.add_argument("--out", metavar="DIR", help="the run directory: new")
    options = parser.parse_args()
    for field in options.set:
        if "=" not in field:
            parser.error(f"--set {field}: is not FIELD=VALUE")
    fields = dict(field.split("=", 1) for field in options.set)
    if options.duration is not None:
        fields["time.duration_s"] = options.duration
    try:
        run = simulate(
            options.scenario, seed=options.seed, set=fields, out=options.out, law=options.law
        )
    except ErgocastError as problem:
        print(problem, file=sys.stderr)
        return 2
    found = run.metrics["detection_probability"].iloc[-1]
    print(f"phi^2 {run.ergodic_metric():.3g}, found {found:.3f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
