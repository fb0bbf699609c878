// What the page says in words.
export const VERDICTS = ["clear", "touches", "intersects at its start", "undecided"];

const number = (x, digits = 4) => String(Number(x.toPrecision(digits)));
export const many = (count, one) => `${count.toLocaleString("en")} ${one}${count === 1 ? "" : "s"}`;
export const both = (a, b, verb) => (a === b ? (a === "the surface" ? `it ${verb} itself` : `${a} ${verb} itself`) : `${a} ${verb} ${b}`);

// Number and second of a frame, between frames too.
export function momentOf(recording, position) {
  const { frame_number: numbers, seconds } = recording.clip;
  const i = Math.min(recording.intervals - 1, Math.max(0, Math.floor(position))), t = position - i;
  const between = (row) => (1 - t) * row[i] + t * row[i + 1];
  return { frame: between(numbers), seconds: seconds ? between(seconds) : null };
}

export function momentText(recording, position) {
  const { frame, seconds } = momentOf(recording, position);
  return `frame ${number(frame)}` + (seconds === null ? "" : ` (${number(seconds, 3)} s)`);
}

// One sentence: does it, where, when.
export function verdictSentence(recording, strategy, first) {
  const { name } = recording.header;
  const range = `in frames ${number(recording.clip.frame_number[0])} to ${number(recording.clip.frame_number.at(-1))}`;
  if (!first) {
    if (strategy.summary.undecided > 0) return `${name} may touch itself ${range}: the elementary test could not tell.`;
    return `${name} does not touch itself ${range}.`;
  }
  const when = momentText(recording, first.position), verb = first.crossing ? "crosses" : "touches";
  return `${name} ${first.crossing ? "intersects" : "touches"} itself, first at ${when}: ${both(first.a, first.b, verb)}.`;
}

export function detailSentence(recording, strategy) {
  const { summary } = strategy, parts = [];
  const bad = summary.touches + summary.intersects_at_start;
  if (bad > 0) {
    let text = `In ${bad} of ${many(summary.intervals, "interval")}`;
    if (summary.intersects_at_start > 0 && summary.touches > 0) text += ` (${summary.intersects_at_start} begin with a crossing)`;
    if (summary.worst) text += `; worst at frame ${number(Math.floor(summary.worst.frame))} with ` +
      (summary.worst.start_pairs > 0 ? `${many(summary.worst.start_pairs, "crossing pair")} and ` : "") + many(summary.worst.contacts, "contact");
    parts.push(text + ".");
  } else {
    parts.push(`All ${many(summary.intervals, "interval")} are clear.`);
  }
  parts.push(summary.proven === summary.intervals ? "Every answer is proven." : `${summary.proven} of ${summary.intervals} answers are proven.`);
  const { rest } = recording.header;
  if (rest.pairs > 0)
    parts.push(`${many(rest.pairs, "pair")} of triangles cross at rest (${rest.parts.slice(0, 2).map((p) => (p.first === p.second ? p.first : `${p.first} in ${p.second}`)).join(", ")}${rest.parts.length > 2 ? ", ..." : ""}) and ${rest.left_out ? "are left out" : "are counted"}.`);
  return parts.join(" ");
}
