// SPDX-License-Identifier: Apache-2.0
import {flight_line} from '../world.js';

// Seconds, and the most of the film that they may be: the eye comes down from the overview before
// the flight begins, and stays when it has ended.
const kComes = {seconds: 2.5, share: 0.15};
const kStays = {seconds: 2, share: 0.12};

const length_of = ({seconds, share}, film) => Math.min(seconds, share * film);

/** For `altiplan view --mp4`: `begin` a film of that many seconds, then draw its frames, each by its
 *  second. What they show depends on nothing else. */
export function build_film(view, world, store) {
  let [seconds, comes, rate, now] = [0, 0, 1, 0];
  const line = flight_line(world, store.state);
  // After the view's own callback of this frame.
  const painted = () => new Promise((resolve) => requestAnimationFrame(() => resolve()));
  return {
    begin(length) {
      seconds = length;
      comes = length_of(kComes, seconds);
      rate = line.times.at(-1) / (seconds - comes - length_of(kStays, seconds));
      view.now = () => now;
      view.resize();
      view.look('fit');
      view.comes_in?.(comes * 1000);
      store.set({selected: line.result, source: 'flight', filmed: true, speed: rate, follow: true});
      return painted();
    },
    frame(second) {
      now = second * 1000;
      const time = Math.min(line.times.at(-1), Math.max(0, second - comes) * rate);
      store.set({time});
      view.draw();
      return painted();
    },
  };
}
