// What happens when: the intervals of a strategy's answers in which something touches or crosses.

// The first thing of an interval: a crossing at its start, or else its earliest contact.
function firstOf(strategy, interval) {
  const pair = strategy.crossingOffset[interval], contact = strategy.contactOffset[interval];
  if (strategy.crossingOffset[interval + 1] > pair) return { interval, pair };
  return { interval, contact: strategy.contactOffset[interval + 1] > contact ? contact : undefined };
}

// One moment for each interval with contacts or crossings, in order: {interval, contact} or {interval, pair}.
export function momentsOf(strategy) {
  if (!strategy.moments) {
    strategy.moments = [];
    for (let i = 0; i < strategy.verdict.length; ++i)
      if (strategy.contacts[i] > 0 || strategy.start_pairs[i] > 0) strategy.moments.push(firstOf(strategy, i));
  }
  return strategy.moments;
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
  const found = [];
  if (interval < 0) return found;
  for (let pair = strategy.crossingOffset[interval]; pair < strategy.crossingOffset[interval + 1]; ++pair) found.push({ interval, pair });
  for (let contact = strategy.contactOffset[interval]; contact < strategy.contactOffset[interval + 1]; ++contact) found.push({ interval, contact });
  const both = JSON.stringify([named.first, named.second]);
  return found.filter((moment) => JSON.stringify(namesOf(recording, strategy, moment)) === both).slice(0, 1);
}

// The moment at which a page opens: that of which the verdict speaks first. Undefined where nothing happens.
export function openingOf(recording, strategy) {
  const number = strategy.summary.headline?.event, worst = recording.events.find((event) => event.number === number);
  return worst ? momentOfEvent(worst) : [...truthsOf(recording), ...namedOf(recording, strategy), ...momentsOf(strategy)][0];
}

// When a moment is, in its interval.
export const timeOf = (strategy, moment) => (moment.truth ? moment.truth.at : moment.event ? moment.event.time : moment.contact === undefined ? 0 : strategy.contact_time[moment.contact] / 65535);
