// SPDX-License-Identifier: BSD-3-Clause
// Explains the labels of a run's page in plain words, for their tooltips and the list in the help.
import { S } from './state.js';
import { $, element } from '../text.js';

const PHI =
  'How far the time that the team has spent at each place is from the target. ' +
  '0 is a perfect match; less is better.';

const TOP = {
  state: 'What the mission does at the chosen time.',
  time: 'Mission time. Ticks of a pause do not count.',
  'φ²': `The ergodic metric. ${PHI}`,
  found:
    'How likely the team has found, by the chosen time, an object that stands still somewhere in the ' +
    'target. It begins again with each new target.',
  agents: 'Agents that report, of those that the mission has.',
};
const MAP = {
  Target:
    'Where the target wants the team to spend its time. ' +
    'While a team runs, “New target” or the command “ergocast amend --target FILE” gives it another one.',
  'New target':
    'Draws peaks and polygons over the present target, and shows what they would change. ' +
    'With control you send them; without, the page shows the command.',
  'New zone':
    'Draws a polygon that the team leaves for a time, and shows which agents are inside. ' +
    'With control you send it; without, the page shows the command.',
  zone:
    'A red area: a part of the domain that is closed for a time. Its number is that of the amendment. ' +
    'The outline is dashed while agents may still be on their way out. “Cancel zone” ends it.',
  amendment:
    'The target at the chosen time is no longer that of the plan. ' +
    'Each moment counts against the target of its time.',
  Achieved: 'Where the team has spent its time up to the chosen time.',
  Difference: 'Where the team has been too little or too much: this is what φ² adds up.',
  Missed:
    'Where an object may be that has not been found up to the chosen time: the stronger a colour, ' +
    'the likelier. At the start this is the target.',
  scale: 'A colour shows how many times denser a place is than the average of the domain.',
  Trail: 'How much of its way is drawn behind each agent.',
  Course:
    'The thin line from an agent ends where its present velocity leads in that time. ' +
    'The velocity of a point is its mean of the last second. An agent that stands has no line.',
  'dashed arrow':
    'Where an agent’s present command leads in the time of Course: the velocity that its program sends to ' +
    'its vehicle now, with what bodies, edges and zones leave of it. ' +
    'A point’s is the mean of the last second. ' +
    'In a team of more than 12 only chosen agents have it. Records do not have it.',
  Distance:
    'A ring around each agent, to scale. Its radius is half the distance that agents keep: ' +
    'where two rings touch, the distance is reached. In a team of more than 12 only chosen agents have it.',
  'Radio range': 'Teammates inside an agent’s circle receive what the agent sends.',
  'dotted circle':
    'An agent finds objects inside it. Chosen agents have it, and beside “Missed” all of a small team.',
  pin: 'Its tip is an agent’s place, and the arrow there shows its direction. Its size means nothing.',
  disc: 'An agent’s body, to scale. Its radius is half the distance that bodies keep.',
  'thick arrow': 'From an agent that has been blocked for a second or more to the one that blocks it.',
  'no-entry sign': 'An agent that an edge or a wall has blocked for a second or more.',
  cross: 'Where an agent started.',
  diamond: 'Where an agent was when it found an object: the number of the object, and when.',
  triangle:
    'A contact at its newest probability, from its newest report on: sensors have reported something ' +
    'there. A filled one is confirmed.',
  square: 'A station: where an agent is at the end of the mission.',
  'hatched area': 'The target is 0 here: it wants no agent.',
};
const CHART = {
  'Ergodic metric φ²': PHI,
  'Chance to have found an object [%]':
    'How likely the team has found an object that stands still somewhere in the target. ' +
    'It begins again with each new target.',
  'Disagreement on φ²':
    'The largest minus the smallest φ² that agents compute of what each of them knows. 0: all know the same.',
  'Oldest update': 'The time since the worst informed agent last received coverage of one of its teammates.',
  'Messages per second': 'Contributions that arrive at all agents, each second of mission time.',
  '∝ 1/t': 'A line that falls like 1/t, to compare the slope of φ² with.',
  'log t': 'Equal steps multiply the time, so the beginning has room.',
  linear: 'Equal steps add the same time.',
};
const AGENTS = {
  '#': 'The number of an agent. A click on its row chooses the agent.',
  State: 'Whether it runs, rests, goes home, charges, waits for another process, is late, silent or gone.',
  Battery: 'What is left in the battery of its vehicle. The agent goes to its station to charge it.',
  Speed: 'Over the last second.',
  Distance: 'The length of its path since the start.',
  'Oldest update':
    'The mission time since it last received coverage of the teammate that it knows least of. ' +
    'It grows when a teammate stops or messages are lost.',
  'φ² vs team':
    'How far the φ² that it computes is above (+) or below (−) the team’s median. ' +
    'Near 0 % it knows what the others know.',
  Lag: 'The longest delay of its process in the last half second. Above 100 ms the machine is too busy.',
  'Own φ²': 'φ² of the coverage that it knew at the end',
  Lost: 'Messages that teammates sent and it did not receive.',
  Dropped:
    'Datagrams that the kernel dropped before it read them: ' +
    'the machine is too slow, or the buffers are too small.',
};
const FIGURES = {
  result:
    'done: the last tick of the plan is recorded. stopped: it ended before. failed: it could not go on.',
  'φ² in modes of': 'The modes in which φ² is computed. Compare it only with φ² in the same modes.',
  'φ² first': 'At the first recorded time.',
  'φ² last': 'At the last recorded time.',
  'slope, last decade': 'The power of t that fits φ² over the last tenfold of time. −1 falls like 1/t.',
  'hidden objects found':
    'How many of the objects that the world has hidden the team has found. A diamond on the map is a find.',
  'chance to have found an object':
    'How likely the team has found an object that stands still somewhere in the target. ' +
    'The scenario’s sensor says how near an agent must be, and at which rate it then finds the object.',
  '50 % chance after [s]':
    'The time from the newest target on after which an object had been found with a probability of ½.',
  '80 % chance after [s]': 'The same with a probability of 0.8.',
  'left alone at most [s]':
    'Places with 95 % of the target were never left alone for longer: an agent’s sensor was near them.',
  'distance to the target [m]':
    'How far the time that the team has spent would have to move to be like the target: ' +
    'the sliced Wasserstein distance.',
  'way of all agents [m]': 'The lengths of all paths together.',
  ticks: 'Control steps, and the mission time that each of them takes.',
  modes: 'How many cosine waves along each axis describe coverage and target.',
  seed: 'The number from which all random numbers of the mission follow.',
  mode: 'simulate: in one process. lockstep: every tick waits for all processes. realtime: by the clock.',
  'blocked share':
    'Share of the agents’ ticks in which a body or an edge left less than a tenth of the command.',
  'longest block [s]': 'The longest time for which a body or an edge blocked one agent without a break.',
  messages: 'Sent by all agents together.',
  lost: 'Messages that others sent and agents did not receive.',
  'ticks missing': 'Ticks without a recorded position before the last one.',
  run: 'The first digits of the run’s identifier.',
  'messages per second': 'Sent by all agents together, each second of wall time.',
  'messages lost': 'Messages that others sent and agents did not receive, since the start.',
  'late commands': 'Commands that were missing when their tick ended, since the start.',
  authenticated:
    'Whether the team has a key. Without one any host on the network may have sent what is shown.',
  'shown to': 'Browsers, Foxglove and TAK: all that displays on the page’s host serve.',
};
const SECTIONS = [
  ['Top line', TOP],
  ['Map', MAP],
  ['Chart', CHART],
  ['Agents', AGENTS],
  ['Key figures', FIGURES],
];

export const meaningOf = (section, label) => ({ TOP, MAP, CHART, AGENTS, FIGURES })[section][label] ?? '';

// Elements with data-word="SECTION:label" get their tooltips; what follows in `(…)`, the key, stays.
export function explainLabels() {
  for (const node of document.querySelectorAll('[data-word]')) {
    const [section, label] = node.dataset.word.split(':'),
      key = node.title ? ` (${node.title})` : '';
    node.title = meaningOf(section, label) + key;
  }
}

// What of the map's signs this mission has.
function isShown(label) {
  const { mission } = S.run;
  const needs = {
    disc: mission.body_radius_m > 0,
    Distance: mission.body_radius_m > 0,
    'thick arrow': mission.body_radius_m > 0,
    'no-entry sign': mission.body_radius_m > 0 || mission.walls?.length > 0,
    'dashed arrow': S.live,
    pin: true,
    amendment: S.run.targets.length > 1,
    'New target': S.live,
    'New zone': S.live,
    zone: S.run.zones.length > 0,
    diamond: S.run.finds.length > 0,
    triangle: S.run.contacts.length > 0,
    'hidden objects found': S.run.mission.objects > 0,
    square: mission.stations?.length > 0,
    'Radio range': mission.radio_range_m > 0,
    'hatched area': S.run.targetAt(S.run.rowAt(S.t)).nowhere?.rectangles.length > 0,
  };
  return needs[label] ?? true;
}

// Fills the list of the help; a screen without a pointer has no tooltips.
export function listWords() {
  $('words').replaceChildren(
    ...SECTIONS.flatMap(([title, words]) => {
      const dl = element('dl', 'list');
      for (const [label, text] of Object.entries(words)) {
        if (!isShown(label)) continue;
        const row = element('div');
        row.append(element('dt', '', label), element('dd', '', text));
        dl.append(row);
      }
      return [element('h2', '', title), dl];
    }),
  );
}
