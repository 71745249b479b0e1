// SPDX-License-Identifier: BSD-3-Clause
// Fetches MCAP's reference reader from npm's registry: fetch_reader.mjs FOLDER. Each package is pinned by
// the SHA-512 of its tarball, so nothing else can come; what is there already is only checked.
import { createHash } from 'node:crypto';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, renameSync, writeFileSync } from 'node:fs';

const PACKAGES = [
  ['@mcap/core', '2.2.2', 'W4NFiyqQlJsNjw8JxAAQ872u0xLWJy0GFC3YFm8bTLbNs+HdDWe8DwBqznr0MGYpWtw+AX8XzHWB5Y9rLEGJJg=='],
  ['@foxglove/crc', '0.0.3', 'DjIZsnL3CyP/yQ/vUYA9cjrD0a/8YXejI5ZmsaOiT16cLfZcTwaCxIN01/ys4jsy+dZCQ/9DnWFn7AEFbiMDaA=='],
  ['heap-js', '2.7.1', 'EQfezRg0NCZGNlhlDR3Evrw1FVL2G3LhU7EgPoxufQKruNBSYA8MiRPHeWbU+36o+Fhel0wMwM+sLEiBAlNLJA=='],
  ['tslib', '2.8.1', 'oJFu94HQb+KVduSUQL7wnpmqnfmLsOA/nAh6b6EH0wCEoK0/mPeXU6c3wKDV83MkOuHPRHtSXKKU99IBazS/2w=='],
];
const folder = process.argv[2];
const registry = (process.env.npm_config_registry ?? 'https://registry.npmjs.org').replace(/\/$/, '');

for (const [name, version, sha512] of PACKAGES) {
  const tarball = `${folder}/${name.replace(/.*\//, '')}-${version}.tgz`, place = `${folder}/node_modules/${name}`;
  mkdirSync(place, { recursive: true });
  if (!existsSync(tarball)) {
    const answer = await fetch(`${registry}/${name}/-/${name.replace(/.*\//, '')}-${version}.tgz`);
    if (!answer.ok) throw new Error(`${answer.url}: ${answer.status}`);
    writeFileSync(`${tarball}.part`, Buffer.from(await answer.arrayBuffer()));
    renameSync(`${tarball}.part`, tarball);
  }
  const found = createHash('sha512').update(readFileSync(tarball)).digest('base64');
  if (found !== sha512) throw new Error(`${tarball}: its SHA-512 is ${found}, not ${sha512}; remove it`);
  execFileSync('tar', ['-xzf', tarball, '-C', place, '--strip-components=1']);
}
