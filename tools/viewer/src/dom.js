// SPDX-License-Identifier: Apache-2.0
/** A new element with attributes, listeners (`onclick`), properties and children. */
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on') || name in made) made[name] = value;
    else if (value !== null && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return made;
}

export const by_id = (id) => document.getElementById(id);

export function checkbox(label, checked, onchange, ...marks) {
  const input = element('input', {type: 'checkbox', checked,
    onchange: (event) => onchange(event.target.checked)});
  return {input, row: element('label', {className: 'check'}, input, ...marks, label)};
}

export function swatch(color, kind = 'fill') {
  const made = element('span', {className: `swatch ${kind}`});
  made.style.setProperty('--swatch', color);
  return made;
}
