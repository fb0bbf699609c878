// The list of what lies in what, and of moments by the pair of places that meets, with the contacts of the chosen moment below it.
import { element } from "./dom.js";
import { foldsOf, groupOf, groupsOf, momentOfEvent, momentsOf, namesOf, openingOf, timeOf, truthsOf } from "./moments.js";
import { both, contactVerb, contactWord, many, momentText } from "./words.js";

const MOST_ROWS = 1500;  // browsers grow slow with more
const MOST_CONTACTS = 200;
const MOST_EVENTS = 10;

export class MomentList {
  // `select` is called with a moment that was clicked.
  constructor(recording, box, title, select) {
    this.recording = recording;
    this.box = box;
    this.title = title;
    box.addEventListener("click", (event) => {
      const row = event.target.closest("button");
      if (row && row.moment) select(row.moment);
    });
  }

  show(strategy, chosen, playing) {
    if (this.strategy !== strategy) this.fill(strategy);
    if (!playing) this.unfold(chosen);
    this.mark(chosen);
  }

  fill(strategy) {
    this.strategy = strategy;
    const moments = momentsOf(this.recording, strategy);
    const what = strategy.close ? "close pairs" : "contact";
    const lines = this.recording.truths ? " along straight lines" : "";
    this.title.textContent = (moments.length ? `${many(moments.length, "moment")} with ${what}` : `No ${what}`) + lines;
    const boxes = [], quiet = [];
    this.groups = new Map();
    for (const [key, those] of groupsOf(this.recording, strategy)) {
      const box = this.groupBox(strategy, those);
      this.groups.set(key, box);
      (foldsOf(this.recording, strategy).has(key) ? quiet : boxes).push(box.details);
    }
    if (quiet.length > 0) quiet.unshift(element("p", "At joints, less deep than a tenth of the limb's girth:"));
    const rows = [...boxes, ...quiet];
    if (moments.length === 0) rows.push(element("p", (strategy.close ? "Nothing comes close" : "Nothing touches") + lines + "."));
    const events = this.recording.events.slice(0, MOST_EVENTS).map((event) => {
      const row = element("button", undefined, "event");
      row.moment = momentOfEvent(event);
      row.append(element("span", event.text, "what"));
      return row;
    });
    const more = this.recording.events.length - events.length;
    if (events.length > 0) events.unshift(element("p", `${this.placesText()}${more > 0 ? "; deepest in" : ""}:`));
    const truths = truthsOf(this.recording).slice(0, MOST_EVENTS).map((moment) => {
      const row = element("button", undefined, "event");
      row.moment = moment;
      row.append(element("span", moment.truth.text, "what"), element("span", momentText(this.recording, moment.interval + moment.truth.at), "when"));
      return row;
    });
    this.opening = openingOf(this.recording, strategy);
    this.unfolded = null;
    this.box.replaceChildren(...truths, ...events, ...rows);
  }

  placesText() {
    const { events } = this.recording, folds = events.filter(({ atJoint }) => atJoint).length, others = events.length - folds;
    if (others === 0) return `Folds onto itself at joints in ${many(folds, "place")}`;
    return `Lies in itself in ${many(others, "place")}${folds > 0 ? `, and at joints in ${folds} more` : ""}`;
  }

  // A pair of places that meets. Its moments are listed once it is unfolded.
  groupBox(strategy, moments) {
    const details = element("details"), summary = element("summary"), [first] = moments, last = moments.at(-1);
    const verb = moments.some(({ pair }) => pair !== undefined) ? "crosses" : contactVerb(strategy, first.contact);
    const frameOf = (moment) => momentText(this.recording, moment.interval + timeOf(strategy, moment));
    summary.append(element("span", both(...namesOf(this.recording, strategy, first), verb), "what"),
      element("span", moments.length > 1 ? `${many(moments.length, "moment")}, ${frameOf(first)} to ${frameOf(last)}` : frameOf(first), "many"));
    details.append(summary);
    const box = { details, rows: null };
    box.fill = () => {
      if (box.rows) return;
      box.rows = new Map();  // by interval
      for (const moment of moments.slice(0, MOST_ROWS)) {
        const row = element("button"), counts = [], { interval } = moment;
        row.moment = moment;
        if (strategy.start_pairs[interval] > 0) counts.push(many(strategy.start_pairs[interval], "crossing pair"));
        if (strategy.contacts[interval] > 0) counts.push(many(strategy.contacts[interval], contactWord(strategy)));
        row.append(element("span", frameOf(moment), "what"), element("span", `${counts.join(", ")} in all`, "many"));
        box.rows.set(interval, row);
        details.append(row);
      }
      if (moments.length > MOST_ROWS) details.append(element("p", `and ${moments.length - MOST_ROWS} more: use the timeline`));
    };
    details.addEventListener("toggle", () => { if (details.open) box.fill(); });
    return box;
  }

  // Shows the group of a chosen moment, and below the moment the contacts of its pair in that interval, folded.
  unfold(chosen) {
    const group = chosen && !chosen.event && !chosen.truth ? groupOf(this.recording, this.strategy, chosen) : null;
    const key = group === null ? null : `${group} ${chosen.interval}`;
    if (key === this.unfolded) return;
    this.unfolded = key;
    if (this.opened) this.opened.open = false;  // it was opened for another moment
    this.opened = null;
    this.box.querySelector(".contacts")?.remove();
    const box = this.groups.get(group);
    if (!box) return;
    box.fill();
    if (!box.details.open) this.opened = box.details;
    box.details.open = true;
    const row = box.rows.get(chosen.interval), { strategy, recording } = this, own = [];
    if (!row) return;
    for (let contact = strategy.contactOffset[chosen.interval]; contact < strategy.contactOffset[chosen.interval + 1]; ++contact)
      if (groupOf(recording, strategy, { contact }) === group) own.push(contact);
    const rows = own.slice(0, MOST_CONTACTS).map((contact) => {
      const one = element("button");
      one.moment = { interval: chosen.interval, contact };
      one.append(element("span", `${both(...namesOf(recording, strategy, one.moment), contactVerb(strategy, contact))} (${strategy.contact_kind[contact] === 0 ? "vertex, face" : "edge, edge"})`, "what"),
        element("span", `t = ${timeOf(strategy, one.moment).toFixed(4)}`, "when"));
      return one;
    });
    if (rows.length === 0) return;
    if (own.length > rows.length) rows.push(element("p", `and ${many(own.length - rows.length, `more ${contactWord(strategy)}`)}`));
    const contacts = element("details", undefined, "contacts"), heading = element("summary");
    heading.append(element("span", many(own.length, contactWord(strategy)), "what"));
    contacts.append(heading, ...rows);
    row.after(contacts);
  }

  mark(chosen) {
    for (const row of this.box.querySelectorAll("[aria-current]")) row.removeAttribute("aria-current");
    if (!chosen) return;
    const one = chosen.contact === undefined ? null
      : Array.from(this.box.querySelectorAll("details.contacts[open] button")).find((row) => row.moment.contact === chosen.contact);
    const special = chosen.event || chosen.truth;
    const event = special && Array.from(this.box.querySelectorAll("button.event")).find((row) => (row.moment.event || row.moment.truth) === special);
    const box = special ? null : this.groups.get(groupOf(this.recording, this.strategy, chosen));
    const row = event || one || box?.rows?.get(chosen.interval);
    if (!row) return;
    row.setAttribute("aria-current", "true");
    if (row === this.current) return;  // whoever scrolls away from it may stay there
    const opens = this.current === undefined;
    this.current = row;
    if (opens && chosen.interval === this.opening?.interval) return;  // a page opens at the top of its list, which says what lies deepest
    const place = row.getBoundingClientRect(), frame = this.box.getBoundingClientRect();
    if (place.top < frame.top || place.bottom > frame.bottom) this.box.scrollTop += place.top - frame.top - 60;
  }
}
