// SPDX-License-Identifier: Apache-2.0
// The page can be read without this. With it, tables sort, and a click on a point, a cell or a run
// shows that run and its route in the 3-D scene.
'use strict';

const kLongTable = 10;  // rows
const kPlace = '/*SCENE*/';
const report = window.altiplan_report = {ready: false, ready_ms: null, errors: []};
addEventListener('error', (event) => report.errors.push(event.message));
addEventListener('unhandledrejection', (event) => report.errors.push(String(event.reason)));

const by_id = (id) => document.getElementById(id);

function element(tag, properties, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children.flat());
  return made;
}

/** Text that the page holds compressed; taken apart when it is first asked for. */
const unpacked = new Map();
function unpack(id) {
  if (!window.DecompressionStream) {
    return Promise.reject(new Error('This browser cannot unpack the runs (no DecompressionStream); ' +
      'see runs.csv.'));
  }
  if (!unpacked.has(id)) {
    const bytes = Uint8Array.from(atob(by_id(id).textContent), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    unpacked.set(id, new Response(stream).text());
  }
  return unpacked.get(id);
}

let loaded = null;
function load() {
  loaded ??= unpack('data').then((text) => {
    const data = JSON.parse(text);
    data.runs = data.runs.map(([scenario, pipeline, repetition, seed, outcome, message, store, id],
      index) => ({index, scenario, pipeline, repetition, seed, store: store ?? 0, id: id ?? null,
      outcome: data.outcomes[outcome], message: data.messages[message],
      values: data.values[index]}));
    data.why_not = new Map(data.why_not.map(([row, why]) => [row, data.messages[why]]));
    // A pair is one scenario and repetition; its scene is that of any of its runs.
    data.scene_of = new Map();
    data.scenes.forEach((rows, scene) => data.scene_of.set(pair_of(data.runs[rows[0]]), scene));
    return data;
  });
  return loaded;
}

const pair_of = (run) => `${run.scenario} ${run.repetition}`;
const run_name = (data, run) =>
  `${data.pipelines[run.pipeline]} ${data.scenarios[run.scenario]} #${run.repetition}`;
const words = (text) => text.replaceAll('_', ' ');

function shell_word(text) {
  return /^[A-Za-z0-9_./=:,+@-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}

/** With four digits that matter, or all before the point; short times in ms; a word as it is. */
function number(value, unit) {
  if (typeof value === 'string') return value;
  const size = Math.abs(value);
  if (unit === 's' && size !== 0 && size < 0.1) return number(1000 * value, 'ms');
  const text = size !== 0 && (size < 1e-4 || size >= 1e9) ? value.toExponential(3) :
    value.toLocaleString('en', size < 1000 ? {maximumSignificantDigits: 4} :
      {maximumFractionDigits: 0});
  return text + (unit === '°' || unit === '' ? unit : ` ${unit}`);
}

/** A placeholder in the scene's list for a run without anything to draw, instead of another's profile. */
function without_route(data, run) {
  return {name: data.pipelines[run.pipeline], series: data.series[run.pipeline],
    file: run_name(data, run), status: run.outcome,
    message: data.why_not.get(run.index) ?? run.message, seed: run.seed, metrics: null, check: null,
    steps: [], route: null, limits: null, profile: null, flight: null, trace: null};
}

/** The scene's page, the run that was clicked first and selected. */
async function scene_page(data, run, scene) {
  const [template, text] = await Promise.all([unpack('viewer'), unpack(`scene-${scene}`)]);
  const json = JSON.parse(text);
  const first = data.scenes[scene].indexOf(run.index);
  json.results.unshift(...(first < 0 ? [without_route(data, run)] : json.results.splice(first, 1)));
  json.selected = 0;
  return template.split(kPlace).join(JSON.stringify(json).replaceAll('<', '\\u003c'));
}

function scene_part(data, run) {
  const scene = data.scene_of.get(pair_of(run));
  const command = `altiplan replay ${shell_word(data.stores[run.store])} ` +
    shell_word(run_name(data, run));
  const why = data.why_not.get(run.index);
  const parts = [];
  if (data.imported.includes(run.index)) {
    return [element('p', {className: 'quiet'},
      'This run comes from the database of another program: it has no scene, and no command ' +
      'repeats it.')];
  }
  if (scene === undefined) {
    parts.push(element('p', {className: 'quiet'}, 'This page has no 3-D scene of this run' +
      `${why ? `: ${why}` : ''}. To reproduce the run:`));
  } else {
    if (!data.scenes[scene].includes(run.index)) {
      parts.push(element('p', {className: 'quiet'}, why ? `This run is not shown: ${why}.` :
        'This run left no result; the scene shows the other pipelines of its pair.'));
    }
    const frame = element('iframe', {title: `Scene of ${run_name(data, run)}`});
    frame.setAttribute('sandbox', 'allow-scripts allow-downloads');
    scene_page(data, run, scene).then((page) => frame.srcdoc = page, (error) => {
      frame.replaceWith(element('p', {}, error.message));
      throw error;
    });
    parts.push(frame, element('p', {className: 'quiet'}, 'To reproduce this run:'));
  }
  return [...parts, element('pre', {className: 'command'}, command)];
}

function pair_part(data, run) {
  const others = data.runs.filter((other) => pair_of(other) === pair_of(run));
  return element('div', {className: 'pair'}, others.map((other) => {
    const button = element('button', {type: 'button', onclick: () => show_run(data, other)},
      `${data.pipelines[other.pipeline]}: ${words(other.outcome)}`);
    button.setAttribute('aria-pressed', String(other === run));
    return button;
  }));
}

function open_panel(title, ...parts) {
  const panel = by_id('panel');
  const close = element('button', {type: 'button', onclick: close_panel, id: 'close'}, 'Close');
  panel.replaceChildren(
    element('div', {className: 'top'}, element('h2', {}, title), close), ...parts.flat());
  panel.hidden = false;
  panel.scrollTop = 0;
  close.focus({preventScroll: true});
}

let opened_from = null;
function close_panel() {
  by_id('panel').replaceChildren();
  by_id('panel').hidden = true;
  opened_from?.focus?.({preventScroll: true});
}

function show_run(data, run) {
  const solved = run.outcome === 'solved';
  const origin = `seed ${run.seed}` + (run.id === null ? '' : `, run ${run.id}`);
  open_panel(`${data.scenarios[run.scenario]} #${run.repetition}`,
    element('p', {className: `state ${solved ? 'good' : 'bad'}`},
      element('b', {}, `${data.pipelines[run.pipeline]}: ${words(run.outcome)}`),
      element('span', {className: 'quiet'}, origin)),
    run.message ? element('p', {id: 'message'}, run.message) : [],
    pair_part(data, run),
    scene_part(data, run),
    element('ul', {className: 'values'}, data.columns.map(([name, title, unit], at) =>
      run.values[at] === null ? '' : element('li', {title: name}, element('span', {}, title),
        element('span', {}, number(run.values[at], unit))))),
    data.all_columns ? [] : element('p', {className: 'quiet'}, 'Values of steps are in runs.csv.'));
  report.shown = run.index;
}

function show_cell(data, scenario, pipeline) {
  const runs = data.runs.filter((run) => run.scenario === scenario && run.pipeline === pipeline);
  // One that did not solve is what most look for.
  const run = runs.find(({outcome}) => outcome !== 'solved') ?? runs[0];
  show_run(data, run);
  if (runs.length > 1) {
    by_id('panel').querySelector('.pair').before(element('div', {className: 'pair'},
      runs.map((other) => element('button', {type: 'button', onclick: () => show_run(data, other)},
        `#${other.repetition}: ${words(other.outcome)}`))));
  }
}

/** What an element names: "run 17", or "cell 3 1" (a scenario and a pipeline). */
async function show(target) {
  opened_from = target;
  const [kind, ...indices] = target.dataset.open.split(' ');
  try {
    const data = await load();
    const numbers = indices.map(Number);
    if (kind === 'run') show_run(data, data.runs[numbers[0]]);
    else show_cell(data, ...numbers);
  } catch (error) {
    open_panel('This run cannot be shown', element('p', {}, error.message));
    throw error;
  }
}

/** By the numbers that cells carry, else by their texts; what has neither comes last. */
function sort_by(table, column, descending) {
  const key = (row) => {
    const cell = row.cells[column];
    if (cell.dataset.v !== undefined) return Number(cell.dataset.v);
    return cell.textContent === '–' ? null : cell.textContent;
  };
  const body = table.tBodies[0];
  const rows = [...body.rows].map((row) => ({row, key: key(row)}));
  rows.sort((a, b) => {
    if (a.key === null || b.key === null) return (a.key === null) - (b.key === null);
    const order = typeof a.key === 'number' && typeof b.key === 'number' ? a.key - b.key :
      String(a.key).localeCompare(String(b.key), 'en', {numeric: true});
    return descending ? -order : order;
  });
  body.append(...rows.map(({row}) => row));
  for (const [at, cell] of [...table.tHead.rows[0].cells].entries()) {
    if (at === column) cell.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
    else cell.removeAttribute('aria-sort');
  }
}

async function show_all_rows(button) {
  const {more_rows} = await load();
  const body = by_id('table-scenarios').tBodies[0];
  body.insertAdjacentHTML('beforeend', more_rows.map((row) => `<tr>${row}</tr>`).join(''));
  make_cells_reachable(body);
  button.hidden = true;
}

function make_cells_reachable(part) {
  for (const cell of part.querySelectorAll('[data-open]')) {
    cell.tabIndex = 0;
    cell.setAttribute('role', 'button');
  }
}

/** Any table sorts; of a long one the heads say so, and keys reach them. */
function mark_as_sortable(table) {
  table.classList.add('long');
  for (const head of table.tHead.rows[0].cells) {
    head.tabIndex = 0;
    head.title = 'Sort by this column';
  }
}

function clicked(event) {
  const target = event.target.closest('[data-open]');
  if (target) return void show(target);
  const head = event.target.closest('table.sortable thead th');
  if (head) sort_by(head.closest('table'), head.cellIndex,
    head.getAttribute('aria-sort') === 'ascending');
}

function pressed(event) {
  if (event.key === 'Escape') close_panel();
  if (event.key !== 'Enter' && event.key !== ' ') return;
  if (event.target.dataset?.open) {
    event.preventDefault();
    show(event.target);
  } else if (event.target.matches('thead th')) {
    event.preventDefault();
    event.target.click();
  }
}

function start() {
  document.body.classList.add('live');
  for (const table of document.querySelectorAll('table')) {
    make_cells_reachable(table);
    if (table.tBodies[0].rows.length > kLongTable) mark_as_sortable(table);
  }
  document.addEventListener('click', clicked);
  document.addEventListener('keydown', pressed);
  const more = by_id('more');
  if (more) {
    more.hidden = false;
    more.addEventListener('click', () => show_all_rows(more));
  }
  requestAnimationFrame(() => setTimeout(() => {
    report.ready_ms = performance.now();
    report.ready = true;
  }));
}

start();
