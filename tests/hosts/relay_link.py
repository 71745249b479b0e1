#!/usr/bin/env -S python3 -B
# SPDX-License-Identifier: BSD-3-Clause
"""Measures a mission over a relay whose link delays and loses packets. By hand:

    tests/hosts/relay_link.py build/release/bin scenarios/quadrimodal_corners.textproto

Two sites on one machine, as in docs/relays.md. World, coordinator, logger and half of the agents
are at the ground site, the others at the field site, whose relay joins relay_shim.py in the place
of the hub. The last lines are the figures, as JSON.
"""
import argparse
import json
import os
import pathlib
import re
import signal
import subprocess
import tempfile

from relay_shim import Faults, Links

GROUND, FIELD = "udpm://239.255.76.67:24600?ttl=0", "udpm://239.255.76.67:24610?ttl=0"
HUB, LINK = 7790, 7791


def scenario_of(text, options):
    """The scenario in real time with that many agents at random starts."""
    text = re.sub(r"agents \{.*?\n\}", f"agents {{ random_count: {options.agents} {options.in_agents} }}", text,
                  flags=re.DOTALL)
    return re.sub(r"time \{.*?\n\}", f"time {{ dt_s: {options.dt} duration_s: {options.duration} "
                  f"pace: REALTIME {options.in_time} }}", text, flags=re.DOTALL)


class Programs:
    """The programs of one mission; those that still run end with the block."""

    def __init__(self, options, folder, name):
        self.options, self.folder, self.name, self.all = options, folder, name, []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for program in self.all:
            program.send_signal(signal.SIGTERM)
        for program in self.all:
            program.wait()

    def log(self, name):
        return self.folder / f"{self.name}-{name}.log"

    def start(self, program, *arguments, name=None):
        with open(self.log(name or program), "w") as log:
            self.all.append(subprocess.Popen([self.options.bin / program, *map(str, arguments)],
                                             stdout=log, stderr=log))
        return self.all[-1]


def start_relays(programs, options):
    faults = Faults(delay_s=options.delay_ms / 1000, loss=options.loss_percent / 100)
    links = Links("127.0.0.1", [LINK], ("127.0.0.1", HUB), faults, options.seed)
    links.start()
    rate = ["--max-rate", options.max_rate] if options.max_rate else []
    relay = "ergocast-relay"
    programs.start(relay, "--hub", "--listen", f"127.0.0.1:{HUB}", *rate, name="hub")
    programs.start(relay, "--to", f"127.0.0.1:{HUB}", "--lcm-url", GROUND, name="ground")
    programs.start(relay, "--to", f"127.0.0.1:{LINK}", "--lcm-url", FIELD, *rate, name="field")
    return links


def run_mission(programs, options, out, field):
    """Until the record is complete."""
    logger = programs.start("ergocast-logger", "--out", out, "--lcm-url", GROUND)
    programs.start("ergocast-sim", "--lcm-url", GROUND)
    coordinator = programs.start("ergocast-coordinator", programs.folder / "scenario.textproto", "--lcm-url", GROUND,
                                 "--key-file", programs.folder / "team.coordinator.key")
    for agent in range(options.agents):
        url = GROUND if agent < options.agents - options.field_agents else field
        programs.start("ergocast-agent", "--id", agent, "--lcm-url", url, name=f"agent{agent}")
    if coordinator.wait() != 0:
        raise SystemExit(programs.log("ergocast-coordinator").read_text())
    logger.wait()


def measure(options, folder, relayed):
    out = folder / ("relayed" if relayed else "direct")
    out.mkdir()
    with Programs(options, folder, out.name) as programs:
        links = start_relays(programs, options) if relayed else None
        run_mission(programs, options, out, FIELD if relayed else GROUND)
        carried_bytes = dict(links.links[0].bytes) if links else {}
        channels = dict(links.links[0].channels.most_common()) if links else {}
    summary = json.loads((out / "summary.json").read_text())
    commands = summary["ticks"] * options.agents
    figures = {"agents": options.agents, "result": summary["result"], "ticks": summary["ticks"],
               "metric": summary["ergodic_metric"], "late_commands": summary["missed_deadlines"],
               "late_share": round(summary["missed_deadlines"] / max(1, commands), 4),
               "skipped_ticks": summary["skipped_ticks"], "gaps": summary["gaps"]}
    if relayed:
        figures["kbit_per_s"] = {way: round(8e-3 * count / summary["wall_time_s"], 1)
                                 for way, count in carried_bytes.items()}
        figures["received_kbit_per_s"] = {channel: round(8e-3 * count / summary["wall_time_s"], 1)
                                          for channel, count in channels.items()}
        figures["link_late_ms"] = round(1e3 * links.late_s, 1)
        figures["relays"] = {name: programs.log(name).read_text().splitlines()[-1]
                             for name in ("ground", "field", "hub")}
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=lambda text: pathlib.Path(text).resolve(), help="folder of the programs")
    parser.add_argument("scenario", type=pathlib.Path)
    parser.add_argument("--agents", type=int, default=16)
    parser.add_argument("--dt", type=float, default=0.5, help="a tick [s]")
    parser.add_argument("--duration", type=float, default=120, help="of the mission [s]")
    parser.add_argument("--delay-ms", type=float, default=150, help="each way")
    parser.add_argument("--loss-percent", type=float, default=2, help="each way")
    parser.add_argument("--max-rate", type=int, default=300, help="of the field's link [kbit/s]; 0: no limit")
    parser.add_argument("--in-time", default="", help="more fields of `time`")
    parser.add_argument("--in-agents", default="", help="more fields of `agents`")
    parser.add_argument("--seed", type=int, default=1, help="of the losses")
    parser.add_argument("--direct", action="store_true", help="also measure without a relay, to compare")
    parser.add_argument("--field-agents", type=int, help="at the field site (default: half)")
    options = parser.parse_args()
    if options.field_agents is None:
        options.field_agents = options.agents - options.agents // 2
    with tempfile.TemporaryDirectory(prefix="relay-link-") as name:
        folder = pathlib.Path(name)
        subprocess.run([options.bin / "ergocast", "keygen", folder / "team"], check=True, stdout=subprocess.DEVNULL)
        os.environ["ERGOCAST_KEY_FILE"] = str(folder / "team.key")
        (folder / "scenario.textproto").write_text(scenario_of(options.scenario.read_text(), options))
        for relayed in [False, True] if options.direct else [True]:
            print(json.dumps({"relayed" if relayed else "direct": measure(options, folder, relayed)}, indent=1),
                  flush=True)


if __name__ == "__main__":
    main()
