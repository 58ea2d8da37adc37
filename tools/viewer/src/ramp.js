// SPDX-License-Identifier: Apache-2.0
// Height colours: lightness (OKLab L) increases evenly from low to high ground and the hue runs
// from blue-grey through sage to sand, an axis distinguishable with any kind of colour vision. The
// chroma is low, so that routes and zones stand out.
const kLightness = [0.54, 0.95];
const kHue = [215, 75];
const kChroma = [0.045, 0.055];
const kEntries = 256;

/** OKLCH to sRGB bytes (Ottosson's OKLab matrices). */
function rgb(lightness, chroma, hue_deg) {
  const a = chroma * Math.cos(hue_deg * Math.PI / 180);
  const b = chroma * Math.sin(hue_deg * Math.PI / 180);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.2914855480 * b) ** 3;
  const linear = [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s];
  return linear.map((value) => {
    const kept = Math.min(1, Math.max(0, value));
    return 255 * (kept <= 0.0031308 ? 12.92 * kept : 1.055 * kept ** (1 / 2.4) - 0.055);
  });
}

const between = ([from, to], share) => from + (to - from) * share;

/** 256 colours of three bytes, from the lowest to the highest ground. */
export const ramp = new Uint8Array(kEntries * 3);
for (let entry = 0; entry < kEntries; entry++) {
  const share = entry / (kEntries - 1);
  ramp.set(rgb(between(kLightness, share), between(kChroma, share), between(kHue, share)),
    entry * 3);
}

export function ramp_gradient() {
  const stops = [];
  for (let stop = 0; stop <= 8; stop++) {
    const at = Math.round(stop / 8 * (kEntries - 1)) * 3;
    stops.push(`rgb(${ramp[at]},${ramp[at + 1]},${ramp[at + 2]})`);
  }
  return `linear-gradient(to right,${stops.join(',')})`;
}
