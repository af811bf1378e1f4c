// SPDX-License-Identifier: GPL-3.0-or-later
// The page: what a user does, and what follows from it.  While something moves, sketches come
// from one worker; when it is let go, the exact answer comes from the other.

import { Answer } from "./answer.js";
import { Engine } from "./engine.js";
import { download, toPNG, toSVG } from "./export.js";
import { listen } from "./input.js";
import { Scale } from "./palette.js";
import {
  $,
  short,
  showLegend,
  showLists,
  showMessage,
  showNoAnswer,
  showNumbers,
  showOld,
  showProgress,
  showScene,
  showStatus,
  showStudy,
  showTiles,
  showValues,
  showWall,
  showWarnings,
} from "./panel.js";
import { Scene } from "./scene.js";
import { fromFragment, isShared, keep, kept, toFragment } from "./share.js";
import { View } from "./view.js";

const BUDGET = 30; // milliseconds for a sketch
const SLIDE_BUDGET = 300;
const CELL = 4; // pixels for a node of an exact field
const MOST_LINKS = 3e6;
const MOST_STEPS = 200; // of undo
const IMAGES = 0.15; // of the size of a scene, on each side of a cell
const LETTERS = {
  emission: "E",
  reflectance: "ρ",
  transmittance: "τ",
  temperature: "T",
  emissivity: "ε",
  flux: "q",
  heat: "Q",
};

export class Page {
  constructor(engine) {
    this.engine = engine;
    this.view = new View($("plan"));
    this.scene = new Scene();
    this.kept = this.scene.copy();
    this.past = [];
    this.future = [];
    this.chosen = -1;
    this.band = 0;
    this.path = [];
    this.files = 0;
    this.images = new Float64Array(0);
    this.study = { rows: [], slope: 0 };
    this.scale = new Scale(1, "root");
  }

  // The scene.

  /** Opens the text of a file as a step of history; the state says so until it is read. */
  async openFile(read, what) {
    const { state } = $("status").dataset;
    const said = $("status").textContent;
    showStatus("busy", `Opening ${what} …`);
    try {
      const text = await read();
      const opened = await this.engine.ask({ task: "open", text });
      const scene = Scene.fromFile(text, opened);
      scene.title = what;
      this.begin(scene, opened.images);
      const { cuts } = opened;
      showMessage(
        cuts ? `${what}: walls were cut where they cross, at ${cuts} places.` : "",
        "note",
      );
    } catch (error) {
      showMessage(`${what}: ${error.message}`);
      this.showLists();
      showStatus(state, said);
      return false;
    }
    this.changed();
    return true;
  }

  /** Takes another scene in the place of the one that is shown, as a step of history. */
  begin(scene, images) {
    this.record();
    if (this.scene.walls.length) this.keep();
    scene.file = ++this.files;
    this.scene = scene;
    this.kept = scene.copy();
    this.forget();
    this.images = images;
    this.fit();
    this.showLists();
  }

  /** Forgets what belongs to the last scene. */
  forget() {
    performance.clearMarks("sketch");
    this.chosen = -1;
    this.band = Math.min(this.band, this.scene.bands - 1);
    this.path = [];
    this.dropAnswer();
    this.study = { rows: [], slope: 0 };
    $("under").textContent = "\u00a0";
  }

  /** Shows no answer any more: there is none, or it is one to another question. */
  dropAnswer() {
    this.answer = null;
    this.field = null;
    this.images = new Float64Array(0);
    this.view.image = null;
    this.path = [];
    showNoAnswer();
  }

  /** All walls that matter, and what stands around a cell in a period or between mirrors. */
  fit() {
    const { low, high } = this.scene.bounds(true);
    const more = this.images.length ? IMAGES * this.scene.size() : 0;
    this.view.fit({ low: low.map((v) => v - more), high: high.map((v) => v + more) });
  }

  showLists() {
    $("example").value = this.scene.title;
    if ($("example").selectedIndex < 0) $("example").value = "";
    showLists(this.scene, this.band);
    showScene(this.scene);
  }

  /** Takes a step of history back or forth. */
  travel(from, to) {
    this.record();
    if (!from.length) return;
    to.push(this.scene.copy());
    const { file } = this.scene;
    this.scene = from.pop();
    this.kept = this.scene.copy();
    this.chosen = Math.min(this.chosen, this.scene.walls.length - 1);
    showMessage("");
    if (this.scene.file !== file) {
      this.forget();
      this.fit();
    }
    this.showLists();
    this.changed();
  }

  undo() {
    this.travel(this.past, this.future);
  }

  redo() {
    this.travel(this.future, this.past);
  }

  /** Keeps a step of history if anything has changed since the last one. */
  record() {
    if (this.scene.toGeoJSON() === this.kept.toGeoJSON()) return;
    this.keep();
    this.kept = this.scene.copy();
  }

  keep() {
    this.past.push(this.kept);
    if (this.past.length > MOST_STEPS) this.past.shift();
    this.future.length = 0;
  }

  /** After an edit that is complete. */
  edited() {
    this.record();
    showMessage("");
    this.study = { rows: [], slope: 0 };
    this.showLists();
    this.changed();
  }

  choose(wall) {
    this.chosen = wall;
    this.path = [];
    this.show();
    const w = this.scene.walls[wall];
    if (w) $("under").textContent = this.describe(wall);
  }

  describe(wall) {
    const w = this.scene.walls[wall];
    const point = (p) => `(${short(p[0])}, ${short(p[1])})`;
    const patch = this.scene.patchOf(wall);
    const known = this.answer && patch < this.answer.patches;
    const light = known ? `, B = ${short(this.answer.average(patch, this.band))}` : "";
    const said = this.answer?.document?.patches[patch];
    const heat = this.exact && said?.temperature ? `, T = ${short(said.temperature)} K` : "";
    const about = Object.entries(w.properties)
      .filter(([key, v]) => LETTERS[key] && v !== null)
      .map(([key, v]) => `, ${LETTERS[key]} = ${Array.isArray(v) ? JSON.stringify(v) : short(v)}`);
    const answer = { mirror: ", a mirror", gas: ", the border of a gas" }[w.kind] ?? light + heat;
    return `${w.name}, from ${point(w.a)} to ${point(w.b)}${about.join("")}${answer}`;
  }

  addWall(a, b) {
    this.chosen = this.scene.add(a, b);
    this.edited();
  }

  deleteWall() {
    if (this.chosen < 0) return;
    this.scene.remove(this.chosen);
    this.chosen = Math.min(this.chosen, this.scene.walls.length - 1);
    this.path = [];
    this.edited();
  }

  save() {
    const blob = new Blob([this.scene.toGeoJSON()], { type: "application/geo+json" });
    download(blob, "scene.geojson");
  }

  async exportPNG() {
    download(await toPNG(this), "scene.png");
  }

  exportSVG() {
    download(new Blob([toSVG(this)], { type: "image/svg+xml" }), "scene.svg");
  }

  /** An empty plane under a sky. */
  new() {
    const scene = new Scene({ type: "FeatureCollection", hr2d: { background: 1 }, features: [] });
    this.begin(scene, new Float64Array(0));
    showMessage("");
    this.changed();
    document.querySelector("input[name=tool][value=draw]").checked = true;
  }

  /** Puts the scene into the address of the page, and into the clipboard where that is allowed. */
  async share() {
    const fragment = await toFragment(this.scene.title, this.scene.toGeoJSON());
    history.replaceState(null, "", fragment);
    const copied = await navigator.clipboard?.writeText(location.href).then(
      () => true,
      () => false,
    );
    showMessage(
      `The address of this page now holds the scene, in ${location.href.length} characters` +
        `${copied ? ", and has been copied" : ": copy it"}. Nothing has left this machine.`,
      "note",
    );
  }

  /** The scene of the address, or else the last one of this browser; whether there is one. */
  async openKept() {
    if (isShared(location.hash)) {
      let scene;
      try {
        scene = await fromFragment(location.hash);
      } catch (error) {
        showMessage(error.message);
        return false;
      }
      return this.openFile(async () => scene.text, scene.title || "shared scene");
    }
    const last = kept();
    return last ? this.openFile(async () => last.text, last.title || "last scene") : false;
  }

  /** After each change: an address that holds another scene is none of this one. */
  keepScene() {
    const text = this.scene.toGeoJSON();
    if (text === this.textKept) return;
    if (this.textKept !== undefined && isShared(location.hash))
      history.replaceState(null, "", location.pathname + location.search);
    this.textKept = text;
    $("kept").textContent = keep(this.scene.title, text)
      ? "Kept in this browser"
      : "Too large to be kept in this browser: save it";
  }

  // Answers.

  method() {
    const epsilon = document.querySelector("input[name=method]:checked").value === "epsilon";
    const oracle = $("oracle").value;
    if (!epsilon) return { error: Number($("error").value), oracle };
    return { epsilon: this.epsilon(), oracle, mostLinks: MOST_LINKS };
  }

  epsilon() {
    return 2 ** Number($("epsilon").value);
  }

  /** While something moves. */
  moving() {
    this.answered = false;
    showOld();
    showStatus("moving", "Moving: a sketch");
    this.engine.stop();
    this.job({ task: "sketch", budget: BUDGET });
    this.path = [];
    this.show();
  }

  /** While ε slides. */
  sliding() {
    const { oracle, epsilon } = this.method();
    showStatus("moving", "ε slides");
    this.engine.stop();
    this.job({ task: "slide", oracle, epsilon, budget: SLIDE_BUDGET });
  }

  job(message) {
    const { bands, file } = this.scene;
    this.engine.sketch(
      { ...message, text: this.scene.toGeoJSON(), area: this.view.area() },
      (data) => this.scene.file === file && this.take(data, bands, false),
    );
  }

  /** When something has changed and rests: the exact answer. */
  changed() {
    this.engine.settle();
    this.answered = false;
    this.keepScene();
    const { scene } = this;
    if (!scene.walls.length) return this.showNothing();
    showStatus("busy", "Solving …");
    const { width, height } = this.view;
    this.engine.exact(
      {
        task: "exact",
        text: scene.toGeoJSON(),
        method: this.method(),
        area: this.view.area(),
        cells: (width * height) / CELL ** 2,
      },
      (data) => this.take(data, data.scene?.bands ?? scene.bands, true),
    );
    this.show();
  }

  /** Ends a solve that takes too long. */
  halt() {
    this.engine.stop();
    if (this.answered) return showStatus("stopped", "Stopped: solved, but not all of it is shown");
    this.dropAnswer();
    showStatus("stopped", "Stopped: no answer");
    this.show();
  }

  showNothing() {
    this.engine.stop();
    this.dropAnswer();
    showStatus("exact", "No walls: draw some, or choose an example");
    this.show();
  }

  /** A part of an answer. */
  take(data, bands, exact) {
    const { part } = data;
    if (part === "failed") return this.takeFailure(data, exact);
    if (part === "progress" && exact) showProgress(data);
    if (data.elements) this.takeSolution(data, bands, exact);
    if (data.field) this.takeField(data.field, bands, exact);
    if (part === "account")
      Object.assign(this.answer, { account: data.account, measured: true });
    if (data.rows) this.study = data;
    if (part === "answered") showStatus("exact", this.verdict());
    this.show();
  }

  takeFailure({ message, stopped, unsupported }, exact) {
    if ((stopped || unsupported) && !exact)
      return showStatus("moving", "Let go to solve: this takes longer");
    showMessage(message);
    this.dropAnswer();
    showStatus("error", "No answer for these walls");
    this.show();
  }

  takeSolution(data, bands, exact) {
    this.answer = new Answer(data, bands);
    this.path = [];
    this.exact = exact;
    this.answered = exact;
    this.images = data.images ?? data.scene?.images ?? this.images;
    if (exact) this.takeDocument(data);
    showTiles(this.answer, this.answer.patches);
    if ($("message").dataset.kind === "failure") showMessage("");
    if (!exact) performance.mark("sketch");
  }

  /** What the program says, and how the library has read the scene. */
  takeDocument({ document, scene }) {
    this.scene.learn(scene);
    this.kept.learn(scene);
    this.names = scene.patches.map((p) => p.name);
    this.band = Math.min(this.band, scene.bands - 1);
    this.showLists();
    showValues(document);
    showWarnings(document.warnings);
  }

  /** Colours keep their meaning while something moves. */
  takeField(field, bands, exact) {
    this.field = { ...field, bands };
    if (exact || !this.scaled) this.rescale();
    this.colour();
  }

  /** The brightest of nearly all light is the end of the scale. */
  rescale() {
    const { mean, bands } = this.field;
    const values = mean.filter((v, k) => k % bands === this.band && v >= 0).sort();
    const top = values.length ? values[Math.floor(0.995 * (values.length - 1))] : 1;
    this.scale = new Scale(top, $("shape").value);
    this.scaled = true;
    showLegend(this.scale);
  }

  colour() {
    if (!this.field) return;
    this.view.setField(this.field, this.field.bands, this.band, this.scale, !this.exact);
  }

  verdict() {
    const { missed } = this.answer.account;
    if (missed) return missed;
    const dark = this.answer.averages.every((v) => v === 0);
    if (dark) return "Solved: all is dark. Give a wall emission";
    return "Solved";
  }

  // The picture.

  show() {
    if (this.frame) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      this.paint();
    });
  }

  paint() {
    const { view, scene, answer } = this;
    view.clear();
    if ($("show-light").checked) {
      view.paintField();
      view.wipeBacks(scene);
    }
    view.paintImages(this.images);
    view.paintWalls(scene);
    view.paintSun(scene.sun(this.band));
    if (answer) view.paintLeaves(answer, this.scale, this.band, $("show-elements").checked);
    const links = answer && this.path.length ? answer.linksOf(this.path) : [];
    if (answer && $("show-links").checked && this.path.length)
      view.paintLinks(answer, this.path, links);
    if (scene.walls[this.chosen]) view.paintChosen(scene.walls[this.chosen]);
    this.showPanel(links);
  }

  showPanel(links) {
    showWall(this.scene, this.chosen, this.band);
    $("undo").disabled = !this.past.length;
    $("redo").disabled = !this.future.length;
    $("epsilon-value").textContent = short(this.epsilon());
    $("epsilon").setAttribute("aria-valuetext", short(this.epsilon()));
    if (!this.answer) return;
    showNumbers(this.answer, this.exact);
    showStudy(this.study, this.answer.account);
    if (this.path.length) $("under").textContent = this.describeElement(links.length);
    else if (!this.exact && this.chosen >= 0)
      $("under").textContent = this.describe(this.chosen);
  }

  describeElement(links) {
    const { answer, path } = this;
    const name = this.names[answer.patch(path[0])];
    const B = short(answer.value(path[0], this.band));
    return `${name}, element on level ${path.length - 1}: B = ${B}, ${links} links`;
  }

  /** The pointer has left the plan. */
  leave() {
    this.path = [];
    $("under").textContent = this.scene.walls[this.chosen]
      ? this.describe(this.chosen)
      : "\u00a0";
    this.show();
  }

  /** Shows the links of the element at a point of the scene, and the light there. */
  point(at, within) {
    if (!this.answer) return;
    const leaf = this.answer.leafAt(at, within);
    const path = leaf < 0 ? [] : this.answer.path(leaf);
    const moved = path[0] !== this.path[0];
    this.path = path;
    if (leaf < 0) $("under").textContent = this.lightAt(at);
    if (moved) this.show();
  }

  lightAt([x, y]) {
    const f = this.field;
    if (!f) return "\u00a0";
    const column = Math.round(((x - f.low[0]) / (f.high[0] - f.low[0])) * (f.columns - 1));
    const row = Math.round(((y - f.low[1]) / (f.high[1] - f.low[1])) * (f.rows - 1));
    const inside = column >= 0 && row >= 0 && column < f.columns && row < f.rows;
    const mean = inside ? f.mean[(row * f.columns + column) * f.bands + this.band] : NaN;
    const place = `(${short(x)}, ${short(y)})`;
    return Number.isNaN(mean)
      ? `${place}: no light can be here`
      : `${place}: mean radiosity ${short(mean)}`;
  }

  /** Goes from element to element of the chosen wall. */
  stepElement(by) {
    const patch = this.scene.patchOf(this.chosen);
    if (!(this.answer && this.chosen >= 0 && patch < this.answer.patches)) return;
    const leaves = this.answer.leavesOf(patch);
    const now = leaves.indexOf(this.path[0]);
    const next = now < 0 ? 0 : (now + by + leaves.length) % leaves.length;
    this.path = this.answer.path(leaves[next]);
    this.show();
  }
}

async function start() {
  try {
    const page = new Page(await Engine.create("hr2d.wasm"));
    page.view.resize();
    await listen(page);
  } catch (error) {
    showStatus("error", "The library could not be loaded");
    showMessage(error.message);
  }
}

start();
