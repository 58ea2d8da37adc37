// SPDX-License-Identifier: Apache-2.0
// Bundles src/ with three.js and uPlot into one page that needs nothing beside itself.
import {build} from 'esbuild';
import {createHash} from 'node:crypto';
import {readFileSync, readdirSync, writeFileSync} from 'node:fs';

const kPage = 'dist/viewer.html';
const kMaxBytes = 1.5e6;
const kPlace = '/*SCENE*/';

async function bundled(entry) {
  const result = await build({
    entryPoints: [entry], bundle: true, minify: true, write: false, format: 'iife',
    target: 'es2022', charset: 'utf8', legalComments: 'none',
  });
  return result.outputFiles[0].text.trim();
}

// Libraries name their documentation in messages and comments. Nothing would fetch it, but a page
// without a single address is easier to trust; name spaces are not addresses.
function without_addresses(text) {
  return text.replace(/https?:\/\/(?!www\.w3\.org\/)[^\s"'`)\]}\\]*/g, '');
}

function licences() {
  return readFileSync('LICENSES.md', 'utf8').replaceAll('--', '—').trim();
}

// What the page is made of, in a number: a test that has no npm can tell a page that was forgotten.
function sources() {
  const files = readdirSync('src', {recursive: true, withFileTypes: true})
    .filter((entry) => entry.isFile()).map(({path, name}) => `${path}/${name}`);
  const hash = createHash('sha256');
  for (const file of [...files, 'LICENSES.md', 'bundle.mjs', 'package-lock.json'].sort()) {
    hash.update(`${file}\n`).update(readFileSync(file));
  }
  return hash.digest('hex');
}

const parts = {
  SOURCES: sources(),
  LICENCES: licences(),
  STYLE: await bundled('src/style.css'),
  SCRIPT: await bundled('src/main.js'),
};
const page = readFileSync('src/page.html', 'utf8')
  .replace(/LICENCES|(?<=content=")SOURCES(?=")|(?<=<style>)STYLE|(?<=<script>)SCRIPT/g,
    (name) => without_addresses(parts[name]))
  // Only shaders have lines that end in blanks; they do not mind.
  .replace(/[ \t]+$/gm, '');

if (page.split(kPlace).length !== 2) {
  throw new Error(`the page must hold ${kPlace} once: that is where the scene goes`);
}
if (Buffer.byteLength(page) > kMaxBytes) {
  throw new Error(`the page has ${Buffer.byteLength(page)} bytes, the limit is ${kMaxBytes}`);
}
if (process.argv.includes('--check')) {
  if (readFileSync(kPage, 'utf8') !== page) {
    throw new Error(`${kPage} is not what src/ makes: run tools/viewer/build and commit it`);
  }
} else {
  writeFileSync(kPage, page);
}
console.log(`${kPage}: ${Buffer.byteLength(page)} bytes`);
