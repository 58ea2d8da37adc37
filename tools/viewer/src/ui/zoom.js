// SPDX-License-Identifier: Apache-2.0
// The shown part of a profile: [from, to] along it, or null for all of `whole`.

const kPerWheelPixel = 0.0015;
const kSmallestShare = 1 / 200;
// Where in the part the vehicle stays while it is played.
const kVehicleAt = 0.4;

/** The part `factor` times as long, with the same share of it before `at`. */
export function scaled(part, whole, at, factor) {
  const [from, to] = part ?? whole;
  const length = Math.max((to - from) * factor, (whole[1] - whole[0]) * kSmallestShare);
  if (length >= whole[1] - whole[0]) return null;
  const begin = at - (at - from) / (to - from) * length;
  return kept([begin, begin + length], whole);
}

export const moved = (part, whole, by) => part && kept(part.map((end) => end + by), whole);

function kept([from, to], whole) {
  const back = Math.max(0, whole[0] - from) - Math.max(0, to - whole[1]);
  return [from + back, to + back];
}

/** The part that shows x: at rest moved only if it is outside, played on with it. */
export function scrolled(part, whole, x, playing) {
  if (!part || x === null) return part;
  const [from, to] = part;
  const length = to - from;
  const is_behind = x > (playing ? from + kVehicleAt * length : to);
  if (!is_behind && x >= from) return part;
  const begin = x - kVehicleAt * length;
  return kept([begin, begin + length], whole);
}

/** The wheel scales, dragging moves, a double click shows all. */
export function listen_to_zoom(plot, whole, store) {
  const {over} = plot;
  const set = (zoom) => store.set({zoom});
  over.addEventListener('wheel', (event) => {
    event.preventDefault();
    set(scaled(store.state.zoom, whole, plot.posToVal(event.offsetX, 'x'),
      Math.exp(event.deltaY * kPerWheelPixel)));
  }, {passive: false});
  over.addEventListener('dblclick', () => set(null));
  let held = null;
  over.addEventListener('pointerdown', (event) => { held = event.clientX; });
  over.addEventListener('pointermove', (event) => {
    if (event.buttons !== 1 || held === null || !store.state.zoom) return;
    const [from, to] = store.state.zoom;
    set(moved(store.state.zoom, whole, (held - event.clientX) / over.clientWidth * (to - from)));
    held = event.clientX;
  });
}
