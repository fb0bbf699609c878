// What the pages with an engine have in common: the engine, which stands in the page beside the script of its worker, and how another
// recording takes the place of the one that is shown.
import { fromBase64, inflate } from "./data.js";
import { byId } from "./dom.js";
import { Viewer } from "./viewer.js";

const PATIENCE = 60000;  // milliseconds without a word from the worker, after which it is stopped
export const TOOK_LONG = `Stopped, because a frame took longer than ${PATIENCE / 1000} s; cscd query answers it`;

const pause = () => new Promise((go) => { setTimeout(go); });
const bytesOf = (id) => inflate(fromBase64(byId(id).textContent));

export class Engine {
  constructor() {
    this.bytes = bytesOf("engine-bytes");
    this.script = bytesOf("worker-script").then((bytes) => URL.createObjectURL(new Blob([bytes], { type: "text/javascript" })));
  }

  // Has a new worker answer what `question` returns, {message, transfer}, and calls hear() with all that it says, failed() with the text
  // of a fault in the page, and late() where it has said nothing for too long. Whatever was asked before is forgotten.
  async ask(question, { hear, failed, late }) {
    this.stop();
    const asked = (this.asked = {}), isWanted = () => this.asked === asked;
    const [script, bytes, { message, transfer }] = await Promise.all([this.script, this.bytes, question()]), engine = bytes.slice();
    if (!isWanted()) return;
    const worker = (asked.worker = new Worker(script)), wait = () => {
      clearTimeout(asked.timer);
      asked.timer = setTimeout(late, PATIENCE);
    };
    worker.onmessage = ({ data }) => {
      if (!isWanted()) return;
      wait();
      hear(data);
    };
    worker.onerror = (event) => failed(event.message);
    worker.postMessage({ ...message, engine }, [engine, ...transfer]);
    wait();
  }

  stop() {
    clearTimeout(this.asked?.timer);
    this.asked?.worker?.terminate();
    this.asked = null;
  }
}

// Shows a recording in place of the one that is shown, in steps, so that none blocks the page for long. `isWanted` says between them
// whether it still is. Returns whether it is shown.
export async function showRecording(recording, isWanted) {
  await pause();
  if (!isWanted()) return false;
  const { canvas } = window.cscd?.stage ?? {}, elements = byId("view").content.cloneNode(true);
  window.cscd?.end();
  if (canvas) elements.getElementById("canvas").replaceWith(canvas);  // browsers hold few, and take long to make one
  byId("viewer").replaceChildren(elements);
  await pause();
  if (!isWanted()) return false;
  window.cscd = new Viewer(recording);
  return true;
}
