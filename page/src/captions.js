// What the page says in words beside the list: the verdict, the legend, the numbers of the interval, the names of the panes.
import { bitOf } from "./data.js";
import { byId, element } from "./dom.js";
import { coverOf, mostDepth, tinted } from "./painter.js";
import { BLUE, CROSSED, GREEN, GREY, ORANGE, PINK, RED, SKIN, SKY, TINTS, YELLOW } from "./palette.js";
import { CLOSE, contactWord, isBad, isOpen, isMild, lengthText, many, markOf, number, VERDICTS } from "./words.js";

const MOST_PLACES = 6;  // of those that meet, in the legend

export class Captions {
  constructor(recording) { this.recording = recording; }

  // The sentences are made where the answers are (bench/answer/answer_text.h).
  sayVerdict(strategy) {
    const { summary, sentences: [headline, ...others], details } = strategy;
    const verdict = byId("verdict");
    verdict.className = isMild(summary) ? "mild" : isBad(summary) ? "bad" : isOpen(summary) ? "" : "good";
    verdict.replaceChildren(element("span", `${markOf(summary)} `, "mark"), document.createTextNode(headline), element("span", others.map((sentence) => ` ${sentence}`).join(""), "others"));
    byId("what-to-do").textContent = this.whatToDo(strategy);
    byId("answered").textContent = details;
    document.title = `${this.recording.header.name}: cscd view`;
  }

  // What frees the place that the verdict speaks of first, beside the size of the whole, which tells how bad it is; nothing where no way
  // out is known.
  whatToDo({ summary, close }) {
    const worst = this.recording.events.find(({ number }) => number === summary.headline?.event);
    if (worst?.out) {
      const way = lengthText(this.recording, Math.hypot(...worst.out));
      return `To free the deepest point, move ${worst.name} ${way} along the green arrow; the whole is ${lengthText(this.recording, this.recording.length)} long.`;
    }
    return isMild(summary) && !close && this.recording.events.length === 0 ? "It crosses itself at no frame." : "";
  }

  // In the view, what happens in an interval; the numbers that go with it are for the list of numbers.
  sayInterval(strategy, interval, predicted) {
    const contacts = strategy.contacts[interval], pairs = strategy.start_pairs[interval], text = [];
    if (pairs > 0) text.push("crosses itself here");
    else if (contacts > 0) text.push(strategy.close ? "comes close before the next frame" : "touches itself before the next frame");
    if (predicted && !this.recording.truths) text.push("in the simulator's step, before contacts are resolved");
    const truth = this.recording.truths?.get(interval);
    if (truth) text.push(truth.text);
    byId("moment").textContent = text.join(" · ");
    const facts = [["interval", String(interval + this.recording.clip.first_interval)], ["verdict", VERDICTS[strategy.verdict[interval]]],
      ["answered by", strategy.answered_by[strategy.answerer[interval]] + (strategy.proven[interval] ? ", proven" : ", not proven")]];
    if (pairs > 0) facts.push(["pairs of triangles that cross at its start", pairs.toLocaleString("en")]);
    if (contacts > 0) facts.push([`${contactWord(strategy)}s in it`, contacts.toLocaleString("en")]);
    if (strategy.pairs)  // the library does not count its work
      facts.push(["triangle pairs left by culling", strategy.pairs[interval].toLocaleString("en")], ["elementary tests", strategy.tests[interval].toLocaleString("en")]);
    if (this.recording.truths) facts.push(["true motion", (this.recording.truths.get(interval)?.verdict ?? "clear").replaceAll("_", " ")]);
    if (strategy.has_clusters)
      facts.push(["clusters in force", strategy.clusters[interval].toLocaleString("en")],
        ["positive", `${this.positiveShare(strategy, interval)} % of triangles`]);
    facts.push(["time of this answer here", `${number(strategy.milliseconds[interval])} ms, one try`]);
    byId("facts").replaceChildren(...facts.flatMap(([name, value]) => [element("dt", name), element("dd", value)]));
  }

  sayLegend(strategy, interval, mode, chosen, observers, placeColour) {
    const item = (colour, what) => {
      const span = element("span"), swatch = element("i");
      swatch.style.background = colour;
      span.append(swatch, what);
      return span;
    };
    const rows = [], cover = coverOf(mode);
    if (mode === "verdict") {
      if (strategy.contacts[interval] > 0) {
        if (strategy.close) rows.push(item(SKY, `within ${this.recording.header.thickness}`));
        if (!strategy.close || strategy.verdict[interval] !== CLOSE) rows.push(item(ORANGE, "touches"));
      }
      if (strategy.start_pairs[interval] > 0) rows.push(item(CROSSED, "crosses"), item(RED, "where"));
      if (this.recording.truths?.get(interval)?.pair) rows.push(item(PINK, "true motion"));
      if (rows.length === 0) rows.push(item(SKIN, `this interval is ${VERDICTS[strategy.verdict[interval]]}`));
    } else if (mode === "depth") rows.push(...tinted(this.recording, chosen).map((number, i) => item(TINTS[i], this.recording.texts[number])), item(SKIN, "lies in nothing"), this.depthScale(), item(RED, "lines: where pieces cross"));
    else if (mode === "positive") rows.push(item(SKIN, "positive: seen from behind throughout the interval"), item(RED, "not positive"));
    else if (mode === "often") rows.push(item(SKIN, "never"), item(YELLOW, "once"), item(RED, "most often"));
    else if (mode === "place") {
      const { texts } = this.recording, met = new Set(strategy.summary.met.flatMap(({ first, second }) => [first, second]));
      const named = Array.from(met, (name) => texts.indexOf(name)).filter((number) => placeColour(number)).slice(0, MOST_PLACES);
      rows.push(...named.map((number) => item(placeColour(number), texts[number])), element("b", "the pointer names the others"));
    } else if (mode === "part") rows.push(element("b", "one colour for each part"));
    else if (mode === "patch") rows.push(element("b", strategy.has_patches ? "patches of up to 16 triangles, the unit of work" : `${strategy.name} has no patches`));
    else if (cover > 0) {
      if (strategy.covers > cover) rows.push(element("b", `one colour for each cluster of ${cover === 1 ? "the second cover, which lie at seams of the first" : "the third cover, where seams of both meet"}`), item(GREY, "in no cluster of it"));
      else rows.push(element("b", `${strategy.name} does not look from this cover here`));
    } else {
      const cluster = `one colour for each cluster${strategy.has_patches ? " of the first cover" : ""}`;
      rows.push(element("b", !strategy.has_clusters ? `${strategy.name} has no clusters`
        : mode === "atomic" ? `${cluster}, as made in advance` : `${cluster} that has one observer in this interval`));
    }
    if (observers && strategy.observers?.length > 0) {
      const { offset } = strategy.observers[Math.min(cover, strategy.observers.length - 1)];
      rows.push(element("b", `${many(offset[interval + 1] - offset[interval], "observer")}${strategy.has_patches ? "" : ": points, or bones as segments"}`));
    }
    if (chosen && chosen.event) rows.push(item(BLUE, "lines of the chosen place"));
    if (chosen?.event?.out) rows.push(item(GREEN, `${lengthText(this.recording, Math.hypot(...chosen.event.out))} to free the deepest point of ${chosen.event.name}`));
    if (chosen && chosen.contact !== undefined && mode !== "depth") rows.push(item(BLUE, "first feature, point and normal"), item(PINK, "second feature"));
    byId("legend").replaceChildren(...rows);
  }

  // The colours of depths from 0 to the one that the verdict names, with numbers. Deeper places, such as at a joint, have its colour.
  depthScale() {
    const scale = element("span", undefined, "scale"), bar = element("i"), most = mostDepth(this.recording);
    const text = lengthText(this.recording, most), deeper = this.recording.insideDepth.some((depth) => depth > most && lengthText(this.recording, depth) !== text);
    bar.style.background = `linear-gradient(to right, ${YELLOW}, ${RED})`;
    scale.append(bar, ...[lengthText(this.recording, 0), lengthText(this.recording, most / 2), (deeper ? "\u2265 " : "") + text].map((number) => element("b", number)));
    return scale;
  }

  // Draws a frame with a name round each pane of the stage, if there are several.
  namePanes(panes, strategies) {
    byId("panes").replaceChildren(...(strategies.length < 2 ? [] : panes.map((pane, i) => {
      const box = element("div", undefined, "pane"), name = element("p", strategies[i].name, "pane-name");
      Object.assign(box.style, {
        left: `${pane.x}px`, top: `${pane.y}px`, width: `${pane.w}px`, height: `${pane.h}px`,
        borderLeftWidth: pane.x > 1 ? "1px" : "0", borderTopWidth: pane.y > 1 ? "1px" : "0",
      });
      name.append(element("small", ""));
      box.append(name);
      return box;
    })));
  }

  sayPanes(strategies, interval) {
    strategies.forEach((strategy, i) => {
      const small = byId("panes").children[i]?.querySelector("small");
      if (!small) return;
      const parts = [`${many(strategy.pairs[interval], "pair")} left by culling`];
      if (strategy.has_clusters) parts.push(many(strategy.clusters[interval], "cluster"), `${this.positiveShare(strategy, interval)} % positive`);
      small.textContent = parts.join(" · ");
    });
  }

  positiveShare(strategy, interval) {
    const { triangles } = this.recording.clip;
    strategy.shares ??= new Map();
    if (!strategy.shares.has(interval)) {
      let count = 0;
      for (let t = 0; t < triangles; ++t) count += bitOf(strategy.positive, triangles, interval, t);
      strategy.shares.set(interval, ((100 * count) / triangles).toFixed(1));
    }
    return strategy.shares.get(interval);
  }
}
