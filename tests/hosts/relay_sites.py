#!/usr/bin/env -S python3 -B
# SPDX-License-Identifier: BSD-3-Clause
"""A mission at several sites, each behind a router that translates addresses, with a hub between them.
Needs root. By hand, in real time, with one site cut off and the hub killed:

    tests/hosts/relay_sites.py build/release/bin scenarios/quadrimodal_corners.textproto --direct

World, coordinator, logger and a share of the agents are at site 0. The relay of each site joins
relay_shim.py, which delays, loses and forges packets. The last lines are the figures, as JSON.
With --lockstep the record must be what `ergocast simulate` gives, whatever the machine's speed.
"""
import argparse
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

from relay_link import Programs, scenario_of
from relay_shim import Faults, Links

URL = "udpm://239.255.76.67:24600?ttl=0"
INTERNET = "10.0.0.1"
HUB_PORT, SITE_PORT = 7700, 7701


def sh(command, where=None):
    inside = ["ip", "netns", "exec", where] if where else []
    subprocess.run([*inside, "sh", "-ec", command], check=True)


def enter_own_network(argv):
    """Starts this program again with a network, mounts and processes of its own."""
    if os.environ.get("ERGOCAST_IN_NAMESPACE") == "yes":
        return
    if os.geteuid() != 0:
        print("skipped: networks of several hosts need root")
        sys.exit(77)
    os.environ["ERGOCAST_IN_NAMESPACE"] = "yes"
    os.execvp("unshare", ["unshare", "--net", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc",
                          "--propagation", "private", sys.executable, "-B", *argv])


def make_sites(count):
    """This network is the internet, without multicast. All sites have the same private addresses."""
    sh(f"""mkdir -p /run/netns; mount -t tmpfs tmpfs /run/netns
           ip link set lo up; ip link add internet type bridge mcast_snooping 0
           ip addr add {INTERNET}/24 dev internet; ip link set internet up
           nft 'table bridge filter {{ chain forward {{ type filter hook forward priority 0;
             ether type ip meta pkttype multicast drop; }}; }}'""")
    for site in range(count):
        sh(f"""ip netns add router-{site}; ip netns add site-{site}
               ip link add p{site} type veth peer name eth0 netns router-{site}
               ip link set p{site} master internet up""")
        sh(f"""ip link set lo up; ip addr add 10.0.0.{10 + site}/24 dev eth0; ip link set eth0 up
               ip link add lan type veth peer name eth0 netns site-{site}
               ip addr add 192.168.7.1/24 dev lan; ip link set lan up
               echo 1 >/proc/sys/net/ipv4/ip_forward
               nft 'table ip nat {{ chain post {{ type nat hook postrouting priority 100;
                 oifname eth0 masquerade; }}; }}'""", f"router-{site}")
        sh("""ip link set lo up; ip addr add 192.168.7.2/24 dev eth0; ip link set eth0 up
              ip route add default via 192.168.7.1; ip route add 224.0.0.0/4 dev lo""", f"site-{site}")


class Mission(Programs):
    """The programs at their sites; with one site there is no relay."""

    def __init__(self, options, folder, name, sites):
        super().__init__(options, folder, name)
        self.sites, self.out = sites, folder / name
        self.links = self.hub = None
        self.relays, self.agents = [], []

    def at(self, site, program, *arguments, name=None):
        return self.start(shutil.which("ip"), "netns", "exec", f"site-{site}", self.options.bin / program, *arguments,
                          "--lcm-url", URL, name=name or program)

    def site_of(self, agent):
        return agent * self.sites // self.options.agents

    def start_hub(self):
        self.hub = self.start(self.options.bin / "ergocast-relay", "--hub", "--listen", f":{HUB_PORT}",
                              name=f"hub-{len(self.all)}")

    def start_relays(self):
        self.start_hub()
        options = self.options
        faults = Faults(options.delay_ms / 1e3, options.jitter_ms / 1e3, options.loss_percent / 100,
                        options.duplication_percent / 100, options.forgery_percent / 100)
        self.links = Links(INTERNET, range(SITE_PORT, SITE_PORT + self.sites), (INTERNET, HUB_PORT), faults,
                           options.seed)
        self.links.start()
        for site in range(self.sites):
            self.relays.append(f"relay-{site}")
            self.at(site, "ergocast-relay", "--to", f"{INTERNET}:{SITE_PORT + site}", name=f"relay-{site}")

    def start_team(self):
        self.out.mkdir()
        self.logger = self.at(0, "ergocast-logger", "--out", self.out)
        if not self.options.drivers:
            self.at(0, "ergocast-sim")
        self.coordinator = self.at(0, "ergocast-coordinator", self.folder / "scenario.textproto",
                                   "--key-file", self.folder / "team.coordinator.key")
        for agent in range(self.options.agents):
            site = self.site_of(agent)
            if self.options.drivers:
                self.at(site, "ergocast-example-driver", "--id", agent, name=f"driver{agent}")
            self.agents.append(self.at(site, "ergocast-agent", "--id", agent, name=f"agent{agent}"))

    def printed(self, name):
        return self.log(name).read_text()

    def wait_until(self, holds, what):
        """For as long as the mission runs."""
        while not holds():
            if self.coordinator.poll() is not None and not holds():
                raise SystemExit(f"never: {what}\n" + self.printed("ergocast-coordinator"))
            time.sleep(0.02)

    def recorded_ticks(self):
        rows = sum(file.read_bytes().count(b"\n") for file in self.out.glob("trajectory*.csv"))
        return rows // self.options.agents

    def wait_for_tick(self, tick):
        self.wait_until(lambda: self.recorded_ticks() >= tick, f"tick {tick}")

    def wait_for_print(self, name, text, times=1):
        self.wait_until(lambda: self.printed(name).count(text) >= times, f"{name} prints {text}")

    def kill_hub(self):
        """Until all sites have noticed it."""
        self.hub.kill()
        for relay in self.relays:
            self.wait_for_print(relay, "cut off")
        self.start_hub()
        for relay in self.relays:
            self.wait_for_print(relay, "joined the hub", 2)

    def end(self):
        """Waits for the record, then ends the relays, whose last line has all counts."""
        code = self.coordinator.wait()
        self.logger.wait()
        return code

    def refused(self):
        """Datagrams that the relays of sites refused, by cause. A killed hub reports none."""
        refused = {}
        for relay in self.relays:
            for cause, count in re.findall(r"(\w+)=(\d+)", self.printed(relay).splitlines()[-1]):
                refused[cause] = refused.get(cause, 0) + int(count)
        return refused


def figures_of(mission, wall_s, cpu_s):
    summary = json.loads((mission.out / "summary.json").read_text())
    commands = max(1, summary["ticks"] * mission.options.agents)
    views = [agent["ergodic_metric"] for agent in summary["agents"]]
    return {"result": summary["result"], "ticks": summary["ticks"], "metric": summary["ergodic_metric"]["last"],
            "metric_of_agents": [min(views), max(views)], "lost_positions": summary["lost_positions"],
            "late_share": round(summary["missed_deadlines"] / commands, 4),
            "skipped_ticks": summary["skipped_ticks"], "gaps": summary["gaps"],
            "cores": round(cpu_s / wall_s, 2)}


def cpu_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def real_time_faults(mission, options):
    """One site is cut off; the hub is killed while it is."""
    per_s = 1 / options.dt
    mission.wait_for_tick(int(options.cut_at_s * per_s))
    cut = mission.links.links[options.cut_site]
    cut.cut = True
    begun = time.monotonic()
    if options.hub_down_s > 0:
        time.sleep(options.cut_s / 4)
        mission.hub.kill()
        time.sleep(options.hub_down_s)
        mission.start_hub()
    time.sleep(max(0, begun + options.cut_s - time.monotonic()))
    cut.cut = False


def lockstep_faults(mission, options, ticks):
    mission.wait_for_tick(ticks // 5)
    mission.kill_hub()
    mission.wait_for_tick(ticks // 2)
    cut = mission.links.links[options.cut_site]
    relay = mission.relays[options.cut_site]
    cut.cut = True
    mission.wait_for_print(relay, "cut off", 2)
    cut.cut = False
    mission.wait_for_print(relay, "joined the hub", 3)


def run(options, folder, name, sites):
    began, used_s = time.monotonic(), cpu_s()
    with Mission(options, folder, name, sites) as mission:
        if sites > 1:
            mission.start_relays()
        mission.start_team()
        if sites > 1 and options.lockstep:
            lockstep_faults(mission, options, round(options.duration / options.dt))
        elif sites > 1 and options.cut_s > 0:
            real_time_faults(mission, options)
        if mission.end() != 0:
            raise SystemExit(mission.printed("ergocast-coordinator"))
    figures = figures_of(mission, time.monotonic() - began, cpu_s() - used_s)
    if sites > 1:
        links = mission.links.links
        figures["kbit_per_s"] = [{way: round(8e-3 * count / (time.monotonic() - began)) for way, count in
                                  link.bytes.items()} for link in links]
        figures["shim_late_ms"] = round(1e3 * mission.links.late_s, 1)
        for way in ("sends", "receives"):
            figures[f"forged_{way}"] = sum(link.forged[way] for link in links)
        figures["refused_by_sites"] = mission.refused()
    return figures


def stop_at_once(options, folder):
    """How long after `ergocast stop --now`, and after a path is back, the last agent of a site ends."""
    name = "stopped"
    with Mission(options, folder, name, options.sites) as mission:
        mission.start_relays()
        mission.start_team()
        mission.wait_for_tick(10)
        cut = mission.links.links[options.cut_site]
        relay = mission.relays[options.cut_site]
        cut.cut = True
        mission.wait_for_print(relay, "cut off")
        began = time.monotonic()
        mission.at(0, "ergocast", "stop", "--now", "--key-file", folder / "team.coordinator.key", name="stop")
        ends = {}
        joins = relinked = None
        while len(ends) < len(mission.agents):
            now = time.monotonic()
            for agent, program in enumerate(mission.agents):
                if agent not in ends and program.poll() is not None:
                    ends[agent] = now
            if joins is None and mission.printed(relay).count("joined the hub") > 1:
                joins = now
            if relinked is None and now > began + options.stop_cut_s:
                cut.cut, relinked = False, now
            if now > began + 300:
                break
            time.sleep(0.005)
        far = [agent for agent in range(options.agents) if mission.site_of(agent) == options.cut_site]
        near = [agent for agent in range(options.agents) if agent not in far]
        return {"ended": len(ends), "last_with_a_path_s": round(max(ends[agent] for agent in near) - began, 2),
                "joined_after_the_path_s": round(joins - relinked, 2) if joins else None,
                "last_cut_off_after_joining_s":
                    round(max(ends[agent] for agent in far) - joins, 2) if joins and ends.keys() >= set(far) else None,
                "command": mission.printed("stop")}


def same_as_simulated(options, folder):
    """Whether the record over relays is that of the simulation, and nothing forged was taken."""
    subprocess.run([options.bin / "ergocast", "simulate", folder / "scenario.textproto", "--out", folder / "simulated"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    ours, simulated = ((folder / name / "trajectory.csv").read_bytes() for name in ("relayed", "simulated"))
    return ours == simulated


def parse(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=lambda text: pathlib.Path(text).resolve(), help="folder of the programs")
    parser.add_argument("scenario", type=pathlib.Path)
    parser.add_argument("--agents", type=int, default=64)
    parser.add_argument("--sites", type=int, default=4)
    parser.add_argument("--dt", type=float, default=1, help="a tick [s]")
    parser.add_argument("--duration", type=float, default=120, help="of the mission [s]")
    parser.add_argument("--delay-ms", type=float, default=100, help="of each site's link, each way, as the next")
    parser.add_argument("--jitter-ms", type=float, default=30)
    parser.add_argument("--loss-percent", type=float, default=5)
    parser.add_argument("--duplication-percent", type=float, default=1)
    parser.add_argument("--forgery-percent", type=float, default=1, help="packets of which a changed copy follows")
    parser.add_argument("--cut-site", type=int, default=1)
    parser.add_argument("--cut-at-s", type=float, default=30)
    parser.add_argument("--cut-s", type=float, default=60)
    parser.add_argument("--hub-down-s", type=float, default=5, help="how long the killed hub is away; 0: none")
    parser.add_argument("--stop-cut-s", type=float, default=8, help="a site is cut off when --stop sends a stop")
    parser.add_argument("--drivers", action="store_true", help="each agent has a driver beside it; else one world")
    parser.add_argument("--in-time", default="", help="more fields of `time`")
    parser.add_argument("--in-agents", default="", help="more fields of `agents`")
    parser.add_argument("--seed", type=int, default=1, help="of the losses and the random starts")
    parser.add_argument("--direct", action="store_true", help="also measure on one network, to compare")
    parser.add_argument("--stop", action="store_true", help="measure only how soon a stop arrives")
    parser.add_argument("--lockstep", action="store_true", help="check a lockstep mission against the simulation")
    return parser.parse_args(argv)


def main():
    options = parse(sys.argv[1:])
    enter_own_network(sys.argv)
    make_sites(options.sites)
    with tempfile.TemporaryDirectory(prefix="relay-sites-") as name:
        folder = pathlib.Path(name)
        subprocess.run([options.bin / "ergocast", "keygen", folder / "team"], check=True, stdout=subprocess.DEVNULL)
        os.environ["ERGOCAST_KEY_FILE"] = str(folder / "team.key")
        text = scenario_of(options.scenario.read_text(), options)
        text = re.sub(r"seed: \d+", f"seed: {options.seed}", text)
        if options.lockstep:
            text = text.replace("pace: REALTIME", "pace: LOCKSTEP")
        (folder / "scenario.textproto").write_text(text)
        if options.stop:
            print(json.dumps(stop_at_once(options, folder), indent=1))
            return
        figures = {"relayed": run(options, folder, "relayed", options.sites)}
        if options.direct:
            figures["direct"] = run(options, folder, "direct", 1)
            figures["ratio"] = round(figures["relayed"]["metric"] / figures["direct"]["metric"], 3)
        print(json.dumps(figures, indent=1))
        if options.lockstep:
            if not same_as_simulated(options, folder):
                raise SystemExit("the record over relays is not what the simulation gives")
            if figures["relayed"]["refused_by_sites"].get("tag", 0) == 0:
                raise SystemExit("nothing forged was refused")
        if options.drivers and options.loss_percent > 0 and figures["relayed"]["lost_positions"] == 0:
            raise SystemExit("the record has no row for a lost position")


if __name__ == "__main__":
    main()
