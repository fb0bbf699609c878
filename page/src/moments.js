// What happens when: the intervals of a strategy's answers in which something touches or crosses.

const keyOf = (a, b) => 65536 * Math.min(a, b) + Math.max(a, b);

// The group of a moment: the numbers of both places that meet, the smaller one first, as one number. It is -1 where the page
// does not hold what meets.
export function groupOf({ place }, strategy, { pair, contact }) {
  const [a, b] = pair !== undefined ? [place[strategy.crossing[2 * pair]], place[strategy.crossing[2 * pair + 1]]]
    : contact !== undefined ? [strategy.contact_place[2 * contact], strategy.contact_place[2 * contact + 1]] : [0, -1];
  return b < 0 ? -1 : keyOf(a, b);
}

// The groups that only fold at joints, as every character does.
export function foldsOf({ texts }, strategy) {
  strategy.folds ??= new Set(strategy.summary.met.filter((row) => row.at_joint).map(({ first, second }) => keyOf(texts.indexOf(first), texts.indexOf(second))));
  return strategy.folds;
}

// All crossings at the start of an interval, then its contacts, the earliest first.
function* allOf({ crossingOffset, contactOffset }, interval) {
  for (let pair = crossingOffset[interval]; pair < crossingOffset[interval + 1]; ++pair) yield { interval, pair };
  for (let contact = contactOffset[interval]; contact < contactOffset[interval + 1]; ++contact) yield { interval, contact };
}

// What stands for an interval: the first thing in it that is no fold at a joint, or else the first.
function firstOf(recording, strategy, interval) {
  let first;
  for (const moment of allOf(strategy, interval)) {
    if (!foldsOf(recording, strategy).has(groupOf(recording, strategy, moment))) return moment;
    first ??= moment;
  }
  return first ?? { interval };
}

// One moment for each interval with contacts or crossings, in order: {interval, contact} or {interval, pair}.
export function momentsOf(recording, strategy) {
  if (!strategy.moments) {
    strategy.moments = [];
    for (let i = 0; i < strategy.verdict.length; ++i)
      if (strategy.contacts[i] > 0 || strategy.start_pairs[i] > 0) strategy.moments.push(firstOf(recording, strategy, i));
  }
  return strategy.moments;
}

// The moments of each pair of places that meets, by the pair's number: the first one of each interval in which the two meet.
export function groupsOf(recording, strategy) {
  if (strategy.groups) return strategy.groups;
  const groups = strategy.groups = new Map();
  const add = (moment) => {
    const key = groupOf(recording, strategy, moment);
    if (!groups.has(key)) groups.set(key, []);
    const moments = groups.get(key);
    if (moments.at(-1)?.interval !== moment.interval) moments.push(moment);
  };
  for (const moment of momentsOf(recording, strategy)) {
    if (groupOf(recording, strategy, moment) < 0) add(moment);
    for (const one of allOf(strategy, moment.interval)) add(one);
  }
  return groups;
}

// The names of both places that meet.
export function namesOf({ texts, place }, strategy, moment) {
  if (moment.pair !== undefined)
    return [0, 1].map((side) => texts[place[strategy.crossing[2 * moment.pair + side]]]);
  if (moment.contact === undefined) return ["the surface", "the surface"];
  return [0, 1].map((side) => texts[strategy.contact_place[2 * moment.contact + side]]);
}

// Moments of the true motion that straight lines do not have. The other ends of their intervals are the poses then.
export const truthsOf = ({ truths, endOfInterval }) =>
  Array.from(truths?.values() ?? []).filter((truth) => endOfInterval.has(truth.interval)).map((truth) => ({ interval: truth.interval, truth }));

// The moment of an event, at the start where it is deepest.
export const momentOfEvent = (event) => ({ interval: event.deepest, event });

// The first contact or crossing that the verdict names, as a list of one; empty where the page does not hold it.
function namedOf(recording, strategy) {
  const { first_named: named } = strategy.summary, interval = named ? named.interval - recording.clip.first_interval : -1;
  if (interval < 0) return [];
  const both = JSON.stringify([named.first, named.second]);
  return Array.from(allOf(strategy, interval)).filter((moment) => JSON.stringify(namesOf(recording, strategy, moment)) === both).slice(0, 1);
}

// The moment at which a page opens: that of which the verdict speaks first. Undefined where nothing happens.
export function openingOf(recording, strategy) {
  const number = strategy.summary.headline?.event, worst = recording.events.find((event) => event.number === number);
  return worst ? momentOfEvent(worst) : [...truthsOf(recording), ...namedOf(recording, strategy), ...momentsOf(recording, strategy)][0];
}

// When a moment is, in its interval.
export const timeOf = (strategy, moment) => (moment.truth ? moment.truth.at : moment.event ? moment.event.time : moment.contact === undefined ? 0 : strategy.contact_time[moment.contact] / 65535);
