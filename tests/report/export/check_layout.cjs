// SPDX-License-Identifier: BSD-3-Clause
// Compares a Foxglove layout with topics of a file: check_layout.cjs LAYOUT TOPICS, which begin its lines.
const assert = require('node:assert');
const { readFileSync } = require('node:fs');
const [layoutFile, topicsFile] = process.argv.slice(2);

const text = readFileSync(layoutFile, 'utf8'),
  { configById, layout } = JSON.parse(text);
// The team of a file may be smaller than that of the layout.
const kind = topic => topic.replace(/\/agent\d+\//, '/agent…/');
const topics = new Set(
  readFileSync(topicsFile, 'utf8')
    .split('\n')
    .filter(Boolean)
    .map(line => kind(line.split(' ')[0])),
);
const named = new Set([...text.matchAll(/"(\/[\w/]+)[."]/g)].map(([, topic]) => kind(topic)));
assert.deepEqual([...named].sort(), [...topics].sort());
for (const panel of Object.keys(configById)) assert.ok(JSON.stringify(layout).includes(`"${panel}"`), panel);
