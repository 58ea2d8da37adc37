# SPDX-License-Identifier: Apache-2.0
"""All texts that a page shows, as rectangles: which are cut, and which lie on one another."""

# Of the document: every text node that is seen, line by line, and what the charts' canvases hold.
# What has been scrolled out of a panel that scrolls is not seen, and not cut by its edge.
FIND = """
const scrolled = arguments[0];
const corners = ({left, top, right, bottom}) => [left, top, right, bottom];
const clips = (element) => getComputedStyle(element).overflow !== 'visible';
const scrolls = (element) => /auto|scroll/.test(getComputedStyle(element).overflow) &&
  (element.scrollHeight > element.clientHeight || element.scrollWidth > element.clientWidth);
const found = [];
const add = (text, box, element, wide) => {
  let within = scrolled ? [0, -Infinity, document.documentElement.clientWidth, Infinity] :
    [0, 0, innerWidth, innerHeight];
  for (let over = element; over && over !== document.body; over = over.parentElement) {
    if (!clips(over)) continue;
    const edge = corners(over.getBoundingClientRect());
    if (scrolls(over)) {
      const out = box[0] < edge[0] || box[1] < edge[1] || box[2] > edge[2] || box[3] > edge[3];
      if (out) return;
    } else {
      within = [Math.max(within[0], edge[0]), Math.max(within[1], edge[1]),
        Math.min(within[2], edge[2]), Math.min(within[3], edge[3])];
    }
  }
  found.push({text, box, within: wide ?? within});
};
const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
for (let node = walker.nextNode(); node; node = walker.nextNode()) {
  const element = node.parentElement;
  const text = node.data.trim();
  if (!text || element.closest('script, style, option, title, iframe') ||
    !element.checkVisibility({visibilityProperty: true, opacityProperty: true})) continue;
  const svg = element.closest('svg text');
  if (svg) {
    add(text, corners(svg.getBoundingClientRect()), element,
      corners(element.closest('svg').getBoundingClientRect()));
    continue;
  }
  const range = document.createRange();
  range.selectNodeContents(node);
  for (const line of range.getClientRects()) {
    // A line is as high as its font; the letters are less.
    const spare = 0.14 * line.height;
    if (line.width > 1) add(text, [line.left, line.top + spare, line.right, line.bottom - spare], element);
  }
}
for (const {text, box, within} of window.altiplan?.labels?.() ?? []) {
  const pane = document.querySelector('.pane.profiles').getBoundingClientRect();
  if (box[1] >= pane.top && box[3] <= pane.bottom) found.push({text, box, within});
}
const wrong = [];
const kHair = 1;
for (const {text, box, within} of found) {
  if (box[0] < within[0] - kHair || box[1] < within[1] - kHair || box[2] > within[2] + kHair ||
    box[3] > within[3] + kHair) wrong.push(`cut: ${text} ${box.map(Math.round)} in ${within.map(Math.round)}`);
}
found.sort((a, b) => a.box[1] - b.box[1]);
for (const [nth, a] of found.entries()) {
  for (let other = nth + 1; other < found.length && found[other].box[1] < a.box[3] - kHair; other++) {
    const b = found[other];
    if (a.box[0] < b.box[2] - kHair && b.box[0] < a.box[2] - kHair) {
      wrong.push(`over: ${a.text} ${a.box.map(Math.round)} | ${b.text} ${b.box.map(Math.round)}`);
    }
  }
}
return {wrong, texts: found.map(({text}) => text)};
"""


def find(browser, scrolls=False):
    """{wrong, texts}; `scrolls`: a page that is longer than the window."""
    return browser.run(FIND, scrolls)
