"""Every promise of the library, held against a search of all pairs in numpy, on small random surfaces.

The surfaces are closed, open and torn, of one and of several pieces, and some stand beside others as obstacles. The
search decides by roots of cubics in doubles, and passes over the few pairs that are too close to call. Answers of the
library to related questions are compared without any tolerance. CSCD_RANDOM_INTERVALS sets how many intervals.
"""
import itertools
import os
import unittest

import cscd
import numpy as np

INTERVALS = int(os.environ.get("CSCD_RANDOM_INTERVALS", "60"))
UNSURE = 1e-6  # shares of a face or an edge, and times, that are too close to call
KINDS = ["free", "touching", "crossing", "unsure", "filtered", "obstacles", "at the obstacle"]
SHAPES = {
    "octahedron": ([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]],
                   [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]),
    "tetrahedron": ([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.3, 0.3, 1]]),
    "strip": ([[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5], [4, 6, 5], [5, 6, 7]],
              [[-1.5, 0, 0], [-1.5, 1, 0], [-0.5, 0, 0], [-0.5, 1, 0], [0.5, 0, 0], [0.5, 1, 0], [1.5, 0, 0], [1.5, 1, 0]]),
}


def turned(random, points):
    q, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return points @ q


class Interval:
    """A random step of a scene. Vertices from `own` on are those of an obstacle, or there is none."""

    def __init__(self, seed):
        random = np.random.default_rng(seed)
        self.seed, faces, before, after = seed, [], [], []
        pieces = random.integers(1, 4)
        self.obstacle = pieces > 1 and seed % 3 == 0
        for piece in range(pieces):
            corners, points = map(np.array, SHAPES[random.choice(list(SHAPES))])
            if random.random() < 0.3:  # torn: a face is missing, another is turned round
                corners = np.vstack([corners[2:], corners[:1, ::-1]])
            first = sum(len(b) for b in before)
            if piece == pieces - 1:
                self.own, self.own_faces = (first, sum(map(len, faces))) if self.obstacle else (None, None)
            faces.append(corners + first)
            start = turned(random, points + 0.1 * random.normal(size=points.shape)) + 1.2 * random.normal(size=3)
            calm = 0.3 if random.random() < 0.5 else 1.5
            end = start + calm * (random.normal(size=3) + 0.5 * random.normal(size=start.shape))
            if self.obstacle and piece == pieces - 1 and seed % 2 == 0:
                end = start
            before.append(start)
            after.append(end)
        self.faces = np.vstack(faces).astype(np.int32)
        self.before, self.after = np.vstack(before), np.vstack(after)
        self.own = len(self.before) if self.own is None else self.own
        self.own_faces = len(self.faces) if self.own_faces is None else self.own_faces
        edges = np.sort(self.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        self.edges = np.unique(edges, axis=0)

    def body(self, **options):
        if self.obstacle:
            corners = self.faces[self.own_faces:] - self.own
            options["obstacles"] = [(corners, self.before[self.own:])]
        body = cscd.SelfCollision(self.faces[:self.own_faces], self.before[:self.own], **options)
        if self.obstacle:
            body.move_obstacle(0, self.before[self.own:], self.after[self.own:])
        return body

    def step(self):
        return self.before[:self.own], self.after[:self.own]

    def pairs(self):
        """[n, 4] vertices and [n] faces of all pairs of a vertex and a face, then of two edges (face -1)."""
        used = np.unique(self.faces)
        v, f = (a.ravel() for a in np.meshgrid(used, np.arange(len(self.faces)), indexing="ij"))
        e, g = np.triu_indices(len(self.edges), 1)
        vertices = np.vstack([np.c_[v, self.faces[f]], np.c_[self.edges[e], self.edges[g]]])
        face = np.r_[f, np.full(len(e), -1)]
        ordered = np.sort(vertices, axis=1)
        keep = (ordered[:, 1:] != ordered[:, :-1]).all(axis=1)
        keep &= (vertices < self.own).any(axis=1)  # obstacle against obstacle is never asked
        return vertices[keep], face[keep]


def gap(interval, vertices, face):
    """How far the boxes of both features' paths are apart along the worst axis, [n]."""
    at = np.stack([interval.before, interval.after], 1)[vertices]  # [n, 4, 2, 3]
    split = np.where(face >= 0, 1, 2)[:, None]
    first = (np.arange(4) < split)[:, :, None, None]
    low, high = ([np.where(mask, at, fill).reshape(len(at), 8, 3) for mask in (first, ~first)] for fill in (np.inf, -np.inf))
    low, high = [a.min(axis=1) for a in low], [a.max(axis=1) for a in high]
    return np.maximum(low[0] - high[1], low[1] - high[0]).max(axis=1)


def cubic(a, b, c):
    """Coefficients of det(a, b, c) for vectors that move from [n, 0] to [n, 1], lowest first, [n, 4]."""
    out = np.zeros((len(a), 4))
    for i, j, k in itertools.product(range(2), repeat=3):
        u, v, w = (x[:, 0] if n == 0 else x[:, 1] - x[:, 0] for x, n in ((a, i), (b, j), (c, k)))
        out[:, i + j + k] += np.einsum("ij,ij->i", u, np.cross(v, w))
    return out


def roots(p):
    """Roots of cubics in [0, 1], [n, 3], NaN for none, and whether the cubic comes near zero without a root, [n]."""
    value = lambda t: ((p[:, 3:] * t + p[:, 2:3]) * t + p[:, 1:2]) * t + p[:, :1]
    with np.errstate(all="ignore"):
        root = np.sqrt(p[:, 2] ** 2 - 3 * p[:, 1] * p[:, 3])
        q = -(p[:, 2] + np.where(p[:, 2] < 0, -root, root))
        turns = np.sort(np.nan_to_num(np.c_[q / (3 * p[:, 3]), p[:, 1] / q], nan=0, posinf=0, neginf=0).clip(0, 1))
    at = np.c_[np.zeros(len(p)), turns, np.ones(len(p))]
    low, high, f = at[:, :3].copy(), at[:, 1:].copy(), value(at)
    there, rising = f[:, :3] * f[:, 1:] <= 0, f[:, :3] <= f[:, 1:]
    for _ in range(50):
        middle = 0.5 * (low + high)
        left = (value(middle) < 0) == rising
        low, high = np.where(left, middle, low), np.where(left, high, middle)
    near = (np.abs(f) < 1e-9 * np.abs(p).sum(axis=1, keepdims=True)).any(axis=1)
    return np.where(there, 0.5 * (low + high), np.nan), near


def margins(vertices, face, where):
    """How far inside both features the common point lies, for coplanar features at positions [n, 4, 3]; negative: outside."""
    a, b, c, d = (where[:, i] for i in range(4))
    out = np.empty(len(where))
    with np.errstate(all="ignore"):
        normal = np.cross(c - b, d - b)
        area = np.einsum("ij,ij->i", normal, normal)
        part = [np.einsum("ij,ij->i", np.cross(q - p, a - p), normal) / area for p, q in ((b, c), (c, d), (d, b))]
        normal = np.cross(b - a, d - c)
        area = np.einsum("ij,ij->i", normal, normal)
        s = np.einsum("ij,ij->i", np.cross(c - a, d - c), normal) / area
        t = np.einsum("ij,ij->i", np.cross(c - a, b - a), normal) / area
        inside = np.min(part, axis=0), np.min([s, 1 - s, t, 1 - t], axis=0)
    out = np.where(face >= 0, *inside)
    return np.where(np.isfinite(out), out, 0)


def contacts(interval, vertices, face):
    """The time of each pair's contact, [n]: infinite for apart, NaN for too close to call."""
    at = np.stack([interval.before, interval.after], 1)[vertices]
    edges = (face < 0)[:, None, None]
    a, b, c, d = (at[:, i] for i in range(4))
    times, near = roots(cubic(np.where(edges, b - a, c - b), np.where(edges, d - c, d - b), np.where(edges, c - a, a - b)))
    out = np.where(near, np.nan, np.inf)
    for k in (2, 1, 0):  # the earliest last
        t = np.nan_to_num(times[:, k])[:, None, None]
        inside = margins(vertices, face, (1 - t) * at[:, :, 0] + t * at[:, :, 1])
        found = ~np.isnan(times[:, k])
        out = np.where(found & (inside > UNSURE), times[:, k], np.where(found & (np.abs(inside) <= UNSURE), np.nan, out))
    return np.where(near, np.nan, out)


def crossings(interval):
    """Pairs of faces that surely cross at the start, and those that may."""
    x, sure, maybe = interval.before, set(), set()
    e, f = (a.ravel() for a in np.meshgrid(np.arange(len(interval.edges)), np.arange(len(interval.faces)), indexing="ij"))
    edge, face = interval.edges[e], interval.faces[f]
    keep = ~(edge[:, :, None] == face[:, None, :]).any(axis=(1, 2)) & (np.c_[edge, face] < interval.own).any(axis=1)
    e, f, edge, face = e[keep], f[keep], edge[keep], face[keep]
    p, q, a, b, c = x[edge[:, 0]], x[edge[:, 1]], x[face[:, 0]], x[face[:, 1]], x[face[:, 2]]
    volume = lambda u, v, w, o: np.einsum("ij,ij->i", np.cross(v - u, w - u), o - u)
    ends = -volume(a, b, c, p) * volume(a, b, c, q)
    sides = np.stack([volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)])
    inside = np.maximum(sides.min(axis=0), -sides.max(axis=0))
    at_edge = [np.nonzero((interval.faces[:, :, None] == edge[None, None, :]).any(axis=1).all(axis=1))[0] for edge in interval.edges]
    for i in np.nonzero((ends > -1e-9) & (inside > -1e-9))[0]:
        for g in at_edge[e[i]]:
            pair = (min(g, f[i]), max(g, f[i]))
            maybe.add(pair)
            if ends[i] > 1e-9 and inside[i] > 1e-9:
                sure.add(pair)
    return sure, maybe


def keys(answer):
    return [(tuple(v), f) for v, f in zip(answer.vertices.tolist(), answer.faces.tolist())]


class Guarantees(unittest.TestCase):
    def test_all_seven(self):
        seen = dict.fromkeys(KINDS, 0)
        for seed in range(INTERVALS):
            with self.subTest(seed=seed):
                self.check(Interval(seed), seen)
        print(INTERVALS, "intervals:", seen)
        for kind, count in seen.items():
            self.assertTrue(count > 0 or kind == "unsure", kind)
        self.assertLess(seen["unsure"], INTERVALS / 10)

    def test_wrong_answers_are_seen(self):
        class Displaced(Interval):  # one vertex ends elsewhere than the library is told
            def step(self):
                before, after = super().step()
                after = after.copy()
                after[0] += 0.1
                return before, after

        class AtRest(Interval):  # an obstacle moves, and the library is told that it is at rest
            def body(self, **options):
                body = super().body(**options)
                if self.obstacle:
                    body.place_obstacle(0, self.before[self.own:])
                return body

        class Unfiltered(Interval):  # a filter is not passed on
            def body(self, exclude=None, **options):
                return super().body(**options)

        for wrong in (Displaced, AtRest, Unfiltered):
            seen = 0
            for seed in range(3, 63, 3):
                try:
                    self.check(wrong(seed), dict.fromkeys(KINDS, 0))
                except AssertionError:
                    seen += 1
            self.assertGreater(seen, 0, wrong.__name__)

    def check(self, interval, seen):
        body, step = interval.body(), interval.step()
        vertices, face = interval.pairs()
        apart = gap(interval, vertices, face)
        times = np.full(len(face), np.inf)
        times[apart <= 0] = contacts(interval, vertices[apart <= 0], face[apart <= 0])
        truth = {(tuple(v), f): t for v, f, t in zip(vertices.tolist(), face.tolist(), times)}
        # All contacts.
        answer = body.all_contacts(*step)
        found = dict(zip(keys(answer), answer.times))
        self.assertEqual(len(found), len(answer.times))
        for key, time in found.items():
            self.assertTrue(np.isnan(truth[key]) or abs(truth[key] - time) < UNSURE, (key, time, truth[key]))
        for key, time in truth.items():
            self.assertTrue(not time <= 1 or key in found, (key, time))
        # The start.
        sure, maybe = crossings(interval)
        crossing = {tuple(pair) for pair in answer.start_crossings.tolist()}
        self.assertTrue(sure <= crossing <= maybe, (sure, crossing, maybe))
        # The earliest contact, free, and the largest step.
        first = body.first_contact(*step)
        self.assertEqual(first.time, answer.time)
        self.assertTrue(set(keys(first)) <= {key for key, time in found.items() if time == answer.time})
        self.assertEqual(bool(len(first.times)), bool(found))
        self.assertEqual(body.is_free(*step), not found and not crossing)
        share = body.largest_step(*step, safety=0.8)
        if crossing or answer.time is None:
            self.assertEqual(share, 0 if crossing else 1)
        else:
            self.assertTrue(0.8 * (answer.time - 1e-14) <= share <= 0.8 * answer.time)
        # Candidates.
        for radius in (0, 0.2):
            got_faces, got_edges = interval.body().candidates(*step, radius) if radius else body.candidates(*step, radius)
            got = [((v, *interval.faces[f].tolist()), f) for v, f in got_faces.tolist()] + [(tuple(e), -1) for e in got_edges.tolist()]
            within = {(tuple(v), f) for v, f in zip(vertices[apart <= radius].tolist(), face[apart <= radius].tolist())}
            self.assertEqual(len(set(got)), len(got))
            close = keys(interval.body(thickness=radius).all_contacts(*step)) if radius else found
            self.assertTrue(set(close) <= set(got) <= within)
        # Filters.
        random = np.random.default_rng(interval.seed)
        group = np.arange(len(interval.before)) * 3 // len(interval.before)
        ignoring = [(0, 1), (2, 2)] if interval.seed % 2 else [(0, 0)]
        pairs = random.integers(0, len(group), (len(group), 2))
        ignored = np.zeros((3, 3), bool)
        for a, b in ignoring:
            ignored[a, b] = ignored[b, a] = True
        excluded = ignored[group[:, None], group[None, :]]
        excluded[pairs[:, 0], pairs[:, 1]] = excluded[pairs[:, 1], pairs[:, 0]] = True
        out = lambda first, second: excluded[np.ix_(first, second)].all()
        filtered = interval.body(exclude=cscd.Exclusions(group=group, groups_that_ignore_each_other=ignoring, vertex_pairs=pairs))
        left = {key: t for key, t in found.items() if not (out(key[0][:1], key[0][1:]) if key[1] >= 0 else out(key[0][:2], key[0][2:]))}
        kept = filtered.all_contacts(*step)
        self.assertEqual(dict(zip(keys(kept), kept.times)), left)
        self.assertEqual({tuple(pair) for pair in kept.start_crossings.tolist()},
                         {(a, b) for a, b in crossing if not out(interval.faces[a], interval.faces[b])})
        self.assertEqual(filtered.first_contact(*step).time, min(left.values(), default=None))
        seen["free"] += body.is_free(*step)
        seen["touching"] += bool(found)
        seen["crossing"] += bool(crossing)
        seen["unsure"] += bool(np.isnan(times).any())
        seen["filtered"] += len(left) < len(found)
        seen["obstacles"] += interval.obstacle
        seen["at the obstacle"] += any(max(v) >= interval.own for v, _ in found)


if __name__ == "__main__":
    unittest.main()
