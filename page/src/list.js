// The list of moments, with the contacts of the chosen one below it.
import { element } from "./dom.js";
import { momentOfEvent, momentsOf, namesOf, openingOf, timeOf, truthsOf } from "./moments.js";
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
    const interval = chosen ? chosen.interval : null;
    if (this.expanded !== interval && !playing) this.expand(strategy, interval);
    this.mark(chosen);
  }

  fill(strategy) {
    this.strategy = strategy;
    this.expanded = null;
    this.rowOf = new Map();  // by interval
    const moments = momentsOf(strategy);
    const what = strategy.close ? "close pairs" : "contact";
    const lines = this.recording.truths ? " along straight lines" : "";
    this.title.textContent = (moments.length ? `${many(moments.length, "moment")} with ${what}` : `No ${what}`) + lines;
    const rows = moments.slice(0, MOST_ROWS).map((moment) => {
      const { interval } = moment, row = element("button"), counts = [];
      row.moment = moment;
      row.append(element("span", both(...namesOf(this.recording, strategy, moment), moment.pair !== undefined ? "crosses" : contactVerb(strategy, moment.contact)), "what"),
        element("span", momentText(this.recording, interval + timeOf(strategy, moment)), "when"));
      if (strategy.start_pairs[interval] > 0) counts.push(many(strategy.start_pairs[interval], "crossing pair"));
      if (strategy.contacts[interval] > 0) counts.push(many(strategy.contacts[interval], contactWord(strategy)));
      row.append(element("span", counts.join(", "), "many"));
      this.rowOf.set(interval, row);
      return row;
    });
    if (moments.length > MOST_ROWS) rows.push(element("p", `and ${moments.length - MOST_ROWS} more: use the timeline`));
    if (moments.length === 0) rows.push(element("p", (strategy.close ? "Nothing comes close" : "Nothing touches") + lines + "."));
    const events = this.recording.events.slice(0, MOST_EVENTS).map((event) => {
      const row = element("button", undefined, "event");
      row.moment = momentOfEvent(event);
      row.append(element("span", event.text, "what"));
      return row;
    });
    const more = this.recording.events.length - events.length;
    if (events.length > 0) events.unshift(element("p", `Lies in itself in ${many(this.recording.events.length, "place")}${more > 0 ? ", deepest in" : ""}:`));
    const truths = truthsOf(this.recording).slice(0, MOST_EVENTS).map((moment) => {
      const row = element("button", undefined, "event");
      row.moment = moment;
      row.append(element("span", moment.truth.text, "what"), element("span", momentText(this.recording, moment.interval + moment.truth.at), "when"));
      return row;
    });
    this.opening = openingOf(this.recording, strategy);
    this.box.replaceChildren(...truths, ...events, ...rows);
  }

  expand(strategy, interval) {
    this.box.querySelectorAll(".one").forEach((row) => row.remove());
    this.expanded = interval;
    const row = this.rowOf.get(interval);
    if (!row) return;
    const from = strategy.contactOffset[interval], to = Math.min(strategy.contactOffset[interval + 1], from + MOST_CONTACTS), rows = [];
    for (let contact = from; contact < to; ++contact) {
      const one = element("button", undefined, "one");
      one.moment = { interval, contact };
      one.append(element("span", `${both(...namesOf(this.recording, strategy, one.moment), contactVerb(strategy, contact))} (${strategy.contact_kind[contact] === 0 ? "vertex, face" : "edge, edge"})`, "what"),
        element("span", `t = ${timeOf(strategy, one.moment).toFixed(4)}`, "when"));
      rows.push(one);
    }
    const left = strategy.contacts[interval] - rows.length;
    if (left > 0) rows.push(element("p", `and ${many(left, `more ${contactWord(strategy)}`)}`, "one"));
    row.after(...rows);
  }

  mark(chosen) {
    for (const row of this.box.querySelectorAll("[aria-current]")) row.removeAttribute("aria-current");
    if (!chosen) return;
    const one = chosen.contact === undefined ? null
      : Array.from(this.box.querySelectorAll("button.one")).find((row) => row.moment.contact === chosen.contact);
    const special = chosen.event || chosen.truth;
    const event = special && Array.from(this.box.querySelectorAll("button.event")).find((row) => (row.moment.event || row.moment.truth) === special);
    const row = event || one || this.rowOf.get(chosen.interval);
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
