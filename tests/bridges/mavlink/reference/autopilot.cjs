// SPDX-License-Identifier: BSD-3-Clause
// The mock autopilot of vehicle.cjs at a UDP port, by this machine's clock:
//
//   autopilot.cjs FOLDER PORT [--system N] [--make px4|ardupilot] [--body copter|rover|wing]
//                 [--at LAT,LON] [--to PORT] [--patience SECONDS|never] [--stubborn yes]
//
// FOLDER has node_modules. It speaks MAVLink with all who send to UDP port PORT of this host, and with --to.
// It passes frames between them, as routers do. A datagram that begins with "pilot " is a pilot's order; the
// answer is the vehicle's state as JSON:
//
//   pilot state | arm | disarm | takeoff METRES | mode NAME | fly NORTH EAST | jump METRES | silent
//     | battery PERCENT | land
//         | fence refuse|shift|forget
//
// An order that ends in "#NUMBER" is obeyed once, and its answer has it.
const { createRequire } = require('node:module');
const dgram = require('node:dgram');
const { Autopilot, STEP } = require('./vehicle.cjs');
const mavlink = createRequire(require('node:path').resolve(process.argv[2]) + '/')('node-mavlink');

const options = {};
for (let i = 4; i + 1 < process.argv.length; i += 2) options[process.argv[i].slice(2)] = process.argv[i + 1];

const clients = new Map(); // address → the step at which it was last heard
const socket = dgram.createSocket('udp4');
const started = process.hrtime.bigint();

function sendTo(buffer, client) {
  const [host, port] = client.split(' ');
  socket.send(buffer, Number(port), host);
}

const vehicle = new Autopilot(
  mavlink,
  options,
  () => process.hrtime.bigint() - started,
  frame => {
    for (const client of clients.keys()) sendTo(frame, client);
  },
);

socket.on('message', (data, from) => {
  if (data.toString('latin1', 0, 6) === 'pilot ') {
    vehicle.obey(data.toString('utf8', 6));
    socket.send(JSON.stringify(vehicle.state), from.port, from.address);
    return;
  }
  const client = `${from.address} ${from.port}`;
  const { steps } = vehicle.state;
  clients.set(client, Math.max(steps, clients.get(client) ?? 0));
  for (const [other, heard] of clients) {
    if (steps - heard > 10 / STEP) clients.delete(other);
    else if (other !== client) sendTo(data, other);
  }
  vehicle.state.drivers = clients.size;
  vehicle.write(data);
});
socket.on('error', problem => {
  console.error(problem.message);
  process.exit(1);
});
socket.bind(Number(process.argv[3]), '127.0.0.1', () => {
  console.log(
    `system ${vehicle.system} (${vehicle.options.make}, ${vehicle.options.body}) listens at ` +
      `udp:127.0.0.1:${process.argv[3]}`,
  );
  if (options.to) clients.set(`127.0.0.1 ${options.to}`, Infinity);
  setInterval(() => vehicle.step(), STEP * 1000);
});
