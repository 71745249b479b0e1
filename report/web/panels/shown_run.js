// SPDX-License-Identifier: BSD-3-Clause
// Chooses which run the page shows: a record, or a running team that later becomes a record.
import { S, ask, startTail } from './state.js';
import { buildStrip, seek, showFollowing } from './timeline.js';
import { buildTeam } from './team.js';
import { showContacts } from './contacts.js';
import { showFacts } from './details.js';
import { set, showLegend } from './legend.js';
import { layout } from './screen.js';
import { QUANTITIES } from './chart.js';
import { endControl, listAgents, showControl } from './control.js';
import { beginSpace } from './space_controls.js';
import { courseSeconds } from '../data/motion.js';
import { $, ofModes, put } from '../text.js';

const NO_KEY = 'The team has no key: any host on the network may have sent what is shown';

let runs = 0;

// φ² over time is as it was recorded; the maps are of cosines.
function nameBasis(run) {
  const basis = ofModes(run.mission);
  QUANTITIES.phi.title = basis ? `φ²${basis}` : 'Ergodic metric φ²';
  QUANTITIES.spread.title = `Disagreement on φ²${basis}`;
  put($('metricName'), `φ²${basis}`);
  for (const option of $('quantity').options) option.text = QUANTITIES[option.value].title;
}

function show(run) {
  run.id = ++runs;
  const first = !S.run;
  S.run = run;
  put($('name'), run.mission.name);
  document.title = `${run.mission.name} – Ergocast`;
  $('slider').max = Math.max(0, run.rows - 1);
  $('slider').step = 1;
  nameBasis(run);
  $('radioLabel').hidden = !(run.mission.radio_range_m > 0);
  $('distanceLabel').hidden = !(run.mission.body_radius_m > 0);
  put($('courseText'), `${courseSeconds(run)} s`);
  if (first) S.tail = startTail(run);
  beginSpace(run);
  buildTeam();
  showLegend();
  layout();
}

// Checkpoints are made in slices, so that the page answers meanwhile.
function buildCheckpoints(run) {
  if (S.run === run && !run.coverage.build(6)) setTimeout(() => buildCheckpoints(run), 0);
  else run.ready = true;
}

export function showRecord(run, at) {
  S.live = S.following = false;
  S.facts = null;
  show(run);
  showFollowing();
  showFacts(null);
  showContacts(run);
  seek(Math.min(at ?? run.end, run.end));
  buildCheckpoints(run);
}

export const livePage = {
  began(run, facts) {
    S.facts = facts;
    S.live = S.following = true;
    show(run);
    showFollowing();
  },
  changed(facts) {
    S.facts = facts;
    listAgents();
    const { run } = S;
    $('slider').max = Math.max(0, run.rows - 1);
    const { marks } = run;
    if (run.newIncidents || marks.length !== run.marksSpoken) {
      const last = marks.findLast(mark => mark.kind !== 'zone'), // zone_list.js speaks of zones
        words = last ? `${last.text} at ${last.t.toFixed(0)} s` : '';
      run.marksSpoken = marks.length;
      if (words && words !== run.wordsSpoken) put($('spoken'), words);
      run.wordsSpoken = words;
      run.newIncidents = false;
      buildStrip();
    }
    if (performance.now() - (run.stripAt ?? 0) > 500) {
      run.stripAt = performance.now();
      buildStrip();
      showFacts(facts);
      showContacts(run);
    }
    if (run.tracks.length > 12 && !run.tailChosen) {
      run.tailChosen = true;
      set('tail', startTail(run));
    }
    put($('authentication'), facts.replay ? 'replay' : facts.authenticated ? '' : 'not authenticated');
    $('authentication').title = facts.replay ? 'ergocast replay sends a record: no team is running' : NO_KEY;
    $('authentication').hidden = facts.authenticated && !facts.replay;
    ask();
  },
  controlled: showControl,
  ended(run, text) {
    endControl();
    const at = S.following ? undefined : S.t;
    if (run) showRecord(run, at);
    this.lost('');
    put($('spoken'), `The mission has ended: ${text}`);
  },
  lost(text) {
    put($('banner'), text);
    $('banner').hidden = !text;
  },
};
