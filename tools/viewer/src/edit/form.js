// SPDX-License-Identifier: Apache-2.0
import {element} from '../dom.js';

/** The value at a dotted path of a tree. */
export const at_path = (tree, path) => path.split('.').reduce((value, key) => value?.[key], tree);

/** A value of the scenario's tree as one writes it in YAML, on one line. */
export function yaml_text(value) {
  if (Array.isArray(value)) return `[${value.map(yaml_text).join(', ')}]`;
  if (value !== null && typeof value === 'object') {
    return `{${Object.entries(value).map(([key, inner]) => `${key}: ${yaml_text(inner)}`).join(', ')}}`;
  }
  return String(value);
}

const default_text = (value) => value === null ? '' : yaml_text(value);

function range_text({min, max, min_itself_allowed}) {
  const parts = [];
  if (min !== null) parts.push(`${min_itself_allowed ? '≥' : '>'} ${min}`);
  if (max !== null) parts.push(`≤ ${max}`);
  return parts.join(', ');
}

/** A row for one key: its name, what is written, its unit and help. `change` gets the new text, null
 *  where the key is to be left out. */
export function row({key, unit, doc, choices = [], type = '', ...spec}, written, change) {
  const text = written === undefined ? '' : yaml_text(written);
  const help = [doc, type, spec.min !== undefined ? range_text(spec) : ''].filter(Boolean).join('; ');
  const submit = (event) => {
    const now = event.target.value.trim();
    if (now !== text) change(now === '' ? null : now);
  };
  const options = choices.length > 0 ? choices : type === 'true or false' ? ['true', 'false'] : [];
  const input = options.length > 0 ?
    element('select', {onchange: submit, ariaLabel: key}, ['', ...options].map((choice) =>
      element('option', {value: choice, selected: choice === text},
        choice === '' ? `default${spec.default === undefined ? '' : `: ${default_text(spec.default)}`}` : choice))) :
    element('input', {type: 'text', value: text, onchange: submit, ariaLabel: key,
      placeholder: spec.default === undefined ? '' : default_text(spec.default)});
  return element('label', {className: 'field', title: help}, element('span', {}, key), input,
    element('small', {}, unit ?? ''));
}

/** Rows for all parameters of a plugin, those that are written first. */
export function rows(parameters, written, change) {
  const known = new Set(parameters.map(({key}) => key));
  const others = Object.keys(written).filter((key) => !known.has(key)).map((key) => ({key}));
  // Some parameters are written by several keys, and have a sentence for a name.
  return [...parameters.filter(({key}) => /^\w+$/.test(key)), ...others]
    .toSorted((a, b) => (b.key in written) - (a.key in written))
    .map((spec) => row(spec, written[spec.key], (text) => change(spec.key, text)));
}
