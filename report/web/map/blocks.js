// SPDX-License-Identifier: BSD-3-Clause
// Paints which agents are blocked, and what blocks them.
// It draws on a canvas, or on anything with the same methods (svg.js).

const SIGN = 5.5; // pixels: the radius of the sign of a blocked agent
const HEAD = 6; // pixels

// The two ends of the line from a blocked agent to the agent that blocks it. They are at the agents'
// places, or beside a number that is drawn there.
export function lineBetween(from, to) {
  const away = [to.x - from.x, to.y - from.y],
    long = Math.hypot(...away),
    pull = ({ inside, ringed, r, body }) =>
      inside ? Math.min(ringed ? r + 1 : 0.4 * Math.min(...body), 0.3 * long) / Math.max(long, 1e-6) : 0;
  return [
    [from.x + away[0] * pull(from), from.y + away[1] * pull(from)],
    [to.x - away[0] * pull(to), to.y - away[1] * pull(to)],
  ];
}

function paintLine(g, [[x, y], [tipX, tipY]], colours) {
  const long = Math.hypot(tipX - x, tipY - y);
  if (long < 1) return;
  const right = (tipX - x) / long,
    down = (tipY - y) / long,
    back = aside => [tipX - right * HEAD - down * aside, tipY - down * HEAD + right * aside];
  g.lineJoin = 'round';
  for (const [stroke, width] of [
    [colours.panel, 5],
    [colours.ink, 2.2],
  ]) {
    g.strokeStyle = stroke;
    g.lineWidth = width;
    g.beginPath();
    g.moveTo(x, y);
    g.lineTo(tipX, tipY);
    g.moveTo(...back(0.6 * HEAD));
    g.lineTo(tipX, tipY);
    g.lineTo(...back(-0.6 * HEAD));
    g.stroke();
  }
}

// The place of the sign for an agent that an edge or a wall blocks: opposite the pin's head.
export function signAt({ x, y, head, rim, inside, r }) {
  const long = Math.hypot(head[0] - x, head[1] - y);
  if (inside || long < 1e-6) return [x, y + r + SIGN + 2];
  const away = (rim + SIGN + 3) / long;
  return [x - (head[0] - x) * away, y - (head[1] - y) * away];
}

// Paints a no-entry sign: a disc with a bar.
function paintSign(g, [x, y], colours) {
  g.beginPath();
  g.arc(x, y, SIGN, 0, 2 * Math.PI);
  g.fillStyle = colours.bad;
  g.strokeStyle = colours.panel;
  g.lineWidth = 2;
  g.stroke();
  g.fill();
  g.fillStyle = colours.panel;
  g.fillRect(x - 3.4, y - 1.2, 6.8, 2.4);
}

// `blocks`: a list of {marker, by}. `by` is the number of the blocking agent; null: an edge or a wall.
export function paintBlockLines(g, markers, blocks, colours) {
  const byId = new Map(markers.map(marker => [marker.track.id, marker]));
  for (const { marker, by } of blocks) {
    const other = byId.get(by);
    if (other) paintLine(g, lineBetween(marker, other), colours);
  }
}

// Paints a sign for each agent that an edge or a wall blocks.
export function paintBlockSigns(g, blocks, colours) {
  for (const { marker, by } of blocks) if (by === null) paintSign(g, signAt(marker), colours);
}
