// SPDX-License-Identifier: GPL-3.0-or-later
// Mouse, touch, keys and controls.

import { $, ENDS, PROPERTIES, showLegend, showMessage } from "./panel.js";
import { Scale } from "./palette.js";
import { isShared } from "./share.js";

const GRAB = 10; // pixels around what is grabbed
const FINGER = 22;
const SNAP = 9;
const REST = 500; // milliseconds after the last arrow key
const STEP = 1 / 200; // of the scene, for an arrow key
const LEAP = 10;

const distance = (p, q) => Math.hypot(p[0] - q[0], p[1] - q[1]);

/** Pointers on the plan: move walls or draw them; drag the empty plan to shift the view. */
class Pointer {
  constructor(page) {
    this.page = page;
    this.drag = null;
    this.fingers = new Map(); // or the mouse, where they are on the screen
    const plan = $("plan");
    plan.addEventListener("pointerdown", (event) => this.down(event));
    plan.addEventListener("pointermove", (event) => this.move(event));
    plan.addEventListener("pointerup", (event) => this.up(event));
    plan.addEventListener("pointercancel", (event) => this.up(event));
    plan.addEventListener("pointerleave", () => this.drag || this.page.leave());
    plan.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
  }

  at(event) {
    return this.page.view.toScene([event.offsetX, event.offsetY]);
  }

  reach(event) {
    return (event.pointerType === "touch" ? FINGER : GRAB) / this.page.view.scale;
  }

  down(event) {
    if (event.button !== 0) return;
    this.fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    if (this.fingers.size > 2) return;
    if (this.fingers.size === 2) return this.pinch();
    if (this.drag) return;
    const { page } = this;
    const at = this.at(event);
    $("plan").setPointerCapture(event.pointerId);
    if (document.querySelector("input[name=tool]:checked").value === "draw")
      return this.draw(at);
    const screen = [event.offsetX, event.offsetY];
    if (page.view.isSun(screen, page.scene.sun(page.band))) return (this.drag = { kind: "sun" });
    const found = page.scene.at(at, this.reach(event));
    page.choose(found ? found.wall : -1);
    this.drag = found
      ? this.grab(found, at)
      : { kind: "shift", at: [event.offsetX, event.offsetY] };
  }

  draw(at) {
    const { scene, view } = this.page;
    const from = scene.snap(at, SNAP / view.scale) ?? at;
    this.drag = { kind: "draw", from, start: scene.copy() };
  }

  grab({ wall, grabbed }, at) {
    return { kind: "move", at, wall, grabbed };
  }

  move(event) {
    const at = this.at(event);
    if (this.fingers.has(event.pointerId))
      this.fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    if (!this.drag) return this.page.point(at, this.reach(event));
    this.drag.moved = true;
    this[`${this.drag.kind}To`](at, event);
  }

  /** Not before something moves: it may part a wall from its line. */
  begin(drag) {
    const { scene } = this.page;
    drag.ends = scene.endsToMove(drag.wall, drag.grabbed, $("how").value);
    drag.start = scene.copy();
  }

  moveTo(at) {
    const { scene, view } = this.page;
    if (!this.drag.start) this.begin(this.drag);
    const { ends, start, wall, grabbed } = this.drag;
    const by = [at[0] - this.drag.at[0], at[1] - this.drag.at[1]];
    if (grabbed === "wall") {
      scene.move(ends, start, by);
    } else {
      const from = start.walls[wall][grabbed];
      const to = [from[0] + by[0], from[1] + by[1]];
      scene.moveEnd(ends, start, from, scene.snap(to, SNAP / view.scale, ends) ?? to);
    }
    this.page.moving();
  }

  drawTo(at) {
    const { page, drag } = this;
    page.scene = drag.start.copy();
    const to = page.scene.snap(at, SNAP / page.view.scale) ?? at;
    if (to[0] === drag.from[0] && to[1] === drag.from[1]) return;
    page.chosen = page.scene.add(drag.from, to);
    page.moving();
  }

  sunTo(at, event) {
    const { page } = this;
    const bearing = Math.round(page.view.bearingOf([event.offsetX, event.offsetY]));
    page.scene.setSun(page.band, { bearing });
    page.showLists();
    page.moving();
  }

  /** Two fingers shift and stretch the view; what the first one had begun is taken back. */
  pinch() {
    if (this.drag?.start) this.page.scene = this.drag.start;
    this.drag = { kind: "pinch", moved: true, last: this.grip() };
  }

  /** The middle of two fingers, and how far apart they are. */
  grip() {
    const [p, q] = [...this.fingers.values()];
    return { at: [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2], apart: distance(p, q) };
  }

  pinchTo() {
    if (this.fingers.size < 2) return;
    const { view } = this.page;
    const { last } = this.drag;
    const now = (this.drag.last = this.grip());
    view.shift([now.at[0] - last.at[0], now.at[1] - last.at[1]]);
    if (last.apart > 0 && now.apart > 0) view.zoom(now.apart / last.apart, now.at);
    this.page.show();
  }

  shiftTo(at, event) {
    const { view } = this.page;
    const now = [event.offsetX, event.offsetY];
    view.shift([now[0] - this.drag.at[0], now[1] - this.drag.at[1]]);
    this.drag.at = now;
    this.page.show();
  }

  up(event) {
    const { drag, page } = this;
    this.fingers.delete(event.pointerId);
    if (drag?.kind === "pinch" && this.fingers.size) return; // the other finger is still there
    this.drag = null;
    if (!drag?.moved) return;
    if (drag.kind === "shift" || drag.kind === "pinch") page.changed();
    else page.edited();
  }

  wheel(event) {
    event.preventDefault();
    this.page.view.zoom(Math.exp(-0.0015 * event.deltaY), [event.offsetX, event.offsetY]);
    this.page.show();
    clearTimeout(this.rest);
    this.rest = setTimeout(() => this.page.changed(), REST);
  }
}

/** Keys on the plan. */
class Keys {
  constructor(page) {
    this.page = page;
    $("plan").addEventListener("keydown", (event) => this.down(event));
    document.addEventListener("keydown", (event) => this.history(event));
  }

  down(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const act = this.action(event);
    if (!act) return;
    event.preventDefault();
    act();
  }

  action({ key, shiftKey }) {
    const { page } = this;
    const arrows = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, 1],
      ArrowDown: [0, -1],
    };
    if (arrows[key]) return page.chosen < 0 ? null : () => this.nudge(arrows[key], shiftKey);
    const zoom = (factor) => () => {
      page.view.zoom(factor);
      page.changed();
    };
    const actions = {
      n: () => this.step(1),
      PageDown: () => this.step(1),
      p: () => this.step(-1),
      PageUp: () => this.step(-1),
      Delete: () => page.deleteWall(),
      Backspace: () => page.deleteWall(),
      Escape: () => page.choose(-1),
      "[": () => page.stepElement(-1),
      "]": () => page.stepElement(1),
      "+": zoom(1.25),
      "-": zoom(0.8),
      0: () => fit(page),
    };
    return actions[key.length === 1 ? key.toLowerCase() : key];
  }

  step(by) {
    const { page } = this;
    const count = page.scene.walls.length;
    if (count) page.choose((Math.max(page.chosen, by > 0 ? -1 : 0) + by + count) % count);
  }

  nudge([x, y], far) {
    const { page } = this;
    const length = page.scene.size() * STEP * (far ? LEAP : 1);
    const ends = page.scene.endsToMove(page.chosen, "wall", $("how").value);
    page.scene.move(ends, page.scene.copy(), [x * length, y * length]);
    page.moving();
    $("under").textContent = page.describe(page.chosen);
    clearTimeout(this.rest);
    this.rest = setTimeout(() => page.edited(), REST);
  }

  history(event) {
    if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
    const key = event.key.toLowerCase();
    const back = key === "z" && !event.shiftKey;
    const forth = key === "y" || (key === "z" && event.shiftKey);
    if (!back && !forth) return;
    event.preventDefault();
    if (back) this.page.undo();
    else this.page.redo();
  }
}

function fit(page) {
  page.fit();
  page.changed();
}

/** A slider with a number beside it: `set` while it slides, and then the edit is complete. */
function sliderAndNumber(page, id, set) {
  const slider = $(id);
  const number = $(`${id}-number`);
  slider.addEventListener("input", () => {
    number.value = slider.value;
    set(Number(slider.value));
    page.moving();
  });
  slider.addEventListener("change", () => page.edited());
  number.addEventListener("change", () => {
    if (!number.checkValidity() || number.value === "")
      return showMessage(number.validationMessage || "a number is missing");
    set(Number(number.value));
    page.edited();
  });
}

function listenToWalls(page) {
  const whole = () => $("whole").checked;
  const set = (which) => (v) => {
    const key = PROPERTIES[page.scene.walls[page.chosen].kind][which];
    page.scene.setValue(page.chosen, key, page.band, v, whole());
  };
  const edit = (id, change) =>
    $(id).addEventListener("change", (event) => {
      change(page.scene, event.target);
      page.edited();
    });
  sliderAndNumber(page, "emission", set(0));
  sliderAndNumber(page, "reflectance", set(1));
  sliderAndNumber(page, "transmittance", (v) =>
    page.scene.setValue(page.chosen, "transmittance", page.band, v, whole()),
  );
  $("wall").addEventListener("change", (event) =>
    page.choose(event.target.value === "" ? -1 : Number(event.target.value)),
  );
  listenToEnds(page);
  edit("kind", (scene, { value }) => scene.setKind(page.chosen, value, whole()));
  edit("both", (scene, { checked }) => scene.setSides(page.chosen, checked, whole()));
  textOf(page, "properties", (object) => page.scene.setProperties(page.chosen, object));
  $("flip").addEventListener("click", () => {
    page.scene.turn(page.chosen);
    page.edited();
  });
  $("delete").addEventListener("click", () => page.deleteWall());
  $("add").addEventListener("click", () => {
    const [x, y] = page.view.centre;
    const half = page.scene.size() / 10;
    page.addWall([x - half, y], [x + half, y]);
    $("plan").focus();
  });
}

/** Typed coordinates, and a length from the first end on. */
function listenToEnds(page) {
  const moveTo = (end, point) => {
    const { scene, chosen } = page;
    const from = scene.walls[chosen][end];
    const ends = scene.endsToMove(chosen, end, $("how").value);
    scene.moveEnd(ends, scene.copy(), from, point);
    page.edited();
  };
  const listen = (id, move) =>
    $(id).addEventListener("change", ({ target }) => {
      if (target.value === "" || !target.checkValidity())
        return showMessage(target.validationMessage || "a number is missing");
      move(Number(target.value), page.scene.walls[page.chosen]);
    });
  for (const [id, end, axis] of ENDS)
    listen(id, (v, w) => moveTo(end, w[end].map((old, k) => (k === axis ? v : old))));
  listen("length", (v, { a, b }) => {
    const part = v / distance(a, b);
    moveTo("b", [a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])]);
  });
}

/** A text of JSON, which is taken if it is an object. */
function textOf(page, id, set) {
  $(id).addEventListener("change", (event) => {
    try {
      const object = JSON.parse(event.target.value || "{}");
      if (!object || typeof object !== "object" || Array.isArray(object))
        throw new Error("it has to be an object, { … }");
      set(object);
    } catch (error) {
      const [label] = event.target.labels;
      return showMessage(`${label.firstChild.textContent.trim()}: ${error.message}`);
    }
    page.edited();
  });
}

function listenToScene(page) {
  sliderAndNumber(page, "background", (v) => page.scene.setBackground(page.band, v));
  sliderAndNumber(page, "sun", (bearing) => page.scene.setSun(page.band, { bearing }));
  sliderAndNumber(page, "irradiance", (irradiance) =>
    page.scene.setSun(page.band, { irradiance }),
  );
  textOf(page, "members", (object) => (page.scene.members = object));
}

function listenToAnswers(page) {
  const chooseMethod = () => {
    const method = document.querySelector("input[name=method]:checked").value;
    for (const row of document.querySelectorAll(".of-target")) row.hidden = method !== "target";
    for (const row of document.querySelectorAll(".of-epsilon"))
      row.hidden = method !== "epsilon";
  };
  for (const radio of document.querySelectorAll("input[name=method]"))
    radio.addEventListener("change", () => {
      chooseMethod();
      page.changed();
    });
  chooseMethod();
  $("error").addEventListener("change", () => page.changed());
  $("oracle").addEventListener("change", () => page.changed());
  $("epsilon").addEventListener("input", () => page.sliding());
  $("epsilon").addEventListener("change", () => page.changed());
  $("stop").addEventListener("click", () => page.halt());
}

function listenToPicture(page) {
  for (const id of ["show-light", "show-elements", "show-links"])
    $(id).addEventListener("change", () => page.show());
  $("shape").addEventListener("change", (event) => {
    page.scale = new Scale(page.scale.top, event.target.value);
    showLegend(page.scale);
    page.colour();
    page.show();
  });
  $("band").addEventListener("change", (event) => {
    page.band = Number(event.target.value);
    if (page.field) page.rescale();
    page.colour();
    page.show();
  });
  $("zoom-in").addEventListener("click", () => (page.view.zoom(1.25), page.changed()));
  $("zoom-out").addEventListener("click", () => (page.view.zoom(0.8), page.changed()));
  $("fit").addEventListener("click", () => fit(page));
  new ResizeObserver(() => {
    const { width, height } = page.view;
    page.view.resize();
    if (page.view.width !== width || page.view.height !== height) fit(page);
    page.show();
  }).observe($("plan"));
}

/** The examples of the menu; one of them is opened. */
async function listenToFiles(page) {
  const menu = $("example");
  const openExample = () =>
    page.openFile(async () => (await fetch(`scenes/${menu.value}`)).text(), menu.value);
  menu.add(new Option("choose one", ""));
  for (const file of await (await fetch("scenes/list.json")).json())
    menu.add(new Option(file.replace(/\.geojson$/, ""), file));
  menu.addEventListener("change", () => menu.value && openExample());
  $("load").addEventListener("click", () => $("file").click());
  $("file").addEventListener("change", async (event) => {
    const [file] = event.target.files;
    event.target.value = "";
    if (file) await page.openFile(() => file.text(), file.name);
  });
  $("new").addEventListener("click", () => page.new());
  $("save").addEventListener("click", () => page.save());
  $("share").addEventListener("click", () => page.share());
  $("png").addEventListener("click", () => page.exportPNG());
  $("svg").addEventListener("click", () => page.exportSVG());
  addEventListener("hashchange", () => isShared(location.hash) && page.openKept());
  $("undo").addEventListener("click", () => page.undo());
  $("redo").addEventListener("click", () => page.redo());
  if (await page.openKept()) return;
  const said = $("message").textContent;
  menu.value = "partition.geojson";
  await openExample();
  if (said) showMessage(said, "note");
}

export async function listen(page) {
  new Pointer(page);
  new Keys(page);
  listenToWalls(page);
  listenToScene(page);
  listenToAnswers(page);
  listenToPicture(page);
  await listenToFiles(page);
}
