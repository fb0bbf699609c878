"""Continuous self-collision detection of deforming triangle meshes.

    import cscd
    body = cscd.SelfCollision(faces, rest)           # [faces, 3] int, [vertices, 3] float
    answer = body.first_contact(before, after)       # [vertices, 3] float each
    print(answer.free, answer.time, answer.points)

Arrays may have any layout and any real type that holds no number which the library cannot hold exactly: an index is
whole and has at most 32 bits, a position is a number in double precision. Row-major arrays of doubles are read where they
are. What is wrong raises ValueError with one line. Answers can be copied and pickled.

read() gives the frames of a character or a point cache through the program `cscd`.
"""
from __future__ import annotations

import os
import pathlib
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _cscd
from ._cscd import Answer, Contact, Crossings, Curve, Overlap, PathsAnswer, Region, __version__, instruction_set
from ._values import INDEX, REAL, as_array, flag, numbers

__all__ = ["Answer", "Contact", "Crossings", "Curve", "Exclusions", "Overlap", "PathsAnswer", "Region", "SelfCollision",
           "__version__", "instruction_set", "read"]


def _faces(value, name="faces"):
    return numbers(value, name, INDEX, "faces", 3)


def _positions(value, name):
    return numbers(value, name, REAL, "vertices", 3)


def _pairs(value, name):
    empty = isinstance(value, (list, tuple)) and not value
    return [] if empty else numbers(value, name, INDEX, "pairs", 2).tolist()


class Exclusions(_cscd.Exclusions):
    """What does not count as a collision.

    Two features may collide if some vertex of one may collide with some vertex of the other.

    rigid: [vertices] bool; vertices that never collide with each other, such as a part that moves as one body.
    group: [vertices] int, any from 0, and pairs of groups that do not collide with each other, which name at most 4096
        different groups.
    vertex_pairs, face_pairs: [pairs, 2] int; pairs of indices that do not collide.
    rings: vertices that are joined by at most so many edges do not collide.
    rest_distance: nor do vertices nearer than this in the reference positions.
    ongoing: whether a step leaves out what lies within an overlap of its start (crossings()): crossings and contacts
        between two faces on the two sheets of one of its curves. A face is on a sheet of a curve because the curve runs
        through it there, or because it belongs to a region which that curve bounds there: it has a vertex in the region,
        or is run through by a curve that bounds it. What is left is new: what touches between two fingers that are both
        in a thigh, too. Contacts with obstacles always count. candidates(), vertex_bounds() and true_motion() keep no
        account of this. Needs check_start.
    """

    def __init__(self, *, rigid: ArrayLike = (), group: ArrayLike = (), groups_that_ignore_each_other: ArrayLike = (),
                 vertex_pairs: ArrayLike = (), face_pairs: ArrayLike = (), rings: int = 0, rest_distance: float = 0.0,
                 ongoing: bool = False) -> None:
        marked = as_array(rigid, "exclude, rigid")
        if marked.ndim != 1 or (marked.size and marked.dtype.kind != "b"):
            raise ValueError("exclude, rigid: give one boolean a vertex")
        super().__init__(marked.tolist(), numbers(group, "exclude, group", INDEX, "vertices").tolist(),
                         _pairs(groups_that_ignore_each_other, "exclude, groups_that_ignore_each_other"),
                         _pairs(vertex_pairs, "exclude, vertex_pairs"), _pairs(face_pairs, "exclude, face_pairs"),
                         int(numbers(rings, "exclude, rings", INDEX)),
                         float(numbers(rest_distance, "exclude, rest_distance", REAL)), flag(ongoing, "exclude, ongoing"))


class SelfCollision(_cscd.SelfCollision):
    """Continuous self-collision detection of one mesh.

    faces: [faces, 3] int, corners counter-clockwise seen from outside.
    reference: [vertices, 3] float, a pose without crossings, such as the pose at rest.
    threads: on which one step is answered; answers do not depend on it.
    check_positions: whether positions are searched for numbers that are not finite. Without, the answer to such numbers
        is undefined.
    check_start: whether answers say which triangles cross at the start.
    exclude: what does not count as a collision, an object of Exclusions.
    obstacles: list of (faces, positions) of surfaces that the mesh collides with, and that never collide with each
        other; each rests until place_obstacle() or move_obstacle(). Their vertices and faces are numbered behind the
        mesh's, in contacts and in `exclude`.
    preparation: what preparation() of another object returned.
    labels: [vertices] int, the part that each vertex belongs to, such as the bone that it follows most; at most 1000
        different ones. They help the engine with a closed mesh that bends at joints which `reference` does not show, such
        as a hand, and cost time in preparing. Answers are the same.
    thickness: how near features may come before they count as contacts, in the unit of the positions, finite and at least
        0. Neighbours that are closer than that by construction are left out by `rings` or `rest_distance` of Exclusions.
    vertex_thickness: [vertices of the mesh and of obstacles] float, at least 0; a pair of features has `thickness`, and the
        sum of the largest of either feature on top, rounded up. Empty for none.

    A vertex of no face counts as a point that touches faces; true_motion refuses a mesh that has such vertices.

    A step is two arrays of positions, [vertices, 3] float: every vertex moves in a straight line from the first to
    the second. Answers are exact for the numbers as they are given. Wrong input raises ValueError.
    One object is used by one thread at a time, and RuntimeError tells a second one so; different objects are independent.
    """

    def __init__(self, faces: ArrayLike, reference: ArrayLike, *, threads: int = 1, check_positions: bool = True,
                 check_start: bool = True, exclude: Exclusions | None = None,
                 obstacles: Sequence[tuple[ArrayLike, ArrayLike]] = (), preparation: bytes | bytearray | memoryview = b"",
                 labels: ArrayLike = (), thickness: float = 0.0, vertex_thickness: ArrayLike = ()) -> None:
        if exclude is not None and not isinstance(exclude, Exclusions):
            raise ValueError("exclude: give an object of cscd.Exclusions")
        if not isinstance(preparation, (bytes, bytearray, memoryview)):
            raise ValueError("preparation: give the bytes that preparation() returned")
        try:
            surfaces = [(corners, where) for corners, where in obstacles]
        except (TypeError, ValueError):
            raise ValueError("obstacles: give a list of pairs of faces and positions") from None
        super().__init__(_faces(faces), _positions(reference, "reference positions"),
                         int(numbers(threads, "threads", INDEX)), flag(check_positions, "check_positions"),
                         flag(check_start, "check_start"), Exclusions() if exclude is None else exclude,
                         [(_faces(corners, f"obstacle {i}, faces"), _positions(where, f"obstacle {i}, positions"))
                          for i, (corners, where) in enumerate(surfaces)], bytes(preparation),
                         numbers(labels, "labels", INDEX, "vertices").tolist(),
                         float(numbers(thickness, "thickness", REAL)),
                         numbers(vertex_thickness, "vertex_thickness", REAL, "vertices").tolist())

    def place_obstacle(self, obstacle: int, positions: ArrayLike) -> None:
        """Places an obstacle, counted from 0, where it rests in the steps from then on."""
        super().place_obstacle(int(numbers(obstacle, "obstacle", INDEX)), _positions(positions, "positions"))

    def move_obstacle(self, obstacle: int, start: ArrayLike, end: ArrayLike) -> None:
        """Moves an obstacle from start to end in every step, until it is placed or moved again."""
        super().move_obstacle(int(numbers(obstacle, "obstacle", INDEX)), *_step(start, end))

    def is_free(self, start: ArrayLike, end: ArrayLike) -> bool:
        """Returns whether the step is free of contacts, and starts without crossings.

        With a thickness, whatever comes within it is a contact.
        """
        return super().is_free(*_step(start, end))

    def first_contact(self, start: ArrayLike, end: ArrayLike) -> Answer:
        """Returns an Answer with contacts of the earliest time, at least one where anything touches."""
        return super().first_contact(*_step(start, end))

    def all_contacts(self, start: ArrayLike, end: ArrayLike) -> Answer:
        """Returns an Answer with all contacts."""
        return super().all_contacts(*_step(start, end))

    def largest_step(self, start: ArrayLike, end: ArrayLike, safety: float = 0.9) -> float:
        """Returns a time t in [0, 1] such that nothing touches in [0, t]; 1 for a free step.

        Otherwise that is `safety`, in (0, 1], times the earliest time of a contact, less by at most 2^-40 of it and
        2^-48. It is 0 from a start in which something crosses, touches, or is within the thickness, even where that moves apart.

        The promise is about the exact lines. Positions that you store, such as start + t * (end - start), are rounded: where
        steps become very short, ask is_free(start, stored) before you go on from there.
        """
        return super().largest_step(*_step(start, end), float(numbers(safety, "safety", REAL)))

    def candidates(self, start: ArrayLike, end: ArrayLike,
                   radius: float) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """Returns all pairs that come within the radius.

        These are [n, 2] int of a vertex and a face, and [m, 4] int of the ends of two edges.
        """
        return super().candidates(*_step(start, end), float(numbers(radius, "radius", REAL)))

    def vertex_bounds(self, positions: ArrayLike, cap: float) -> NDArray[np.float64]:
        """Returns [vertices] float: how far each vertex may move from `positions`, in any direction and along any path.

        While all stay within their bounds, no two features that are not excluded come as close as the thickness, and
        nothing comes to cross. Obstacles stay where they are placed or move as they were told. No bound exceeds `cap`, a
        finite length of at least 0. What moves is the position that is stored: where sums round,
        leave room for that. Vertices of a pair that is not farther apart than the thickness have the bound 0.
        """
        return super().vertex_bounds(_positions(positions, "positions"), float(numbers(cap, "cap", REAL)))

    def true_motion(self, positions: Callable[[float], ArrayLike], acceleration_bound: Callable[[float, float], ArrayLike],
                    start: float = 0.0, end: float = 1.0, *, position_error: float = 0.0,
                    resolution: float = 0.0) -> PathsAnswer:
        """Returns a PathsAnswer for vertices that do not move in straight lines.

        positions: a function of a time that returns [vertices, 3] float, at most `position_error` from the true places.
        acceleration_bound: a function of two times that returns an upper bound of how large the acceleration of each vertex
            is between them, the length of the second derivative of its path: one number, or [vertices] float.
        start, end: two times.
        resolution: a length; contacts are closed in on until they are proven or known to be nearer than this. 0 stands for
            a hundredth of the mean edge of the reference positions.

        The promise holds for the paths themselves, if both functions keep theirs: `clear` is proven, and so is `touches`.
        For a mesh without obstacles and without a thickness.
        """
        for name, function in (("positions", positions), ("acceleration_bound", acceleration_bound)):
            if not callable(function):
                raise ValueError(f"{name}: give a function of {'a time' if name == 'positions' else 'two times'}")

        def bounds(earlier, later):
            given = as_array(acceleration_bound(earlier, later), "acceleration_bound")
            return numbers(given.reshape(-1), "acceleration_bound", REAL, "vertices").tolist()

        return super().true_motion(lambda time: _positions(positions(time), "positions").ravel().tolist(), bounds,
                                   *(float(numbers(value, name, REAL)) for value, name in
                                     ((start, "start"), (end, "end"), (position_error, "position_error"),
                                      (resolution, "resolution"))))

    def crossings(self, positions: ArrayLike) -> Crossings:
        """Returns a Crossings: which pieces of the mesh lie in each other in a pose, how deep, and along which curves.

        Obstacles are left out, and so are overlaps of which half of the pairs of faces, or more, are excluded. A piece that
        lies wholly inside another crosses nothing.
        """
        return super().crossings(_positions(positions, "positions"))


def _step(start, end):
    return _positions(start, "start positions"), _positions(end, "end positions")


def read(path: str | os.PathLike[str], *options: str,
         program: str = "cscd") -> tuple[NDArray[np.int32], NDArray[np.float64]]:
    """Returns (faces, frames) of a model file, a point cache or a scene: [faces, 3] int32, [frames, vertices, 3] float64.

    The program `cscd` reads the file in a process of its own. `options` are those of `cscd export`, such as "--clip",
    "walk". Needs h5py. Raises ValueError where the file cannot be read, FileNotFoundError where there is no program.
    """
    import h5py  # type: ignore[import]  # it declares no types

    if shutil.which(program) is None:
        raise FileNotFoundError(f"{program}: no such program; install the component `program` or pass program=")
    with tempfile.TemporaryDirectory() as folder:
        cache = pathlib.Path(folder, "frames.h5")
        done = subprocess.run([program, "export", str(path), str(cache), *options], capture_output=True,
                              text=True, check=False)
        if done.returncode != 0:
            raise ValueError(done.stderr.strip() or f"{path}: cannot be read")
        with h5py.File(cache) as file:
            return file["triangles"][:], file["positions"][:]
