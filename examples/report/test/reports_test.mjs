// SPDX-License-Identifier: MIT
// Opens reports in headless Chromium and uses them as a reader would:
//   node reports_test.mjs FOLDER_WITH_NODE_MODULES CHROMIUM PICTURE_FOLDER REPORT...
// Each must load without an error and without a request, draw something, play, scrub, switch a layer off and on, change its
// colours with the theme, and hold the positions that the program had. PICTURE_FOLDER receives what was seen.
// Exit status 77: skipped, because the pages were not built; with SOFTTISSUE_REQUIRE_NODE set that is a failure.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, mkdtempSync, rmSync, statSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [packages, executablePath, pictureFolder, ...files] = process.argv.slice(2);
const largestFile = 15e6;

function skip(reason) {
  console.log(`skipped: ${reason}`);
  process.exit(process.env.SOFTTISSUE_REQUIRE_NODE ? 1 : 77);
}

if (!existsSync(join(packages, 'node_modules', 'playwright-core'))) {
  skip('the packages of the page are not installed (see the output of the build)');
}
if (!files.some((file) => existsSync(file))) {
  skip('the programs wrote no report, because its page was not built (see the output of the build)');
}
const { chromium } = createRequire(join(resolve(packages), 'package.json'))('playwright-core');

const profile = mkdtempSync(join(tmpdir(), 'softtissue-browser-'));
const context = await chromium.launchPersistentContext(profile, {
  executablePath,
  headless: true,
  viewport: { width: 960, height: 640 },
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic',
    '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'],
});

context.setDefaultTimeout(60000);  // other tests may need the machine

/** How many different colours the 3D view shows, and how much of it is not background. */
const lookAt = (page) => page.evaluate(() => {
  const { viewer } = globalThis.softtissueReport;
  viewer.stage.render();
  const small = document.createElement('canvas');
  [small.width, small.height] = [160, 100];
  const pen = small.getContext('2d', { willReadFrequently: true });
  pen.drawImage(viewer.canvas, 0, 0, 160, 100);
  const { data } = pen.getImageData(0, 0, 160, 100);
  const colors = new Set();
  let covered = 0;
  let sum = 0;
  for (let i = 0; i < data.length; i += 4) {
    covered += data[i + 3] > 200 ? 1 : 0;
    colors.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
    sum += data[i] + 3 * data[i + 1] + 7 * data[i + 2] + 11 * (i % 997) * data[i + 3];
  }
  return { colors: colors.size, covered: covered / 16000, sum };
});

/** The decoded positions have the means that the program computed before it packed them. */
const comparePositions = (page) => page.evaluate(() => {
  const { report, viewer } = globalThis.softtissueReport;
  const last = report.scene.times.length - 1;
  const errors = viewer.parts.flatMap((part, k) =>
    part.mean(last).map((value, axis) => Math.abs(value - report.scene.meshes[k].mean_of_last_frame[axis])));
  return { error: Math.max(...errors), step: report.scene.grid.step };
});

async function check3d(page) {
  const frames = await page.evaluate(() => globalThis.softtissueReport.viewer.clock.count);
  const first = await lookAt(page);
  assert(first.colors > 20 && first.covered > 0.002, `the 3D view is empty: ${JSON.stringify(first)}`);

  const { error, step } = await comparePositions(page);
  assert(error <= step, `positions are off by ${error} m, expected at most ${step} m`);

  const frame = () => page.evaluate(() => globalThis.softtissueReport.viewer.clock.frame);
  if (frames > 1) {
    await page.locator('.scrub').fill('0');
    assert.equal(await frame(), 0, 'the slider does not show its frame');
    const start = await lookAt(page);
    await page.locator('.scrub').fill(String(frames - 1));
    assert.equal(await frame(), frames - 1, 'the slider does not show its frame');
    const end = await lookAt(page);
    assert.notEqual(start.sum, end.sum, 'the last frame looks like the first one');
    await page.keyboard.press('Home');
    await page.keyboard.press('ArrowRight');
    assert.equal(await frame(), 1, 'the arrow key does not step');
    await page.keyboard.press('ArrowLeft');
    await page.locator('.play').click();
    await page.waitForFunction(() => globalThis.softtissueReport.viewer.clock.frame > 0, null);
    await page.keyboard.press('Space');
    assert(!(await page.evaluate(() => globalThis.softtissueReport.viewer.clock.isPlaying)), 'space does not pause');
  }

  const shown = page.locator('.layer[aria-pressed="true"]');
  while (await shown.count() > 0) {
    await shown.first().click();
  }
  const nothing = await lookAt(page);
  assert(nothing.covered < 0.001, 'with all layers off, something is left');
  await page.locator('.layer').first().click();
  const again = await lookAt(page);
  assert(again.covered > 0.01 || (await page.locator('.layer').count()) > 1, 'a layer does not come back');
}

async function check(file) {
  const size = statSync(file).size;
  assert(size < largestFile, `${size} bytes, expected at most ${largestFile}`);
  const page = await context.newPage();
  const complaints = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) &&
    !message.text().includes('GL Driver Message') && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('request', (request) => /^(http|ws)/.test(request.url()) && complaints.push(`asks for ${request.url()}`));
  await page.goto(pathToFileURL(resolve(file)).href);
  await page.waitForSelector('html[data-ready="true"]');
  const what = await page.evaluate(() => {
    const { report, viewer } = globalThis.softtissueReport;
    return { has3d: viewer !== null, charts: report.charts.length, tables: report.tables.length };
  });
  const picture = `${basename(dirname(resolve(file)))}_${basename(file, '.html')}.png`;
  await page.screenshot({ path: join(pictureFolder, picture) });
  if (what.has3d) {
    await check3d(page);
  }
  assert.equal(await page.locator('.chart canvas').count(), what.charts, 'a plot is missing');
  assert.equal(await page.locator('.table table').count(), what.tables, 'a table is missing');
  assert(what.has3d || what.charts > 0 || what.tables > 0, 'the page is empty');
  const paper = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const before = await paper();
  await page.keyboard.press('t');
  assert.notEqual(await paper(), before, 'the theme does not change');
  assert.deepEqual(complaints, [], 'the console has complaints');
  await page.close();
  return what;
}

mkdirSync(pictureFolder, { recursive: true });
let failures = 0;
for (const file of files) {
  const begin = performance.now();
  try {
    const { has3d, charts, tables } = await check(file);
    const seconds = ((performance.now() - begin) / 1000).toFixed(1);
    console.log(`ok      ${file}: ${(statSync(file).size / 1e6).toFixed(1)} MB, ${has3d ? '3D, ' : ''}${charts} plots, ${tables} tables, ${seconds} s`);
  } catch (error) {
    ++failures;
    console.log(`FAILED  ${file}: ${error.message}`);
  }
}
await context.close();
rmSync(profile, { recursive: true, force: true });
process.exit(failures > 0 ? 1 : 0);
