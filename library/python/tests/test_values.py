"""Answers as values that travel, and the types that the package declares."""
import ast
import copy
import pathlib
import pickle
import re
import unittest

import cscd
import numpy as np

from test_cscd import fallen, tetrahedra


def public(kind):
    return {name for name in vars(kind) if not name.startswith("_")}


def same(one, other):
    """Whether two answers hold the same, to the last bit."""
    if isinstance(one, (list, tuple)):
        return len(one) == len(other) and all(map(same, one, other))
    if type(one).__module__ == "cscd._cscd":
        return type(one) is type(other) and all(same(getattr(one, name), getattr(other, name)) for name in public(type(one)))
    return np.array_equal(one, other)


class Values(unittest.TestCase):
    def setUp(self):
        faces, self.before = tetrahedra()
        self.body = cscd.SelfCollision(faces, self.before)

    # Mutation: a member is left out of what is pickled.
    def test_answers_are_pickled_and_copied(self):
        inside, below = fallen(self.before, 1.5), fallen(self.before, 2.5)
        answers = [self.body.all_contacts(self.before, below), self.body.all_contacts(inside, below),
                   self.body.crossings(inside),
                   self.body.true_motion(lambda time: fallen(self.before, 2 * time), lambda *_: 0.0),
                   self.body.true_motion(lambda time: fallen(self.before, 0.1 * time), lambda *_: 0.0)]
        self.assertTrue(answers[0].contacts and len(answers[1].start_crossings) and answers[2].overlaps[0].regions)
        self.assertEqual([answer.verdict == "clear" for answer in answers[3:]], [False, True])
        for answer in answers:
            for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
                self.assertTrue(same(pickle.loads(pickle.dumps(answer, protocol)), answer), answer)
            self.assertTrue(same(copy.deepcopy(answer), answer), answer)
        self.assertFalse(same(answers[0], answers[1]))

    def test_the_version_is_that_of_the_project(self):
        root = pathlib.Path(__file__).parents[3]
        version = re.search(r"project\(cscd VERSION ([0-9.]+)", (root / "CMakeLists.txt").read_text())[1]
        self.assertEqual(cscd.__version__, version)

    # Mutation: a property of the compiled module has no declared type.
    def test_everything_has_a_declared_type(self):
        folder = pathlib.Path(cscd.__file__).parent
        self.assertTrue((folder / "py.typed").exists())
        stub = ast.parse((folder / "_cscd.pyi").read_text())
        declared = {node.name: {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
                    for node in stub.body if isinstance(node, ast.ClassDef)}
        for kind in vars(cscd._cscd).values():
            if isinstance(kind, type) and kind.__name__ not in ("SelfCollision", "Exclusions"):
                self.assertEqual(declared[kind.__name__], public(kind))
        annotated = public(cscd.SelfCollision) | {"__init__"}
        self.assertEqual(declared["SelfCollision"], public(cscd._cscd.SelfCollision) | {"__init__"})
        for function in [vars(cscd.SelfCollision)[name] for name in annotated] + [cscd.Exclusions.__init__, cscd.read]:
            names = function.__code__.co_varnames[:function.__code__.co_argcount + function.__code__.co_kwonlyargcount]
            self.assertEqual({*names, "return"} - {"self"}, {*function.__annotations__} - {"options"}, function)


if __name__ == "__main__":
    unittest.main()
