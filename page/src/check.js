// The page that takes a file: hands it to the worker (check/worker.js), and the viewer what the worker says.
import { listClips, worstClip } from "./clips.js";
import { recordingOf } from "./data.js";
import { byId, prefersDark, setDark } from "./dom.js";
import { Engine, showRecording, TOOK_LONG } from "./engine.js";
import { requireBrowser } from "./viewer.js";

// An answer about nothing yet, so that the surface can be seen.
function unanswered(name, title, { frames, triangles }) {
  const n = frames - 1, zeros = ["milliseconds", "contacts", "start_pairs", "kept_contacts", "kept_pairs", "verdict", "proven", "answerer"];
  const empty = ["contact_kind", "contact_time", "contact_along", "contact_normal", "contact_vertex", "contact_place", "crossing"];
  const arrays = Object.fromEntries([...zeros.map((key) => [`s0.${key}`, new Uint32Array(n)]), ...empty.map((key) => [`s0.${key}`, new Uint32Array(0)])]);
  for (const key of ["inside_count", "curve_count"]) arrays[key] = new Uint32Array(n);
  for (const key of ["inside_vertex", "inside_depth", "curve_points", "curve_event", "curve_edge", "curve_share"]) arrays[key] = new Uint32Array(0);
  arrays["s0.touched"] = new Uint8Array(n * Math.ceil(triangles / 8));
  const summary = { verdict: "undecided", undecided: 1, touches: 0, intersects_at_start: 0, headline: null, met: [], events: [], first_named: null };
  return { events: [], arrays, strategy: { name: "the library", answered_by: [""], covers: 0, summary, sentences: [`${name}, '${title}': not answered yet.`], details: "" } };
}

class Check {
  constructor() {
    this.engine = new Engine();
    const onClick = (id, act) => byId(id).addEventListener("click", act);
    byId("files").addEventListener("change", ({ target }) => this.take(Array.from(target.files)));
    onClick("stop", () => this.stop("Stopped"));
    onClick("save", () => this.save());
    onClick("another", () => this.ask(""));
    for (const kind of ["dragenter", "dragover", "dragleave", "drop"])
      document.addEventListener(kind, (event) => {
        event.preventDefault();
        document.body.classList.toggle("over", kind === "dragenter" || kind === "dragover");
        if (kind === "drop" && event.dataTransfer.files.length > 0) this.take(Array.from(event.dataTransfer.files));
      });
  }

  // Asks for a file, after a refusal perhaps.
  ask(refusal) {
    this.engine.stop();
    this.run = { clips: [] };  // what is under way is for nobody
    byId("files").value = "";
    byId("refusal").textContent = refusal;
    document.body.className = "asking";
    document.title = "cscd check";
  }

  async take(files) {
    this.ask("");
    const run = (this.run = { begun: performance.now(), clips: [], header: null });
    document.body.className = "checking unanswered reading";
    byId("file").textContent = files.map(({ name }) => name)[0] + (files.length > 1 ? ` and ${files.length - 1} more` : "");
    this.say("reading ...", 0);
    const question = async () => {
      const given = await Promise.all(files.map(async (file) => ({ name: file.name, bytes: await file.arrayBuffer() })));
      return { message: { files: given }, transfer: given.map(({ bytes }) => bytes) };
    };
    const failed = (text) => this.ask(`${files[0].name}: the page failed: ${text}`);
    await this.engine.ask(question, { hear: (data) => this.hear(run, data), failed, late: () => this.stop(TOOK_LONG) });
  }

  say(what, share) {
    byId("doing").textContent = what;
    byId("progress").value = share;
  }

  hear(run, { kind, number, ...data }) {
    if (kind === "refused") this.ask(`${data.name}: ${data.text}${/[.!?]$/.test(data.text) ? "" : "."} It was not checked.`);
    if (kind === "read") Object.assign(run, { header: data.header, titles: data.clips, intervals: data.intervals });
    if (kind === "frames") {
      const title = run.titles[number];
      run.clips[number] = { title, clip: data.clip, frames: data.arrays, ...unanswered(run.header.name, title, data.clip) };
      if (number === 0) this.say("preparing ...", 0), this.show(0);
    }
    if (kind === "progress") this.say(`clip ${number + 1} of ${run.titles.length}, '${run.titles[number]}': frame ${data.interval} of ${run.clips[number].clip.frames - 1}`, data.done / run.intervals);
    if (kind === "answer") Object.assign(run.clips[number], data, { isAnswered: true, strategies: [data.strategy] });
    if (kind === "done") this.finish(`${this.answered.length > 1 ? `${this.answered.length} clips ` : ""}answered in ${((performance.now() - run.begun) / 1000).toFixed(1)} s`);
  }

  get answered() { return this.run.clips.filter(({ isAnswered }) => isAnswered); }

  stop(why) {
    if (this.run.clips.some(({ isAnswered }) => isAnswered)) this.finish(`${why}: ${this.answered.length} of ${this.run.titles.length} clips answered`);
    else this.ask(`${byId("file").textContent}: ${why.toLowerCase()} before a clip was answered.`);
  }

  async finish(what) {
    const { run } = this;
    this.engine.stop();
    this.say(what, 1);
    await this.show(worstClip(this.answered));
    if (this.run === run) document.body.className = "";
  }

  async show(number) {
    const { run } = this, clips = this.answered.length > 0 ? this.answered : run.clips, { clip, frames, arrays, events, rest, strategy } = clips[number];
    const recording = (run.shown = recordingOf({ ...run.header, clip, events, rest, strategies: [strategy] }, { ...frames, ...arrays }));
    if (!(await showRecording(recording, () => this.run === run && run.shown === recording))) return;
    byId("details").textContent = run.header.notes;
    document.body.classList.remove("reading");
    if (this.answered.length < 2) return;
    listClips(this.run.header, this.answered, number);
    byId("clips").addEventListener("change", ({ target }) => this.show(Number(target.value)));
  }

  // The fields of `cscd query --json` that this page knows, under their names.
  json() {
    const { header, titles } = this.run, answers = this.answered.map(({ json }) => ({ input: header.name, ...json }));
    const head = { schema: "cscd.check/1", fields_of: "cscd.query/4", input: header.name, import: { ...header.import, clips: titles.map((name) => ({ name })) } };
    return answers.length === 1 ? { ...head, ...answers[0] } : { ...head, clips: answers };
  }

  save() {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([JSON.stringify(this.json(), null, 1)], { type: "application/json" }));
    link.download = `${this.run.header.name.replace(/\.\w+$/, "")}.json`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }
}

setDark(prefersDark());
try {
  requireBrowser();
  window.check = new Check();
} catch (error) {
  byId("refusal").textContent = error.message;
}
