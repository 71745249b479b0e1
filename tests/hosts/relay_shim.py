# SPDX-License-Identifier: BSD-3-Clause
"""The internet between relays: a UDP port for each site, which passes packets on to the hub and back.

A kernel without netem cannot delay or lose packets, so relays join this program. It delays each
packet by delay_s ± jitter_s, so that later ones may overtake, and loses, repeats or forges some. It
has no rate and no queue of its own; the relays' --max-rate is the only one.
"""
import collections
import dataclasses
import heapq
import random
import selectors
import socket
import threading
import time

IP_AND_UDP_BYTES = 28
DATA = 0x80  # first byte of a packet of datagrams; see relay/packets.h


@dataclasses.dataclass
class Faults:
    """What each link does, in each direction."""
    delay_s: float = 0
    jitter_s: float = 0
    loss: float = 0
    duplication: float = 0
    forgery: float = 0  # share of the packets after which a changed copy follows


class Link:
    """Between one site and the hub."""

    def __init__(self, host, port):
        self.site_side, self.hub_side = (socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2))
        self.site_side.bind((host, port))
        for one in (self.site_side, self.hub_side):
            one.setblocking(False)
        self.site = None  # where the site's packets come from
        self.cut = False
        self.bytes = {"sends": 0, "receives": 0}
        self.channels = collections.Counter()  # bytes of datagrams that the site receives, by channel
        self.forged = {"sends": 0, "receives": 0}  # copies that were passed on


def first_frame_end(packet):
    return 4 + (packet[2] << 8 | packet[3])


def changed(packet):
    """The last byte of the first datagram has another value, which is in its tag or its signature."""
    at = first_frame_end(packet) - 1
    return packet[:at] + bytes([packet[at] ^ 1]) + packet[at + 1:first_frame_end(packet)]


def channels_of(packet):
    """Yields channel and bytes of each datagram, with what LCM's header has in front of the channel."""
    at = 1
    while at + 3 < len(packet):
        size = packet[at + 1] << 8 | packet[at + 2]
        name = packet[at + 7:at + 3 + size].split(b"\0")[0].decode("ascii", "replace")
        yield name.rstrip("0123456789").rstrip("_"), 3 + size
        at += 3 + size


class Links(threading.Thread):
    """The links of all sites, at `ports` of `host`. The hub is at UDP `hub`."""

    def __init__(self, host, ports, hub, faults, seed):
        super().__init__(daemon=True)
        self.hub, self.faults, self.dice = hub, faults, random.Random(seed)
        self.links = [Link(host, port) for port in ports]
        self.late_s = 0  # the most that this program was late itself
        self.waiting, self.count = [], 0

    def run(self):
        selector = selectors.DefaultSelector()
        for link in self.links:
            selector.register(link.site_side, selectors.EVENT_READ, (link, "sends"))
            selector.register(link.hub_side, selectors.EVENT_READ, (link, "receives"))
        while True:
            wait_s = max(0, self.waiting[0][0] - time.monotonic()) if self.waiting else 1
            for key, _ in selector.select(wait_s):
                self.receive(key.fileobj, *key.data)
            while self.waiting and self.waiting[0][0] <= time.monotonic():
                due, _, link, way, forged, packet = heapq.heappop(self.waiting)
                self.late_s = max(self.late_s, time.monotonic() - due)
                self.pass_on(link, way, forged, packet)

    def receive(self, side, link, way):
        while True:
            try:
                packet, sender = side.recvfrom(65535)
            except (BlockingIOError, ConnectionRefusedError):  # the hub is down
                return
            if way == "sends":
                link.site = sender
            link.bytes[way] += len(packet) + IP_AND_UDP_BYTES
            if way == "receives" and packet[0] == DATA:
                for channel, size in channels_of(packet):
                    link.channels[channel] += size
            if self.dice.random() < self.faults.loss:
                continue
            self.delay(link, way, packet)
            if self.dice.random() < self.faults.duplication:
                self.delay(link, way, packet)
            if packet[0] == DATA and self.dice.random() < self.faults.forgery:
                self.delay(link, way, changed(packet), forged=1)

    def delay(self, link, way, packet, forged=0):
        late_s = self.faults.delay_s + self.faults.jitter_s * self.dice.uniform(-1, 1)
        self.count += 1
        heapq.heappush(self.waiting, (time.monotonic() + late_s, self.count, link, way, forged, packet))

    def pass_on(self, link, way, forged, packet):
        if link.cut:
            return
        try:
            if way == "sends":
                link.hub_side.sendto(packet, self.hub)
            elif link.site:
                link.site_side.sendto(packet, link.site)
            link.forged[way] += forged
        except (BlockingIOError, ConnectionRefusedError):  # the hub is down
            pass
