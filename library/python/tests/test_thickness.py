"""Every promise at a thickness, held against distances of all pairs in numpy, on small random surfaces.

Distances are sampled over the step and searched between samples. What is nearer to the thickness than ROUNDING may be
either. CSCD_RANDOM_INTERVALS sets how many intervals.
"""
import os
import resource
import unittest

import cscd
import numpy as np
from test_guarantees import Interval, crossings, gap, keys

INTERVALS = int(os.environ.get("CSCD_RANDOM_INTERVALS", "60"))
ROUNDING = 1e-9
dot = lambda a, b: np.einsum("...j,...j->...", a, b)


def to_segment(p, a, b):
    way = b - a
    with np.errstate(all="ignore"):
        share = np.nan_to_num(dot(p - a, way) / dot(way, way)).clip(0, 1)
    return np.linalg.norm(a + share[..., None] * way - p, axis=-1)


def distances(at, face):
    """The distance of each pair of features at positions [n, 4, 3], [n]."""
    a, b, c, d = (at[:, i] for i in range(4))
    edges = face < 0
    with np.errstate(all="ignore"):
        n = np.cross(c - b, d - b)
        inside = np.min([dot(np.cross(q - p, a - p), n) for p, q in ((b, c), (c, d), (d, b))], axis=0) >= 0
        plane = np.where(inside, np.abs(dot(a - b, n)) / np.linalg.norm(n, axis=1), np.inf)
        n = np.cross(b - a, d - c)
        area = dot(n, n)
        s, t = dot(np.cross(c - a, d - c), n) / area, dot(np.cross(c - a, b - a), n) / area
        inside = (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
        line = np.where(inside, np.abs(dot(a - c, n)) / np.sqrt(area), np.inf)
    to_face = np.fmin(plane, np.min([to_segment(a, b, c), to_segment(a, c, d), to_segment(a, d, b)], axis=0))
    ends = [to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)]
    return np.where(edges, np.fmin(line, np.min(ends, axis=0)), to_face)


class Thickness(unittest.TestCase):
    def test_memory(self):
        """Where pairs take more memory than there is, an error comes first and says so."""
        side = 20
        i, j = np.meshgrid(np.arange(side + 1), np.arange(side + 1), indexing="ij")
        sheet = np.stack([i, j, 0.01 * np.sin(21 * i + j)], -1).reshape(-1, 3)
        a = (i[:-1, :-1] * (side + 1) + j[:-1, :-1]).ravel()
        faces = np.concatenate([np.stack([a, a + side + 1, a + 1], 1), np.stack([a + 1, a + side + 1, a + side + 2], 1)])
        body = cscd.SelfCollision(np.concatenate([faces, faces + len(sheet)]), np.concatenate([sheet, sheet + [0, 0, 0.4]]),
                                  thickness=4.5)
        pose = np.concatenate([sheet, sheet + [0, 0, 0.4]])
        body.is_free(pose, pose)
        before = resource.getrlimit(resource.RLIMIT_AS)
        with open("/proc/self/statm") as file:
            taken = int(file.read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (taken + (32 << 20), before[1]))
        try:
            with self.assertRaisesRegex(MemoryError, "(pairs of features are near enough so far, and going on|testing the pairs of features that may be near) takes"):
                body.all_contacts(pose, pose)
        finally:
            resource.setrlimit(resource.RLIMIT_AS, before)
        self.assertGreater(len(body.all_contacts(pose, pose).times), 300_000)

    def test_random_steps(self):
        seen = dict.fromkeys(["free", "close at start", "close later", "by vertex", "moved"], 0)
        for seed in range(INTERVALS):
            with self.subTest(seed=seed):
                self.check(Interval(seed), seen)
        print(INTERVALS, "intervals at a thickness:", seen)
        for kind, count in seen.items():
            self.assertGreater(count, 0, kind)

    def test_wrong_answers_are_seen(self):
        class Thin(Interval):  # a thickness a little below what is asked for
            def body(self, thickness, **options):
                return super().body(thickness=0.9 * thickness, **options)

        seen = 0
        for seed in range(30):
            try:
                self.check(Thin(seed), dict.fromkeys(["free", "close at start", "close later", "by vertex", "moved"], 0))
            except AssertionError:
                seen += 1
        self.assertGreater(seen, 3)

    def check(self, interval, seen):
        random = np.random.default_rng(interval.seed)
        options = {"thickness": 0.4 * random.random() ** 3}
        of_vertex = np.zeros(len(interval.before))
        if interval.seed % 3 == 1:
            options["vertex_thickness"] = of_vertex = 0.1 * random.random(len(of_vertex))
        body, step = interval.body(**options), interval.step()
        vertices, face = interval.pairs()
        first = np.arange(4) < np.where(face >= 0, 1, 2)[:, None]
        own = of_vertex[vertices]
        r = options["thickness"] + np.where(first, own, 0).max(axis=1) + np.where(first, 0, own).max(axis=1)
        near = gap(interval, vertices, face) <= r
        vertices, face, r = vertices[near], face[near], r[near]
        at = lambda t: ((1 - t) * interval.before[vertices].T + t * interval.after[vertices].T).T  # t: one for each pair
        measure = lambda t: distances(at(np.broadcast_to(t, len(face))), face)

        answer = body.all_contacts(*step)
        found = dict(zip(keys(answer), answer.times))
        pairs = list(zip(map(tuple, vertices.tolist()), face.tolist()))
        self.assertTrue(set(found) <= set(pairs))
        times = np.array([found.get(pair, np.inf) for pair in pairs])
        there = times <= 1
        at_time = measure(np.where(there, times, 0))
        self.assertTrue((at_time <= r + ROUNDING)[there].all(), "every contact is close at its time")
        self.assertTrue((at_time >= r - ROUNDING)[there & (times > 0)].all(), "and not before")
        samples = np.linspace(0, 1, 33)
        sampled = np.array([measure(t) for t in samples])
        early = samples[:, None] < times - 1e-6
        self.assertTrue((sampled >= r - ROUNDING)[early].all(), "no pair is close earlier")
        low = samples[np.maximum(sampled.argmin(axis=0) - 1, 0)] if len(face) else np.zeros(0)
        high = np.minimum(low + 2 / 32, 1)
        for _ in range(30):  # the least distance near the least sample
            a, b = low + (high - low) / 3, high - (high - low) / 3
            left = measure(a) < measure(b)
            low, high = np.where(left, low, a), np.where(left, b, high)
        self.assertTrue((measure(low) >= r - 1e-6)[~there].all(), "no pair is missing")

        sure, maybe = crossings(interval)
        crossing = {tuple(pair) for pair in answer.start_crossings.tolist()}
        self.assertTrue(sure <= crossing <= maybe)
        self.assertEqual(answer.close_at_start, np.count_nonzero(answer.times == 0))
        first = body.first_contact(*step)
        self.assertEqual((first.time, first.close_at_start), (answer.time, answer.close_at_start))
        self.assertEqual(body.is_free(*step), not found and not crossing)
        share = body.largest_step(*step, safety=1)
        if crossing or answer.time is None:
            self.assertEqual(share, 0 if crossing else 1)
        else:
            self.assertTrue(answer.time - 1e-14 <= share <= answer.time)

        # Within their bounds, vertices go wherever they like.
        cap = 0.3
        bounds = body.vertex_bounds(step[0], cap)
        self.assertTrue(((bounds >= 0) & (bounds <= cap)).all())
        rest = Interval(interval.seed)
        rest.after = interval.before
        body = rest.body(**options)
        bounds = body.vertex_bounds(step[0], cap)
        close = set(keys(body.all_contacts(step[0], step[0])))
        way = random.normal(size=step[0].shape)
        moved = step[0] + (0.999999 * bounds / np.linalg.norm(way, axis=1))[:, None] * way
        self.assertTrue(set(keys(body.all_contacts(step[0], moved))) <= close)
        seen["free"] += body.is_free(step[0], moved)
        seen["close at start"] += answer.close_at_start > 0
        seen["close later"] += answer.close_at_start < len(found)
        seen["by vertex"] += bool(of_vertex.any())
        seen["moved"] += bool((bounds > 0).any())


if __name__ == "__main__":
    unittest.main()
