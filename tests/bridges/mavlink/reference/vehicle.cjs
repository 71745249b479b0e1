// SPDX-License-Identifier: BSD-3-Clause
// A mock of an autopilot with its vehicle, written with node-mavlink, which shares no code with our driver.
//
// Motion and time-outs count steps of 20 ms, whatever makes them. Only messages have the time of a clock.
//
// options: system, make (px4, ardupilot), body (copter, rover, wing), at ("LAT,LON"), patience (replaces both
// time-outs [s]; "never": there is none), stubborn (it denies drivers each mode). A body of another program
// may move: step(body) has its place and velocity, and wanted() is what the autopilot wants of it.
// clock() → ns as a BigInt; send(frame) passes a frame to all who are on the link.
const HOME_ALTITUDE = 402.5;
const STEP = 0.02; // s
const RESPONSE = 0.3; // s, in which the velocity follows
const TYPES = { copter: 2, rover: 10, wing: 1 };
const FENCE = 1; // MAV_MISSION_TYPE
const METRES = 6378137 * (Math.PI / 180); // of a degree
const make = (clazz, fields) => Object.assign(new clazz(), fields);

function modesOf(options) {
  if (options.make === 'px4') return { MANUAL: 1, POSCTL: 3, AUTO: 4, OFFBOARD: 6 };
  if (options.body === 'rover') return { MANUAL: 0, HOLD: 4, LOITER: 5, GUIDED: 15 };
  return { STABILIZE: 0, GUIDED: 4, LOITER: 5, RTL: 6, LAND: 9 };
}

class Autopilot {
  constructor(mavlink, wishes, clock, send) {
    const options = { system: '1', make: 'px4', body: 'copter', at: '47.6535,9.175', ...wishes };
    this.mavlink = mavlink;
    this.options = options;
    this.clock = clock;
    this.sendFrame = send;
    this.system = Number(options.system);
    this.px4 = options.make === 'px4';
    this.home = options.at.split(',').map(Number);
    const patience =
      options.patience === 'never' ? Infinity : Number(options.patience ?? (this.px4 ? 0.5 : 1));
    this.timeout = patience / STEP; // steps without a setpoint; ArduPilot then stands
    this.modes = modesOf(options);
    this.external = this.px4 ? 'OFFBOARD' : 'GUIDED';
    this.state = {
      mode: this.px4 ? 'POSCTL' : Object.keys(this.modes)[0],
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
      fence: 0, // items
    };
    this.lastSetpoint = -1e9;
    this.inMode = false; // whether a setpoint has come since the external mode was chosen
    this.heartbeatsSince = 0; // the last order of the pilot
    this.byHand = [0, 0];
    this.takeoff = 0;
    this.silent = false;
    this.battery = -1; // %, not reported
    this.offset = 0; // m, of reported positions
    this.fence = [];
    this.upload = null;
    this.fenceFault = ''; // refuse, shift, forget
    this.due = { position: 0, landed: 0, heartbeat: 0 }; // ms
    this.protocol = new mavlink.MavLinkProtocolV2(this.system, 1);
    this.sequence = 0;
    this.splitter = new mavlink.MavLinkPacketSplitter();
    this.splitter.pipe(new mavlink.MavLinkPacketParser()).on('data', packet => this.takeFrame(packet));
    this.set = { ...mavlink.minimal.REGISTRY, ...mavlink.common.REGISTRY };
  }

  // ---- what it sends ----

  send(message) {
    if (!this.silent) this.sendFrame(this.protocol.serialize(message, this.sequence++ & 255));
  }

  say(text) {
    this.send(make(this.mavlink.common.StatusText, { severity: 4, text }));
  }

  heartbeat() {
    const { state } = this;
    this.heartbeatsSince += 1;
    const mode = this.modes[state.mode];
    this.send(
      make(this.mavlink.minimal.Heartbeat, {
        type: TYPES[this.options.body],
        autopilot: this.px4 ? 12 : 3,
        baseMode: (state.armed ? 128 : 0) | 1,
        customMode: this.px4 ? mode << 16 : mode,
        systemStatus: state.armed ? 4 : 3,
        mavlinkVersion: 3,
      }),
    );
    if (this.battery >= 0) this.reportBattery();
  }

  // PX4 and ArduPilot send both messages. SYS_STATUS of this one knows nothing.
  reportBattery() {
    const voltages = [3900, 3900, 3900, 3900].concat(Array(6).fill(65535));
    this.send(make(this.mavlink.common.SysStatus, { batteryRemaining: -1 }));
    this.send(make(this.mavlink.common.BatteryStatus, { batteryRemaining: this.battery, voltages }));
  }

  place(north) {
    const [latitude, longitude] = this.home;
    const east = this.state.east / METRES / Math.cos((latitude * Math.PI) / 180);
    return [latitude + north / METRES, longitude + east];
  }

  position(ms) {
    const { state } = this;
    const [latitude, longitude] = this.place(state.north + this.offset);
    this.send(
      make(this.mavlink.common.GlobalPositionInt, {
        timeBootMs: ms,
        lat: Math.round(latitude * 1e7),
        lon: Math.round(longitude * 1e7),
        alt: Math.round((HOME_ALTITUDE + state.up) * 1000),
        relativeAlt: Math.round(state.up * 1000),
        vx: Math.round(state.velocity[0] * 100),
        vy: Math.round(state.velocity[1] * 100),
        vz: Math.round(-state.velocity[2] * 100),
        hdg: 65535,
      }),
    );
  }

  report() {
    const ms = Number(this.clock() / 1000000n);
    const falls = (what, period) => {
      if (ms < this.due[what]) return false;
      this.due[what] = ms + period;
      return true;
    };
    if (falls('position', 40)) this.position(ms);
    const landedState = this.state.air ? 2 : 1;
    if (falls('landed', 500))
      this.send(make(this.mavlink.common.ExtendedSysState, { vtolState: 0, landedState }));
    if (falls('heartbeat', 1000)) this.heartbeat();
  }

  // ---- how it moves ----

  wanted() {
    const { state } = this;
    if (!state.armed) return [0, 0, 0];
    if (this.takeoff > 0) return [0, 0, state.up < this.takeoff ? 5 : 0];
    return state.mode === this.external ? state.setpoint : [...this.byHand, 0];
  }

  // With the vehicle's own dynamics.
  move() {
    const { state } = this;
    const target = this.wanted();
    const share = 1 - Math.exp(-STEP / RESPONSE);
    state.velocity = state.velocity.map((v, i) => v + share * (target[i] - v));
    if (!state.armed) state.velocity = [0, 0, 0];
    const [north, east, up] = state.velocity;
    if (state.air) {
      state.north += north * STEP;
      state.east += east * STEP;
    }
    if (this.options.body !== 'rover') state.up = Math.max(0, state.up + up * STEP);
  }

  // body: north, east and up of its start, and its velocity in these directions
  step(body) {
    const { state } = this;
    state.steps += 1;
    const since = state.steps - this.lastSetpoint;
    if (state.mode === this.external && since > this.timeout) this.lose();
    if (body) [state.north, state.east, state.up, ...state.velocity] = body;
    else this.move();
    const [north, east] = state.velocity;
    if (state.air && state.mode === this.external) state.path += Math.hypot(north, east) * STEP;
    if (state.up > 0.5) state.air = true;
    if (this.takeoff > 0 && state.up >= this.takeoff - 0.5) this.takeoff = 0;
    this.report();
  }

  // No setpoint has come for too long.
  lose() {
    const { state } = this;
    if (this.inMode || this.px4) state.timeouts += 1;
    this.inMode = false;
    state.setpoint = [0, 0, 0];
    if (!this.px4) return;
    state.mode = 'AUTO';
    this.say('Offboard lost');
  }

  // ---- a driver's messages ----

  allowed() {
    return this.state.mode === this.external && this.state.armed && this.state.air;
  }

  takeSetpoint(m) {
    const { state } = this;
    state.setpoints += 1;
    const velocityOnly = m.typeMask === 0b110111000111 && m.coordinateFrame === 1;
    if (!velocityOnly || m.targetSystem !== this.system) {
      state.refused += 1;
      return;
    }
    if (this.inMode) state.gap = Math.max(state.gap, state.steps - this.lastSetpoint);
    this.inMode = state.mode === this.external;
    this.lastSetpoint = state.steps;
    state.setpoint = [m.vx, m.vy, -m.vz];
    const moves = m.vx !== 0 || m.vy !== 0;
    if (!moves) state.stood += 1;
    if (!this.allowed() && this.heartbeatsSince >= 2 && moves) state.disobeyed += 1;
  }

  // A driver's, or the pilot's, wish for a mode.
  setMode(name) {
    const { state } = this;
    const since = state.steps - this.lastSetpoint;
    const needs = Math.min(this.timeout, 1e6); // a setpoint must have come at all
    if (!(name in this.modes) || (this.px4 && name === this.external && since > needs)) {
      this.say(`Switching to ${name} is currently not possible`);
      return false;
    }
    this.inMode = false;
    state.mode = name;
    return true;
  }

  takeCommand(m) {
    const { state } = this;
    let result = 0;
    if (m.command === 176) {
      state.orders.push('mode');
      const name = Object.keys(this.modes).find(one => this.modes[one] === m._param2);
      result = name && !this.options.stubborn && this.setMode(name) ? 0 : 2;
    } else if (m.command === 400) {
      state.orders.push('arm');
      state.armed = m._param1 === 1;
    } else if (m.command === 22) {
      state.orders.push('takeoff');
      this.takeoff = m._param7;
    } else if (m.command === 401) {
      result = state.armed ? 1 : 0; // an armed autopilot rejects the checks
    } else if (m.command !== 511) {
      result = 3;
    }
    this.send(make(this.mavlink.common.CommandAck, { command: m.command, result }));
  }

  // ---- the mission protocol, for fences only ----

  answer(clazz, fields) {
    const to = { targetSystem: this.system, targetComponent: 191, missionType: FENCE };
    this.send(make(this.mavlink.common[clazz], { ...to, ...fields }));
  }

  takeFence(m) {
    const { common } = this.mavlink;
    if (m.missionType !== FENCE || m.targetSystem !== this.system) return;
    if (m instanceof common.MissionCount) {
      if (this.fenceFault === 'refuse') return this.answer('MissionAck', { type: 4 });
      this.upload = { count: m.count, items: [] };
      this.answer('MissionRequestInt', { seq: 0 });
    } else if (m instanceof common.MissionItemInt) {
      this.takeItem(m);
    } else if (m instanceof common.MissionRequestList) {
      this.answer('MissionCount', { count: this.fence.length });
    } else if (m instanceof common.MissionRequestInt && m.seq < this.fence.length) {
      this.answer('MissionItemInt', this.fence[m.seq]);
    }
  }

  takeItem(m) {
    if (!this.upload && m.seq === this.fence.length - 1) return this.answer('MissionAck', { type: 0 });
    if (!this.upload) return;
    if (m.seq !== this.upload.items.length)
      return this.answer('MissionRequestInt', { seq: this.upload.items.length });
    const { command, param1, x, y, seq } = m;
    this.upload.items.push({ command, param1, x, y, seq, frame: m.frame });
    if (seq + 1 < this.upload.count) return this.answer('MissionRequestInt', { seq: seq + 1 });
    this.fence = this.upload.items;
    this.upload = null;
    if (this.fenceFault === 'shift') this.fence[2].x += 20;
    if (this.fenceFault === 'forget') this.fence.pop();
    this.state.fence = this.fence.length;
    this.answer('MissionAck', { type: 0 });
  }

  takeFrame(packet) {
    const clazz = this.set[packet.header.msgid];
    if (!clazz) return;
    const { common } = this.mavlink;
    const message = packet.protocol.data(packet.payload, clazz);
    if (message instanceof common.SetPositionTargetLocalNed) this.takeSetpoint(message);
    if (message instanceof common.CommandLong) this.takeCommand(message);
    if (clazz.MSG_NAME.startsWith('MISSION_')) this.takeFence(message);
    if (message instanceof common.TimeSync && message.tc1 === 0n)
      this.send(make(common.TimeSync, { tc1: this.clock(), ts1: message.ts1 }));
  }

  // Bytes of the link.
  write(data) {
    this.splitter.write(data);
  }

  // ---- the pilot ----

  // An order that ends in "#NUMBER" is obeyed once.
  obey(text) {
    const { state } = this;
    const [order, ...rest] = text.trim().split(' ');
    const repeated = text.includes('#') && `pilot ${text}` === state.order;
    if (order !== 'state' && !repeated) this.heartbeatsSince = state.stood = 0;
    const orders = {
      arm: () => (state.armed = true),
      disarm: () => (state.armed = false),
      takeoff: metres => (this.takeoff = Number(metres)),
      mode: name => this.setMode(name),
      fly: (north, east) => (this.byHand = [Number(north), Number(east)]),
      jump: metres => (this.offset += Number(metres)),
      silent: () => (this.silent = true),
      battery: percent => (this.battery = Number(percent)),
      land: () => ((state.up = 0), (state.air = false)),
      fence: fault => (this.fenceFault = fault),
    };
    if (order in orders && !repeated) orders[order](...rest);
    state.order = `pilot ${text}`;
  }
}

module.exports = { Autopilot, STEP };
