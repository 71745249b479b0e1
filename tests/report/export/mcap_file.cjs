// SPDX-License-Identifier: BSD-3-Clause
// Reads any MCAP file with the reference reader, and the tables of a record.
const assert = require('node:assert');
const {
  readFileSync,
  promises: { open },
} = require('node:fs');

const core = reader => require(`${reader}/node_modules/@mcap/core/dist/cjs`);

/** The rows of a table of a run, as numbers by column. */
exports.tableOf = (runDir, name) => {
  const [head, ...lines] = readFileSync(`${runDir}/${name}`, 'utf8').trimEnd().split('\n');
  return lines.map(line =>
    Object.fromEntries(line.split(',').map((value, i) => [head.split(',')[i], Number(value)])),
  );
};

/**
 * The messages of each topic, by the file's index. `begin(mcap)` sees the file's header and schemas, and
 * returns what reads a message: (message, channel, schema) => value.
 */
exports.readTopics = async (reader, file, begin) => {
  const handle = await open(file),
    { size } = await handle.stat();
  const readable = {
    size: async () => BigInt(size),
    read: async (offset, length) => {
      const bytes = new Uint8Array(Number(length));
      await handle.read(bytes, 0, Number(length), Number(offset));
      return bytes;
    },
  };
  const mcap = await core(reader).McapIndexedReader.Initialize({ readable });
  const valueOf = begin(mcap),
    topics = new Map();
  for await (const message of mcap.readMessages()) {
    const channel = mcap.channelsById.get(message.channelId),
      schema = mcap.schemasById.get(channel.schemaId);
    const topic = topics.get(channel.topic) ?? { schema: schema.name, messages: [] };
    topic.messages.push({ time: message.logTime, value: valueOf(message, channel, schema) });
    topics.set(channel.topic, topic);
  }
  const metadata = [];
  for await (const one of mcap.readMetadata()) metadata.push(one);
  await handle.close();
  return { topics, statistics: mcap.statistics, metadata };
};

/** How many messages there are, by every byte in the order of the file; checks the sums. */
exports.countStreamed = (reader, file) => {
  const stream = new (core(reader).McapStreamReader)({ validateCrcs: true });
  stream.append(readFileSync(file));
  let messages = 0;
  for (let record; (record = stream.nextRecord()); ) messages += record.type === 'Message';
  assert.ok(stream.done());
  return messages;
};
