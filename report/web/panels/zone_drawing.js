// SPDX-License-Identifier: BSD-3-Clause
// The control "New zone": a polygon that the team leaves for a time. The page shows which agents are inside.
import { S } from './state.js';
import { isSound } from '../data/drawn.js';
import { MOST_CORNERS, crosses, insideAt, zoneRequestOf, zoneTextOf } from '../data/zones.js';
import { $, put, readable } from '../text.js';

const LASTS_S = 600,
  MOST_NAMED = 8; // agents whose way is named

const polygon = () => S.drawing.parts[0];
const request = () => zoneRequestOf(polygon(), S.drawing.lasts, S.run.mission);

function problem() {
  const { corners } = polygon();
  if (!(S.drawing.lasts > 0)) return 'Write for how many seconds the zone lasts.';
  if (!isSound(polygon())) return 'The lower height has to be below the upper one.';
  if (crosses(corners)) return 'Two of its edges cross: drag a corner until they do not.';
  if (corners.length > MOST_CORNERS)
    return `It has ${corners.length} corners, and a zone at most ${MOST_CORNERS}: remove it and draw fewer.`;
  return '';
}

const metres = v => (v === Infinity ? 'no way out is seen' : `${readable(v)} m`);

function ways(found) {
  const named = found.slice(0, MOST_NAMED).map(({ id, metres: way }) => `agent ${id}: ${metres(way)}`),
    more = found.length - named.length;
  return named.length
    ? `To the nearest edge, at least: ${named.join('; ')}${more ? `; ${more} more are nearer` : ''}.`
    : '';
}

function describe() {
  if (!polygon()) {
    put(
      $('drawnText'),
      S.drawing.open.length
        ? 'Click for each corner, and on the first one to close the polygon.'
        : 'Click where the zone’s corners are.',
    );
    put($('drawnWays'), '');
    return;
  }
  const { corners, heights } = polygon(),
    { run } = S,
    found = crosses(corners) ? [] : insideAt(run, run.rowAt(run.end), corners, heights),
    all = run.tracks.filter(track => track.isMember(run.rowAt(run.end))).length,
    inside = found.length
      ? `${found.length} of ${all} agents ${found.length === 1 ? 'is' : 'are'} inside now.`
      : 'No agent is inside now.';
  put($('drawnText'), problem() || inside);
  put($('drawnWays'), ways(found));
}

export const zoneDrawing = {
  name: 'New zone',
  button: 'drawZone',
  tools: 'zoneTools',
  most: 1,
  label:
    'The new zone. Enter adds a square or closes a polygon, arrows move it, plus and minus change its ' +
    'size, C chooses a corner for the arrows, Delete removes it',
  begin() {
    $('zoneFor').value = LASTS_S;
    return { tool: 'polygon', lasts: LASTS_S };
  },
  changed() {},
  isReady: () => Boolean(polygon()) && S.drawing.lasts > 0 && isSound(polygon()),
  describe,
  order: () => ['zone', { zone: request() }],
  command: () =>
    `cat > zone.textproto <<'END'\n${zoneTextOf(request())}END\n` +
    `ergocast amend --run-id ${S.facts.run} --zone zone.textproto --for ${S.drawing.lasts}s`,
  newest: () => Math.max(-1, ...S.run.zones.map(zone => zone.number)),
};

export function connectZone(changed) {
  $('zoneFor').oninput = e => {
    S.drawing.lasts = Number(e.target.value);
    changed();
  };
}
