// SPDX-License-Identifier: Apache-2.0
import {by_id, element} from '../dom.js';
import {at_path, row, rows} from './form.js';
import {build_placing} from './placing.js';
import {kTools} from './tools.js';

const kVerbs = {plan: ['planner', 'local_planner'], smooth: ['smoother'], fly: ['local_planner']};
// Of the start and the ends, the keys that a form offers beside those that are written.
const kEnds = {
  start: [{key: 'heading_deg', unit: 'deg', doc: 'heading at the start'}],
  via: [{key: 'tolerance_m', unit: 'm', doc: 'how near is near enough'}],
  goal: [{key: 'tolerance_m', unit: 'm', doc: 'how near is near enough'},
    {key: 'heading_deg', unit: 'deg', doc: 'heading at the goal'}],
};

const button = (text, title, onclick, more = {}) =>
  element('button', {type: 'button', title, onclick, ...more}, text);

/** The map that an item's form shows, and the key before its own. */
const owner_of = (key) => key.split('.').slice(0, -1).join('.');

/** The panel of all that can be changed. */
export function build_panel(view, world, store, editor, message) {
  const panel = element('aside', {id: 'edit', ariaLabel: 'Edit'});
  by_id('side').after(panel);
  message.setAttribute('role', 'status');
  const [history, items, steps, limits, command] = ['div', 'div', 'div', 'div', 'div']
    .map((tag) => element(tag, {}));
  editor.remove = (item) => remove(item, editor);
  if (editor.state.mission) {
    build_mission(panel, history, items, message, editor);
    return;
  }
  const placing = build_placing(view, world, store, editor);
  panel.append(history, message, element('h2', {}, 'Add'), add_buttons(placing), placing.hint,
    element('h2', {}, 'Change'), items, element('h2', {}, 'Pipelines'), steps,
    element('h2', {}, 'Constraints'), limits, element('h2', {}, 'Take it along'),
    leaving(editor, world.scene.edit_formats), command);
  let plugins = [];
  const reflect = () => {
    const focused = document.activeElement?.closest('#edit [data-field]')?.dataset.field;
    world.scene.edit_scenario = editor.state.scenario;
    history.replaceChildren(...history_buttons(editor));
    items.replaceChildren(...items_form(editor, plugins));
    steps.replaceChildren(...editor.state.pipelines.map((pipeline, nth) =>
      pipeline_form(pipeline, nth, editor, plugins)));
    limits.replaceChildren(...constraints_form(editor, plugins));
    command.replaceChildren(...commands(editor.state.pipelines));
    // The forms are built anew, and in another order where a value has been given: each field is known
    // by its key and by how many of that key stand before it.
    const seen = new Map();
    for (const field of panel.querySelectorAll('.field')) {
      const key = field.firstChild.textContent;
      seen.set(key, (seen.get(key) ?? 0) + 1);
      field.dataset.field = `${key} ${seen.get(key)}`;
    }
    if (focused) panel.querySelector(`[data-field="${CSS.escape(focused)}"] :is(input, select)`)?.focus();
  };
  editor.on_change(() => { if (!editor.dragging) reflect(); });
  reflect();
  editor.plugins().then((all) => {
    plugins = Array.isArray(all) ? all : [];
    reflect();
  });
  listen_to_keys(editor);
}

/** Of a mission: its items, and the verdict of altiplan check. */
function build_mission(panel, history, items, message, editor) {
  const verdict = element('div', {id: 'judged'});
  panel.append(history, message, element('h2', {}, 'Move'), items, element('h2', {}, 'Check'), verdict);
  const reflect = () => {
    const {verdict: text, findings} = editor.state;
    verdict.replaceChildren(element('p', {}, text),
      element('ol', {}, findings.map((finding) => element('li', {}, finding))));
    if (editor.dragging) return;
    history.replaceChildren(...history_buttons(editor));
    items.replaceChildren(...items_form(editor, []));
  };
  editor.on_change(reflect);
  reflect();
  listen_to_keys(editor);
}

function history_buttons(editor) {
  const {undo, redo} = editor.state;
  return [element('div', {className: 'row'},
    button('↶ Undo', 'Undo (Ctrl+Z)', () => editor.undo(), {disabled: !undo, id: 'undo'}),
    button('↷ Redo', 'Redo (Ctrl+Y)', () => editor.redo(), {disabled: !redo, id: 'redo'}),
    button('Save', 'Write the changes into the files; comments stay (Ctrl+S)', () => editor.save(),
      {id: 'save'}),
    button('Save as …', 'Write new files beside these', () => {
      const name = prompt('A word to put behind the names of the new files:', 'edited');
      if (name) editor.save(name);
    }))];
}

const add_buttons = (placing) => element('div', {className: 'row'}, Object.entries(kTools)
  .map(([tool, {name}]) => button(name, 'Then click on the picture', () => placing.begin(tool),
    {id: `add_${tool}`})));

const spec_of = (plugins, kinds, name) =>
  plugins.find((one) => kinds.includes(one.kind) && one.name === name)?.parameters ?? [];

function items_form(editor, plugins) {
  const {movable, selected, state} = editor;
  const choice = element('select', {id: 'items', ariaLabel: 'What is changed',
    onchange: (event) => editor.select(event.target.value || null)},
  element('option', {value: ''}, 'click a handle, or choose'),
  movable.map(({key, name, kind}) => element('option', {value: key, selected: key === selected},
    kind === 'item' || kind === name.toLowerCase() ? name : `${name} (${kind})`)));
  const item = editor.item(selected);
  if (!item || item.kind === 'item') return [choice];
  const map = at_path(state.scenario, item.key) ?? {};
  const change = (prefix) => (key, text) =>
    editor.set([text === null ? `~scenario.${prefix}.${key}` : `scenario.${prefix}.${key}=${text}`]);
  const specs = item.plugin ? spec_of(plugins, ['environment'], item.plugin) : kEnds[item.kind] ?? [];
  const made = [choice, ...rows(specs, map, change(item.key))];
  if (item.kind === 'layer' || item.kind === 'moving') {
    const owner = owner_of(item.key);
    made.push(row({key: 'known', type: 'true or false', doc: 'false: only met in flight'},
      at_path(state.scenario, owner).known, (text) => change(owner)('known', text)));
  }
  if (item.kind === 'event') {
    const owner = owner_of(owner_of(item.key));
    made.push(row({key: 'at_s', unit: 's', doc: 'time since take-off'},
      at_path(state.scenario, owner).at_s, (text) => change(owner)('at_s', text)));
  }
  if (!['start', 'goal'].includes(item.kind)) {
    made.push(button('Remove', 'Remove it (Delete)', () => remove(item, editor), {id: 'remove'}));
  }
  return made;
}

function remove(item, editor) {
  if (item.kind === 'item') {
    editor.say('Items of a mission are moved here, not removed.');
    return;
  }
  if (['start', 'goal'].includes(item.kind)) {
    editor.say(`A scenario needs its ${item.kind}.`);
    return;
  }
  const list = item.key.split('.').slice(0, 2).join('.');
  editor.selected = null;
  editor.set([`~scenario.${list}`]);
}

function pipeline_form({name, tree}, nth, editor, plugins) {
  const set = (assignments) => editor.set(assignments, nth);
  return element('section', {className: 'result'}, element('b', {}, name),
    tree.steps.map((step, at) => {
      const verb = Object.keys(kVerbs).find((one) => one in step);
      if (!verb) {  // judges returns of an autopilot, which is no plugin
        return element('div', {className: 'step'}, element('span', {}, 'returns'), step.returns);
      }
      const kinds = kVerbs[verb];
      const names = plugins.filter(({kind}) => kinds.includes(kind)).map((one) => one.name);
      const all = [...new Set([step[verb], ...names, ...verb === 'fly' ? ['route'] : []])];
      const plugin = element('select', {ariaLabel: `${verb}`, className: `step ${verb}`,
        onchange: (event) => set([...step.with ? [`~steps.${at}.with`] : [],
          `steps.${at}.${verb}=${event.target.value}`])},
      all.map((one) => element('option', {value: one, selected: one === step[verb]}, one)));
      const parameters = rows([{key: 'within_s', unit: 's', doc: 'time budget'}],
        'within_s' in step ? {within_s: step.within_s} : {}, (key, text) =>
          set([text === null ? `~steps.${at}.${key}` : `steps.${at}.${key}=${text}`]));
      const own = rows(spec_of(plugins, kinds, step[verb]), step.with ?? {}, (key, text) =>
        set([text === null ? `~steps.${at}.with.${key}` : `steps.${at}.with.${key}=${text}`]));
      const details = element('details', {open: editor.open.has(`${nth}.${at}`),
        ontoggle: (event) => {
          editor.open[event.target.open ? 'add' : 'delete'](`${nth}.${at}`);
        }}, element('summary', {}, 'parameters'), own, parameters);
      return element('div', {className: 'step'}, element('span', {}, verb), plugin, details);
    }),
    nth > 0 ? null : button('Compare with another', editor.state.pipelines.length > 1 ?
      'Two are compared: open the page anew for another comparison' :
      'Plan with a second pipeline on the same world; "Save as" writes it into a file of its own',
      () => editor.compare(), {id: 'compare', disabled: editor.state.pipelines.length > 1}));
}

function constraints_form(editor, plugins) {
  const entries = (tree, prefix, nth) => (tree.constraints ?? []).map((constraint, at) => {
    const name = Object.keys(constraint)[0];
    const path = `${prefix}constraints.${at}`;
    return element('div', {className: 'step'}, element('b', {}, name),
      rows(spec_of(plugins, ['constraint'], name), constraint[name] ?? {}, (key, text) =>
        editor.set([text === null ? `~${path}.${name}.${key}` : `${path}.${name}.${key}=${text}`], nth)),
      button('Remove', 'Remove this constraint', () => editor.set([`~${path}`], nth)));
  });
  const {pipelines, scenario} = editor.state;
  const own = pipelines.flatMap(({name, tree}, nth) => [
    ...pipelines.length > 1 ? [element('h3', {}, `of ${name}`)] : [],
    ...entries(tree, '', nth), new_constraint(tree, nth, editor, plugins)]);
  return [...entries(scenario, 'scenario.', 0), ...own];
}

/** A constraint needs its limits before it can be checked. */
function new_constraint(tree, nth, editor, plugins) {
  const names = plugins.filter(({kind}) => kind === 'constraint').map(({name}) => name);
  const name = element('select', {ariaLabel: 'A further constraint'}, element('option', {value: ''}, 'add …'),
    names.map((one) => element('option', {value: one}, one)));
  const limits = element('div', {});
  name.onchange = () => {
    const specs = spec_of(plugins, ['constraint'], name.value);
    const written = {};
    limits.replaceChildren(...specs.map((spec) =>
      row(spec, undefined, (text) => { written[spec.key] = text; })), button('Add', 'Add this constraint', () => {
      const count = tree.constraints?.length ?? 0;
      const keys = Object.entries(written).filter(([, text]) => text !== null)
        .map(([key, text]) => `${key}: ${text}`);
      const text = `{${name.value}: {${keys.join(', ')}}}`;
      editor.set([count > 0 ? `constraints.${count}=${text}` : `constraints=[${text}]`], nth);
    }));
  };
  return element('div', {className: 'step'}, name, limits);
}

/** `formats`: name and extension of each. */
function leaving(editor, formats) {
  const format = element('select', {id: 'format', ariaLabel: 'Format'},
    formats.map(([name]) => element('option', {value: name}, name)));
  const address = element('input', {type: 'text', id: 'address', placeholder: 'udp:127.0.0.1:14550',
    ariaLabel: 'Address of the autopilot'});
  const pipeline = () => Math.min(editor.store.state.selected, editor.state.pipelines.length - 1);
  return element('div', {}, element('div', {className: 'row'}, format,
    button('Export', 'As altiplan export writes it', async () => {
      const blob = await editor.export_to(format.value, pipeline());
      if (!blob) return;
      const [, extension] = formats.find(([name]) => name === format.value);
      const link = element('a', {href: URL.createObjectURL(blob),
        download: `${editor.state.pipelines[pipeline()].name}${extension}`});
      link.click();
      URL.revokeObjectURL(link.href);
    }, {id: 'export'})),
  element('div', {className: 'row'}, address, button('Upload', 'As altiplan upload does it', () =>
    editor.upload(address.value || address.placeholder, pipeline()), {id: 'upload'})));
}

/** What does the same on a command line. */
function commands(pipelines) {
  const quoted = (text) => `'${text.replaceAll("'", "'\\''")}'`;
  return pipelines.map(({file, set}) => element('code', {}, ['altiplan run', file,
    ...set.flatMap((text) => ['--set', quoted(text)])].join(' ')));
}

function listen_to_keys(editor) {
  addEventListener('keydown', (event) => {
    if (!event.ctrlKey && !event.metaKey) return;
    const deeds = {z: () => event.shiftKey ? editor.redo() : editor.undo(), y: () => editor.redo(),
      s: () => editor.save()};
    const deed = deeds[event.key.toLowerCase()];
    if (!deed || event.target.matches('input[type=text]') && event.key.toLowerCase() !== 's') return;
    event.preventDefault();
    deed();
  });
}
