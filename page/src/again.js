// The page of `cscd view --with-engine`: the viewer of the recording that stands in the page, and a bar that has the page's own engine
// answer the clip again (again/worker.js) with another thickness, or with pairs ignored.
import { offerClips } from "./clips.js";
import { loadRecording, recordingOf } from "./data.js";
import { byId, element } from "./dom.js";
import { Engine, showRecording, TOOK_LONG } from "./engine.js";
import { namesOf } from "./moments.js";
import { both, many } from "./words.js";
import { fail, requireBrowser } from "./viewer.js";

class Again {
  constructor({ header, arrays, laterArray }) {
    Object.assign(this, { header, arrays, laterArray, engine: new Engine(), pairs: [] });
    const { thickness, neighbours } = header.engine.asked;
    byId("thickness").value = thickness;
    byId("neighbours").append(...Array.from({ length: Math.max(4, neighbours ?? 0) + 1 }, (_, joints) => Object.assign(element("option", `up to ${many(joints, "joint")} apart`), { value: joints })));
    byId("neighbours").value = String(neighbours ?? "");
    byId("neighbours-label").hidden = header.engine.bone_parent.length === 0;
    byId("again").addEventListener("submit", (event) => {
      event.preventDefault();
      this.ask();
    });
    byId("ignore").addEventListener("click", () => this.ignoreChosen());
    byId("stop").addEventListener("click", () => this.end("Stopped."));
    byId("recorded").addEventListener("click", () => this.showRecorded());
  }

  get asked() {
    const neighbours = byId("neighbours").value;
    return { thickness: byId("thickness").value.trim(), neighbours: neighbours === "" ? null : Number(neighbours), pairs: this.pairs };
  }

  async show(recording) {
    this.shown = recording;
    if (await showRecording(recording, () => this.shown === recording)) offerClips(this.header, window.cscd.ended.signal);
  }

  async showRecorded() {
    this.end("");
    document.body.classList.remove("answered");
    await this.show(recordingOf(this.header, this.arrays));
  }

  ignoreChosen() {
    const { chosen, recording, active } = window.cscd;
    if (!chosen) return this.say("Choose a moment first: its pair is what is ignored.");
    const names = chosen.event ? [chosen.event.name, chosen.event.other] : chosen.truth ? [] : namesOf(recording, active, chosen);
    if (!this.pairs.some((pair) => pair.every((name) => names.includes(name)) && names.every((name) => pair.includes(name)))) this.pairs.push(names);
    this.listPairs();
    this.say("");
  }

  listPairs() {
    byId("ignored").replaceChildren(...this.pairs.map((pair) => {
      const button = element("button", `${both(...pair, "and")} \u00d7`);
      button.type = "button";
      button.title = "Do not ignore this pair";
      button.addEventListener("click", () => {
        this.pairs = this.pairs.filter((other) => other !== pair);
        this.listPairs();
      });
      return button;
    }));
  }

  say(what, share = 0) {
    byId("doing").textContent = what;
    byId("progress").value = share;
  }

  end(what) {
    this.engine.stop();
    document.body.classList.remove("checking");
    this.say(what);
  }

  // The arrays of the question are unpacked for it, and given away to the worker.
  async question() {
    const names = ["rest", "starts", "ends", "place_number"], exact = await Promise.all(names.map((name) => this.laterArray(`exact.${name}`)));
    const { corners, place, part } = this.arrays, { sections, clips, strategies, events, true_motion: truth, ...header } = this.header;
    const arrays = { corners, place, part, ...Object.fromEntries(names.map((name, i) => [name, exact[i]])) };
    return { message: { header, arrays, asked: this.asked }, transfer: exact.map(({ buffer }) => buffer) };
  }

  ask() {
    const begun = performance.now(), intervals = this.header.clip.frames - 1;
    document.body.classList.add("checking");
    this.say("preparing ...");
    this.engine.ask(() => this.question(), {
      hear: ({ kind, ...data }) => {
        if (kind === "progress") this.say(`frame ${data.interval} of ${intervals}`, data.interval / intervals);
        if (kind === "refused") this.end(`Not answered: ${data.text}${/[.!?]$/.test(data.text) ? "" : "."}`);
        if (kind === "answer") this.take(data, begun);
      },
      failed: (text) => this.end(`Not answered: the page failed: ${text}`),
      late: () => this.end(TOOK_LONG),
    }).catch((error) => this.end(`Not answered: ${error.message}`));
  }

  async take({ events, rest, strategy, texts, arrays }, begun) {
    const header = { ...this.header, events, rest, texts, true_motion: null, engine_colours: false, thickness: this.asked.thickness, strategies: [strategy] };
    const { places, bones, corners, place, part } = this.arrays;
    this.end(`Answered in this page, from exact positions, in ${((performance.now() - begun) / 1000).toFixed(1)} s`);
    document.body.classList.add("answered");
    await this.show(recordingOf(header, { places, bones, corners, place, part, ...arrays }));
  }
}

async function begin() {
  byId("viewer").replaceChildren(byId("view").content.cloneNode(true));
  requireBrowser();
  window.again = new Again(await loadRecording());
  await window.again.showRecorded();
}

begin().catch(fail);
