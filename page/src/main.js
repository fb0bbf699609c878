// The page of `cscd view`: the viewer (viewer.js) of the recording that stands in the page (data.js).
import { offerClips } from "./clips.js";
import { loadRecording } from "./data.js";
import { byId } from "./dom.js";
import { requireBrowser, Viewer } from "./viewer.js";

function fail(error) {
  document.body.classList.add("failed");
  byId("verdict").textContent = "This page cannot be shown.";
  byId("details").textContent = error instanceof RangeError
    ? "The recording is larger than this browser can hold; write it again with fewer frames: cscd view INPUT --frames A:B"
    : error instanceof SyntaxError ? "The page is damaged. Write it again with cscd view."
    : String(error.message || error);
  console.warn(error);
}

async function begin() {
  requireBrowser();
  window.cscd = new Viewer(await loadRecording());
  offerClips(window.cscd.recording.header);
}

begin().catch(fail);
