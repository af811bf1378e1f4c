// SPDX-License-Identifier: GPL-3.0-or-later
// Where positions stand in a GeoJSON geometry.  Values are not looked at: the library reads them.

const DEPTH = { LineString: 0, MultiLineString: 1, Polygon: 1, MultiPolygon: 2 };

/** The arrays of positions of a geometry, in their order. */
export function linesOf(geometry) {
  if (geometry?.type === "GeometryCollection")
    return (geometry.geometries ?? []).flatMap((part) => linesOf(part));
  const depth = DEPTH[geometry?.type];
  const found = geometry?.coordinates;
  if (depth === undefined || !Array.isArray(found)) return [];
  return depth ? found.flat(depth - 1) : [found];
}

/** Positions that are missing, as some tools write them, are left out. */
const isMissing = (p) => !Array.isArray(p) || (p[0] ?? null) === null || (p[1] ?? null) === null;

/** The different positions along a line: {point, from, last}, the first and last number of a run of
    positions that are the same; those of a ring that closes it are one, and listed twice. */
export function runsOf(line) {
  const runs = [];
  line.forEach((p, k) => {
    if (isMissing(p)) return;
    const before = runs.at(-1);
    if (before && before.point[0] === p[0] && before.point[1] === p[1]) before.last = k;
    else runs.push({ point: [p[0], p[1]], from: k, last: k });
  });
  const [first, end] = [runs[0], runs.at(-1)];
  const closed =
    runs.length > 2 && first.point[0] === end.point[0] && first.point[1] === end.point[1];
  if (closed) [first.other, end.other] = [end, first];
  return runs;
}

/** Moves a run; an altitude stays. */
export function setRun(line, run, [x, y]) {
  for (const { from, last } of run.other ? [run, run.other] : [run])
    for (let k = from; k <= last; k++) if (!isMissing(line[k])) line[k].splice(0, 2, x, y);
}

/** Boxes around what has moved are not right any more. */
export function removeBoxes(document, feature) {
  delete document.bbox;
  delete document.features[feature].bbox;
}

/** The point of a wall that is nearest to a point. */
export function foot(wall, point) {
  const u = [wall.b[0] - wall.a[0], wall.b[1] - wall.a[1]];
  const squared = u[0] ** 2 + u[1] ** 2;
  const along = (point[0] - wall.a[0]) * u[0] + (point[1] - wall.a[1]) * u[1];
  const t = squared ? Math.min(1, Math.max(0, along / squared)) : 0;
  return [wall.a[0] + t * u[0], wall.a[1] + t * u[1]];
}
