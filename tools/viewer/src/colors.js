// SPDX-License-Identifier: Apache-2.0
// Distinguishable with any kind of colour vision, and from Okabe and Ito's vermilion and purple, which
// are reserved for threats and zones: no route looks like something to avoid. The same as in
// framework/host/view/series_colors.hpp, which reports use.
const kRoutes = {
  light: ['#0072b2', '#4f4606', '#d556f8', '#4fa394', '#8a662e', '#024c6c', '#1b2430'],
  dark: ['#56b4e9', '#dcc875', '#d22bfa', '#03a388', '#8e6736', '#18739f', '#e6eaef'],
};
const kRoles = {obstacle: '#7d8590', keep_out: '#cc79a7', keep_in: '#009e73', threat: '#d55e00',
  unknown: '#b3a369'};
export const kViolation = '#d55e00';
export const kKinds = ['#56b4e9', '#009e73', '#999999', '#e69f00', '#f0e442'];
export const kKindNames = ['expanded', 'added', 'removed', 'rewired', 'iteration'];
export const kRoleNames = {obstacle: 'Obstacle', keep_out: 'Keep-out zone',
  keep_in: 'Keep-in zone', threat: 'Threat', unknown: 'Unknown space, treated as blocked'};

/** The place of each result's colour: of a study's, that of its pipeline. */
let series = [];
export function set_series(results) {
  series = results.map((result, index) => result.series ?? index);
}

export function route_color(index, theme) {
  const palette = kRoutes[theme];
  return palette[(series[index] ?? index) % palette.length];
}

const channels = (color) => [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));

/** Colours of the obstacle kinds plotted beside a line of `color`, without those like it. */
export const kind_colors = (color) => ['#cc79a7', '#009e73', '#e69f00', '#56b4e9', '#8a6d3b',
  '#0072b2'].filter((other) => Math.hypot(...channels(other).map((value, at) => value -
    channels(color)[at])) > 60);

export const role_color = (role) => kRoles[role] ?? kRoles.obstacle;

/** Colour of the outline of a line: dark around light colours, light around dark ones. */
export function casing(color) {
  const [red, green, blue] = channels(color).map((value) => value / 255);
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue > 0.45 ? '#15191f' : '#ffffff';
}

/** Linear mix of two colours #rrggbb. */
export function mix(from, to, share) {
  const channel = (color, at) => parseInt(color.slice(at, at + 2), 16);
  return '#' + [1, 3, 5].map((at) => Math.round(channel(from, at) * (1 - share) +
    channel(to, at) * share).toString(16).padStart(2, '0')).join('');
}

export const style_of = (name) =>
  getComputedStyle(document.body).getPropertyValue(name).trim();
