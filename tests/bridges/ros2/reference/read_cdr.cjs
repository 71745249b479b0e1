// SPDX-License-Identifier: BSD-3-Clause
// Prints recorded messages as JSON, read by Foxglove's reader with the definitions of ROS 2: read_cdr FOLDER FILE.
const fs = require('fs');
const path = require('path');

const [folder, file] = process.argv.slice(2);
const load = name => require(path.join(folder, 'node_modules', name));
const { MessageReader } = load('@foxglove/rosmsg2-serialization');
const { ros2humble, ros2jazzy } = load('@foxglove/rosmsg-msgs-common');

/** The definition of a type, and those of all types that it has. */
function definitionsOf(name, all, found = []) {
  const short = name.replace('/msg/', '/');
  const definition = all[short] ?? all[name];
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
console.log(JSON.stringify(messages));
