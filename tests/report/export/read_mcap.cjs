// SPDX-License-Identifier: BSD-3-Clause
// Reads an exported MCAP file with the reference reader and compares it with the record:
// read_mcap.cjs READER_FOLDER FILE RUN_DIR. Prints what was found, or what differs.
const assert = require('node:assert');
const { readFileSync } = require('node:fs');
const { countStreamed, readTopics, tableOf } = require('./mcap_file.cjs');
const [reader, file, runDir] = process.argv.slice(2);

function valueOf(message, channel, schema) {
  assert.equal(channel.messageEncoding, 'json');
  assert.equal(schema.encoding, 'jsonschema');
  const text = JSON.parse(Buffer.from(schema.data).toString());
  const value = JSON.parse(Buffer.from(message.data).toString());
  assert.equal(text.title, schema.name);
  // The schema has exactly the members that are written.
  assert.deepEqual(Object.keys(value).sort(), Object.keys(text.properties).sort(), schema.name);
  assert.equal(BigInt(value.timestamp.sec) * 1000000000n + BigInt(value.timestamp.nsec), message.logTime);
  return value;
}

function grid(value) {
  const bytes = Buffer.from(value.data, 'base64');
  assert.equal(value.fields[0].type, 7);
  assert.equal(bytes.length % value.row_stride, 0);
  return Array.from({ length: bytes.length / 4 }, (_, i) => bytes.readFloatLE(4 * i));
}

(async () => {
  const { topics, statistics, metadata } = await readTopics(reader, file, () => valueOf);
  let messages = 0;
  for (const { messages: list } of topics.values()) messages += list.length;
  assert.equal(BigInt(messages), statistics.messageCount);
  assert.equal(countStreamed(reader, file), messages);

  const summary = JSON.parse(readFileSync(`${runDir}/summary.json`, 'utf8'));
  assert.equal(metadata[0].metadata.get('run_id'), summary.run_id);
  const start = BigInt(Date.parse(summary.started)) * 1000000n;
  const rows = tableOf(runDir, 'trajectory.csv'),
    agents = new Set(rows.map(row => row.agent));
  for (const agent of agents) {
    const own = rows.filter(row => row.agent === agent),
      poses = topics.get(`/agents/${agent}/pose`);
    assert.equal(poses.schema, 'foxglove.PoseInFrame');
    assert.equal(poses.messages.length, own.length);
    own.forEach((row, i) => {
      const {
        time,
        value: {
          pose: { position, orientation },
        },
      } = poses.messages[i];
      assert.deepEqual(position, { x: row.x_m, y: row.y_m, z: 0 });
      assert.equal(time, start + BigInt(Math.round(row.t_s * 1e9)));
      const heading = 2 * Math.atan2(orientation.z, orientation.w),
        wanted = Math.atan2(row.vy_mps, row.vx_mps);
      assert.ok(Math.abs(Math.sin((heading - wanted) / 2)) < 1e-9);
    });
    const places = topics.get(`/agents/${agent}/location`);
    assert.equal(places.messages.length, own.length);
    assert.ok(
      places.messages.every(
        ({ value }) => Math.abs(value.latitude - 47.5) < 0.05 && Math.abs(value.longitude - 9.2) < 0.05,
      ),
    );
  }
  assert.deepEqual(
    topics.get('/metrics').messages.map(({ value }) => value.ergodic_metric),
    tableOf(runDir, 'metrics.csv').map(row => row.ergodic_metric),
  );
  const free = readFileSync(`${runDir}/scenario.textproto`, 'utf8').includes('free_domain: true');
  const basis = free ? 'modes of the free domain' : 'cosines';
  assert.ok(
    topics.get('/metrics').messages.every(({ value }) => value.basis === basis),
    `φ² is in ${basis}`,
  );

  const target = topics.get('/target'),
    coverage = topics.get('/coverage');
  assert.equal(target.messages.length, 1);
  const density = readFileSync(`${runDir}/target_density.csv`, 'utf8')
    .trimEnd()
    .split('\n')
    .reverse()
    .flatMap(line => line.split(',').map(Number));
  assert.deepEqual(grid(target.messages[0].value), density.map(Math.fround));
  for (const { value } of coverage.messages) {
    const cells = grid(value),
      mean = cells.reduce((a, b) => a + b) / cells.length;
    assert.ok(Math.abs(mean - 1) < 0.02, `the mean density is ${mean}`);
  }
  if (topics.has('/log'))
    assert.ok(topics.get('/log').messages.every(({ value }) => value.level >= 1 && value.message));
  console.log(
    [...topics].map(([topic, { schema, messages: list }]) => `${topic} ${schema} ${list.length}`).join('\n'),
  );
})().catch(error => {
  console.error(error.message);
  process.exit(1);
});
