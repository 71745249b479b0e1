// SPDX-License-Identifier: BSD-3-Clause
// Reads every topic of a live team with @foxglove/ws-protocol's client:
//   read_team.cjs FOLDER URL MESSAGES PROTOCOL [SILENT]
// FOLDER has node_modules. It ends when each topic that is advertised has had MESSAGES messages, or one if it
// changes rarely. It prints a line of JSON for each topic, or what is wrong. The topic SILENT may have none.
const assert = require('node:assert');
const [folder, url, wanted, protocol, silent] = process.argv.slice(2);
const { FoxgloveClient } = require(`${folder}/node_modules/@foxglove/ws-protocol`);
const { WebSocket } = require(`${folder}/node_modules/ws`);

const RARE = ['/target', '/log', '/amendments'];
const topics = new Map(); // by topic: { schema, text, count, value }
const bySubscription = new Map();
let info;

// The value has exactly the members of its schema, each of its type; a number may be unknown.
function check(value, schema, path) {
  const types = {
    object: () => typeof value === 'object' && !Array.isArray(value),
    array: () => Array.isArray(value),
    string: () => typeof value === 'string',
    number: () => value === null || typeof value === 'number',
    integer: () => Number.isInteger(value),
  };
  assert.ok(types[schema.type]?.(), `${path} is no ${schema.type}: ${JSON.stringify(value)}`);
  if (schema.type === 'array') value.forEach((one, i) => check(one, schema.items, `${path}[${i}]`));
  if (schema.type !== 'object') return;
  assert.deepEqual(Object.keys(value).sort(), Object.keys(schema.properties).sort(), path);
  for (const [name, member] of Object.entries(schema.properties))
    check(value[name], member, `${path}.${name}`);
}

function grid({ data, column_count: columns, row_stride: stride, cell_stride: cell, fields }) {
  const bytes = Buffer.from(data, 'base64');
  assert.deepEqual(fields, [{ name: 'density', offset: 0, type: 7 }]);
  assert.equal(stride, columns * cell);
  assert.equal(bytes.length % stride, 0);
  let sum = 0;
  for (let at = 0; at < bytes.length; at += cell) sum += bytes.readFloatLE(at);
  assert.ok(Math.abs(sum / (bytes.length / cell) - 1) < 0.02, 'the mean of a density is 1');
}

function isComplete() {
  const all = [...topics];
  const agents = all.filter(([name]) => name.startsWith('/agents/'));
  return (
    agents.length > 0 &&
    all.every(([name, { count }]) => name === silent || count >= (RARE.includes(name) ? 1 : Number(wanted)))
  );
}

const socket = new WebSocket(url, [protocol], {
  rejectUnauthorized: false, // certificates of tests sign themselves
});
const client = new FoxgloveClient({ ws: socket });
client.on('error', error => {
  throw error;
});
client.on('close', () => {
  assert.ok(isComplete(), 'the server has closed the connection');
});
client.on('serverInfo', one => {
  info = one;
  assert.deepEqual(info.capabilities, []);
});
client.on('status', ({ message }) => console.error(message));
client.on('advertise', channels => {
  assert.ok(info, 'serverInfo comes first');
  for (const { id, topic, encoding, schemaName, schema, schemaEncoding } of channels) {
    assert.equal(encoding, 'json');
    assert.equal(schemaEncoding, 'jsonschema');
    assert.ok(!topics.has(topic), topic);
    topics.set(topic, { schema: schemaName, text: schema, count: 0 });
    bySubscription.set(client.subscribe(id), topic);
  }
});
client.on('message', ({ subscriptionId, timestamp, data }) => {
  const topic = topics.get(bySubscription.get(subscriptionId));
  const value = JSON.parse(new TextDecoder().decode(data));
  check(value, JSON.parse(topic.text), bySubscription.get(subscriptionId));
  assert.equal(BigInt(value.timestamp.sec) * 1000000000n + BigInt(value.timestamp.nsec), timestamp);
  if (topic.schema === 'foxglove.Grid') grid(value);
  topic.count += 1;
  topic.value = value;
  if (!isComplete()) return;
  const lines = [...topics].map(([name, one]) => JSON.stringify({ topic: name, ...one }) + '\n');
  process.stdout.write(lines.join(''), () => process.exit(0));
});
