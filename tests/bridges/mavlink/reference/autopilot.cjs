// SPDX-License-Identifier: BSD-3-Clause
// A mock of an autopilot with its vehicle, written with node-mavlink, which shares no code with our driver:
//
//   autopilot.cjs FOLDER PORT [--system N] [--make px4|ardupilot] [--body copter|rover|wing]
//                 [--at LAT,LON] [--to PORT] [--patience SECONDS]
//
// FOLDER has node_modules. It speaks MAVLink with all who send to UDP port PORT of this host, and with --to.
// It passes frames between them, as routers do. A datagram that begins with "pilot " is a pilot's order; the
// answer is the vehicle's state as JSON:
//
//   pilot state | arm | disarm | takeoff METRES | mode NAME | fly NORTH EAST | jump METRES | silent | land
//
// An order that ends in "#NUMBER" is obeyed once, and its answer has it. --patience replaces both time-outs.
//
// Motion and time-outs count steps of 20 ms, so they stand while this process gets no processor time. Only
// messages have the time of a clock.
const { createRequire } = require('node:module');
const dgram = require('node:dgram');
const mavlink = createRequire(require('node:path').resolve(process.argv[2]) + '/')('node-mavlink');

const options = { system: '1', make: 'px4', body: 'copter', at: '47.6535,9.175' };
for (let i = 4; i + 1 < process.argv.length; i += 2) options[process.argv[i].slice(2)] = process.argv[i + 1];
const system = Number(options.system);
const px4 = options.make === 'px4';
const [LATITUDE, LONGITUDE] = options.at.split(',').map(Number);
const HOME_ALTITUDE = 402.5;

const STEP = 0.02; // s
const RESPONSE = 0.3; // s, in which the velocity follows
const OFFBOARD_TIMEOUT = (options.patience ?? 0.5) / STEP; // steps without a setpoint, as PX4 has them
const GUIDED_TIMEOUT = (options.patience ?? 3) / STEP; // ArduPilot then stands

const MODES = px4
  ? { MANUAL: 1, POSCTL: 3, AUTO: 4, OFFBOARD: 6 }
  : options.body === 'rover'
    ? { MANUAL: 0, HOLD: 4, LOITER: 5, GUIDED: 15 }
    : { STABILIZE: 0, GUIDED: 4, LOITER: 5, RTL: 6, LAND: 9 };
const TYPES = { copter: 2, rover: 10, wing: 1 };
const external = px4 ? 'OFFBOARD' : 'GUIDED';
const custom = mode => (px4 ? MODES[mode] << 16 : MODES[mode]);

const state = {
  mode: px4 ? 'POSCTL' : Object.keys(MODES)[0],
  armed: false,
  air: options.body === 'rover',
  north: 0,
  east: 0,
  up: 0,
  velocity: [0, 0, 0], // north, east, up
  setpoint: [0, 0, 0],
  steps: 0,
  setpoints: 0,
  gap: 0, // the most steps between two setpoints in the external mode
  timeouts: 0,
  disobeyed: 0, // setpoints that moved, long after the pilot had not allowed it
  stood: 0, // setpoints of velocity 0 since the pilot's last order
  refused: 0, // orders of a driver that this autopilot refused
  orders: [], // a driver's commands to arm, to take off, to change modes
  path: 0, // m, flown in the external mode
  drivers: 0,
};
let lastSetpoint = -1e9;
let heartbeatsSince = 0; // the last order of the pilot
let byHand = [0, 0];
let takeoff = 0;
let silent = false;
let offset = 0; // m, of reported positions

const clients = new Map(); // address → when it was last heard
const socket = dgram.createSocket('udp4');
const protocol = new mavlink.MavLinkProtocolV2(system, 1);
let sequence = 0;

function sendTo(buffer, client) {
  const [host, port] = client.split(' ');
  socket.send(buffer, Number(port), host);
}

function send(message) {
  if (silent) return;
  const buffer = protocol.serialize(message, sequence++ & 255);
  for (const client of clients.keys()) sendTo(buffer, client);
}

const make = (clazz, fields) => Object.assign(new clazz(), fields);
const allowed = () => state.mode === external && state.armed && state.air;
const say = text => send(make(mavlink.common.StatusText, { severity: 4, text }));
const started = process.hrtime.bigint();
let nextPosition = 0; // ms
let nextLanded = 0;
let nextHeartbeat = 0;
const bootNs = () => process.hrtime.bigint() - started;

function heartbeat() {
  heartbeatsSince += 1;
  send(
    make(mavlink.minimal.Heartbeat, {
      type: TYPES[options.body],
      autopilot: px4 ? 12 : 3,
      baseMode: (state.armed ? 128 : 0) | 1,
      customMode: custom(state.mode),
      systemStatus: state.armed ? 4 : 3,
      mavlinkVersion: 3,
    }),
  );
}

function position() {
  const metres = 6378137 * (Math.PI / 180);
  const north = state.north + offset;
  send(
    make(mavlink.common.GlobalPositionInt, {
      timeBootMs: Number(bootNs() / 1000000n),
      lat: Math.round((LATITUDE + north / metres) * 1e7),
      lon: Math.round((LONGITUDE + state.east / metres / Math.cos((LATITUDE * Math.PI) / 180)) * 1e7),
      alt: Math.round((HOME_ALTITUDE + state.up) * 1000),
      relativeAlt: Math.round(state.up * 1000),
      vx: Math.round(state.velocity[0] * 100),
      vy: Math.round(state.velocity[1] * 100),
      vz: Math.round(-state.velocity[2] * 100),
      hdg: 65535,
    }),
  );
}

function wanted() {
  if (!state.armed) return [0, 0, 0];
  if (takeoff > 0) return [0, 0, state.up < takeoff ? 5 : 0];
  if (state.mode !== external) return [...byHand, 0];
  return state.setpoint;
}

function step() {
  state.steps += 1;
  const since = state.steps - lastSetpoint;
  if (state.mode === external && px4 && since > OFFBOARD_TIMEOUT) {
    state.timeouts += 1;
    state.mode = 'AUTO';
    say('Offboard lost');
  }
  if (state.mode === external && !px4 && since > GUIDED_TIMEOUT) state.setpoint = [0, 0, 0];
  const target = wanted();
  const share = 1 - Math.exp(-STEP / RESPONSE);
  state.velocity = state.velocity.map((v, i) => v + share * (target[i] - v));
  if (!state.armed) state.velocity = [0, 0, 0];
  const [north, east, up] = state.velocity;
  if (state.air) {
    state.north += north * STEP;
    state.east += east * STEP;
    if (state.mode === external) state.path += Math.hypot(north, east) * STEP;
  }
  if (options.body !== 'rover') state.up = Math.max(0, state.up + up * STEP);
  if (state.up > 0.5) state.air = true;
  if (takeoff > 0 && state.up >= takeoff - 0.5) takeoff = 0;
  const now = Number(bootNs() / 1000000n);
  if (now >= nextPosition) {
    nextPosition = now + 40;
    position();
  }
  if (now >= nextLanded) {
    nextLanded = now + 500;
    send(make(mavlink.common.ExtendedSysState, { vtolState: 0, landedState: state.air ? 2 : 1 }));
  }
  if (now >= nextHeartbeat) {
    nextHeartbeat = now + 1000;
    heartbeat();
  }
}

function takeSetpoint(m) {
  state.setpoints += 1;
  const velocityOnly = m.typeMask === 0b110111000111 && m.coordinateFrame === 1;
  if (!velocityOnly || m.targetSystem !== system) {
    state.refused += 1;
    return;
  }
  if (state.mode === external) state.gap = Math.max(state.gap, state.steps - lastSetpoint);
  lastSetpoint = state.steps;
  state.setpoint = [m.vx, m.vy, -m.vz];
  if (m.vx === 0 && m.vy === 0) state.stood += 1;
  if (!allowed() && heartbeatsSince >= 2 && (m.vx !== 0 || m.vy !== 0)) state.disobeyed += 1;
}

// A driver's, or the pilot's, wish for a mode.
function setMode(name) {
  const refused =
    !(name in MODES) || (px4 && name === external && state.steps - lastSetpoint > OFFBOARD_TIMEOUT);
  if (refused) {
    say(`Switching to ${name} is currently not possible`);
    return false;
  }
  if (name === external) lastSetpoint = Math.max(lastSetpoint, state.steps - 1);
  state.mode = name;
  return true;
}

function takeCommand(m) {
  let result = 0;
  if (m.command === 176) {
    state.orders.push('mode');
    const name = Object.keys(MODES).find(one => MODES[one] === m._param2);
    result = name && !options.stubborn && setMode(name) ? 0 : 2;
  } else if (m.command === 400) {
    state.orders.push('arm');
    state.armed = m._param1 === 1;
  } else if (m.command === 22) {
    state.orders.push('takeoff');
    takeoff = m._param7;
  } else if (m.command !== 511) {
    result = 3;
  }
  send(make(mavlink.common.CommandAck, { command: m.command, result }));
}

const ORDERS = {
  state() {},
  arm: () => (state.armed = true),
  disarm: () => (state.armed = false),
  takeoff: metres => (takeoff = Number(metres)),
  mode: name => setMode(name),
  fly: (north, east) => (byHand = [Number(north), Number(east)]),
  jump: metres => (offset += Number(metres)),
  silent: () => (silent = true),
  land: () => ((state.up = 0), (state.air = false)),
};

function obeyPilot(text, from) {
  const [, order, ...rest] = text.trim().split(' ');
  const repeated = text.includes('#') && text === state.order;
  if (order !== 'state' && !repeated) heartbeatsSince = state.stood = 0;
  if (order in ORDERS && !repeated) ORDERS[order](...rest);
  state.order = text;
  socket.send(JSON.stringify(state), from.port, from.address);
}

function takeFrame(packet) {
  const set = { ...mavlink.minimal.REGISTRY, ...mavlink.common.REGISTRY };
  const clazz = set[packet.header.msgid];
  if (!clazz) return;
  const message = packet.protocol.data(packet.payload, clazz);
  if (message instanceof mavlink.common.SetPositionTargetLocalNed) takeSetpoint(message);
  if (message instanceof mavlink.common.CommandLong) takeCommand(message);
  if (message instanceof mavlink.common.TimeSync && message.tc1 === 0n) {
    const tc1 = bootNs();
    send(make(mavlink.common.TimeSync, { tc1, ts1: message.ts1 }));
  }
}

const splitter = new mavlink.MavLinkPacketSplitter();
splitter.pipe(new mavlink.MavLinkPacketParser()).on('data', takeFrame);
socket.on('message', (data, from) => {
  if (data.toString('latin1', 0, 6) === 'pilot ') return obeyPilot(data.toString(), from);
  const client = `${from.address} ${from.port}`;
  clients.set(client, Math.max(state.steps, clients.get(client) ?? 0));
  for (const [other, heard] of clients) {
    if (state.steps - heard > 10 / STEP) clients.delete(other);
    else if (other !== client) sendTo(data, other);
  }
  state.drivers = clients.size;
  splitter.write(data);
});
socket.on('error', problem => {
  console.error(problem.message);
  process.exit(1);
});
socket.bind(Number(process.argv[3]), '127.0.0.1', () => {
  console.log(
    `system ${system} (${options.make}, ${options.body}) listens at udp:127.0.0.1:${process.argv[3]}`,
  );
  if (options.to) clients.set(`127.0.0.1 ${options.to}`, Infinity);
  setInterval(step, STEP * 1000);
});
