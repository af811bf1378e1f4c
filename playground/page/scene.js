// SPDX-License-Identifier: GPL-3.0-or-later
// The scene that a user edits.  It is the document of a GeoJSON file, kept whole, as
// doc/scene-files.md describes it: edits change positions and properties in it, and what the page
// does not know stays as it was.  The library alone reads it; walls are the segments of its lines
// and rings, in their order, so that patches can be told by counting.

import { foot, linesOf, removeBoxes, runsOf, setRun } from "./geojson.js";

const FAR_LONGER = 20;
const LIGHT = ["emission", "reflectance", "transmittance"];
const HEAT = ["temperature", "flux", "heat", "shield", "emissivity"];
/** What a wall of each kind begins with. */
const KINDS = {
  light: { emission: 0, reflectance: 0.5 },
  temperature: { temperature: 300, emissivity: 0.9 },
  flux: { flux: 0, emissivity: 0.9 },
  heat: { heat: 0, emissivity: 0.9 },
  shield: { shield: true, emissivity: 0.1, sides: "both" },
  mirror: { sides: "mirror" },
};

const distance = (p, q) => Math.hypot(p[0] - q[0], p[1] - q[1]);
const same = (p, q) => p[0] === q[0] && p[1] === q[1];
const alike = (x, y) => x.length === y.length && x.every((v, k) => v === y[k]);
const given = (v) => v !== undefined && v !== null;

/** One number where a scene is grey. */
const plain = (bands) => (bands.length === 1 ? bands[0] : bands);

/** The number of a value in a band, of one that is a number or has one for each band. */
const inBand = (v, band) => (Array.isArray(v) ? v[band] : v);

function isBackOf(back, front) {
  return (
    same(back.a, front.b) &&
    same(back.b, front.a) &&
    LIGHT.every((key) => alike(back[key], front[key]))
  );
}

function around(walls) {
  const x = walls.flatMap((w) => [w.a[0], w.b[0]]);
  const y = walls.flatMap((w) => [w.a[1], w.b[1]]);
  return { low: [Math.min(...x), Math.min(...y)], high: [Math.max(...x), Math.max(...y)] };
}

const extent = ({ low, high }) => Math.max(high[0] - low[0], high[1] - low[1]);

const geometryOf = (feature) => (feature?.type === "Feature" ? feature.geometry : feature);
const propertiesOf = (feature) => (feature?.type === "Feature" && feature.properties) || {};

/** A file may also be one feature or one geometry. */
function collectionOf(root) {
  if (root.type === "FeatureCollection") return root;
  const { hr2d, ...feature } = root;
  return {
    type: "FeatureCollection",
    ...(given(hr2d) && { hr2d }),
    features: [root.type === "Feature" ? feature : root],
  };
}

/** The document of a file that is not GeoJSON: a patch and its back are one feature. */
function documentOf({ patches, background }) {
  const features = [];
  for (let k = 0; k < patches.length; k++) {
    const p = patches[k];
    const both = k + 1 < patches.length && isBackOf(patches[k + 1], p);
    const properties = { name: p.name };
    for (const key of LIGHT)
      if (key !== "transmittance" || p[key].some((t) => t > 0)) properties[key] = plain(p[key]);
    if (both) properties.sides = "both";
    features.push({
      type: "Feature",
      properties,
      geometry: { type: "LineString", coordinates: [p.a, p.b] },
    });
    if (both) k++;
  }
  return { type: "FeatureCollection", hr2d: { background: plain(background) }, features };
}

function parse(text) {
  try {
    return collectionOf(JSON.parse(text));
  } catch {
    return null;
  }
}

/** A feature stands on a line of its own. */
function write(document) {
  const { features, ...rest } = document;
  const rows = features.map((f) => JSON.stringify(f)).join(",\n");
  return `${JSON.stringify(rest).slice(0, -1)},"features":[\n${rows}\n]}\n`;
}

export class Scene {
  constructor(document = { type: "FeatureCollection", features: [] }) {
    this.document = document;
    this.bands = 1;
    this.facts = []; // of each wall, as the library has read it: {name, turned}
    this.source = null; // the text of a file, and the document in it
    this.file = 0; // which one of those that were opened,
    this.title = ""; // and its name
    this.update();
  }

  /** From the text of a file and what the library has read in it. */
  static fromFile(text, opened) {
    const read = parse(text);
    const scene = new Scene(read ?? documentOf(opened));
    if (read) scene.source = { text, written: write(read) };
    if (opened.cuts) scene.cutAt(opened.patches);
    else if (!scene.learn(opened)) throw new Error("the page cannot tell the walls of this file");
    scene.bands = opened.bands;
    return scene;
  }

  copy() {
    const scene = new Scene(structuredClone(this.document));
    scene.bands = this.bands;
    scene.source = this.source;
    scene.file = this.file;
    scene.title = this.title;
    scene.facts = structuredClone(this.facts);
    scene.update();
    return scene;
  }

  /** The text of the file: that which was loaded, as long as nothing in it has changed. */
  toGeoJSON() {
    const text = write(this.document);
    return text === this.source?.written ? this.source.text : text;
  }

  /** Finds the walls of the document. */
  update() {
    this.walls = [];
    this.document.features.forEach((feature, index) => {
      const properties = propertiesOf(feature);
      const first = this.walls.length;
      for (const line of linesOf(geometryOf(feature))) {
        const runs = runsOf(line);
        for (let k = 0; k + 1 < runs.length; k++)
          this.walls.push(this.wall(index, properties, line, runs[k], runs[k + 1]));
      }
      const count = this.walls.length - first;
      // The sides of a border stay together.
      for (const w of this.walls.slice(first)) w.alone = count === 1 || w.kind === "gas";
    });
  }

  wall(feature, properties, line, from, to) {
    const { turned = false, name } = this.facts[this.walls.length] ?? {};
    const [start, end] = turned ? [to, from] : [from, to];
    const kind = kindOf(properties);
    return {
      feature,
      line,
      properties,
      kind,
      both: isPatch({ kind }) && properties.sides === "both",
      name: name ?? String(properties.name ?? kind),
      runs: { a: start, b: end },
      a: start.point,
      b: end.point,
    };
  }

  /** Takes names and fronts of the walls from the patches that the library has read.  Returns
      whether they are those of this document. */
  learn({ patches, bands }) {
    const facts = [];
    let at = 0;
    for (const [k, w] of this.walls.entries()) {
      if (!isPatch(w)) {
        facts.push({ turned: false });
        continue;
      }
      const patch = patches[at];
      const [a, b] = this.facts[k]?.turned ? [w.b, w.a] : [w.a, w.b]; // as in the file
      const turned = Boolean(patch) && same(patch.a, b) && same(patch.b, a);
      if (!patch || !(turned || (same(patch.a, a) && same(patch.b, b)))) return false;
      facts.push({ turned, name: patch.name });
      at += w.both ? 2 : 1;
    }
    if (at !== patches.length) return false;
    this.facts = facts;
    this.bands = bands;
    this.update();
    return true;
  }

  /** Adds the positions at which the library has cut patches that cross. */
  cutAt(patches) {
    let at = 0;
    const piecesUpTo = (from, to) => {
      const points = [];
      for (let p = from; !same(p, to); p = patches[at++].b) {
        if (!patches[at] || !same(patches[at].a, p))
          throw new Error("walls cross, and their pieces cannot be told");
        if (p !== from) points.push(p);
      }
      return points;
    };
    const cuts = [];
    for (const w of this.walls) {
      if (!isPatch(w)) continue;
      const turned = patches[at] && same(patches[at].a, w.b);
      const [from, to] = turned ? [w.b, w.a] : [w.a, w.b];
      const points = piecesUpTo(from, to);
      if (w.both) piecesUpTo(to, from);
      cuts.push({ w, points: turned ? points.reverse() : points });
    }
    for (const { w, points } of cuts.reverse())
      w.line.splice(w.runs.a.last + 1, 0, ...points.map((p) => [...p]));
    this.update();
  }

  /** The number of the front patch of a wall. */
  patchOf(wall) {
    let patch = 0;
    for (const w of this.walls.slice(0, wall)) patch += patchesOf(w);
    return patch;
  }

  // Properties.

  /** The properties of a wall, to be changed: its own ones, if it shares them with others and the
      change is not for all of them. */
  edit(wall, all = false) {
    if (!all) this.separate(wall);
    const { features } = this.document;
    const index = this.walls[wall].feature;
    if (features[index].type !== "Feature")
      features[index] = { type: "Feature", properties: {}, geometry: features[index] };
    return (features[index].properties ??= {});
  }

  /** Makes a feature of each wall of a feature that has several. */
  separate(wall) {
    const { feature, alone } = this.walls[wall];
    if (alone) return;
    const { features } = this.document;
    const first = this.walls.findIndex((w) => w.feature === feature);
    const parts = this.walls.filter((w) => w.feature === feature);
    const whole = features[feature];
    const { id, bbox, geometry, ...rest } = whole.type === "Feature" ? whole : { type: "Feature" };
    const length = parts.reduce((sum, w) => sum + distance(w.a, w.b), 0);
    features.splice(
      feature,
      1,
      ...parts.map((w, k) => {
        const { faces, ...properties } = structuredClone(propertiesOf(whole));
        if (given(properties.name))
          properties.name = this.facts[first + k]?.name ?? `${properties.name}/${k + 1}`;
        for (const side of [properties, properties.back]) // a heat is that of all
          if (given(side?.heat)) side.heat *= distance(w.a, w.b) / length;
        const line = { type: "LineString", coordinates: [[...w.a], [...w.b]] };
        return { ...structuredClone(rest), properties, geometry: line };
      }),
    );
    parts.forEach((w, k) => {
      if (this.facts[first + k]) this.facts[first + k].turned = false;
    });
    this.update();
  }

  /** A property of a wall in a band; undefined if it has none. */
  value(wall, key, band) {
    const v = this.walls[wall]?.properties[key];
    return given(v) ? inBand(v, band) : undefined;
  }

  setValue(wall, key, band, value, all) {
    const properties = this.edit(wall, all);
    properties[key] = this.withBand(properties[key], key, band, value);
    this.update();
  }

  /** A value with one for each band, where a scene has several. */
  withBand(old, key, band, value) {
    const grey = ["temperature", "flux", "heat", "background_temperature"].includes(key);
    if (this.bands === 1 || grey) return value;
    const before = Array.isArray(old) ? old : Array(this.bands).fill(old ?? 0);
    return before.map((v, k) => (k === band ? value : v));
  }

  setKind(wall, kind, all) {
    const properties = this.edit(wall, all);
    const before = kindOf(properties);
    for (const key of [...LIGHT, ...HEAT, "back"]) delete properties[key];
    if (before === "mirror") delete properties.sides;
    Object.assign(properties, KINDS[kind]);
    this.update();
  }

  setSides(wall, both, all) {
    const properties = this.edit(wall, all);
    if (both) properties.sides = "both";
    else for (const key of ["sides", "transmittance", "back"]) delete properties[key];
    this.update();
  }

  setProperties(wall, properties) {
    this.edit(wall, true);
    this.document.features[this.walls[wall].feature].properties = properties;
    this.update();
  }

  // The whole scene.

  get members() {
    return this.document.hr2d ?? {};
  }

  set members(members) {
    this.document.hr2d = members;
  }

  /** Which member says what comes from the surroundings. */
  get surroundings() {
    return given(this.members.background_temperature) ? "background_temperature" : "background";
  }

  background(band) {
    return inBand(this.members[this.surroundings] ?? 0, band);
  }

  setBackground(band, value) {
    const key = this.surroundings;
    const all = this.withBand(this.members[key], key, band, value);
    this.members = { ...this.members, [key]: all };
  }

  /** {bearing, irradiance} of a band, or null. */
  sun(band) {
    const { sun } = this.members;
    if (!given(sun)) return null;
    const { direction } = sun;
    const [dx, dy] = (Array.isArray(direction?.[0]) ? direction[band] : direction) ?? [0, -1];
    const bearing = given(sun.bearing)
      ? inBand(sun.bearing, band)
      : (Math.atan2(-dx, -dy) * 180) / Math.PI;
    return { bearing, irradiance: inBand(sun.irradiance, band) };
  }

  /** A bearing holds for all bands, which have one sun. */
  setSun(band, { bearing, irradiance }) {
    const { direction, ...sun } = this.members.sun ?? { irradiance: 0 };
    const members = { ...this.members, sun };
    if (given(bearing)) sun.bearing = bearing;
    else sun.bearing ??= this.sun(band)?.bearing ?? 0;
    if (given(irradiance))
      sun.irradiance = this.withBand(sun.irradiance, "irradiance", band, irradiance);
    this.members = members;
  }

  // Geometry.

  /** The rectangle around all walls; or without those that are far longer than the extent of all
      shorter ones, such as the ground under a few things. */
  bounds(useful = false) {
    if (!this.walls.length) return { low: [0, 0], high: [1, 1] };
    if (!useful) return around(this.walls);
    const sorted = this.walls
      .map((w) => [distance(w.a, w.b), w])
      .sort(([s], [t]) => s - t);
    let box = around([sorted[0][1]]);
    for (let k = 1; k < sorted.length; k++) {
      const [length, w] = sorted[k];
      if (2 * k >= sorted.length && length >= FAR_LONGER * extent(box)) break;
      const own = around([w]);
      box = {
        low: box.low.map((v, c) => Math.min(v, own.low[c])),
        high: box.high.map((v, c) => Math.max(v, own.high[c])),
      };
    }
    return box;
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
      is joined, "figure" for all that hangs together, "alone" for this wall, which is then no
      part of a line with others any more. */
  endsToMove(wall, grabbed, how) {
    const w = this.walls[wall];
    if (how === "figure")
      return this.figureOf(wall).flatMap((k) => [
        [k, "a"],
        [k, "b"],
      ]);
    const own = grabbed === "wall" ? ["a", "b"] : [grabbed];
    if (how === "alone") {
      this.separate(wall);
      return own.map((end) => [wall, end]);
    }
    return own.flatMap((end) => this.endsAt(w[end]));
  }

  setEnd(wall, end, point) {
    const w = this.walls[wall];
    setRun(w.line, w.runs[end], point);
    removeBoxes(this.document, w.feature);
  }

  /** Moves ends of this scene from where they are in `start`. */
  move(ends, start, by) {
    this.moveEnd(ends, start, null, null, by);
  }

  /** Moves ends so that those that were at `from` are at `to`, bit for bit. */
  moveEnd(ends, start, from, to, by = [to[0] - from[0], to[1] - from[1]]) {
    this.document = structuredClone(start.document);
    this.facts = structuredClone(start.facts);
    this.update();
    for (const [wall, end] of ends) {
      const at = start.walls[wall][end];
      this.setEnd(wall, end, from && same(at, from) ? to : [at[0] + by[0], at[1] + by[1]]);
    }
    this.update();
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
    const name = `wall ${Math.max(0, ...numbers) + 1}`;
    this.document.features.push({
      type: "Feature",
      properties: { name, ...KINDS.light, sides: "both" },
      geometry: { type: "LineString", coordinates: [[...a], [...b]] },
    });
    this.facts[this.walls.length] = { name, turned: false };
    this.update();
    return this.walls.length - 1;
  }

  remove(wall) {
    this.separate(wall);
    const { feature } = this.walls[wall];
    const first = this.walls.findIndex((w) => w.feature === feature);
    this.facts.splice(first, this.walls.filter((w) => w.feature === feature).length);
    this.document.features.splice(feature, 1);
    this.update();
  }

  turn(wall) {
    if (this.walls[wall].kind === "gas") return;
    this.separate(wall);
    const w = this.walls[wall];
    const feature = this.document.features[w.feature];
    const line = { type: "LineString", coordinates: [[...w.b], [...w.a]] };
    if (feature.type === "Feature") feature.geometry = line;
    else this.document.features[w.feature] = line;
    if (this.facts[wall]) this.facts[wall].turned = false;
    this.update();
  }
}

/** Lines of mirrors and sides of the border of a gas are no patches. */
const isPatch = (wall) => wall.kind !== "mirror" && wall.kind !== "gas";

/** How many patches a wall is. */
function patchesOf(wall) {
  if (!isPatch(wall)) return 0;
  return wall.both ? 2 : 1;
}

/** Which of KINDS some properties are. */
function kindOf(properties) {
  if (given(properties.medium)) return "gas";
  if (properties.sides === "mirror") return "mirror";
  if (given(properties.emission)) return "light";
  if (given(properties.temperature)) return "temperature";
  if (given(properties.flux)) return "flux";
  if (given(properties.heat)) return "heat";
  return properties.shield === true ? "shield" : "light";
}
