// SPDX-License-Identifier: Apache-2.0
import {by_id, element} from '../dom.js';
import {clock, number} from '../units.js';
import {happenings} from './happenings.js';

const kSpeeds = [1, 2, 5, 10, 20, 50, 100];
// The default speed plays a flight in at most this time.
const kWatchSeconds = 40;

/** The flight's time: slider, play, speed, and marks of handovers, replans and events. */
export function build_clock(world, store) {
  const tracks = world.lines.filter(({kind}) => kind === 'track');
  const is_editing = document.body.classList.contains('editing');
  by_id('clock').hidden = tracks.length === 0 && !is_editing;
  // While one drags, the picture above keeps its size.
  if (tracks.length === 0 && is_editing) {
    by_id('clock').style.minHeight = `${by_id('clock').offsetHeight}px`;
  }
  by_id('clock').replaceChildren();
  if (tracks.length === 0) return;
  const last = Math.max(...tracks.map(({times}) => times.at(-1)));
  const play = element('button', {id: 'play', title: 'Play or pause (space)',
    onclick: () => store.set({playing: !store.state.playing})});
  const follow = element('button', {id: 'follow', title: 'Fly behind the vehicle (F)',
    onclick: () => store.set({follow: !store.state.follow})}, 'Follow');
  const slider = element('input', {type: 'range', id: 'time', min: 0, max: last, step: 'any',
    ariaLabel: 'Time of flight',
    oninput: () => store.set({time: Number(slider.value), playing: false})});
  const shown = element('output', {id: 'time_text'});
  const marks = element('div', {className: 'marks'});
  const speed = element('select', {id: 'speed', title: 'Speed',
    onchange: () => store.set({speed: Number(speed.value)})},
    kSpeeds.map((factor) => element('option', {value: factor}, `${factor}×`)));
  // Another flight of about the same length is played as fast.
  if (store.state.version === 0) {
    store.set({speed: kSpeeds.find((factor) => last / factor <= kWatchSeconds) ?? kSpeeds.at(-1)});
  }
  by_id('clock').append(play, follow, element('div', {className: 'rail'}, marks, slider), shown, speed);

  const reflect = () => {
    const {time, playing} = store.state;
    slider.value = time;
    shown.textContent = `${clock(time)} / ${clock(last)}`;
    play.textContent = playing ? '❚❚' : '▶';
    play.ariaLabel = playing ? 'Pause' : 'Play';
    speed.value = store.state.speed;
    follow.ariaPressed = String(store.state.follow);
  };
  const reflect_marks = () => marks.replaceChildren(...
    happenings(world.scene, store.state.selected).map((mark) => sign(mark, last, store)));
  store.on(['time', 'playing', 'speed', 'follow'], reflect);
  store.on(['selected'], reflect_marks);
  store.on(['playing'], () => {
    if (!store.state.playing) return;
    // What is played is the flight, and so are the profiles.
    if (world.scene.results[store.state.selected]?.flight?.profile) store.set({source: 'flight'});
    run(store, last);
  });
  reflect();
  reflect_marks();
}

function sign({at_s, kind, text, event}, last, store) {
  const made = element('button', {className: kind, title: `${number(at_s, 's')}: ${text}`,
    onclick: () => store.set({time: at_s, playing: false})});
  made.style.left = `${100 * at_s / last}%`;
  if (event !== undefined) made.dataset.event = event;
  return made;
}

function run(store, last) {
  if (store.state.time >= last) store.set({time: 0});
  let before = performance.now();
  const step = (now) => {
    if (!store.state.playing) return;
    const time = store.state.time + Math.max(0, now - before) / 1000 * store.state.speed;
    before = now;
    store.set(time >= last ? {time: last, playing: false} : {time});
    requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
}
