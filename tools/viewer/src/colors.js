// SPDX-License-Identifier: Apache-2.0
// Okabe and Ito's palette, distinguishable with any kind of colour vision. Vermilion and purple are
// reserved for threats and zones, so that no route looks like something to avoid.
const kRoutes = {
  light: ['#0072b2', '#e69f00', '#009e73', '#56b4e9', '#f0e442', '#000000'],
  dark: ['#56b4e9', '#e69f00', '#009e73', '#f0e442', '#0072b2', '#ffffff'],
};
const kRoles = {obstacle: '#7d8590', keep_out: '#cc79a7', keep_in: '#009e73', threat: '#d55e00',
  unknown: '#b3a369'};
export const kViolation = '#d55e00';
export const kKinds = ['#56b4e9', '#009e73', '#999999', '#e69f00', '#f0e442'];
export const kKindNames = ['expanded', 'added', 'removed', 'rewired', 'iteration'];
export const kRoleNames = {obstacle: 'Obstacle', keep_out: 'Keep-out zone',
  keep_in: 'Keep-in zone', threat: 'Threat', unknown: 'Unknown space, treated as blocked'};

export function route_color(index, theme) {
  const palette = kRoutes[theme];
  return palette[index % palette.length];
}

/** Colours of the obstacle kinds plotted beside a line of `color`, which is left out. */
export const kind_colors = (color) => ['#cc79a7', '#009e73', '#e69f00', '#56b4e9', '#8a6d3b',
  '#0072b2'].filter((other) => other !== color);

export const role_color = (role) => kRoles[role] ?? kRoles.obstacle;

/** Colour of the outline of a line: dark around light colours, light around dark ones. */
export function casing(color) {
  const [red, green, blue] = [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16) / 255);
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
