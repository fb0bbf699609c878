// The page of `cscd view`: the viewer (viewer.js) of the recording that stands in the page (data.js).
import { offerClips } from "./clips.js";
import { loadRecording, recordingOf } from "./data.js";
import { fail, requireBrowser, Viewer } from "./viewer.js";

async function begin() {
  requireBrowser();
  const { header, arrays } = await loadRecording();
  window.cscd = new Viewer(recordingOf(header, arrays));
  offerClips(window.cscd.recording.header);
}

begin().catch(fail);
