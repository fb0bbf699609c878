// Colours that colour-blind readers can tell apart: Okabe and Ito's, as in bench/tables/looks.json.
export const ORANGE = "#E69F00", BLUE = "#0072B2", GREEN = "#009E73", PINK = "#CC79A7", RED = "#D55E00", SKY = "#56B4E9",
  YELLOW = "#F0E442", CROSSED = "#F3B493", SKIN = "#C9D3DB", GREY = "#AEB6BD";
export const CLUSTERS = [BLUE, ORANGE, SKY, RED, GREEN, YELLOW, PINK];

export const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
// The skin of the two places of a chosen event: what lies in the other, and the other.
export const TINTS = [BLUE, PINK].map((hex) => `#${rgb(hex).map((x, i) => Math.round(0.35 * x + 0.65 * rgb(SKIN)[i]).toString(16).padStart(2, "0")).join("")}`);

// Gives every group of triangles a colour of the palette that no neighbouring group has, where the palette allows it: greedily,
// beginning at the colour that `preferred` names. Returns the number of the colour of each group.
export function colourGroups(neighbours, preferred) {
  const colour = new Int8Array(neighbours.length).fill(-1);
  for (let g = 0; g < neighbours.length; ++g) {
    const taken = new Set();
    for (const other of neighbours[g]) taken.add(colour[other]);
    let chosen = preferred(g) % CLUSTERS.length;
    for (let k = 0; k < CLUSTERS.length && taken.has(chosen); ++k) chosen = (chosen + 1) % CLUSTERS.length;
    colour[g] = chosen;
  }
  return colour;
}

// Pairs of triangles that share an edge, as [triangle, triangle, ...].
export function edgeNeighbours(corners, vertices) {
  const first = new Map(), pairs = [];
  for (let t = 0; 3 * t < corners.length; ++t)
    for (let k = 0; k < 3; ++k) {
      const a = corners[3 * t + k], b = corners[3 * t + (k + 1) % 3];
      const key = Math.min(a, b) * vertices + Math.max(a, b);
      const other = first.get(key);
      if (other === undefined) first.set(key, t);
      else pairs.push(other, t);
    }
  return pairs;
}

// The groups that touch each group, for groups numbered from 0; negative numbers are no group.
export function groupNeighbours(pairs, groupOf, groups) {
  const neighbours = Array.from({ length: groups }, () => new Set());
  for (let i = 0; i < pairs.length; i += 2) {
    const a = groupOf(pairs[i]), b = groupOf(pairs[i + 1]);
    if (a !== b && a >= 0 && b >= 0) {
      neighbours[a].add(b);
      neighbours[b].add(a);
    }
  }
  return neighbours;
}
