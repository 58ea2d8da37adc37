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
