// SPDX-License-Identifier: BSD-3-Clause
// Compares our events with what node-cot reads in them: read_events.mjs FOLDER < LINES. FOLDER has
// node_modules.
import assert from 'node:assert';
import { readFileSync } from 'node:fs';
import { resolve } from 'node:path';

// An ES module is found by its file alone, not by a folder that we name.
const { default: CoT } = await import(
  resolve(process.argv[2], 'node_modules/@tak-ps/node-cot/dist/index.js')
);

const ALMOST_DEG = 1e-6; // node-cot cuts to this many decimals

function samePlace(read, ours) {
  for (const axis of [0, 1])
    assert(Math.abs(read[axis] - ours[axis]) <= ALMOST_DEG, `${read} is not ${ours}`);
}

function sameShape(geometry, ours) {
  if (!ours.outline) {
    assert.strictEqual(geometry.type, 'Point');
    return samePlace(geometry.coordinates, ours.place);
  }
  assert.strictEqual(geometry.type, 'Polygon');
  const [ring] = geometry.coordinates;
  assert.strictEqual(ring.length, ours.outline.length + 1);
  for (const [i, corner] of [...ours.outline, ours.outline[0]].entries()) samePlace(ring[i], corner);
}

function compare(ours) {
  const cot = new CoT(ours.xml); // throws if the event is not of its schema
  const { properties, geometry, id } = cot.to_geojson();
  assert.strictEqual(id, ours.uid);
  for (const name of ['type', 'how', 'callsign', 'remarks'])
    assert.strictEqual(properties[name], ours[name], name);
  assert.strictEqual(Date.parse(properties.time), ours.time_ms);
  assert.strictEqual(Date.parse(properties.start), ours.time_ms);
  assert.strictEqual(Date.parse(properties.stale), ours.stale_ms);
  assert.strictEqual('course' in properties, 'course_deg' in ours);
  if ('course_deg' in ours) {
    assert(Math.abs(properties.course - ours.course_deg) <= 0.05, `course ${properties.course}`);
    assert(Math.abs(properties.speed - ours.speed_mps) <= 0.005, `speed ${properties.speed}`);
  }
  sameShape(geometry, ours);
  assert(cot.to_proto(1).length > 0, 'it has no form as a message of TAK');
}

const lines = readFileSync(0, 'utf8').trim().split('\n').map(JSON.parse);
for (const type of ['a-f-G', 'u-d-f', 'b-m-p-s-m'])
  assert(
    lines.some(line => line.type === type),
    type,
  );
lines.forEach(compare);
console.log(`${lines.length} events are the same to node-cot`);
