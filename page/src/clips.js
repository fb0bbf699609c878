// A page of several clips shows one of them. The address says which, as in horse.html#clip=3; without it, the first that touches
// or crosses itself. To show another clip the page is opened anew, because everything on it belongs to one clip.
import { byId, element } from "./dom.js";
import { markOf } from "./words.js";

const summaryOf = (clip) => clip.strategies[0].summary;

export function chosenClip({ clips }) {
  const named = Number(/[#&]clip=(\d+)/.exec(window.location.hash)?.[1] ?? NaN);
  if (named >= 0 && named < clips.length) return named;
  return Math.max(0, clips.findIndex((clip) => summaryOf(clip).verdict !== "clear"));
}

export function offerClips(header) {
  if (!header.clips) return;
  const list = byId("clips"), shown = chosenClip(header);
  list.replaceChildren(...header.clips.map((clip, i) => {
    const option = element("option", `${markOf(summaryOf(clip))} ${clip.title}`);
    option.value = String(i);
    return option;
  }));
  list.value = String(shown);
  byId("clips-label").hidden = false;
  list.addEventListener("change", () => { window.location.hash = `clip=${list.value}`; });
  window.addEventListener("hashchange", () => {
    if (chosenClip(header) !== shown) window.location.reload();
  });
}
