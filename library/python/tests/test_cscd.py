"""Tests of the Python module; run by ctest as python_module."""
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import cscd
import numpy as np


def tetrahedra():
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], dtype=np.int32)
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.3, 0.3, 1]])
    return np.vstack([faces, faces + 4]), np.vstack([corners, corners + [0, 0, 2]])


def fallen(before, by):
    after = before.copy()
    after[4:, 2] -= by
    return after


class SelfCollision(unittest.TestCase):
    def setUp(self):
        self.faces, self.before = tetrahedra()
        self.body = cscd.SelfCollision(self.faces, self.before)

    def test_a_free_step(self):
        after = fallen(self.before, 0.5)
        self.assertTrue(self.body.is_free(self.before, after))
        answer = self.body.first_contact(self.before, after)
        self.assertTrue(answer.free)
        self.assertIsNone(answer.time)
        self.assertEqual(answer.points.shape, (0, 3))
        self.assertEqual(answer.start_crossings.shape, (0, 2))
        self.assertEqual(self.body.largest_step(self.before, after), 1)

    def test_a_contact(self):
        answer = self.body.all_contacts(self.before, fallen(self.before, 2))
        self.assertEqual(answer.time, 0.5)
        self.assertTrue(np.all(np.diff(answer.times) >= 0))
        contact = answer.contacts[0]
        self.assertEqual(list(contact.vertices), list(answer.vertices[0]))
        np.testing.assert_allclose(contact.point, [0.3, 0.3, 1])
        np.testing.assert_allclose(np.linalg.norm(answer.normals[0]), 1)
        self.assertLess(contact.normal_velocity, 0)
        step = self.body.largest_step(self.before, fallen(self.before, 2), safety=1)
        self.assertTrue(0.4999 < step < 0.5)

    def test_labels_change_no_answer(self):
        after = fallen(self.before, 2)
        labelled = cscd.SelfCollision(self.faces, self.before, labels=np.repeat([5, -2], 4))
        self.assertEqual(labelled.all_contacts(self.before, after).times.tolist(),
                         self.body.all_contacts(self.before, after).times.tolist())
        with self.assertRaisesRegex(ValueError, "labels: 3 for 8 vertices"):
            cscd.SelfCollision(self.faces, self.before, labels=[1, 2, 3])

    def test_a_start_that_crosses(self):
        inside = fallen(self.before, 1.5)
        answer = self.body.first_contact(inside, inside)
        self.assertTrue(answer.intersects_at_start)
        self.assertFalse(answer.free)
        self.assertGreater(len(answer.start_crossings), 0)
        self.assertEqual(self.body.largest_step(inside, inside), 0)

    def test_what_lies_in_what(self):
        self.assertEqual(self.body.crossings(self.before).overlaps, [])
        found = self.body.crossings(fallen(self.before, 1.5)).overlaps
        self.assertEqual(len(found), 1)
        curve, = found[0].curves
        self.assertTrue(curve.closed)
        self.assertEqual(curve.points.shape, (len(curve.faces), 3))
        np.testing.assert_allclose(curve.points[:, 2], 0.5)  # of the upper one's base
        np.testing.assert_allclose(found[0].depth, 0.5)
        self.assertGreaterEqual(found[0].depth_bound, found[0].depth)
        region = found[0].regions[0]
        self.assertEqual(region.distances.max(), region.depth)
        (number, column), = region.bounds
        self.assertEqual(number, 0)
        through = curve.faces[:, column]
        self.assertTrue(np.isin(region.vertices, self.faces[through]).any())
        np.testing.assert_allclose(np.linalg.norm(region.ways, axis=1), region.distances)
        self.assertEqual(found[0].gradient.shape, (len(found[0].vertices), 3))
        np.testing.assert_allclose(found[0].length,
                                   np.linalg.norm(curve.points - np.roll(curve.points, 1, axis=0), axis=1).sum())
        self.assertIn(region.deepest, region.vertices)
        np.testing.assert_allclose(np.linalg.norm(region.out), region.depth)
        with self.assertRaisesRegex(ValueError, "positions"):
            self.body.crossings(self.before[:3])

    def test_other_layouts_and_types_are_converted(self):
        after = fallen(self.before, 2)
        for start, end in [(np.asfortranarray(self.before), after), (self.before.astype(np.float32), after),
                           (self.before.tolist(), after.tolist())]:
            self.assertEqual(self.body.first_contact(start, end).time, 0.5)

    def test_exclusions(self):
        group = [0] * 4 + [1] * 4
        apart = cscd.Exclusions(group=group, groups_that_ignore_each_other=[(0, 1)])
        body = cscd.SelfCollision(self.faces, self.before, exclude=apart)
        self.assertTrue(body.is_free(self.before, fallen(self.before, 2)))

    def test_what_lies_in_an_overlap_is_left_out(self):
        body = cscd.SelfCollision(self.faces, self.before, exclude=cscd.Exclusions(ongoing=True))
        inside = fallen(self.before, 1.5)
        self.assertTrue(body.is_free(inside, self.before))
        self.assertEqual(len(body.all_contacts(inside, self.before).start_crossings), 0)
        self.assertFalse(body.is_free(self.before, inside))
        with self.assertRaisesRegex(ValueError, "exclude, ongoing: needs"):
            cscd.SelfCollision(self.faces, self.before, exclude=cscd.Exclusions(ongoing=True), check_start=False)
        with self.assertRaisesRegex(ValueError, "exclude, ongoing: give True or False"):
            cscd.Exclusions(ongoing=1)

    def test_obstacles(self):
        body = cscd.SelfCollision(self.faces[4:] - 4, self.before[4:], obstacles=[(self.faces[:4], self.before[:4])])
        start = self.before[4:]
        answer = body.all_contacts(start, start - [0, 0, 2])
        self.assertEqual(answer.time, 0.5)
        self.assertIn(4 + 3, answer.vertices[0])  # the tip of the obstacle, whose vertices are behind the mesh's
        body.move_obstacle(0, self.before[:4], self.before[:4] - [0, 0, 2])
        self.assertTrue(body.is_free(start, start - [0, 0, 2]))
        body.place_obstacle(0, self.before[:4] + [0, 0, 0.5])
        self.assertEqual(body.first_contact(start, start - [0, 0, 2]).time, 0.25)
        with self.assertRaisesRegex(ValueError, "obstacle 1: there are 1"):
            body.place_obstacle(1, start)

    def test_a_call_takes_little_time(self):
        """A bound that only a call which does something else would miss."""
        after = fallen(self.before, 0.5)
        times = []
        for _ in range(200):
            begin = time.process_time()
            self.body.is_free(self.before, after)
            times.append(time.process_time() - begin)
        self.assertLess(sorted(times)[100], 1e-3)

    def test_candidates(self):
        vertex_face, edge_edge = self.body.candidates(self.before, self.before, 1.1)
        self.assertIn([3, 4], vertex_face.tolist())
        self.assertEqual(edge_edge.shape[1], 4)
        self.assertNotIn([3, 4], self.body.candidates(self.before, self.before, 0.5)[0].tolist())

    def test_a_contact_says_what_it_is(self):
        after = self.before.copy()
        after[4:] -= [0, 0, 2]
        first = self.body.first_contact(self.before, after).contacts[0]
        self.assertRegex(repr(first), r"^<cscd.Contact: (vertex \d+ and face|edges \d+ \d+ and) [\d ]+, at t = 0\.\d+>$")

    def test_a_second_thread_is_turned_away(self):
        after, wrong = self.before - [0, 0, 1e-3], []

        def ask():
            for _ in range(3000):
                try:
                    self.body.is_free(self.before, after)
                except RuntimeError as error:
                    wrong.extend([] if "another thread" in str(error) else [error])

        threads = [threading.Thread(target=ask) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])

    def test_a_thickness(self):
        thick = cscd.SelfCollision(self.faces, self.before, thickness=0.25, vertex_thickness=np.full(8, 0.125))
        after = fallen(self.before, 0.75)
        answer = thick.first_contact(self.before, after)
        self.assertAlmostEqual(answer.time, 2 / 3, 12)
        self.assertAlmostEqual(thick.largest_step(self.before, after, safety=1), 2 / 3, 12)
        self.assertFalse(thick.is_free(self.before, after))
        self.assertTrue(self.body.is_free(self.before, after))
        self.assertEqual(answer.close_at_start, 0)
        self.assertGreater(thick.first_contact(after, after).close_at_start, 0)
        self.assertTrue((thick.vertex_bounds(self.before, 10) <= self.body.vertex_bounds(self.before, 10)).all())

    def test_vertex_bounds(self):
        bounds = self.body.vertex_bounds(self.before, 10)
        np.testing.assert_array_equal(self.body.vertex_bounds(self.before, 0.01), np.full(8, 0.01))
        self.assertEqual(bounds.shape, (8,))
        self.assertTrue((bounds > 0.2).all() and (bounds < 1).all())

    def test_wrong_input_is_a_value_error(self):
        nan = self.before.copy()
        nan[2, 1] = np.nan
        for call, text in [(lambda: self.body.is_free(nan, self.before), "start positions"),
                           (lambda: self.body.is_free(self.before[:3], self.before), "3 rows for 8 vertices"),
                           (lambda: cscd.SelfCollision(self.faces + 5, self.before), "faces"),
                           (lambda: self.body.largest_step(self.before, self.before, safety=2), "safety")]:
            with self.assertRaisesRegex(ValueError, text):
                call()

    def test_objects_work_in_several_threads_at_once(self):
        after, times = fallen(self.before, 2), []

        def work():
            body = cscd.SelfCollision(self.faces, self.before)
            for _ in range(200):
                times.append(body.first_contact(self.before, after).time)

        threads = [threading.Thread(target=work) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(times, [0.5] * 800)


@unittest.skipUnless(os.environ.get("CSCD_PROGRAM"), "CSCD_PROGRAM does not name the program")
class Read(unittest.TestCase):
    def test_frames_of_a_scene(self):
        faces, frames = cscd.read("urchin_contact", program=os.environ["CSCD_PROGRAM"])
        self.assertEqual(frames.shape[2], 3)
        body = cscd.SelfCollision(faces, frames[0])
        begin = time.perf_counter()
        answers = [body.first_contact(a, b) for a, b in zip(frames[:-1], frames[1:])]
        self.assertLess((time.perf_counter() - begin) / len(answers), 0.5)
        self.assertFalse(any(answer.intersects_at_start for answer in answers))

    def test_frames_of_a_model_file(self):
        with tempfile.TemporaryDirectory() as folder:
            model = os.path.join(folder, "character.glb")
            subprocess.run([os.environ["CSCD_PROGRAM"], "export", "urchin", model], check=True, capture_output=True)
            faces, frames = cscd.read(model, program=os.environ["CSCD_PROGRAM"])
        self.assertEqual(faces.shape[1], 3)
        self.assertGreater(len(frames), 1)
        self.assertTrue(cscd.SelfCollision(faces, frames[0]).is_free(frames[0], frames[1]))

    def test_the_picture_of_contact_times(self):
        try:
            import h5py
            import matplotlib  # noqa: F401
        except ImportError:
            self.skipTest("h5py or matplotlib is not installed")
        faces, before = tetrahedra()
        script = pathlib.Path(__file__).parents[2] / "examples" / "contact_times.py"
        with tempfile.TemporaryDirectory() as folder:
            clip, picture = os.path.join(folder, "clip.h5"), os.path.join(folder, "times.png")
            with h5py.File(clip, "w") as file:  # one falls through the other, and back up
                file["triangles"] = faces
                file["positions"] = [fallen(before, by) for by in (0, 0.3, 0.6, 1.3, 1.6, 1.3, 0.6, 0.3)]
            done = subprocess.run([sys.executable, script, clip, picture], check=True, capture_output=True, text=True)
            self.assertIn("2 of 7 steps touch; 3 start with crossings", done.stdout)
            with open(picture, "rb") as file:
                self.assertEqual(file.read(4), b"\x89PNG")

    def test_what_cannot_be_read(self):
        with self.assertRaisesRegex(ValueError, "nothing.glb"):
            cscd.read("nothing.glb", program=os.environ["CSCD_PROGRAM"])


if __name__ == "__main__":
    unittest.main()
