// SPDX-License-Identifier: BSD-3-Clause
// Mock autopilots of vehicle.cjs whose time is that of another program: fleet.cjs FOLDER. FOLDER has
// node_modules. The first line of the input has the options of all vehicles as a JSON list. Each further
// line is a step of 20 ms, and is answered by a line:
//
//   { "ns": TIME, "frames": [[VEHICLE, HEX], …], "pilot": [[VEHICLE, ORDER], …], "states": true|false,
//     "bodies": [[NORTH, EAST, UP, and the velocity], …] }
//   { "frames": [[VEHICLE, HEX], …], "at": [[LAT, LON, UP], …], "states": [STATE, …],
//     "wanted": [[NORTH, EAST, UP], …] }
//
// Frames and orders of a line count before its step. Without bodies the vehicles move by their own dynamics.
const { createRequire } = require('node:module');
const readline = require('node:readline');
const { Autopilot } = require('./vehicle.cjs');
const mavlink = createRequire(require('node:path').resolve(process.argv[2]) + '/')('node-mavlink');

let now = 0n;
let sent = [];
let vehicles = null;

// Streams deliver on the ticks before the next turn of the event loop.
const turn = () => new Promise(done => setImmediate(done));

async function main() {
  for await (const line of readline.createInterface({ input: process.stdin })) {
    const read = JSON.parse(line);
    if (!vehicles) {
      vehicles = read.map(
        (options, i) =>
          new Autopilot(
            mavlink,
            options,
            () => now,
            frame => sent.push([i, frame.toString('hex')]),
          ),
      );
      continue;
    }
    now = BigInt(read.ns);
    for (const [i, hex] of read.frames) vehicles[i].write(Buffer.from(hex, 'hex'));
    await turn();
    await turn();
    for (const [i, order] of read.pilot) vehicles[i].obey(order);
    for (const [i, vehicle] of vehicles.entries()) vehicle.step(read.bodies[i]);
    const at = vehicles.map(vehicle => [...vehicle.place(vehicle.state.north), vehicle.state.up]);
    const states = read.states ? vehicles.map(vehicle => vehicle.state) : [];
    const wanted = vehicles.map(vehicle => vehicle.wanted());
    process.stdout.write(JSON.stringify({ frames: sent, at, states, wanted }) + '\n');
    sent = [];
  }
}

main().catch(problem => {
  console.error(problem);
  process.exit(1);
});
