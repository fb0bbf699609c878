"""What the module takes and what it refuses: arrays of all types and layouts, lists, and what is no array at all.

A random test draws what to give, and decides by Python's own numbers, without numpy's conversions, whether that is right.
CSCD_RANDOM_INTERVALS sets how many draws.
"""
import math
import os
import unittest

import cscd
import numpy as np

DRAWS = 20 * int(os.environ.get("CSCD_RANDOM_INTERVALS", "60"))
FACES = np.array([[0, 1, 2], [3, 4, 5]], dtype=np.int32)
START = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, 1], [2, 1, 1], [1, 2, 1]], dtype=float)
END = START + np.repeat([[0, 0, 0], [0, 0, -2]], 3, axis=0)
NO_ARRAYS = [None, "abc", b"abc", [["0", "1", "2"]], {}, {1, 2}, object(), [], [[]], [[0, 1], [2]], [[0, 1, 2], [3, 4]],
             np.array(None), np.array([[None] * 3] * 6), 1.5, range(3), [[0, 1, None]], [[1j, 0, 0]] * 6, lambda: 0]


class Broken:
    def __array__(self, *_args, **_kinds):
        raise RuntimeError("first line\nsecond line")


def packed(array, offset):
    """The same array at an address that is not aligned."""
    buffer = b"\0" * offset + array.tobytes()
    return np.frombuffer(buffer, dtype=array.dtype, offset=offset).reshape(array.shape)


def spread(array):
    """The same array as every second row and column of another one."""
    wide = np.full((2 * array.shape[0], 2 * array.shape[1]), 7, dtype=array.dtype)
    wide[::2, ::2] = array
    return wide[::2, ::2]


def widened(array):
    """The same array as the first columns of a wider one."""
    return np.hstack([array, np.full((len(array), 1), 7, dtype=array.dtype)])[:, :array.shape[1]]


LAYOUTS = [lambda a: a, np.asfortranarray, spread, widened, lambda a: a[::-1].copy()[::-1], lambda a: a.T.copy().T,
           lambda a: packed(a, 1), np.matrix, lambda a: a.astype(a.dtype.newbyteorder()), lambda a: a.tolist(),
           lambda a: list(a), lambda a: tuple(map(tuple, a.tolist())), np.ma.masked_array]
TYPES = ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8", "g"]
WRONG_TYPES = ["?", "c8", "O", "U8", "S8", "M8[s]", "m8[s]"]


def one_line_error(call):
    try:
        call()
    except ValueError as error:
        assert str(error) and "\n" not in str(error), repr(str(error))
        return str(error)
    return None


class Input(unittest.TestCase):
    def setUp(self):
        self.body = cscd.SelfCollision(FACES, START)

    def refused(self, call, text=""):
        error = one_line_error(call)
        self.assertIsNotNone(error, "taken")
        self.assertIn(text, error)

    # Mutation: the module reads the memory that pybind11 makes for an object whose __init__() has not been called.
    def test_methods_of_what_was_never_made_are_refused(self):
        class Early(cscd.SelfCollision):
            def __init__(self):
                self.number = self.vertex_count
                super().__init__(FACES, START)

        class Failed(cscd.SelfCollision):
            def __init__(self):
                try:
                    super().__init__(FACES, START[:5])
                except ValueError:
                    self.is_free(START, END)

        raw = cscd.SelfCollision.__new__(cscd.SelfCollision)
        exclude = cscd.Exclusions.__new__(cscd.Exclusions)
        for call in (Early, Failed, lambda: raw.is_free(START, END), lambda: raw.closed, raw.preparation,
                     lambda: cscd.SelfCollision(FACES, START, exclude=exclude)):
            with self.assertRaisesRegex(RuntimeError, r"call super\(\).__init__\(\) first"):
                call()

        class Late(cscd.SelfCollision):
            def __init__(self):
                super().__init__(FACES, START, exclude=cscd.Exclusions())
                self.number = self.vertex_count
        self.assertEqual(Late().number, 6)

    def test_layouts_and_types_are_read_alike(self):
        for layout in LAYOUTS:
            for kind in TYPES:
                with self.subTest(layout=layout, type=kind):
                    start, end = (layout((pose + 1).astype(kind)) for pose in (START, END))
                    body = cscd.SelfCollision(layout(FACES.astype(kind)), start)
                    self.assertEqual(body.first_contact(start, end).time, 0.5)

    def test_what_is_read_where_it_is(self):
        from cscd._values import REAL, numbers
        self.assertIs(numbers(START, "positions", REAL, "vertices", 3), START)

    def test_numbers_that_do_not_fit(self):
        for faces, text in [
                (FACES + 2**33, "8589934592 at [0, 0]"), (FACES + 0.9, "0.9 at [0, 0]"), (FACES - 2**32, "-4294967296"),
                (FACES * np.nan, "nan"), (np.full((2, 3), np.inf), "inf"), (FACES + 2**31, "2147483648"),
                (FACES.astype(np.uint64) + np.uint64(2**63), "9223372036854775808"), (FACES - 1, "names vertex -1"),
                (FACES + 1, "names vertex 6"), (FACES.astype(bool), "booleans"), (FACES.astype(object), "objects"),
                (FACES * 1j, "complex"), (FACES.ravel(), "reshape(-1, 3)"), (np.hstack([FACES] * 2)[:, :4], "quads"),
                (np.vstack([FACES] * 4).T, "transpose"), (FACES[0], "[faces, 3]"), (FACES[None], "[faces, 3]"),
                (FACES[:0], "no triangles"), ([[2**70, 0, 1]], "objects")]:
            with self.subTest(faces=str(faces).replace("\n", " ")):
                self.refused(lambda: cscd.SelfCollision(faces, START), text)
                self.refused(lambda: cscd.SelfCollision(FACES, START, obstacles=[(faces, START)]), "obstacle 0, faces")
        exact = np.array([[2**53 + 1, 0, 0]] * 6, dtype=np.int64)
        for positions, text in [
                (exact, "9007199254740993 at [0, 0]"), (START.ravel(), "reshape(-1, 3)"), (START.T, "transpose"),
                (START[:, :2], "[vertices, 3]"), (START.astype(bool), "booleans"), (START.astype(str), "text"),
                (START * np.nan, "vertex 0"), (START + np.inf, "vertex 0"), (START[:5], "5 rows for 6"),
                (np.ma.masked_equal(START, 4), "masked"), (Broken(), "first line"),
                (START.astype("g") + np.longdouble(2)**-60, "double precision"),
                (np.full((6, 3), 2**64, "g")**32, "double precision")]:
            with self.subTest(positions=str(positions).replace("\n", " ")):
                self.every_call_refuses(positions, text)

    def every_call_refuses(self, positions, text=""):
        body = cscd.SelfCollision(FACES, START, obstacles=[(FACES, START + 50)])
        for call in [body.is_free, body.first_contact, body.all_contacts, body.largest_step,
                     lambda a, b: body.candidates(a, b, 1), lambda a, b: body.move_obstacle(0, a, b)]:
            self.refused(lambda: call(positions, END), text)
            self.refused(lambda: call(START, positions), text)
        self.refused(lambda: body.place_obstacle(0, positions), text)
        if "rows for" not in text:
            self.refused(lambda: cscd.SelfCollision(FACES, positions), text)
            self.refused(lambda: cscd.SelfCollision(FACES, START, obstacles=[(FACES, positions)]), text)
        self.assertEqual(body.first_contact(START, END).time, 0.5, "the object outlives wrong calls")

    def test_what_is_no_array(self):
        for value in NO_ARRAYS:
            with self.subTest(value=str(value)):
                self.every_call_refuses(value)
                self.refused(lambda: cscd.SelfCollision(value, START))

    def test_options(self):
        for name, values in {
                "threads": [0, -1, 1.5, "1", None, True, 2**40, 4096, [1], np.nan],
                "check_positions": [0, 1, None, "yes"], "check_start": [0.5, []],
                "thickness": [-1, -5e-324, np.nan, np.inf, "1", None, [1], 1j, True],
                "vertex_thickness": [[0.1] * 5, [-1] * 6, [np.nan] * 6, [1e308] * 6, [[0.1] * 6], "a", None, [True] * 6, 1],
                "exclude": [0, [], {}, "none"], "preparation": ["", b"abc", 0, None, [1]],
                "obstacles": [0, [0], [(FACES,)], [(FACES, START, 1)], "ab", [None], [("a", "b")], {1: 2}, None]}.items():
            for value in values:
                with self.subTest(name=name, value=value):
                    self.refused(lambda: cscd.SelfCollision(FACES, START, **{name: value}))
        for name, values in {
                "rigid": [[1] * 6, [0.0] * 6, "abcdef", None, [[True] * 6], [True] * 5, 5],
                "group": [[0.5] * 6, [-1] * 6, [0] * 5, [2**40] * 6, [None] * 6, 0, "a", [[0]] * 6],
                "groups_that_ignore_each_other": [[(0, 0)]], "face_pairs": [[(0, 2)], [(True, False)]],
                "vertex_pairs": [[(0, 6)], [(-1, 0)], [0, 1], [(0, 1, 2)], [(0, 0.5)], [(0, None)], 3, "ab", [(0, 2**33)]],
                "rings": [-1, 0.5, None, "2"], "rest_distance": [-1, np.nan, np.inf, "1", None, [1], 1j, True]}.items():
            for value in values:
                with self.subTest(name=name, value=value):
                    self.refused(lambda: cscd.SelfCollision(FACES, START, exclude=cscd.Exclusions(**{name: value})))
        for safety in [0, -1, 1.5, np.nan, np.inf, None, "1", [0.5], True, 2**80]:
            self.refused(lambda: self.body.largest_step(START, END, safety), "safety")
        for cap in [-1, np.nan, np.inf, 1e308, None, "1", [1, 2], 1j]:
            self.refused(lambda: self.body.vertex_bounds(START, cap), "cap")
        for radius in [-1, np.nan, np.inf, None, "1", [1, 2], 1j]:
            self.refused(lambda: self.body.candidates(START, END, radius), "radius")
        body = cscd.SelfCollision(FACES, START, obstacles=[(FACES, START + 50)])
        for obstacle in [-1, 1, 2**31 - 1, 2**64, 0.5, None, "0", True]:
            self.refused(lambda: body.place_obstacle(obstacle, START), "obstacle")
        preparation = self.body.preparation()
        for kept in (preparation, bytearray(preparation), memoryview(preparation)):
            self.assertEqual(cscd.SelfCollision(FACES, START, preparation=kept).first_contact(START, END).time, 0.5)
        self.refused(lambda: cscd.SelfCollision(FACES, START, preparation=preparation[:-1]), "preparation")
        every = cscd.Exclusions(group=np.array([0, 0, 0, 1, 1, 1], dtype="u1"),
                                groups_that_ignore_each_other=np.array([[0.0, 1.0]]))
        self.assertTrue(cscd.SelfCollision(FACES, START, exclude=every, threads=np.int8(1)).is_free(START, END))
        large = cscd.Exclusions(group=[2**31 - 1] * 3 + [5000] * 3, groups_that_ignore_each_other=[(5000, 2**31 - 1)])
        self.assertTrue(cscd.SelfCollision(FACES, START, exclude=large).is_free(START, END))

    def test_random_values(self):
        random = np.random.default_rng(1)
        seen = {"right": 0, "wrong": 0}
        for draw in range(DRAWS):
            faces, faces_right = any_array(random, FACES, is_index)
            pose, pose_right = any_array(random, START, is_real)
            end, end_right = any_array(random, END, is_real)
            if random.random() < 0.5:
                pose, pose_right = START, True
            mesh_right = faces_right and pose_right and is_mesh(faces, len(np.asarray(pose, dtype=float)))
            with self.subTest(draw=draw, faces=str(faces).replace("\n", " "), pose=str(pose).replace("\n", " ")):
                body = []
                error = one_line_error(lambda: body.append(cscd.SelfCollision(faces, pose)))
                self.assertEqual(error is None, mesh_right, error)
                seen["right" if mesh_right else "wrong"] += 1
                if not mesh_right:
                    continue
                pose = np.array(pose, dtype=float)
                right = end_right and np.asarray(end, dtype=float).shape == pose.shape
                error = one_line_error(lambda: body.append(body[0].all_contacts(pose, end)))
                self.assertEqual(error is None, right, (error, end))
                if right:
                    plain = cscd.SelfCollision(np.array(faces, dtype=np.int32), pose)
                    expected = plain.all_contacts(pose, np.array(end, dtype=float))
                    self.assertEqual(list(body[1].times), list(expected.times))
                    self.assertEqual(body[1].vertices.tolist(), expected.vertices.tolist())
        self.assertGreater(min(seen.values()), DRAWS / 10)


def is_index(number):
    return is_finite(number) and number == int(number) and -2**31 <= number < 2**31


def is_real(number):
    return is_finite(number) and (isinstance(number, float) or abs(number) <= 2**53)


def is_finite(number):
    return isinstance(number, int) or isinstance(number, float) and math.isfinite(number)


def is_mesh(faces, vertices):
    rows = np.asarray(faces).astype(float).tolist()
    in_range = all(0 <= v < vertices for row in rows for v in row)
    return len(rows) > 0 and in_range and all(len(set(row)) == 3 for row in rows)


def any_array(random, usual, fits):
    """Draws what is given in place of the usual array, and decides whether it is right."""
    if random.random() < 0.05:
        return NO_ARRAYS[random.integers(len(NO_ARRAYS))], False
    array = usual.astype(random.choice(TYPES if random.random() < 0.9 else WRONG_TYPES))
    if random.random() < 0.1:
        array = array[:random.integers(len(array) + 1), :random.integers(4)]
    if random.random() < 0.1:
        array = [array.T, array.ravel(), array[None], np.hstack([array, array])[:, :4]][random.integers(4)]
    if array.dtype.kind in "iuf" and array.size and random.random() < 0.3:
        array = array.copy()
        wild = np.array([0.5, np.nan, np.inf, -1, 2**16, 2**31, 2**33 + 1, 2**53, 2**62, 6, 1e300, 1e-5, 1])
        with np.errstate(all="ignore"):
            array.flat[random.integers(array.size)] = random.choice(wild).astype(array.dtype)
        if array.dtype == np.int64 and random.random() < 0.3:
            array.flat[0] = 2**53 + 1
    right = array.ndim == 2 and array.shape[1] == 3 and array.dtype.kind in "iuf"
    if right:
        # A longdouble of numpy is no number of Python's, but these hold no more digits than a double.
        numbers = array.astype(float) if array.dtype.char == "g" else array
        right = all(fits(number) for number in numbers.ravel().tolist())
    if array.ndim == 2 and array.dtype.kind in "iuf":
        array = LAYOUTS[random.integers(len(LAYOUTS))](array)
        if isinstance(array, (list, tuple)) and any(isinstance(n, np.longdouble) for row in array for n in row):
            array = np.array(array, dtype="g")
    return array, right


if __name__ == "__main__":
    unittest.main()
