"""Tests of names, events and sentences, without Blender. Answers of the engine are made by hand."""
import pathlib
import sys
import types
import unittest

import numpy as np

# The file is read by itself, because its package needs Blender.
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cscd_self_collision"))
import events as ev  # noqa: E402  (after the path is set)

# Two boxes' worth of nothing: rows of triangles along x, faces 0 to 3 of the bones "hand", "arm" and faces 4, 5 of the object "ball".
REST = np.array([[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [2, 0, 0], [2, 1, 0], [0, 0, 3], [1, 0, 3], [0, 1, 3], [1, 1, 3]], float)
FACES = np.array([[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5], [6, 7, 8], [8, 7, 9]])
BONE = np.array([0, 0, 0, 1, 1, 1, -1, -1, -1, -1])


def surface(poses=(REST,), faces=FACES, bone=BONE, parents=(1, -1)):
    return ev.Surface(list(poses), faces, np.array([0] * 4 + [1] * (len(faces) - 4)), ["body", "ball"], bone, ["hand", "arm"], list(parents))


def overlap(pairs, depth, regions=((0, [0, 1]),), bound=None):
    """One curve through pairs of faces, and regions: the sheet that each lies on, and its vertices, which are all as deep."""
    curve = types.SimpleNamespace(faces=np.array(pairs), points=np.zeros((len(pairs), 3)), closed=True)
    made = [types.SimpleNamespace(bounds=np.array([[0, sheet]]), vertices=np.array(vertices), distances=np.full(len(vertices), depth),
                                  depth=depth, deepest=vertices[0], out=np.array([0, 0, depth])) for sheet, vertices in regions]
    return types.SimpleNamespace(curves=[curve], regions=made, depth=depth, depth_bound=bound or 2 * depth)


def contact(vertices, time, edges=False):
    return types.SimpleNamespace(edges=edges, vertices=vertices, time=time, point=np.zeros(3), normal=np.array([0, 0, 1.0]))


def check(overlaps, contacts=(), rest=(), **options):
    """The events of a check whose engine finds these overlaps in each frame from 10 on, and these contacts before each next frame."""
    answers, steps = iter([rest, *overlaps] if options.get("leave_out_rest", True) else overlaps), iter(contacts)
    body = types.SimpleNamespace(crossings=lambda _: types.SimpleNamespace(overlaps=next(answers)),
                                 all_contacts=lambda *_: types.SimpleNamespace(contacts=next(steps, [])))
    cscd = types.SimpleNamespace(SelfCollision=lambda *_, **__: body, Exclusions=lambda **_: None)
    made = ev.Check(cscd, surface(), REST, **options)
    for frame in range(10, 10 + len(overlaps)):
        made.add(frame, REST)
    return made


def metres(length):
    return f"{length:g} m"


class Surfaces(unittest.TestCase):
    def test_vertices_of_a_seam_are_one_until_they_part(self):
        faces = np.vstack([FACES, [[10, 7, 9], [6, 10, 6]]])  # vertex 10 repeats vertex 8
        rest, bone = np.vstack([REST, REST[8]]), np.append(BONE, -1)
        whole = surface([rest], faces, bone)
        self.assertEqual((len(whole.source), len(whole.faces)), (10, 6))  # a repeated face and one without area are gone
        apart = rest.copy()
        apart[10] += 0.1
        self.assertTrue(whole.parts_in(apart))
        self.assertFalse(whole.parts_in(rest + 1))
        self.assertEqual(len(surface([rest, apart], faces, bone).source), 11)

    def test_a_face_belongs_to_the_bone_of_most_corners_or_to_its_object(self):
        self.assertEqual([surface().names[p] for p in surface().place], ["hand", "hand", "arm", "arm", "ball", "ball"])

    def test_bones_meet_at_joints_and_parts_at_shared_vertices(self):
        event = ev.Event((0, 1), depth=0.01, bound=1)
        self.assertTrue(surface().is_fold(event))
        self.assertFalse(surface(parents=(-1, -1)).is_fold(event))
        self.assertFalse(surface().is_fold(ev.Event((0, 1), depth=5, bound=5)))
        self.assertFalse(surface().is_fold(ev.Event((0, 1), depth=0, bound=5)))

    def test_girth_is_that_of_a_round_limb(self):
        angle = np.linspace(0, 2 * np.pi, 65)[:-1]
        ring = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
        tube = np.vstack([ring, ring + [0, 0, 9]])
        faces = np.array([[[i, (i + 1) % 64, 64 + i], [64 + i, (i + 1) % 64, 64 + (i + 1) % 64]] for i in range(64)]).reshape(-1, 3)
        made = ev.Surface([tube], faces, np.zeros(128, int), ["tube"], np.full(128, -1), [], [])
        self.assertAlmostEqual(made._girth[0], 2 * np.pi, 2)


class Events(unittest.TestCase):
    def test_an_overlap_is_followed_and_named_by_which_lies_in_which(self):
        deep = [[overlap([(4, 0)], 0.1, [(1, [0])])], [overlap([(5, 3), (5, 0), (5, 1)], 0.3, [(1, [0, 2])])], [],
                [overlap([(4, 0)], 0.2, [(1, [1])])]]
        one, other = check(deep).events()
        self.assertEqual((one.names, one.begins, one.deepest, one.ends, one.depth), (("hand", "ball"), 10, 11, 11, 0.3))
        self.assertEqual((other.begins, other.depth), (13, 0.2))
        self.assertEqual(ev.sentence(one, metres), "hand is 0.3 m deep in ball, deepest at frame 11 (frames 10 to 11)")
        self.assertEqual(ev.sentence(other, metres), "hand is 0.2 m deep in ball, at frame 13 alone")

    def test_without_shared_vertices_pairs_and_then_names_continue_an_event(self):
        found = check([[overlap([(0, 4)], 0.1)], [overlap([(0, 4)], 0.2, [(0, [2])])], [overlap([(1, 5)], 0.1, [(0, [3])])]]).events()
        self.assertEqual([(e.begins, e.ends, e.deepest) for e in found], [(10, 12, 11)])

    def test_what_crosses_at_rest_is_left_out_until_it_is_deeper_or_has_parted(self):
        there = overlap([(0, 4)], 0.1)
        self.assertEqual(check([[there]] * 3, rest=[there]).events(), [])
        deeper, = check([[there], [overlap([(1, 5)], 0.12)]], rest=[there]).events()  # within two rings
        self.assertEqual((deeper.begins, deeper.at_rest), (11, 0.1))
        self.assertIn("deeper than at rest (0.1 m)", ev.sentence(deeper, metres))
        self.assertEqual([e.begins for e in check([[there], [], [there]], rest=[there]).events()], [12])
        self.assertEqual([e.begins for e in check([[there]], leave_out_rest=False).events()], [10])

    def test_what_touches_between_frames_is_said_where_nothing_is_deep(self):
        touch = contact([0, 6, 7, 8], 0.25)
        found = check([[], [], [overlap([(0, 4)], 0.1)]], [[], [touch, contact([4, 5, 0, 2], 0.5, True)]])
        self.assertEqual([(e.names, e.touches) for e in found.events()], [(("hand", "ball"), False), (("hand", "arm"), True)])
        found = check([[], [], []], [[touch], [touch]])
        event, = found.events()
        self.assertEqual((event.begins, event.ends), (10.25, 11.25))
        self.assertEqual(ev.headline([event], metres, (10, 12)), "hand touches ball, first at frame 10.25.")
        self.assertEqual(ev.headline([event], metres, (10, 12), 0.5), "hand comes within 0.5 m of ball, first at frame 10.25.")
        self.assertEqual(check([[overlap([(0, 4)], 0.1)]] * 2, [[touch]], rest=[overlap([(0, 4)], 0.1)]).events(), [])

    def test_what_is_close_at_rest_is_no_touch(self):
        near, new = contact([0, 6, 7, 8], 0), contact([1, 6, 7, 8], 0)
        found = check([[], []], [[near], [near, new]], thickness=0.5).events()  # the first answer is about the pose at rest
        self.assertEqual([sorted(e.vertices) for e in found], [[1, 6, 7, 8]])

    def test_the_worst_is_said_first_and_folds_last(self):
        fold, deep, unknown = ev.Event((0, 0), ("a", "a"), depth=9, bound=9, at_joint=True), ev.Event((0, 1), ("a", "b"), 1, 3, 2, 2, 3), ev.Event(
            (0, 1), ("a", "c"), 1, 3, 2, 0, 4)
        order = ev.in_order([fold, unknown, deep])
        self.assertEqual([e.names[1] for e in order], ["b", "c", "a"])
        self.assertEqual(ev.headline(order, metres, (1, 5)), "a is 2 m deep in b, deepest at frame 2 (frames 1 to 3).")
        self.assertEqual(ev.headline([unknown], metres, (1, 5)), "a meets c; how deep is not known, at most 4 m, deepest at frame 2 (frames 1 to 3).")
        self.assertEqual(ev.headline([fold], metres, (1, 5)), "Nothing touches itself in frames 1 to 5, apart from folds at joints.")
        self.assertEqual([ev.title(e, metres) for e in order], ["a in b: 2 m", "a meets c: at most 4 m", "a in itself: 9 m"])

    def test_weights_go_from_a_touch_to_the_deepest(self):
        found = check([[overlap([(0, 4)], 0.2, [(0, [0, 1])])], [overlap([(0, 4)], 0.1, [(0, [1, 2])])]], [[contact([5, 8, 7, 9], 0.5)]])
        weights = found.weights(found.events(), 10)
        np.testing.assert_allclose(weights[[0, 1, 2, 5, 3]], [1, 1, 0.55, 0.1, 0])
        self.assertEqual(set(ev.weights([ev.Event((0, 0), vertices={1: 0.0})], 3).tolist()), {0, 1})


class Answers(unittest.TestCase):
    def test_other_files_are_refused(self):
        for document, why in (([], "no answer of cscd query"), ({"schema": "cscd.query/4", "clips": []}, "several clips")):
            with self.assertRaisesRegex(ValueError, why):
                ev.from_answer(document, np.eye(3))


if __name__ == "__main__":
    unittest.main()
