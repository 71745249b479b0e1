// SPDX-License-Identifier: BSD-3-Clause
// Reads an MCAP file for ROS 2 with Foxglove's readers and compares it with the record:
// read_ros2_mcap.cjs MCAP_READER ROS2_READER FILE RUN_DIR. Prints what was found, or what differs.
const assert = require('node:assert');
const { readFileSync } = require('node:fs');
const { countStreamed, readTopics, tableOf } = require('./mcap_file.cjs');
const [mcapReader, ros2Reader, file, runDir] = process.argv.slice(2);
const load = name => require(`${ros2Reader}/node_modules/@foxglove/${name}`);
const { MessageReader } = load('rosmsg2-serialization');
const { parse } = load('rosmsg');
const { ros2humble, ros2jazzy } = load('rosmsg-msgs-common');

const toNs = ({ sec, nsec }) => BigInt(sec) * 1000000000n + BigInt(nsec);

/** Fields with their types, in order, as ROS 2 itself defines them in both distributions. */
function checkDefinitions(definitions, name) {
  const fields = definition =>
    definition.definitions
      .filter(one => !one.isConstant)
      .map(({ name, type, isArray, arrayLength }) => [
        name,
        type.replace('/msg/', '/'),
        !!isArray,
        arrayLength,
      ]);
  for (const definition of definitions) {
    const short = (definition.name ?? name).replace('/msg/', '/');
    if (short === 'builtin_interfaces/Time') continue; // a time of the reader
    for (const all of [ros2humble, ros2jazzy]) {
      const known = all[short] ?? all[short.replace('/', '/msg/')];
      assert.ok(known, `ROS 2 has no ${short}`);
      assert.deepEqual(fields(definition), fields(known), short);
    }
  }
}

/** Checks header and schemas; returns what reads a message. */
function begin(mcap) {
  assert.equal(mcap.header.profile, 'ros2');
  const readers = new Map();
  for (const schema of mcap.schemasById.values()) {
    assert.equal(schema.encoding, 'ros2msg');
    const definitions = parse(Buffer.from(schema.data).toString(), { ros2: true });
    checkDefinitions(definitions, schema.name);
    readers.set(schema.id, new MessageReader(definitions));
  }
  return (message, channel) => {
    assert.equal(channel.messageEncoding, 'cdr');
    const value = readers.get(channel.schemaId).readMessage(message.data);
    if (value.header) {
      assert.equal(toNs(value.header.stamp), message.logTime, channel.topic);
      assert.equal(value.header.frame_id, 'map');
    }
    return value;
  };
}

/** Each tick of an agent, and its way in at most 500 positions. */
function checkAgent(topics, agent, own, start) {
  const odom = topics.get(`/ergocast/agent${agent}/odom`);
  assert.equal(odom.schema, 'nav_msgs/msg/Odometry');
  assert.equal(odom.messages.length, own.length);
  own.forEach((row, i) => {
    const { time, value } = odom.messages[i];
    const { position, orientation } = value.pose.pose;
    assert.deepEqual(position, { x: row.x_m, y: row.y_m, z: 0 });
    assert.equal(time, start + BigInt(Math.round(row.t_s * 1e9)));
    assert.equal(value.child_frame_id, `agent${agent}`);
    const heading = 2 * Math.atan2(orientation.z, orientation.w);
    const ahead = value.twist.twist.linear.x;
    assert.ok(Math.abs(ahead * Math.cos(heading) - row.vx_mps) < 1e-9);
    assert.ok(Math.abs(ahead * Math.sin(heading) - row.vy_mps) < 1e-9);
    assert.equal(value.pose.covariance.length, 36);
    assert.equal(value.twist.covariance.length, 36);
  });
  const path = topics.get(`/ergocast/agent${agent}/path`);
  assert.equal(path.schema, 'nav_msgs/msg/Path');
  const poses = path.messages.at(-1).value.poses,
    step = Math.ceil(own.length / poses.length);
  assert.ok(poses.length >= 250 && poses.length <= 500, `${poses.length} positions`);
  poses.forEach(({ pose }, i) => {
    assert.deepEqual(pose.position, { x: own[i * step].x_m, y: own[i * step].y_m, z: 0 });
  });
}

function checkGrids(topics, found) {
  const grids = name => {
    const topic = topics.get(`/ergocast/${name}`);
    assert.equal(topic.schema, 'nav_msgs/msg/OccupancyGrid');
    for (const { value } of topic.messages) {
      const { resolution, width, height, origin } = value.info;
      assert.deepEqual([resolution, width, height], [100 / 64, 64, 39]);
      assert.deepEqual(origin.position, { x: -10, y: 5, z: 0 });
      assert.equal(value.data.length, width * height);
    }
    return topic.messages.map(({ value }) => [...value.data]);
  };
  const sum = cells => cells.reduce((all, cell) => all + Math.max(0, cell), 0);
  const [first, target, ...more] = grids('target');
  assert.equal(more.length, 0);
  // Row 38 is from 64.4 m to 65.9 m, and the domain ends at 65 m.
  assert.equal(target.indexOf(-1), 38 * 64);
  for (const cells of [first, target]) assert.equal(Math.max(...cells), 100);
  const at = (x, y) => Math.floor((y - 5) / (100 / 64)) * 64 + Math.floor((x + 10) / (100 / 64));
  assert.ok(first[at(60, 25)] > 95 && first[at(10, 50)] < 50, 'the target is greatest at its peak');
  assert.ok(target[at(10, 50)] > 95 && target[at(60, 25)] < 50, 'so is the second one');
  const coverage = grids('coverage');
  assert.ok(coverage.length > 20, `${coverage.length} pictures`);
  const lefts = grids('left');
  assert.equal(lefts.length, coverage.length);
  // What is left never grows, unless the target is another one.
  const grown = lefts.filter((cells, i) => i > 0 && cells.some((cell, j) => cell > lefts[i - 1][j]));
  assert.equal(grown.length, 1);
  // Nothing is left of what was found.
  const share = sum(lefts.at(-1)) / sum(target);
  assert.ok(Math.abs(share - (1 - found)) < 0.02, `${share} is left, and P(found) = ${found}`);
}

(async () => {
  const { topics, statistics, metadata } = await readTopics(mcapReader, file, begin);
  let messages = 0;
  for (const { messages: list } of topics.values()) messages += list.length;
  assert.equal(BigInt(messages), statistics.messageCount);
  assert.equal(countStreamed(mcapReader, file), messages);

  const summary = JSON.parse(readFileSync(`${runDir}/summary.json`, 'utf8'));
  assert.equal(metadata[0].metadata.get('run_id'), summary.run_id);
  const start = BigInt(Date.parse(summary.started)) * 1000000n;
  const rows = tableOf(runDir, 'trajectory.csv');
  for (const agent of new Set(rows.map(row => row.agent)))
    checkAgent(
      topics,
      agent,
      rows.filter(row => row.agent === agent),
      start,
    );

  const metrics = tableOf(runDir, 'metrics.csv'),
    numbers = name => topics.get(`/ergocast/${name}`).messages.map(({ value }) => value.data);
  assert.deepEqual(
    numbers('phi2'),
    metrics.map(row => row.ergodic_metric),
  );
  assert.deepEqual(
    numbers('found'),
    metrics.map(row => row.detection_probability),
  );
  const status = numbers('status').at(-1);
  assert.match(
    status,
    new RegExp(`^${summary.scenario}: running, tick ${metrics.at(-1).tick} of \\d+, φ² = `),
  );
  checkGrids(topics, metrics.at(-1).detection_probability);

  const finds = summary.objects.finds.map(({ x_m, y_m }) => ({ x: x_m, y: y_m, z: 0 }));
  assert.ok(finds.length > 0, 'this record tests finds');
  assert.deepEqual(
    topics
      .get('/ergocast/finds')
      .messages.at(-1)
      .value.poses.map(pose => pose.position),
    finds,
  );
  summary.objects.finds.forEach(({ t_s }, i) => {
    const first = topics.get('/ergocast/finds').messages.find(({ value }) => value.poses.length > i);
    assert.equal(first.time, start + BigInt(Math.round(t_s * 1e9)), `find ${i} is shown at once`);
  });
  const contacts = topics.get('/ergocast/contacts').messages.at(-1).value.poses;
  const reported = new Set(rows.map(row => row.reported).filter(cell => cell >= 0));
  assert.ok(reported.size > finds.length, 'this record tests false alarms');
  assert.equal(contacts.length, reported.size);
  assert.ok(contacts.every(({ position: { x, y } }) => x > -10 && x < 90 && y > 5 && y < 65));

  const lines = topics.get('/rosout');
  assert.equal(lines.schema, 'rcl_interfaces/msg/Log');
  assert.deepEqual(
    lines.messages.map(({ value: { level, name, msg } }) => `${level} ${name}: ${msg}`).sort(),
    [
      '20 agent-3: agent 3 of run 1: running\nand a second line',
      `20 simulate: amendment 0: target ${summary.amendments[0].hash}`,
      '30 sim: late',
    ],
  );
  console.log(
    [...topics].map(([topic, { schema, messages: list }]) => `${topic} ${schema} ${list.length}`).join('\n'),
  );
})().catch(error => {
  console.error(error.message);
  process.exit(1);
});
