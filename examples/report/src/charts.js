// SPDX-License-Identifier: MIT
import uPlot from 'uplot';

import { element, formatNumber, themeColor } from './dom.js';

const paint = (index) => themeColor(`--series-${(index % 7) + 1}`);
const fade = (color, percent) => `color-mix(in srgb, ${color} ${percent}%, transparent)`;

/** A series that several plots show has one colour in all of them. */
export function assignColors(charts) {
  const places = new Map();
  for (const chart of charts) {
    chart.series.forEach((series, k) => places.set(series.name, [...(places.get(series.name) ?? []), k]));
  }
  for (const chart of charts) {
    const used = new Set();
    chart.series.forEach((series) => {
      const own = places.get(series.name);
      if (own.length > 1) {
        series.color = own[0];
        used.add(own[0]);
      }
    });
    chart.series.forEach((series, k) => {
      if (series.color === undefined) {
        series.color = used.has(k) ? [0, 1, 2, 3, 4, 5, 6].find((each) => !used.has(each)) ?? k : k;
        used.add(series.color);
      }
    });
  }
}

/** All x of all series, ascending, and each series on them. */
function align(chart) {
  const places = [...new Set(chart.series.flatMap((series) => series.x))].sort((a, b) => a - b);
  const index = new Map(places.map((x, k) => [x, k]));
  const rows = chart.series.map((series) => {
    const row = new Array(places.length).fill(undefined);
    series.x.forEach((x, k) => {
      const y = series.y[k];
      row[index.get(x)] = y === null || !Number.isFinite(y) || (chart.is_log_y && y <= 0) ? null : y;
    });
    return row;
  });
  return [places, ...rows];
}

/** A mean of many values is told by few digits, an axis by as many as tell its ticks apart. */
function tickLabels(isLog) {
  return (plot, ticks) => ticks.map((tick) => {
    if (tick === null) {
      return '';
    }
    if (isLog) {
      const power = Math.log10(tick);
      if (Math.abs(power - Math.round(power)) > 1e-6) {
        return '';
      }
      return power >= -3 && power <= 4 ? String(Number(tick.toPrecision(1))) : `1e${Math.round(power)}`.replace('-', '−');
    }
    const size = Math.max(...ticks.map(Math.abs));
    return size !== 0 && (size >= 1e5 || size < 1e-3)
      ? tick.toExponential(1).replace('e+', 'e').replace(/-/g, '−')
      : String(Number(tick.toPrecision(6))).replace('-', '−');
  });
}

const wholeSteps = [0, 1, 2, 3, 4, 5, 6, 7, 8].flatMap((power) => [1, 2, 5].map((digit) => digit * 10 ** power));

/** As wide as the longest of its tick labels. */
function fitToLabels(plot, labels, axisIndex) {
  const axis = plot.axes[axisIndex];
  if (!labels) {
    return 46;
  }
  plot.ctx.save();
  [plot.ctx.font] = axis.font;
  const widths = labels.map((label) => plot.ctx.measureText(label ?? '').width / devicePixelRatio);
  plot.ctx.restore();
  return Math.ceil(Math.max(28, ...widths)) + axis.ticks.size + axis.gap + 8;
}

export class Chart {
  /** `clock`: of the animation, if the x axis has its frames. */
  constructor(chart, clock) {
    this.chart = chart;
    this.clock = chart.follows_frames ? clock : null;
    this.data = align(chart);
    this.plotArea = element('div', { class: 'plot' });
    this.legend = element('div', { class: 'chart-legend' });
    this.node = element('figure', { class: 'card chart' },
      element('figcaption', {}, element('h3', {}, chart.title), chart.note ? element('p', {}, chart.note) : ''),
      this.legend, this.plotArea);
    this.playhead = element('div', { class: 'playhead' });
    new ResizeObserver(() => this.draw()).observe(this.plotArea);
    this.clock?.listen(() => this.follow());
  }

  /** Poses and epochs are counted. */
  hasWholeNumbers() {
    return this.chart.kind !== 'histogram' && this.data[0].every(Number.isInteger);
  }

  options(width, height) {
    const { chart } = this;
    const ink = themeColor('--muted');
    const axis = (title, isLog) => ({
      label: title, labelFont: '12px system-ui, sans-serif', font: '11px system-ui, sans-serif', stroke: ink, labelSize: 22,
      grid: { stroke: themeColor('--grid'), width: 1 }, ticks: { stroke: themeColor('--grid'), width: 1, size: 4 }, gap: 4,
      values: tickLabels(isLog),
    });
    const isHistogram = chart.kind === 'histogram';
    return {
      width, height, legend: { show: false }, padding: [10, 14, 0, 0],
      cursor: {
        points: { size: 7 }, drag: { x: false, y: false },
        bind: { click: (plot) => () => this.seek(plot) },
      },
      scales: {
        x: { time: false, distr: chart.is_log_x ? 3 : 1, range: chart.is_log_x ? undefined : (u, low, high) =>
          low === high ? [low - 0.5, high + 0.5] : [low, high] },
        y: { distr: chart.is_log_y ? 3 : 1, range: chart.is_log_y ? undefined : (u, low, high) => {
          const span = high - low || Math.abs(high) || 1;
          return [low >= 0 && low < 0.6 * high ? 0 : low - 0.08 * span, high + 0.08 * span];
        } },
      },
      axes: [
        { ...axis(chart.x_title, chart.is_log_x), size: 30, incrs: this.hasWholeNumbers() ? wholeSteps : undefined },
        { ...axis(chart.y_title, chart.is_log_y), size: fitToLabels },
      ],
      series: [{}, ...chart.series.map((series, k) => {
        const color = paint(series.color);
        return {
          label: series.name, stroke: color, width: 1.75, dash: series.is_dashed ? [6, 4] : undefined, spanGaps: true,
          paths: isHistogram ? uPlot.paths.stepped({ align: 1 })
            : series.has_line ? uPlot.paths.linear() : () => null,
          fill: isHistogram ? fade(color, 14) : undefined,
          points: { show: !isHistogram && (!series.has_line || series.x.length <= 24) && !series.is_dashed, size: 5,
            fill: color },
        };
      })],
      hooks: { draw: [(plot) => this.drawMarks(plot)], setCursor: [(plot) => this.readOff(plot)] },
    };
  }

  draw() {
    const width = this.plotArea.clientWidth;
    if (width === 0) {
      return;
    }
    this.plot?.destroy();
    this.plot = new uPlot(this.options(width, 250), this.data, this.plotArea);
    this.plot.over.append(this.playhead);
    this.plot.over.classList.toggle('seekable', this.clock !== null);
    this.readOff(this.plot);
    this.follow();
  }

  drawMarks(plot) {
    const { ctx, bbox } = plot;
    for (const mark of this.chart.marks ?? []) {
      const x = Math.round(plot.valToPos(mark.x, 'x', true)) + 0.5;
      if (x < bbox.left || x > bbox.left + bbox.width) {
        continue;
      }
      ctx.save();
      ctx.strokeStyle = ctx.fillStyle = themeColor('--muted');
      ctx.setLineDash([2 * devicePixelRatio, 3 * devicePixelRatio]);
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
      const isRight = x > bbox.left + bbox.width / 2;
      ctx.textAlign = isRight ? 'right' : 'left';
      ctx.fillText(mark.label, x + (isRight ? -5 : 5) * devicePixelRatio, bbox.top + 12 * devicePixelRatio);
      ctx.restore();
    }
  }

  /** Names of the series and, under the cursor, their values. */
  readOff(plot) {
    const place = plot.cursor.idx;
    const items = this.chart.series.map((series, k) => {
      const value = place === null || place === undefined ? null : this.data[k + 1][place];
      const swatch = element('span', { class: `swatch${series.is_dashed ? ' dashed' : ''}` });
      swatch.style.setProperty('--color', paint(series.color));
      const isRead = value !== null && value !== undefined;
      return element('span', { class: 'item' }, swatch, series.name, isRead ? element('b', {}, formatNumber(value)) : '');
    });
    if (place !== null && place !== undefined) {
      items.push(element('span', { class: 'item at' }, `${this.chart.x_title}: ${formatNumber(this.data[0][place])}`));
    }
    this.legend.replaceChildren(...items);
  }

  seek(plot) {
    const { left } = plot.cursor;
    if (!this.clock || left === undefined || left < 0) {
      return;
    }
    const time = plot.posToVal(left, 'x');
    const { places } = this.clock;
    this.clock.pause();
    this.clock.show(places.reduce((best, t, k) => (Math.abs(t - time) < Math.abs(places[best] - time) ? k : best), 0));
  }

  follow() {
    if (!this.clock || !this.plot) {
      this.playhead.style.display = 'none';
      return;
    }
    const x = this.plot.valToPos(this.clock.places[this.clock.frame], 'x');
    const isInside = x >= -1 && x <= this.plot.over.clientWidth + 1;
    this.playhead.style.display = isInside ? '' : 'none';
    this.playhead.style.transform = `translateX(${Math.round(x)}px)`;
  }
}
