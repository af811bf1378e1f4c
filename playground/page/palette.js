// SPDX-License-Identifier: GPL-3.0-or-later
// Viridis, which those who confuse colours can read as well; the polynomials of
// tools/output/palette.c.

const CHANNELS = [
  [
    0.2777273272234177, 0.1050930431085774, -0.3308618287255563, -4.634230498983486,
    6.228269936347081, 4.776384997670288, -5.435455855934631,
  ],
  [
    0.005407344544966578, 1.404613529898575, 0.214847559468213, -5.799100973351585,
    14.17993336680509, -13.74514537774601, 4.645852612178535,
  ],
  [
    0.3340998053353061, 1.384590162594685, 0.09509516302823659, -19.33244095627987,
    56.69055060868105, -65.35303263337234, 26.3124352495832,
  ],
];
const STEPS = 256;
const TABLE = Uint8ClampedArray.from({ length: 3 * STEPS }, (_, k) => {
  const t = Math.floor(k / 3) / (STEPS - 1);
  return 255 * CHANNELS[k % 3].reduceRight((sum, c) => sum * t + c, 0);
});

/** How values become parts of the scale, from 0 to 1, and back. */
const DECADES = 4;
const SHAPES = {
  linear: [(t) => t, (t) => t],
  root: [Math.sqrt, (t) => t * t],
  log: [(t) => 1 + Math.log10(Math.max(t, 1e-30)) / DECADES, (t) => 10 ** (DECADES * (t - 1))],
};

export class Scale {
  constructor(top, shape) {
    this.top = top > 0 ? top : 1;
    [this.forward, this.backward] = SHAPES[shape];
  }

  /** The place of a value in the table of colours. */
  index(value) {
    const t = Math.min(1, Math.max(0, this.forward(Math.max(0, value) / this.top)));
    return 3 * Math.round(t * (STEPS - 1));
  }

  css(value) {
    const k = this.index(value);
    return `rgb(${TABLE[k]} ${TABLE[k + 1]} ${TABLE[k + 2]})`;
  }

  /** Writes the colour of a value as four bytes. */
  put(bytes, at, value) {
    const k = this.index(value);
    bytes[at] = TABLE[k];
    bytes[at + 1] = TABLE[k + 1];
    bytes[at + 2] = TABLE[k + 2];
    bytes[at + 3] = 255;
  }

  /** The value at a part of the scale. */
  value(t) {
    return this.top * this.backward(t);
  }
}
