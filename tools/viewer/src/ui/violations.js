// SPDX-License-Identifier: Apache-2.0
import {element} from '../dom.js';

/** All violations of routes, steps and flights, with the positions of their waypoints. */
export function violations_of({scene}) {
  const found = [];
  const add = (check, points, whose, result, line) => {
    for (const violation of check?.violations ?? []) {
      found.push({...violation, whose, result, line, place: points?.[violation.at] ?? null});
    }
  };
  scene.results.forEach((result, index) => {
    add(result.check, result.route, result.name, index, `${index}`);
    result.steps.forEach((step, at) => {
      // The judge checks the accepted step as the route above, unless another step follows.
      if (step.accepted) return;
      add(step.check, step.route, `${result.name}, ${step.id}`, index, `${index}.${at}`);
    });
    const track = result.flight?.track?.map((sample) => sample.slice(1, 4));
    add(result.flight?.check, track, `${result.name}, flight`, index, `${index}.flight`);
  });
  return found;
}

export function build_violations(view, world, store) {
  const found = violations_of(world);
  if (found.length === 0) {
    return element('div', {}, element('p', {className: 'empty'},
      'No constraint is violated by the results shown.'));
  }
  return element('div', {}, element('ol', {}, found.map((violation) => element('li', {},
    element('button', {
      disabled: violation.place === null,
      title: 'Fly there',
      onclick: () => {
        view.fly_to(violation.place);
        store.toggle('shown', violation.line, true);
        store.set({selected: violation.result,
          cursor: {at: violation.place, x: null, index: null}});
      }},
    element('b', {}, violation.constraint), ` ${violation.message} `,
    element('small', {}, `${violation.whose}, waypoint ${violation.at}`))))));
}
