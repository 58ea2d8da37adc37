// SPDX-License-Identifier: Apache-2.0
/** Decodes base64. */
export function bytes(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}

/**
 * Unpacks a long list of framework/host/view/viewer_page.cpp: thousandths, each as its difference
 * from the value predicted from those before it; points (`per` numbers each) are stored column by
 * column. 0 is null, 1 and a number n repeat the last token n times.
 */
function unpacked({packed, count, per, order}) {
  const raw = bytes(packed);
  let at = 0;
  const read = () => {
    let value = 0;
    let scale = 1;
    for (; raw[at] >= 128; scale *= 128) value += (raw[at++] - 128) * scale;
    return value + raw[at++] * scale;
  };
  let current = 0;
  let repeats = 0;
  const token = () => {
    if (repeats > 0) {
      --repeats;
      return current;
    }
    const next = read();
    if (next !== 1) return (current = next);
    repeats = read() - 1;
    return current;
  };
  const column = () => {
    const values = new Array(count);
    let last = 0;
    let step = 0;
    for (let n = 0; n < count; ++n) {
      const next = token();
      if (next === 0) {
        values[n] = null;
        continue;
      }
      const now = last + step + (next % 2 === 1 ? -(next - 1) / 2 : (next - 2) / 2);
      step = order === 2 ? now - last : 0;
      last = now;
      values[n] = now / 1000;
    }
    return values;
  };
  if (per === 0) return column();
  const columns = Array.from({length: per}, column);
  return columns[0].map((_, n) => columns.map((values) => values[n]));
}

/** Parses JSON that contains packed lists. */
export function parse_packed(text) {
  return JSON.parse(text, (_, value) => (value?.packed === undefined ? value : unpacked(value)));
}
