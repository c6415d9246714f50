// SPDX-License-Identifier: MIT
import { Color } from 'three';

import { formatNumber } from './dom.js';

export const noValue = 255;

/** A field's colours: its stops (sRGB, given by the program), for the page and for the renderer. */
export class Scale {
  constructor(field) {
    this.field = field;
    this.table = new Float32Array(3 * 256);  // linear colours of the codes
    const color = new Color();
    const last = field.stops.length - 1;
    for (let code = 0; code < 255; ++code) {
      const place = (code / 254) * last;
      const below = Math.min(Math.floor(place), last - 1);
      color.set(field.stops[below]).lerp(new Color(field.stops[below + 1]), place - below);
      color.toArray(this.table, 3 * code);
    }
    color.set(field.nothing).toArray(this.table, 3 * noValue);
  }

  value(code) {
    return this.field.low + (code / 254) * (this.field.high - this.field.low);
  }

  /** A value as exact as the codes are. */
  tell(value) {
    const step = (this.field.high - this.field.low) / 254;
    return formatNumber(value, Math.min(6, Math.max(0, Math.ceil(-Math.log10(step) - 0.3))));
  }

  get gradient() {
    const stops = this.field.stops.map((stop, k) => `${stop} ${(100 * k) / (this.field.stops.length - 1)}%`);
    return `linear-gradient(to right, ${stops.join(', ')})`;
  }
}
