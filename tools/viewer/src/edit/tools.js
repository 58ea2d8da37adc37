// SPDX-License-Identifier: Apache-2.0
import {round_step} from '../units.js';

const metres = (value) => Number(value.toFixed(1));
const list = (values) => `[${values.map(metres).join(', ')}]`;

/** A key's assignment that adds an item to a list of the scenario. */
function added(scenario, name, text) {
  const count = scenario[name]?.length ?? 0;
  return count > 0 ? `scenario.${name}.${count}=${text}` : `scenario.${name}=[${text}]`;
}

/** A point above [x, y] in the form in which the start is written. */
function point_like(start, [x, y, ground], z) {
  if (start?.above_ground_m !== undefined) {
    return `at_m: ${list([x, y])}, above_ground_m: ${start.above_ground_m}`;
  }
  const is_level = start?.at_m?.length === 2;
  return `at_m: ${list(is_level ? [x, y] : [x, y, Math.max(z, Number.isNaN(ground) ? z : ground)])}`;
}

/** What can be added: its name, how many places are clicked (0: until Enter), and the assignments that
 *  add it at these places, each [x, y, height of the ground or NaN]. */
export const kTools = {
  via: {name: 'Via point', places: 1, add([place], {scenario, start}) {
    return [added(scenario, 'via', `{${point_like(scenario.start, place, start[2])}}`)];
  }},
  cylinder: {name: 'Cylinder', places: 1, add([[x, y]], {scenario, radius}) {
    return [added(scenario, 'environment', `{cylinder: {at_m: ${list([x, y])}, radius_m: ${radius}}}`)];
  }},
  box: {name: 'Box', places: 1, add([[x, y, ground]], {scenario, radius, floor}) {
    const z = Number.isNaN(ground) ? floor : ground;
    const [min, max] = [[x - radius, y - radius, z], [x + radius, y + radius, z + radius]];
    return [added(scenario, 'environment', `{box: {min_m: ${list(min)}, max_m: ${list(max)}}}`)];
  }},
  zone: {name: 'Zone', places: 0, add(places, {scenario}) {
    const corners = places.map(([x, y]) => list([x, y])).join(', ');
    return [added(scenario, 'environment', `{prism: {outline_m: [${corners}]}}`)];
  }},
  radar: {name: 'Radar', places: 1, add([[x, y, ground]], {scenario, radius, start}) {
    const at = Number.isNaN(ground) ? `at_m: ${list([x, y, start[2]])}` :
      `at_m: ${list([x, y])}, above_ground_m: 10`;
    return [added(scenario, 'environment', `{radar: {${at}, range_m: ${radius}}}`)];
  }},
  hidden: {name: 'Hidden obstacle', places: 1, add([[x, y]], {scenario, radius}) {
    return [added(scenario, 'environment',
      `{cylinder: {at_m: ${list([x, y])}, radius_m: ${radius}}, known: false}`)];
  }},
  pop_up: {name: 'Pop-up', places: 1, add([[x, y]], {scenario, radius, time}) {
    const id = `pop_up_${(scenario.events?.length ?? 0) + 1}`;
    return [added(scenario, 'events',
      `{at_s: ${metres(time)}, add: {cylinder: {at_m: ${list([x, y])}, radius_m: ${radius}}}, id: ${id}}`)];
  }},
};

/** What a tool needs to know of the world. */
export function surroundings(world, {state}) {
  const flights = world.lines.filter(({kind}) => kind === 'track');
  const last = Math.max(0, ...flights.map(({times}) => times.at(-1)));
  return {scenario: world.scene.edit_scenario, radius: round_step(world.frame.diagonal, 40),
    floor: world.frame.box[0][2], start: world.scene.start, time: state.time > 0 ? state.time : last / 3};
}
