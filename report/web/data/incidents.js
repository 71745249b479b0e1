// SPDX-License-Identifier: BSD-3-Clause
// What happened to the agents of a mission, as the roster and the pauses of its record have it.

// Adds what only the roster has: incidents of agents of which no message reports any.
export function withMore(received, roster) {
  const known = new Set(received.map(incident => incident.agent));
  return [...received, ...roster.filter(incident => !known.has(incident.agent))].sort((a, b) => a.t - b.t);
}

// The pauses that no status reports.
export function pausesOf(run) {
  const {
    mission: { dt_s: dt },
    end,
  } = run;
  return run.holds.map(([from, until]) => ({
    t: from * dt,
    kind: 'paused',
    sign: '‖',
    text: 'paused by an operator',
    until: Math.min(end, (until ?? Infinity) * dt),
  }));
}

// Departures and returns in the roster.
export function rosterIncidents(entries, dt, end) {
  const incidents = [],
    byId = new Map();
  for (const entry of entries) {
    if (typeof entry.id !== 'number' || typeof entry.active_from !== 'number') continue;
    if (!byId.has(entry.id)) byId.set(entry.id, []);
    byId.get(entry.id).push(entry);
  }
  for (const [id, list] of byId) {
    list.sort((a, b) => a.active_from - b.active_from);
    list.forEach((entry, i) => {
      const from = entry.active_from * dt,
        left = list[i - 1]?.active_until;
      if (i > 0 && typeof left === 'number' && entry.active_from - left <= 1) {
        incidents.push({ t: from, kind: 'ok', sign: '↻', text: `${id} restarted`, agent: id });
      } else if (entry.active_from > 0) {
        incidents.push({
          t: from,
          kind: 'ok',
          sign: '+',
          text: `${id} ${i > 0 ? 'back' : 'joined'}`,
          agent: id,
        });
      }
      const until = entry.active_until,
        next = list[i + 1]?.active_from;
      if (typeof until === 'number' && !(next - until <= 1)) {
        incidents.push({
          t: until * dt,
          kind: 'gone',
          sign: '–',
          text: `${id} left`,
          agent: id,
          until: Math.min(end, (next ?? Infinity) * dt),
        });
      }
    });
  }
  return incidents.sort((a, b) => a.t - b.t);
}
