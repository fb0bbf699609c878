// What the page says in words.
export const VERDICTS = ["clear", "touches", "crosses itself at its start", "undecided", "close"];

export const CLOSE = 4;
// What a contact is called: with a thickness, it is a pair that comes close.
export const contactWord = (strategy) => (strategy.close ? "close pair" : "contact");
// What the features of a contact do.
export const contactVerb = (strategy, contact) => {
  if (contact === undefined || !strategy.close) return "touches";
  return strategy.contact_touches[contact] ? "comes close to and touches" : "comes close to";
};

// Before a verdict, by the summary of its answers: of the true motion where that was asked for. That is close where nobody can
// tell whether it touches.
export const isBad = ({ true_motion: own, ...lines }) => (own ? own.touches + own.intersects_at_start : lines.touches + lines.intersects_at_start + (lines.close || 0)) > 0;
export const isOpen = ({ true_motion: own, undecided }) => (own ? own.undecided + own.close : undecided) > 0;
// A surface that only touches itself is milder than one that crosses itself.
export const isMild = (summary) => isBad(summary) && !summary.true_motion && !summary.headline && !summary.intersects_at_start;
export const markOf = (summary) => (isMild(summary) ? "\u25cf" : isBad(summary) ? "\u2716" : isOpen(summary) ? "?" : "\u2714");

// A figure as `cscd` writes it (figure_text() of core/base/number_text.h): three significant digits, all digits before the point,
// commas between thousands, an exponent for the small and the very large. JavaScript rounds ties up, and C++ to the even digit.
export function number(x, digits = 3) {
  const size = Math.abs(x), isWhole = size >= 10 ** digits - 0.5 && size < 1e15;
  const kept = isWhole ? Math.floor(Math.log10(size)) : digits - 1;  // digits behind the first one
  const [exact, exponent] = size.toExponential(60).split("e");
  const isEvenTie = /^[02468]50*$/.test(exact.replace(".", "").slice(kept));
  const rounded = isEvenTie ? Number(`${exact.slice(0, kept + (kept > 0 ? 2 : 1))}e${exponent}`) : Number(size.toExponential(kept));
  const sign = x < 0 ? "-" : "";
  if (isWhole || (Number.isInteger(rounded) && size < 1e15)) return sign + rounded.toLocaleString("en");
  if (rounded >= 1e-4 && rounded < 10 ** digits) return sign + String(rounded);
  return sign + rounded.toExponential().replace(/e([+-])(\d)$/, "e$10$2");
}
// A length of the input's positions, in a unit where the input tells its own (distance_text() of bench/inputs/thickness.h).
export function lengthText({ header }, length) {
  const centimetres = (header.import?.centimetres_per_unit ?? 0) * length;
  if (!header.import?.centimetres_per_unit || length === 0) return number(length);
  if (centimetres >= 100) return `${number(centimetres / 100)} m`;
  return centimetres >= 1 ? `${number(centimetres)} cm` : `${number(10 * centimetres)} mm`;
}
export const many = (count, one) => `${count.toLocaleString("en")} ${one}${count === 1 ? "" : "s"}`;
export const both = (a, b, verb) => (a === b ? (a === "the surface" ? `it ${verb} itself` : `${a} ${verb} itself`) : `${a} ${verb} ${b}`);

// Number and second of a frame, between frames too. A model's frames count on the file's own time line, and seconds from the
// clip's start; what comes before the clip is negative in both.
export function momentOf(recording, position) {
  const i = Math.min(recording.intervals - 1, Math.max(0, Math.floor(position)));
  return momentAt(recording.clip, i, position - i);
}

// The same at the share `t` of interval i of a clip; at its last frame, which starts no interval, with t = 0.
export function momentAt({ frame_number: numbers, seconds, fps, first_frame }, i, t) {
  const between = (row) => (t === 0 ? row[i] : (1 - t) * row[i] + t * row[i + 1]);
  if (!seconds) return { frame: between(numbers), seconds: null };
  const second = between(seconds);
  return { frame: second * fps + (second < 0 ? 0 : first_frame), seconds: second };
}

export function momentText(recording, position) {
  const { frame, seconds } = momentOf(recording, position);
  return `frame ${Number(frame.toFixed(2))}` + (seconds === null ? "" : ` (${number(seconds)} s)`);
}
