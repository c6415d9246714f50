// SPDX-License-Identifier: MIT
import { assignColors, Chart } from './charts.js';
import { element, icon } from './dom.js';
import { gridStep } from './stage.js';
import { makeTable } from './table.js';
import { Viewer } from './viewer.js';

const report = JSON.parse(document.getElementById('report').textContent);

// The theme: the system's until the reader chooses. A file without storage forgets the choice.
const systemIsDark = matchMedia('(prefers-color-scheme: dark)');
const remembered = () => {
  try {
    return localStorage.getItem('softtissue-theme');
  } catch {
    return null;
  }
};
const themed = [];

function applyTheme(theme) {
  document.documentElement.dataset.theme = theme ?? (systemIsDark.matches ? 'dark' : 'light');
  themed.forEach((part) => part());
}

function toggleTheme() {
  const theme = document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark';
  try {
    localStorage.setItem('softtissue-theme', theme);
  } catch {
    // only this page then
  }
  applyTheme(theme);
}

applyTheme(remembered());
systemIsDark.addEventListener('change', () => applyTheme(remembered()));

function makeHeader() {
  const theme = element('button', { class: 'quiet', title: 'Light or dark (T)', 'aria-label': 'Light or dark',
    click: toggleTheme });
  const draw = () => theme.replaceChildren(icon(document.documentElement.dataset.theme === 'dark' ? 'sun' : 'moon'));
  themed.push(draw);
  draw();
  return element('header', { class: 'top' },
    element('div', {}, element('p', { class: 'brand' }, 'softtissue', element('span', {}, report.program)),
      element('h1', {}, report.title), element('p', { class: 'summary' }, report.summary)),
    theme);
}

function makeFigures() {
  return element('section', { class: 'figures', 'aria-label': 'Key figures' }, report.figures.map((figure) =>
    element('div', { class: 'card figure' }, element('p', { class: 'name' }, figure.name),
      element('p', { class: 'value' }, figure.value, figure.unit ? element('small', {}, ` ${figure.unit}`) : ''),
      figure.note ? element('p', { class: 'note' }, figure.note) : '')));
}

function makeFooter(viewer) {
  const keys = [['space', 'play, pause'], ['← →', 'one frame'], ['shift ← →', 'a tenth'], ['R', 'reset view'], ['L', 'mesh lines'],
    ['1 … 9', 'views'], ['T', 'light, dark']];
  const notes = [...report.notes];
  if (report.scene?.has_ground) {
    notes.push(`A square of the floor is ${100 * gridStep} cm wide.`);
  }
  return element('footer', {},
    notes.length > 0 ? element('div', { class: 'notes' }, element('h3', {}, 'About these results'),
      element('ul', {}, notes.map((note) => element('li', {}, note)))) : '',
    viewer ? element('div', { class: 'keys' }, element('h3', {}, 'Keys'),
      element('dl', {}, keys.map(([key, what]) => element('div', {}, element('dt', {}, element('kbd', {}, key)), element('dd', {}, what))))) : '',
    element('p', { class: 'made' }, `Written by ${report.program} of softtissue ${report.version}. This page is one file: it asks no server for anything.`));
}

async function start() {
  document.title = `${report.title} · softtissue`;
  const page = element('main', {});
  document.body.append(page);
  page.append(makeHeader());
  let viewer = null;
  if (report.scene) {
    const waiting = element('section', { class: 'card waiting' }, 'Unpacking …');
    page.append(waiting);
    await new Promise((resolve) => setTimeout(resolve, 0));
    if (typeof DecompressionStream === 'undefined') {
      waiting.textContent = 'This browser is too old to unpack the animation (it lacks DecompressionStream). Plots and tables are below.';
    } else {
      viewer = await Viewer.make(report.scene, report.buffers);
      waiting.replaceWith(viewer.node);
      viewer.start();
      themed.push(() => viewer.stage?.applyTheme());
    }
    report.buffers = null;
  }
  if (report.figures.length > 0) {
    page.append(makeFigures());
  }
  if (report.charts.length > 0) {
    assignColors(report.charts);
    const charts = report.charts.map((chart) => new Chart(chart, viewer?.clock ?? null));
    page.append(element('section', { class: `charts${charts.length === 1 ? ' single' : ''}`, 'aria-label': 'Plots' },
      charts.map((chart) => chart.node)));
    themed.push(() => charts.forEach((chart) => chart.draw()));
  }
  page.append(...report.tables.map(makeTable));
  page.append(makeFooter(viewer));
  document.addEventListener('keydown', (event) => {
    const isTyping = event.target instanceof HTMLInputElement && event.target.type !== 'range';
    if (isTyping || event.ctrlKey || event.metaKey || event.altKey) {
      return;
    }
    const key = event.key.toLowerCase();
    if (key === 't') {
      toggleTheme();
    } else if (key === ' ' && event.target instanceof HTMLButtonElement && !event.target.classList.contains('play')) {
      return;  // the button's own key
    } else if (!viewer?.stage || !viewer.press(key, event.shiftKey)) {
      return;
    }
    event.preventDefault();
  });
  globalThis.softtissueReport = { report, viewer };  // for the browser's console and the tests
  document.documentElement.dataset.ready = 'true';
}

start().catch((error) => {
  document.body.append(element('p', { class: 'excuse' }, `This report cannot be shown: ${error.message}`));
  throw error;
});
