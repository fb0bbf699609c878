// Buttons, slider and keys: each calls one method of the viewer (main.js).
import { byId, element, isDark, radios } from "./dom.js";
import { isOfEngine } from "./painter.js";

const AXES = ["x", "y", "z", "-x", "-y", "-z"];

export function makeControls(viewer) {
  const { recording, modes } = viewer, { strategies, clip, header } = recording;
  radios(byId("strategies"), strategies.map((s, i) => [String(i), s.name]), (value) => viewer.setStrategy(Number(value)));
  byId("together-label").hidden = strategies.length < 2;
  byId("together").addEventListener("change", (event) => viewer.setTogether(event.target.checked));
  byId("strategy-row").hidden = strategies.length < 2;
  const engine = modes.filter(([mode]) => isOfEngine(mode));
  radios(byId("modes"), modes.filter(([mode]) => !isOfEngine(mode)), (value) => viewer.setMode(value));
  radios(byId("engine-modes"), engine, (value) => viewer.setMode(value));
  byId("engine").hidden = engine.length === 0;
  byId("engine").open = header.engine_colours;
  makeToggle(viewer, "normals", "normalsShown", "toggles");
  if (clip.bones > 0) makeToggle(viewer, "bones", "bonesShown", "toggles");
  if (strategies.some((s) => s.observers?.length > 0)) makeToggle(viewer, "observers", "observersShown", "engine-toggles");
  makeUp(viewer);

  const slider = byId("slider"), onClick = (id, act) => byId(id).addEventListener("click", act);
  slider.max = String(recording.intervals);
  slider.addEventListener("input", () => viewer.seek(Number(slider.value)));
  onClick("play", () => viewer.setPlaying(!viewer.playing));
  onClick("previous", () => viewer.stepMoment(-1));
  onClick("next", () => viewer.stepMoment(1));
  onClick("whole", () => viewer.showWhole(true));
  onClick("inset", () => viewer.showWhole(true));
  onClick("closer", () => viewer.showChosen(true));
  onClick("theme", () => viewer.setTheme(!isDark()));
  document.addEventListener("keydown", (event) => onKey(viewer, event), { signal: viewer.ended.signal });
}

function makeToggle(viewer, name, property, box) {
  const button = element("button", name);
  button.id = `show-${name}`;
  button.setAttribute("aria-pressed", String(viewer[property]));
  button.addEventListener("click", () => {
    viewer[property] = !viewer[property];
    button.setAttribute("aria-pressed", String(viewer[property]));
    viewer.refresh();
  });
  byId(box).append(button);
}

// Which axis points up, and who says so. The button turns the picture to the next axis.
function makeUp(viewer) {
  const { because } = viewer.recording.header.up, note = byId("up-note");
  const button = element("button", `up: ${viewer.upName}`);
  button.id = "up";
  button.title = because ? `because ${because}` : "";
  note.textContent = because ? "" : `up: ${viewer.upName}, because nothing says otherwise`;
  button.addEventListener("click", () => {
    viewer.setUp(AXES[(AXES.indexOf(viewer.upName) + 1) % AXES.length]);
    button.textContent = `up: ${viewer.upName}`;
    button.title = note.textContent = "";
  });
  byId("toggles").append(button);
}

function onKey(viewer, event) {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  if (event.target.matches("select, input:not([type=range])") || (event.target.matches("button") && event.key === " ")) return;
  const large = event.shiftKey ? 10 : 1, press = (id) => () => byId(id)?.click();
  const actions = {
    " ": () => viewer.setPlaying(!viewer.playing),
    ArrowRight: () => viewer.seek(Math.floor(viewer.position + 1e-6) + large),
    ArrowLeft: () => viewer.seek(Math.ceil(viewer.position - 1e-6) - large),
    Home: () => viewer.seek(0),
    End: () => viewer.seek(viewer.recording.intervals),
    n: () => viewer.stepMoment(1),
    p: () => viewer.stepMoment(-1),
    c: () => viewer.showChosen(true),
    w: () => viewer.showWhole(true),
    s: () => viewer.setStrategy((viewer.strategy + 1) % viewer.recording.strategies.length),
    o: press("show-observers"),
    d: press("theme"),
  };
  const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key], digit = Number(event.key);
  if (digit >= 1 && digit <= viewer.modes.length) viewer.setMode(viewer.modes[digit - 1][0]);
  else if (action) {
    event.preventDefault();
    action();
  }
}
