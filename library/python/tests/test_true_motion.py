"""Paths that are no straight lines: what lines hit and arcs miss, and the reverse."""
import math
import unittest

import cscd
import numpy as np

TURN = 2 * math.pi / 3
HALF_WAY = np.array([math.cos(TURN / 2), math.sin(TURN / 2), 0])
CORNERS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]) - 0.25
FACES = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])


def two_bodies(other):
    """A body at distance 3 from the origin, which turns by a third of a turn about it, and another one at rest."""
    rest = np.concatenate([CORNERS * 0.5 + (3, 0, 0), CORNERS * 0.5 + other])
    return cscd.SelfCollision(np.concatenate([FACES, FACES + 4]), rest), rest


def turned(rest, time):
    c, s = math.cos(TURN * time), math.sin(TURN * time)
    out = rest.copy()
    out[:4] = rest[:4] @ np.array([(c, s, 0), (-s, c, 0), (0, 0, 1)])
    return out


def acceleration(rest):
    return np.where(np.arange(8) < 4, TURN**2 * np.linalg.norm(rest, axis=1) * (1 + 1e-12), 0)


class TrueMotion(unittest.TestCase):
    def ask(self, other):
        body, rest = two_bodies(other)
        answer = body.true_motion(lambda t: turned(rest, t), lambda a, b: acceleration(rest), position_error=1e-14)
        return body.is_free(turned(rest, 0), turned(rest, 1)), answer

    def test_lines_hit_what_arcs_miss(self):
        free, answer = self.ask(1.5 * HALF_WAY)
        self.assertFalse(free)
        self.assertEqual(answer.verdict, "clear", answer)

    def test_arcs_hit_what_lines_miss(self):
        free, answer = self.ask(3 * HALF_WAY)
        self.assertTrue(free)
        self.assertEqual(answer.verdict, "touches", answer)
        self.assertLess(answer.span[1] - answer.span[0], 1 / 255)
        self.assertLess(abs(answer.span[1] - 0.5), 0.2)
        self.assertTrue(min(answer.faces) >= 0)

    def test_starts_that_cross(self):
        _, answer = self.ask((3.05, 0.05, 0))
        self.assertEqual(answer.verdict, "intersects_at_start", answer)

    def test_bounds_that_are_unknown_decide_nothing(self):
        body, rest = two_bodies(1.5 * HALF_WAY)
        self.assertEqual(body.true_motion(lambda t: turned(rest, t), lambda a, b: math.inf).verdict, "undecided")

    def test_refusals(self):
        body, rest = two_bodies(1.5 * HALF_WAY)
        for positions, bound, words in ((lambda t: rest[:3], lambda a, b: 1, "3 a vertex"),
                                        (lambda t: rest, lambda a, b: [1, 2], "one a vertex"),
                                        (lambda t: rest, lambda a, b: -1, "at least 0")):
            with self.assertRaisesRegex(ValueError, words):
                body.true_motion(positions, bound)
        with self.assertRaisesRegex(ValueError, "positions: give a function of a time"):
            body.true_motion(rest, lambda a, b: 1)
        with self.assertRaisesRegex(ValueError, "acceleration_bound: give a function of two times"):
            body.true_motion(lambda t: rest, rest)
        with self.assertRaisesRegex(ValueError, "no span of time"):
            body.true_motion(lambda t: rest, lambda a, b: 1, 1, 1)


if __name__ == "__main__":
    unittest.main()
