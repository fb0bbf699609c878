// How a worker tells the page what it does.

// Posts a message of a kind, and gives the memory of arrays away.
export const post = (kind, message, arrays = {}) => postMessage({ kind, ...message, arrays }, Array.from(new Set(Object.values(arrays).map(({ buffer }) => buffer))));

// Returns a function that posts progress, some twenty times a second at most.
export function teller() {
  let told = 0;
  return (message) => {
    if (performance.now() - told < 50) return;
    told = performance.now();
    post("progress", message);
  };
}
