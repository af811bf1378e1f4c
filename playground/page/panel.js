// SPDX-License-Identifier: GPL-3.0-or-later
// The panel: what it shows of a scene and of an answer.

import { drawChart } from "./chart.js";
import { paintTiles } from "./tiles.js";

const TICKS = 6;

export const $ = (id) => document.getElementById(id);

/** A number in few digits. */
export function short(value) {
  if (!Number.isFinite(value)) return "unknown";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return value.toExponential(2);
  return String(Number(value.toPrecision(4)));
}

const whole = (value) => value.toLocaleString("en");
const tiny = (value) => (Number.isFinite(value) ? value.toExponential(1) : "not known");

export function showStatus(state, text) {
  const status = $("status");
  status.dataset.state = state;
  if (status.textContent !== text) status.textContent = text;
  const busy = state === "busy";
  $("stop").hidden = !busy;
  $("progress").hidden = !busy;
  if (busy) $("progress").removeAttribute("value");
}

/** The phase is not spoken by a reader of the screen: it would never be silent. */
export function showProgress({ phase, fraction }) {
  $("progress").value = fraction;
  $("progress").title = phase;
}

/** A note stays until the next edit, a failure until the next answer. */
export function showMessage(text, kind = "failure") {
  $("message").dataset.kind = kind;
  $("message").textContent = text;
  $("message").hidden = !text;
}

function showList(list, rows) {
  list.replaceChildren(
    ...rows.flatMap(([term, text]) => {
      const dt = document.createElement("dt");
      const dd = document.createElement("dd");
      dt.textContent = term;
      dd.textContent = text;
      return [dt, dd];
    }),
  );
}

/** N, L and, of an exact answer, its errors. */
export function showNumbers(answer, exact) {
  const a = answer.account;
  const rows = [
    ["elements N", whole(a.elements)],
    ["links L", whole(a.links)],
    ["order p", String(a.order)],
  ];
  if (exact) {
    const say = (text) => (answer.measured ? text : "…");
    rows.push(
      ["error of averages", say(`about ${tiny(a.average.estimate)}`)],
      ["at most", say(tiny(a.average.bound))],
    );
    if (!answer.measured || Number.isFinite(a.sup.estimate))
      rows.push(["error at points", say(`about ${tiny(a.sup.estimate)}`)]);
    if (answer.seconds) rows.push(["time", `${short(answer.seconds)} s`]);
  }
  showList($("numbers"), rows);
}

/** What stands in the place of an answer that there is not. */
export function showNoAnswer() {
  $("numbers").replaceChildren();
  showOld();
}

/** While something moves: these belong to an exact answer. */
export function showOld() {
  $("values").tBodies[0].replaceChildren();
  showWarnings([]);
}

const cell = (value) => (value === null || value === undefined ? "" : String(value));

/** Every average with all its digits, from the document of the program; sunlight and heat where the
    scene has some. */
export function showValues({ patches }) {
  const table = $("values");
  for (const [name, key] of [
    ["of-sun", "sunlight"],
    ["of-heat", "heat"],
  ])
    table.classList.toggle(name, patches.some((p) => p[key] !== undefined));
  const rows = patches.flatMap((p) =>
    p.average.map((B, band) => {
      const row = document.createElement("tr");
      const heat = band ? [] : [p.temperature, p.heat]; // of all bands together
      const cells = [p.name, band, B, p.irradiance[band], p.sunlight?.[band], ...heat];
      for (const value of cells) row.insertCell().textContent = cell(value);
      return row;
    }),
  );
  table.tBodies[0].replaceChildren(...rows);
}

/** What the library finds odd in a scene. */
export function showWarnings(warnings) {
  $("warnings").hidden = !warnings.length;
  $("warnings-count").textContent = String(warnings.length);
  $("warnings-list").replaceChildren(
    ...warnings.map(({ text }) => {
      const item = document.createElement("li");
      item.textContent = text;
      return item;
    }),
  );
}

export function showLegend(scale) {
  const canvas = $("legend");
  const context = canvas.getContext("2d");
  const image = context.createImageData(canvas.width, 1);
  for (let k = 0; k < canvas.width; k++)
    scale.put(image.data, 4 * k, scale.value(k / (canvas.width - 1)));
  context.putImageData(image, 0, 0);
  $("legend-ticks").replaceChildren(
    ...Array.from({ length: TICKS }, (_, k) => {
      const tick = document.createElement("span");
      tick.textContent = short(scale.value(k / (TICKS - 1)));
      return tick;
    }),
  );
}

export function showStudy(study, now) {
  drawChart($("chart"), study, now);
  const rows = study.rows.filter((r) => r.links > 0);
  if (!rows.length) {
    $("chart-text").textContent = "No links: no light reaches anything here.";
    return;
  }
  const last = rows.at(-1);
  const slope = study.slope ? `; L grows like N to the power of ${study.slope.toFixed(2)}` : "";
  const ring = now
    ? ` The ring is the answer that is shown: N = ${whole(now.elements)}, L = ${whole(now.links)}.`
    : "";
  $("chart-text").textContent =
    `The paper’s algorithm for ε from ${short(rows[0].epsilon)} to ${short(last.epsilon)}: ` +
    `up to N = ${whole(last.elements)} and L = ${whole(last.links)}${slope}.${ring}`;
}

/** The links as tiles; a sketch has none to show. */
export function showTiles(answer, patches) {
  const count = answer.exchange.length;
  if (!count && answer.account.links) return;
  const top = paintTiles($("tiles"), answer, patches);
  const where = patches === 2 ? "the rectangle of two patches" : `the square of ${patches} patches`;
  const clustered = answer.account.links > count ? " or are linked in clusters" : "";
  $("tiles-text").textContent =
    `${whole(count)} links as tiles of ${where}: columns and rows are elements, colours the mean ` +
    `kernel, bright from ${short(top)} on, dark at ${short(top / 1e4)}. What is white does not ` +
    `see each other${clustered}.`;
}

/** A slider and a number; switched off without a value, or with one that is no number. */
function showPair(id, value) {
  const number = typeof value === "number";
  const name = $(id).closest(".row").firstElementChild.textContent;
  $(`${id}-number`).setAttribute("aria-label", `${name}, as a number`);
  for (const control of [$(id), $(`${id}-number`)]) {
    control.disabled = !number;
    if (document.activeElement !== control) control.value = number ? value : "";
  }
  const row = $(id).closest(".row");
  row.title = number || value === undefined ? "" : "Not a number: see Properties";
}

/** So far goes a slider whose value is free. */
function stretch(id, values, least) {
  if (document.activeElement === $(id)) return;
  const most = Math.max(0, ...values.filter(Number.isFinite).map(Math.abs));
  $(id).max = most > 0 ? 2 * most : least;
}

/** The fields of the ends of a wall. */
export const ENDS = [
  ["from-x", "a", 0],
  ["from-y", "a", 1],
  ["to-x", "b", 0],
  ["to-y", "b", 1],
];

/** The first and second property of each kind of wall, and what the first one is called. */
export const PROPERTIES = {
  light: ["emission", "reflectance", "Emission"],
  temperature: ["temperature", "emissivity", "Temperature, K"],
  flux: ["flux", "emissivity", "Net flux"],
  heat: ["heat", "emissivity", "Heat, W/m"],
  shield: [null, "emissivity", ""],
  mirror: [null, null, ""],
  gas: [null, null, ""],
};

/** Fills the controls of the chosen wall, or switches them off. */
export function showWall(scene, chosen, band) {
  const wall = scene.walls[chosen];
  const [first, second, label] = PROPERTIES[wall?.kind ?? "light"];
  for (const id of ["delete", "properties"]) $(id).disabled = !wall;
  for (const id of ["both", "flip", "kind"]) $(id).disabled = !wall || wall.kind === "gas";
  $("wall").value = wall ? String(chosen) : "";
  $("kind").value = wall ? wall.kind : "";
  $("first-label").textContent = label;
  $("second-label").textContent = second === "emissivity" ? "Emissivity" : "Reflectance";
  $("emission").closest(".row").hidden = !first;
  $("reflectance").closest(".row").hidden = !second;
  $("transmittance").closest(".row").hidden = !wall?.both;
  $("whole").closest(".choice").hidden = !wall || wall.alone;
  stretch("emission", scene.walls.map((_, k) => scene.value(k, first, band)), 1);
  $("emission").min = first === "flux" || first === "heat" ? -$("emission").max : 0;
  const missing = wall && second === "emissivity" ? 1 : 0;
  showPair("emission", wall && (scene.value(chosen, first, band) ?? 0));
  for (const [id, end, axis] of ENDS) {
    $(id).disabled = !wall;
    if (document.activeElement !== $(id)) $(id).value = wall ? wall[end][axis] : "";
  }
  $("length").disabled = !wall;
  if (document.activeElement !== $("length"))
    $("length").value = wall ? Math.hypot(wall.b[0] - wall.a[0], wall.b[1] - wall.a[1]) : "";
  showPair("reflectance", wall && (scene.value(chosen, second, band) ?? missing));
  showPair("transmittance", wall && (scene.value(chosen, "transmittance", band) ?? 0));
  $("both").checked = Boolean(wall?.both);
  showText("properties", wall ? JSON.stringify(wall.properties, null, 1) : "");
}

function showText(id, text) {
  if (document.activeElement !== $(id)) $(id).value = text;
}

/** The controls of what holds for the whole scene. */
export function showScene(scene, band = 0) {
  $("background-label").textContent =
    scene.surroundings === "background" ? "Surroundings" : "Surroundings, K";
  const emissions = scene.walls.map((_, k) => scene.value(k, "emission", band));
  const background = scene.background(band);
  stretch("background", [background, ...emissions], 1);
  showPair("background", background);
  const sun = scene.sun(band);
  showPair("sun", sun?.bearing ?? 0);
  stretch("irradiance", [sun?.irradiance], 1);
  showPair("irradiance", sun?.irradiance ?? 0);
  showText("members", JSON.stringify(scene.members, null, 1));
}

function option(value, text) {
  const o = document.createElement("option");
  o.value = value;
  o.textContent = text;
  return o;
}

/** The lists that depend on the scene alone. */
export function showLists(scene, band) {
  $("wall").replaceChildren(
    option("", "none"),
    ...scene.walls.map((w, k) => option(k, w.name)),
  );
  $("band").replaceChildren(
    ...Array.from({ length: scene.bands }, (_, k) => option(k, `${k + 1} of ${scene.bands}`)),
  );
  $("band").value = String(band);
  document.querySelector(".of-bands").hidden = scene.bands === 1;
}
