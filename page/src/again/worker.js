// Answers the clip that a page of `cscd view --with-engine` shows, beside the page, which stays free. Takes {header, arrays, asked,
// engine} once, and posts {kind}: "progress", and at last "answer" or "refused".
import init, { SelfCollision } from "cscd";
import { answerClip } from "../check/answer.js";
import { post, teller } from "../check/post.js";
import { RecordedSurface } from "./recorded.js";
import { settingsOf } from "./settings.js";

async function answer({ header, arrays, asked, engine }) {
  const loading = init(engine), surface = new RecordedSurface(header, arrays), settings = settingsOf(surface, asked), tell = teller();
  await loading;
  surface.prepare(SelfCollision);
  if (settings.thickness) surface.thickBody = new SelfCollision(surface.mesh.corners, surface.rest, { thickness: settings.thickness.length });
  const { arrays: answers, json, ...said } = answerClip(surface, surface.clip, settings, (interval) => tell({ interval }));
  post("answer", { ...said, texts: surface.texts }, { ...answers, ...surface.otherEnds(answers["s0.contacts"]) });
}

onmessage = ({ data }) => answer(data).catch((error) => post("refused", { text: error.message || String(error) }));
