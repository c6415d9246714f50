// SPDX-License-Identifier: MIT
// Makes the template of all reports, one file: node build.mjs FOLDER_WITH_NODE_MODULES TEMPLATE
import { mkdir, readFile, rename, writeFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const [modules, template] = process.argv.slice(2).map((path) => resolve(path));
const { build } = createRequire(join(modules, 'package.json'))('esbuild');

const bundle = async (entry) => {
  const result = await build({
    entryPoints: [join(here, 'src', entry)],
    nodePaths: [join(modules, 'node_modules')],
    bundle: true,
    minify: true,
    format: 'iife',
    target: ['es2022'],
    legalComments: 'inline',
    logLevel: 'warning',
    write: false,
    outdir: dirname(template),
  });
  return result.outputFiles[0].text.trim();
};

const parts = { '@style@': await bundle('style.css'), '@script@': await bundle('main.js') };
let page = await readFile(join(here, 'index.html'), 'utf8');
for (const [mark, text] of Object.entries(parts)) {
  page = page.split(mark).join(text);
}
await mkdir(dirname(template), { recursive: true });
await writeFile(`${template}.part`, page);
await rename(`${template}.part`, template);
