// SPDX-License-Identifier: BSD-3-Clause
// Compares our codec with node-mavlink, both ways: codec.cjs FOLDER MAVLINK_LINES. FOLDER has node_modules.
const { execFileSync } = require('node:child_process');
const { createRequire } = require('node:module');
const assert = require('node:assert');
const mavlink = createRequire(require('node:path').resolve(process.argv[2]) + '/')('node-mavlink');

const lines = process.argv[3];
const KEY = Buffer.alloc(32, 0x5a);
const TIME = 30_000_000_000_000; // of our frames' signatures, in 10 µs since 2015

const classes = new Map();
for (const set of [mavlink.minimal, mavlink.common]) {
  for (const one of Object.values(set.REGISTRY)) classes.set(one.MSG_NAME, one);
}

// The fields of a message by MAVLink's own names, as our program prints them.
function fieldsOf(message) {
  const all = {};
  for (const field of message.constructor.FIELDS) {
    const value = message[field.name];
    all[field.source] = typeof value === 'bigint' ? String(value) : value;
  }
  return all;
}

function run(...words) {
  const input = typeof words.at(-1) === 'object' ? words.pop().input : '';
  return execFileSync(lines, words, { input, encoding: 'utf8' }).trim().split('\n').map(JSON.parse);
}

// Only the fields that both know: either may know newer extensions.
function compare(ours, theirs) {
  let compared = 0;
  for (const [name, value] of Object.entries(ours)) {
    if (!(name in theirs)) continue;
    assert.deepStrictEqual(value, theirs[name], name);
    compared += 1;
  }
  assert(compared > 0);
  return compared;
}

function parsed(hex) {
  const parser = new mavlink.MavLinkPacketParser();
  const splitter = new mavlink.MavLinkPacketSplitter();
  const found = [];
  splitter.pipe(parser);
  parser.on('data', packet => found.push(packet));
  splitter.write(Buffer.from(hex, 'hex'));
  return new Promise(done => setImmediate(() => setImmediate(() => done(found))));
}

async function readOurs(seed, key) {
  let compared = 0;
  const sent = run('write', String(seed), ...(key ? [key.toString('hex')] : []));
  for (const line of sent) {
    const [packet] = await parsed(line.frame);
    assert(packet, `${line.name} was not read`);
    const clazz = classes.get(line.name);
    assert.strictEqual(packet.header.msgid, clazz.MSG_ID);
    assert.strictEqual(packet.header.sysid, line.system);
    assert.strictEqual(packet.header.compid, line.component);
    compared += compare(line.fields, fieldsOf(packet.protocol.data(packet.payload, clazz)));
    assert.strictEqual(Boolean(packet.signature), Boolean(key));
    if (key) assert(packet.signature.matches(key), `${line.name}: another signature`);
  }
  return [sent, compared];
}

// The same messages, written by node-mavlink as version 2, signed or not, and as version 1.
function readTheirs(sent, key, version) {
  const protocol = version === 1 ? new mavlink.MavLinkProtocolV1(7, 3) : new mavlink.MavLinkProtocolV2(7, 3);
  const frames = sent.map((line, i) => {
    const clazz = classes.get(line.name);
    const message = new clazz();
    for (const field of clazz.FIELDS) {
      if (!(field.source in line.fields)) continue;
      const value = line.fields[field.source];
      message[field.name] = field.size === 8 && field.type !== 'char' ? BigInt(value) : value;
    }
    if (!key) return protocol.serialize(message, i).toString('hex');
    const open = new mavlink.MavLinkProtocolV2(7, 3, mavlink.MavLinkProtocolV2.IFLAG_SIGNED).serialize(
      message,
      i,
    );
    return protocol.sign(open, 1, key, 1420070400000 + TIME / 100 + 1 + i).toString('hex');
  });
  const words = ['read', ...(key ? [key.toString('hex')] : [])];
  const read = run(...words, { input: frames.join('\n') + '\n' });
  assert.strictEqual(read.length, sent.length, `of ${sent.length} frames ${read.length} were read`);
  for (const [i, line] of read.entries()) {
    assert.strictEqual(line.name, sent[i].name);
    for (const field of classes.get(line.name).FIELDS) {
      if (!(field.source in line.fields)) continue;
      assert.deepStrictEqual(
        line.fields[field.source],
        sent[i].fields[field.source],
        `${line.name}.${field.source}`,
      );
    }
  }
}

async function main() {
  let compared = 0;
  for (let seed = 1; seed <= 40; ++seed) {
    const [sent, count] = await readOurs(seed, null);
    compared += count;
    readTheirs(sent, null, 2);
    readTheirs(sent, null, 1);
    const [signed] = await readOurs(seed, KEY);
    readTheirs(signed, KEY, 2);
  }
  console.log(`${compared} fields are the same to node-mavlink, and back`);
}

main().catch(problem => {
  console.error(problem);
  process.exit(1);
});
