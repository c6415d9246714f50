// SPDX-License-Identifier: MIT
import { element, formatNumber, icon } from './dom.js';

/** The row with the best value of a column; rows without a rank (a reference) are left out. */
function bestRow(table, column) {
  const want = table.columns[column].best;
  if (!want) {
    return -1;
  }
  let best = -1;
  table.rows.forEach((row, k) => {
    const value = row.cells[column];
    if (row.is_reference || typeof value !== 'number') {
      return;
    }
    const isBetter = best < 0 || (want === 'low' ? value < table.rows[best].cells[column] : value > table.rows[best].cells[column]);
    best = isBetter ? k : best;
  });
  return best;
}

function copyAsCsv(table) {
  const quote = (text) => `"${String(text ?? '').replaceAll('"', '""')}"`;
  const head = table.columns.map((column) => quote(column.unit ? `${column.title} [${column.unit}]` : column.title));
  const lines = [head, ...table.rows.map((row) => row.cells.map((cell) => (typeof cell === 'number' ? cell : quote(cell))))];
  return navigator.clipboard?.writeText(lines.map((line) => line.join(',')).join('\n'));
}

export function makeTable(table) {
  const best = table.columns.map((_, k) => bestRow(table, k));
  const isNumeric = table.columns.map((_, k) => table.rows.some((row) => typeof row.cells[k] === 'number'));
  const copy = element('button', { class: 'quiet', title: 'Copy as CSV', 'aria-label': 'Copy as CSV', click: () => {
    copyAsCsv(table)?.then(() => {
      copy.classList.add('done');
      setTimeout(() => copy.classList.remove('done'), 900);
    });
  } }, icon('copy'));
  return element('section', { class: 'card table' },
    element('header', {}, element('div', {}, element('h3', {}, table.title), table.note ? element('p', {}, table.note) : ''), copy),
    element('div', { class: 'scroll' }, element('table', {},
      element('thead', {}, element('tr', {}, table.columns.map((column, k) =>
        element('th', { scope: 'col', class: isNumeric[k] ? 'number' : null, title: column.hint || null }, column.title,
          column.unit ? element('small', {}, column.unit) : '')))),
      element('tbody', {}, table.rows.map((row, r) =>
        element('tr', { class: row.is_reference ? 'reference' : null }, row.cells.map((cell, k) => {
          const isNumber = typeof cell === 'number';
          const text = isNumber || cell === null ? formatNumber(cell, table.columns[k].digits ?? null) : cell;
          const mark = best[k] === r && table.rows.length > 2 ? ' best' : '';
          return element(k === 0 ? 'th' : 'td', { scope: k === 0 ? 'row' : null,
            class: isNumeric[k] ? `number${mark}` : null }, text);
        })))))));
}
