// SPDX-License-Identifier: Apache-2.0
const kPlain = new Intl.NumberFormat('en', {maximumFractionDigits: 0});

/** A number with about four significant digits; a dash if there is none. */
export function number(value, unit = '') {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  const magnitude = Math.abs(value);
  const text = magnitude >= 1000 ? kPlain.format(value) :
    String(+value.toFixed(magnitude >= 100 ? 1 : magnitude >= 1 ? 2 : 3));
  return unit ? `${text} ${unit}` : text;
}

export const metres = (value) => number(value, 'm');

// Axes with greater lengths are in km.
const kLongMetres = 1e4;

/** The unit of an axis of lengths up to `greatest` metres: its name, and how many metres it is. */
export const length_unit = (greatest) => greatest > kLongMetres ? {name: 'km', metres: 1000} :
  {name: 'm', metres: 1};

/** The number at a mark of an axis with marks `step` apart; both in metres where `metres` is given. */
export function mark_text(value, step, metres = 1) {
  const apart = step / metres;
  let digits = 0;
  while (digits < 6 && Math.abs(apart * 10 ** digits - Math.round(apart * 10 ** digits)) > 1e-6) {
    digits++;
  }
  // + 0: no minus sign before a zero.
  const shown = +(value / metres).toFixed(digits) + 0;
  return shown.toLocaleString('en', {minimumFractionDigits: digits, maximumFractionDigits: digits});
}

/** A round length: "200 m", "5 km". */
export const length_text = (length) => length >= 1000 ? `${mark_text(length, length, 1000)} km` :
  `${mark_text(length, length)} m`;

export function clock(seconds) {
  const whole = Math.floor(seconds);
  const minutes = Math.floor(whole / 60);
  return `${minutes}:${String(whole % 60).padStart(2, '0')}.${Math.floor((seconds % 1) * 10)}`;
}

/** 1, 2 or 5 times a power of ten, so that `length` holds about `count` of them. */
export function round_step(length, count) {
  const raw = length / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  return power * [1, 2, 5, 10].find((factor) => factor * power >= raw * 0.999);
}
