// SPDX-License-Identifier: GPL-3.0-or-later
// A scene as the fragment of an address, which no server sees: its title and text, compressed; and
// the last scene, kept in this browser.  What is read back may be anything: it is no more than a
// text, which the library takes or refuses.

const MARK = "#scene=";
const MOST_BYTES = 2 ** 23; // of a text; a short fragment could become gigabytes
const MOST_TITLE = 80;
const KEPT = "hr2d-scene";

async function through(bytes, stream, most = Infinity) {
  const reader = new Blob([bytes]).stream().pipeThrough(stream).getReader();
  const chunks = [];
  for (let size = 0; ; ) {
    const { done, value } = await reader.read();
    if (done) break;
    chunks.push(value);
    size += value.length;
    if (size <= most) continue;
    await reader.cancel();
    throw new Error("it is too large");
  }
  return new Uint8Array(await new Blob(chunks).arrayBuffer());
}

const letters = { "+": "-", "/": "_", "=": "" };

function toText(bytes) {
  const binary = Array.from(bytes, (b) => String.fromCharCode(b)).join("");
  return btoa(binary).replace(/[+/=]/g, (c) => letters[c]);
}

const toBytes = (text) =>
  Uint8Array.from(atob(text.replace(/-/g, "+").replace(/_/g, "/")), (c) => c.charCodeAt(0));

/** {title, text} of something that was written by pack(). */
function unpack(json) {
  const { title, text } = JSON.parse(json);
  if (typeof title !== "string" || typeof text !== "string") throw new Error("it is no scene");
  return { title: title.slice(0, MOST_TITLE), text };
}

const pack = (title, text) => JSON.stringify({ title, text });

export async function toFragment(title, text) {
  const bytes = new TextEncoder().encode(pack(title, text));
  return MARK + toText(await through(bytes, new CompressionStream("deflate-raw")));
}

export const isShared = (fragment) => fragment.startsWith(MARK);

/** {title, text} of a fragment; throws an Error. */
export async function fromFragment(fragment) {
  try {
    const bytes = toBytes(fragment.slice(MARK.length));
    const json = await through(bytes, new DecompressionStream("deflate-raw"), MOST_BYTES);
    return unpack(new TextDecoder("utf-8", { fatal: true }).decode(json));
  } catch (error) {
    throw new Error(`the address holds no scene that can be read: ${error.message}`);
  }
}

/** Keeps a scene in this browser; returns whether that is possible. */
export function keep(title, text) {
  try {
    localStorage.setItem(KEPT, pack(title, text));
    return true;
  } catch {
    return false;
  }
}

/** {title, text} that was kept last, or null. */
export function kept() {
  try {
    return unpack(localStorage.getItem(KEPT));
  } catch {
    return null;
  }
}
