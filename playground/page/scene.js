// SPDX-License-Identifier: GPL-3.0-or-later
// The walls that a user edits, and their text: GeoJSON as doc/scene-files.md describes it.

const FAR_LONGER = 8;

const distance = (p, q) => Math.hypot(p[0] - q[0], p[1] - q[1]);
const same = (p, q) => p[0] === q[0] && p[1] === q[1];
const alike = (x, y) => x.length === y.length && x.every((v, k) => v === y[k]);

/** One number where a scene is grey. */
const value = (bands) => (bands.length === 1 ? bands[0] : bands);

/** E is negative on a wall from which heat is taken alone: a net flux is E with a ρ of 1. */
const isFlux = (w) => w.emission.some((e) => e < 0) && w.reflectance.every((r) => r === 1);

function isBackOf(back, front) {
  return (
    back.name === `${front.name} (back)` &&
    same(back.a, front.b) &&
    same(back.b, front.a) &&
    alike(back.emission, front.emission) &&
    alike(back.reflectance, front.reflectance) &&
    alike(back.transmittance, front.transmittance)
  );
}

function around(walls) {
  const x = walls.flatMap((w) => [w.a[0], w.b[0]]);
  const y = walls.flatMap((w) => [w.a[1], w.b[1]]);
  return { low: [Math.min(...x), Math.min(...y)], high: [Math.max(...x), Math.max(...y)] };
}

const extent = ({ low, high }) => Math.max(high[0] - low[0], high[1] - low[1]);

export class Scene {
  constructor() {
    this.walls = [];
    this.background = [0];
    this.bands = 1;
  }

  /** From what the library has read: a patch and its back are one wall. */
  static fromPatches({ patches, background, bands }) {
    const scene = new Scene();
    scene.background = background;
    scene.bands = bands;
    for (let k = 0; k < patches.length; k++) {
      const both = k + 1 < patches.length && isBackOf(patches[k + 1], patches[k]);
      scene.walls.push({ ...patches[k], both });
      if (both) k++;
    }
    return scene;
  }

  copy() {
    const scene = new Scene();
    Object.assign(scene, structuredClone({ ...this }));
    return scene;
  }

  toGeoJSON() {
    const features = this.walls.map((w, k) => {
      const properties = { name: w.name || `wall ${k + 1}` };
      if (isFlux(w)) {
        properties.flux = value(w.emission);
      } else {
        properties.emission = value(w.emission);
        properties.reflectance = value(w.reflectance);
        if (w.transmittance.some((t) => t > 0)) properties.transmittance = value(w.transmittance);
      }
      if (w.both) properties.sides = "both";
      return {
        type: "Feature",
        properties,
        geometry: { type: "LineString", coordinates: [w.a, w.b] },
      };
    });
    return JSON.stringify({
      type: "FeatureCollection",
      hr2d: { background: value(this.background) },
      features,
    });
  }

  /** The number of the front patch of a wall. */
  patchOf(wall) {
    let patch = 0;
    for (let k = 0; k < wall; k++) patch += this.walls[k].both ? 2 : 1;
    return patch;
  }

  /** The wall of a patch. */
  wallOf(patch) {
    let k = 0;
    for (let p = 0; k < this.walls.length; k++) {
      p += this.walls[k].both ? 2 : 1;
      if (patch < p) break;
    }
    return k;
  }

  /** The rectangle around all walls; or without those that are far longer than all others
      together, such as the ground under a few things. */
  bounds(useful = false) {
    if (!this.walls.length) return { low: [0, 0], high: [1, 1] };
    if (!useful) return around(this.walls);
    const lengths = this.walls.map((w) => distance(w.a, w.b));
    const rest = this.walls.filter((_, k) => {
      const others = this.walls.filter((_, other) => lengths[other] < lengths[k] / FAR_LONGER);
      return !others.length || lengths[k] < FAR_LONGER * extent(around(others));
    });
    return around(rest);
  }

  size() {
    return extent(this.bounds(true)) || 1;
  }

  /** The ends at a point, as [wall, "a" or "b"]. */
  endsAt(point) {
    return this.walls.flatMap((w, k) =>
      ["a", "b"].filter((end) => same(w[end], point)).map((end) => [k, end]),
    );
  }

  /** All walls that hang together with one. */
  figureOf(wall) {
    const found = new Set([wall]);
    for (const k of found)
      for (const end of ["a", "b"])
        for (const [other] of this.endsAt(this.walls[k][end])) found.add(other);
    return [...found];
  }

  /** The ends that move with `grabbed`, which is "a", "b" or "wall".  `how` is "joints" for what
      is joined, "figure" for all that hangs together, "alone" for this wall. */
  endsToMove(wall, grabbed, how) {
    const w = this.walls[wall];
    if (how === "figure")
      return this.figureOf(wall).flatMap((k) => [
        [k, "a"],
        [k, "b"],
      ]);
    const own = grabbed === "wall" ? ["a", "b"] : [grabbed];
    if (how === "alone") return own.map((end) => [wall, end]);
    return own.flatMap((end) => this.endsAt(w[end]));
  }

  /** Moves ends of this scene from where they are in `start`. */
  move(ends, start, by) {
    for (const [wall, end] of ends) {
      const from = start.walls[wall][end];
      this.walls[wall][end] = [from[0] + by[0], from[1] + by[1]];
    }
  }

  /** Moves ends so that those that were at `from` are at `to`, bit for bit. */
  moveEnd(ends, start, from, to) {
    this.move(ends, start, [to[0] - from[0], to[1] - from[1]]);
    for (const [wall, end] of ends)
      if (same(start.walls[wall][end], from)) this.walls[wall][end] = [...to];
  }

  /** The nearest end within a distance, or else the nearest place on a wall, or null. */
  snap(point, within, but = []) {
    const excluded = new Set(but.map(([wall]) => wall));
    const others = this.walls.filter((_, k) => !excluded.has(k));
    const nearest = (points) =>
      points
        .map((p) => ({ p, d: distance(p, point) }))
        .filter(({ d }) => d <= within)
        .sort((s, t) => s.d - t.d)[0]?.p;
    const end = nearest(others.flatMap((w) => [w.a, w.b]));
    return end ?? nearest(others.map((w) => foot(w, point))) ?? null;
  }

  /** What is at a point: {wall, grabbed}, or null. */
  at(point, within) {
    let best = null;
    const offer = (wall, grabbed, d) => {
      if (d <= within && (!best || d < best.d)) best = { wall, grabbed, d };
    };
    this.walls.forEach((w, k) => {
      offer(k, "a", distance(w.a, point));
      offer(k, "b", distance(w.b, point));
    });
    if (best) return best;
    this.walls.forEach((w, k) => offer(k, "wall", distance(foot(w, point), point)));
    return best;
  }

  add(a, b) {
    const numbers = this.walls.map((w) => Number(/^wall (\d+)$/.exec(w.name)?.[1] ?? 0));
    this.walls.push({
      name: `wall ${Math.max(0, ...numbers) + 1}`,
      a,
      b,
      emission: Array(this.bands).fill(0),
      reflectance: Array(this.bands).fill(0.5),
      transmittance: Array(this.bands).fill(0),
      both: true,
    });
    return this.walls.length - 1;
  }
}

/** The point of a wall that is nearest to a point. */
export function foot(wall, point) {
  const u = [wall.b[0] - wall.a[0], wall.b[1] - wall.a[1]];
  const squared = u[0] ** 2 + u[1] ** 2;
  const along = (point[0] - wall.a[0]) * u[0] + (point[1] - wall.a[1]) * u[1];
  const t = squared ? Math.min(1, Math.max(0, along / squared)) : 0;
  return [wall.a[0] + t * u[0], wall.a[1] + t * u[1]];
}
