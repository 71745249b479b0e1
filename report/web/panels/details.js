// SPDX-License-Identifier: BSD-3-Clause
// Shows the key figures under the map, and the dialog with all that a record holds besides.
import { S } from './state.js';
import { NOTABLE, lateCommands, lateText } from './notices.js';
import { $, duration, element, grouped, ofModes, readable } from '../text.js';
import { openDialog } from './dialogs.js';
import { findsText, foundBy, foundFacts } from './found.js';
import { meaningOf } from './words.js';

function list(pairs, css) {
  const dl = element('dl', css);
  for (const [name, value] of pairs) {
    const box = element('div');
    box.append(element('dt', '', name), element('dd', '', value));
    dl.append(box);
  }
  return dl;
}

// A value of the summary as text; a summary may have anything.
function valueAt(object, path) {
  for (const key of path.split('.')) object = object && typeof object === 'object' ? object[key] : undefined;
  if (typeof object === 'number') return Number.isInteger(object) ? grouped(object) : readable(object);
  if (typeof object === 'boolean') return object ? 'yes' : 'no';
  return typeof object === 'string' ? object : undefined;
}
const present = pairs => pairs.filter(([, value]) => value !== undefined && value !== '');

function slopeText(run) {
  return typeof run.slope === 'number' ? run.slope.toFixed(2).replace('-', '−') : '–';
}

// `live`: {rate, lost, authenticated, …} of a running team, or null.
export function showFacts(live) {
  const { run } = S,
    { mission, summary, metrics } = run,
    { phi } = metrics,
    late = lateCommands();
  const pairs = live
    ? [
        ['messages per second', readable(live.rate)],
        ['messages lost', grouped(live.lost)],
        ['late commands', lateText(late)],
        ...present([['hidden objects found', findsText(run)]]),
        ...foundFacts(run),
        ['authenticated', live.authenticated ? 'yes' : 'no'],
        ...present([['shown to', live.clients.join(', ')]]),
        ['ticks', `${grouped(run.tickCount)} × ${mission.dt_s} s`],
        ['modes', mission.modes.join(' × ')],
        ['seed', mission.seed],
        ['run', (live.replay ? 'replay of ' : '') + live.run.slice(0, 8)],
      ]
    : [
        ['result', valueAt(summary, 'result') ?? 'no summary'],
        ...present([['φ² in modes of', mission.free_domain ? 'the free domain' : '']]),
        ['φ² first', readable(phi[0])],
        ['φ² last', readable(phi[phi.length - 1])],
        ['slope, last decade', slopeText(run)],
        ...present([
          ['hidden objects found', findsText(run)],
          ['chance to have found an object', foundBy(summary)],
          ['50 % chance after [s]', valueAt(summary, 'detection.time_to_half_s')],
          ['80 % chance after [s]', valueAt(summary, 'detection.time_to_four_fifths_s')],
          ['left alone at most [s]', valueAt(summary, 'greatest_age_s')],
          ['distance to the target [m]', valueAt(summary, 'sliced_wasserstein_m')],
          ['way of all agents [m]', valueAt(summary, 'path_m')],
        ]),
        [
          'ticks',
          grouped(run.ticks) +
            (run.ticks < run.tickCount ? ` of ${grouped(run.tickCount)}` : '') +
            ` × ${mission.dt_s} s`,
        ],
        ['modes', mission.modes.join(' × ')],
        ['seed', mission.seed],
        ['mode', valueAt(summary, 'mode') ?? '–'],
        ...present([
          ['blocked share', valueAt(summary, 'separation.blocked_share')],
          ['longest block [s]', valueAt(summary, 'separation.longest_block_s')],
        ]),
        ['messages', valueAt(summary, 'messages.sent') ?? '–'],
        ['lost', valueAt(summary, 'messages.lost') ?? '–'],
        ...present([['late commands', late.missed > 0 ? lateText(late) : '']]),
        ['ticks missing', valueAt(summary, 'gaps') ?? '–'],
        ['run', (valueAt(summary, 'run_id') ?? '–').slice(0, 8)],
      ];
  const boxes = [...list(pairs).children];
  boxes.forEach((box, i) => {
    box.title = meaningOf('FIGURES', pairs[i][0]);
  });
  if (Math.max(late.share, late.lately) >= NOTABLE)
    boxes.find((_, i) => pairs[i][0] === 'late commands')?.lastChild.classList.add('late');
  $('facts').replaceChildren(...boxes);
}

const AGENT_COLUMNS = [
  ['agent', 'id', 'Its number'],
  ['host', 'host', 'The machine that its process ran on'],
  ['incarnation', 'incarnation', 'Which process it was: a restarted one has another'],
  ['from tick', 'active_from', 'The first tick at which its coverage counts'],
  ['until', 'active_until', 'The first tick at which its coverage no longer counts'],
  ['messages sent', 'messages_sent', 'On all buses'],
  ['received', 'messages_received', 'On all buses'],
  ['contributions', 'contributions_received', 'Messages with coverage of teammates that it received'],
  ['lost', 'contributions_lost', 'Messages that teammates sent and it did not receive'],
  ['missed ticks', 'missed_ticks', 'Ticks of the world that passed without its command'],
  [
    'blocked ticks',
    'blocked_ticks',
    'Ticks in which a body or an edge left less than a tenth of its command',
  ],
  ['longest block', 'longest_block_ticks', 'The most such ticks without a break'],
  [
    'oldest update [s]',
    'max_staleness_s',
    'The mission time since it last received coverage of the teammate that it knows least of',
  ],
  ['dropped', 'kernel_drops', 'Datagrams that the kernel dropped before it read them'],
  ['own φ²', 'ergodic_metric', 'φ² of the coverage that it knew at the end'],
];

function table(columns, objects) {
  const box = element('div', 'scroll'),
    made = element('table'),
    head = element('tr'),
    body = element('tbody');
  const used = columns.filter(([, key]) => objects.some(object => valueAt(object, key) !== undefined));
  head.append(
    ...used.map(([title, key, means = '']) => {
      const th = element('th', '', key === 'ergodic_metric' ? title + ofModes(S.run.mission) : title);
      th.title = means;
      return th;
    }),
  );
  for (const object of objects) {
    const tr = element('tr');
    tr.append(...used.map(([, key]) => element('td', '', valueAt(object, key) ?? '–')));
    body.append(tr);
  }
  const top = element('thead');
  top.append(head);
  made.append(top, body);
  box.append(made);
  return box;
}

const AMENDMENT_COLUMNS = [
  ['amendment', 'number', 'Its number in the mission'],
  [
    'kind',
    'kind',
    'A pause, the target, the end, a zone that is kept free or is cancelled, the law, or a dismissed contact',
  ],
  ['from tick', 'from', 'The first tick of the world at which it holds'],
  ['t [s]', 't', 'Mission time at that tick'],
  ['ticks', 'tick_count', 'Another end: how many ticks the mission has by it'],
  ['zone', 'zone', 'A cancelled zone: the number of its amendment'],
  ['law', 'law', 'Another law: which of its numbers differ from the plan'],
  ['note', 'text', 'A sighting, or the contact that is dismissed'],
  ['operator', 'by', 'The operator that asked for it'],
];
const amendmentsOf = run =>
  run.amendments.map(one => ({ ...one, t: +run.counted(one.from * run.mission.dt_s).toFixed(3) }));

const objectsOf = value => (Array.isArray(value) ? value.filter(v => v && typeof v === 'object') : []);

function refusals(summary) {
  const refused = summary?.messages?.refused;
  if (!refused || typeof refused !== 'object') return undefined;
  return (
    Object.entries(refused)
      .filter(([, n]) => typeof n === 'number' && n > 0)
      .map(([why, n]) => `${grouped(n)} for ${why}`)
      .join(', ') || 'none'
  );
}

function commands(mode) {
  const lines = [];
  if (mode !== 'realtime') lines.push('# simulate it again and compare every position', 'ergocast verify .');
  lines.push(
    '# the same mission as a new run',
    'ergocast simulate scenario.textproto --out ../again',
    '# make this page again',
    'ergocast report .',
    '# this page from a server',
    'ergocast watch .',
  );
  if (mode !== undefined && mode !== 'simulate') {
    lines.push('# send its messages again, for ergocast status and lcm-spy', 'ergocast replay .');
  }
  return lines.join('\n');
}

const heading = text => element('h2', '', text);

export function showDetails() {
  const { run } = S,
    { summary, mission } = run,
    parts = [];
  if (summary) {
    const pace =
      valueAt(summary, 'mode') === 'realtime'
        ? `real time × ${valueAt(summary, 'realtime_factor') ?? 1}`
        : valueAt(summary, 'mode');
    parts.push(
      heading('Run'),
      list(
        present([
          ['result', [valueAt(summary, 'result'), valueAt(summary, 'reason')].filter(Boolean).join(': ')],
          ['mode', pace],
          ['started', valueAt(summary, 'started')],
          ['mission time', duration(run.end)],
          ['wall time [s]', valueAt(summary, 'wall_time_s')],
          ['ticks per second', valueAt(summary, 'ticks_per_s')],
          ['restarts', valueAt(summary, 'restarts')],
          ['late commands', valueAt(summary, 'missed_deadlines')],
          ['skipped ticks', valueAt(summary, 'skipped_ticks')],
          ['commands cut to the speed limit', valueAt(summary, 'speed_limit.clamped_commands')],
          ['dropped by the kernel', valueAt(summary, 'messages.kernel_drops')],
          ['refused messages', refusals(summary)],
          ['run', valueAt(summary, 'run_id')],
          ['scenario hash', valueAt(summary, 'scenario_hash')],
          ['version', valueAt(summary, 'version')],
          ['build', valueAt(summary, 'build')],
          ['processor has FMA', valueAt(summary, 'cpu_fma')],
        ]),
        'list',
      ),
    );
    const agents = objectsOf(summary.agents),
      processes = objectsOf(summary.processes);
    if (agents.length) parts.push(heading('Messages of each agent'), table(AGENT_COLUMNS, agents));
    if (processes.length)
      parts.push(
        heading('Processes'),
        table(
          [
            ['process', 'name'],
            ['restarts', 'restarts'],
            ['end', 'end'],
          ],
          processes,
        ),
      );
  } else if (!S.live) {
    parts.push(
      element(
        'p',
        '',
        'There is no summary.json: the run has not ended yet or was killed. ' +
          'What was recorded up to then is shown.',
      ),
    );
  }
  if (run.amendments.length) parts.push(heading('Amendments'), table(AMENDMENT_COLUMNS, amendmentsOf(run)));
  parts.push(
    heading('Conventions'),
    element(
      'p',
      'muted',
      'A φ² can be compared with another only if the weights, the modes and hₖ are the same.',
    ),
    list(mission.conventions, 'list'),
  );
  if (run.stride > 1)
    parts.push(
      element(
        'p',
        'muted',
        `This page has only every ${run.stride}th tick of this long mission; its cₖ belong to these.`,
      ),
    );
  if (!S.live)
    parts.push(
      heading('How to reproduce'),
      element('p', 'muted', 'In the run’s directory:'),
      element('pre', '', commands(valueAt(summary, 'mode'))),
    );
  $('detailsText').replaceChildren(...parts);
  openDialog($('details'));
}
