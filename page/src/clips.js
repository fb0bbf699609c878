// A page of several clips shows one of them. The address says which, as in horse.html#clip=3; without it, the one in which the
// surface lies deepest in itself, or where nothing does, the first that touches itself. To show another clip the page is opened anew, because everything on it belongs to one clip.
import { byId, element } from "./dom.js";
import { isBad, isMild, isOpen, lengthText, markOf } from "./words.js";

const summaryOf = (clip) => clip.strategies[0].summary;

// How much deeper something lies in a clip than at rest; 0 where no depth is known.
function depthIn(clip) {
  const { headline } = summaryOf(clip);
  return headline ? headline.depth.at_least - (headline.at_rest ?? 0) : 0;
}

export function chosenClip({ clips }) {
  const named = Number(/[#&]clip=(\d+)/.exec(window.location.hash)?.[1] ?? NaN);
  return named >= 0 && named < clips.length ? named : worstClip(clips);
}

export function worstClip(clips) {
  const deepest = clips.reduce((a, b) => Math.max(a, depthIn(b)), 0);
  return Math.max(0, clips.findIndex((clip) => (deepest > 0 ? depthIn(clip) === deepest : summaryOf(clip).verdict !== "clear")));
}

// `signal` ends it, where another viewer takes the place of the one that it is for.
export function offerClips(header, signal) {
  if (!header.clips) return;
  const list = byId("clips"), shown = chosenClip(header);
  listClips(header, header.clips, shown);
  list.addEventListener("change", () => { window.location.hash = `clip=${list.value}`; });
  window.addEventListener("hashchange", () => {
    if (chosenClip(header) !== shown) window.location.reload();
  }, { signal });
}

// The deepest first, then what crosses or touches, then the others, each in the order of the file.
export function listClips(header, clips, shown) {
  const list = byId("clips"), rankOf = (summary) => (isMild(summary) || isOpen(summary) ? 1 : isBad(summary) ? 2 : 0), rank = (clip) => rankOf(summaryOf(clip));
  const sorted = clips.map((clip, i) => ({ clip, i })).sort((a, b) => depthIn(b.clip) - depthIn(a.clip) || rank(b.clip) - rank(a.clip) || a.i - b.i);
  list.replaceChildren(...sorted.map(({ clip, i }) => {
    const { headline } = summaryOf(clip), deep = headline ? `, ${lengthText({ header }, headline.depth.at_least)} deep` : "";
    const option = element("option", `${markOf(summaryOf(clip))} ${clip.title}${deep}`);
    option.value = String(i);
    return option;
  }));
  list.value = String(shown);
  const unclear = clips.filter((clip) => rank(clip) > 0).length;
  byId("clips-label").firstChild.textContent = `${unclear} of ${clips.length} clips are not clear: `;
  byId("clips-label").hidden = false;
}
