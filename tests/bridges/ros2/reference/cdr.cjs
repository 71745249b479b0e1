// SPDX-License-Identifier: BSD-3-Clause
// Foxglove's reader and writer of ROS 2 messages: cdr.cjs FOLDER read FILE prints recorded messages as JSON,
// cdr.cjs FOLDER write prints an Odometry in hex, and cdr.cjs FOLDER map FILE the OccupancyGrid that FILE has
// as JSON.
const fs = require('fs');
const path = require('path');

const [folder, what, file] = process.argv.slice(2);
const load = name => require(path.join(folder, 'node_modules', name));
const { MessageReader, MessageWriter } = load('@foxglove/rosmsg2-serialization');
const { ros2humble, ros2jazzy } = load('@foxglove/rosmsg-msgs-common');

/** The definition of a type, and those of all types that it has. */
function definitionsOf(name, all, found = []) {
  const definition = all[name.replace('/msg/', '/')] ?? all[name];
  if (definition === undefined) throw new Error(`ROS 2 has no ${name}`);
  if (found.some(one => one.name === definition.name)) return found;
  found.push(definition);
  for (const field of definition.definitions) {
    if (field.isComplex) definitionsOf(field.type, all, found);
  }
  return found;
}

/** "nav_msgs::msg::dds_::Path_" is "nav_msgs/Path". */
const rosName = type => type.replace('::msg::dds_::', '/').replace(/_$/, '');

function read() {
  const messages = {};
  for (const [topic, { type, hex }] of Object.entries(JSON.parse(fs.readFileSync(file, 'utf8')))) {
    const bytes = Buffer.from(hex, 'hex');
    const texts = [ros2humble, ros2jazzy].map(all => {
      const message = new MessageReader(definitionsOf(rosName(type), all)).readMessage(bytes);
      return JSON.stringify(message, (_, value) => (ArrayBuffer.isView(value) ? [...value] : value));
    });
    if (texts[0] !== texts[1]) throw new Error(`${topic} differs between Humble and Jazzy`);
    messages[topic] = JSON.parse(texts[0]);
  }
  return JSON.stringify(messages);
}

function write() {
  const zero = { x: 0, y: 0, z: 0 };
  const odometry = {
    header: { stamp: { sec: 0, nanosec: 0 }, frame_id: 'map' },
    child_frame_id: 'robot0/base_link',
    pose: {
      pose: { position: { x: 5, y: 5, z: 0 }, orientation: { ...zero, w: 1 } },
      covariance: Array(36).fill(0),
    },
    twist: { twist: { linear: zero, angular: zero }, covariance: Array(36).fill(0) },
  };
  const writer = new MessageWriter(definitionsOf('nav_msgs/Odometry', ros2jazzy));
  return Buffer.from(writer.writeMessage(odometry)).toString('hex');
}

function map() {
  const writer = new MessageWriter(definitionsOf('nav_msgs/OccupancyGrid', ros2jazzy));
  return Buffer.from(writer.writeMessage(JSON.parse(fs.readFileSync(file, 'utf8')))).toString('hex');
}

console.log({ read, write, map }[what]());
