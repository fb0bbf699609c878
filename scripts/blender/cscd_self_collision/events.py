"""Where a moving surface lies in itself or touches itself: names, events and sentences. Knows numpy and nothing of Blender.

A *place* is the bone that moves most corners of a face, or else the object that the face belongs to. An *event* is one spot
where the surface overlaps itself, followed from frame to frame, or two places that touch. Names, events and folds at joints
follow the rules of `cscd query`, which bench/README.md explains.
"""
from __future__ import annotations

import itertools
from collections import Counter, defaultdict
from dataclasses import dataclass, field

import numpy as np

JOINED = 1e-6  # vertices nearer than this share of the diagonal are one, as files repeat vertices at seams
FOLD = 0.1  # of the girth of the thinner limb; what lies less deep at a joint is a fold
DEEPER = 1.1  # what crosses at rest is an event where it lies deeper by this factor
RINGS = 2  # round two faces that cross at rest; faces of two pieces that cross within these rings cross at rest, too


@dataclass
class Event:
    """Two places of the surface that lie in each other, or that touch."""
    places: tuple[int, int]
    names: tuple[str, str] = ("", "")
    begins: float = 0
    ends: float = 0
    deepest: float = 0
    depth: float = 0  # 0 where none is known
    bound: float = 0  # what no point exceeds
    at_rest: float | None = None  # how deep the two lie in each other at rest
    touches: bool = False  # the two cross in no frame
    at_joint: bool = False
    point: np.ndarray = field(default_factory=lambda: np.zeros(3))
    lines: list[np.ndarray] = field(default_factory=list)  # [points, 3] each: curves, and the way out of the deepest point
    vertices: dict[int, float] = field(default_factory=dict)  # the largest depth of each vertex

    @property
    def excess(self) -> float:
        return self.depth - (self.at_rest or 0)


def joined(poses, tolerance):
    """Returns for each vertex the first vertex that is at the same spot at rest, poses[0], and stays there in the other poses."""
    _, first, inverse = np.unique(poses[0] + 0.0, axis=0, return_index=True, return_inverse=True)
    group = first[inverse]
    for pose in poses[1:]:
        left = np.flatnonzero(np.linalg.norm(pose - pose[group], axis=1) > tolerance)
        spots = np.column_stack([group[left], np.round(pose[left] / max(tolerance, 1e-300))])
        _, first, inverse = np.unique(spots, axis=0, return_index=True, return_inverse=True)
        group[left] = left[first[inverse]]
    return group


class Surface:
    """One surface made of all objects.

    poses: [vertices, 3] float each, first the pose at rest, then poses in which vertices of one spot part.
    triangles: [triangles, 3] int, with the number of the object of each in `owner`.
    bone: [vertices] int, the bone that moves each most, or -1. bone_parents: [bones] int, or -1.
    """

    def __init__(self, poses, triangles, owner, owner_names, bone, bone_names, bone_parents):
        self.size = float(np.linalg.norm(np.ptp(poses[0], axis=0)))
        self.group = joined(poses, JOINED * self.size)
        corners = self.group[triangles]
        kept = np.flatnonzero((corners != np.roll(corners, 1, axis=1)).all(axis=1))
        _, first = np.unique(np.sort(corners[kept], axis=1), axis=0, return_index=True)
        kept = kept[np.sort(first)]
        self.source, faces = np.unique(corners[kept], return_inverse=True)  # the given vertex of each vertex
        self.faces = faces.reshape(-1, 3)
        self.names = [*bone_names, *owner_names]
        b = np.asarray(bone)[self.source][self.faces]
        b = np.where(b[:, 1] == b[:, 2], b[:, 1], b[:, 0])
        self.place = np.where(b >= 0, b, len(bone_names) + np.asarray(owner)[kept])
        self.around = [set() for _ in self.source]  # the faces at each vertex
        for face, three in enumerate(self.faces.tolist()):
            for v in three:
                self.around[v].add(face)
        self.component = self._components()
        self._joints = self._find_joints(bone_parents)
        self._girth = self._find_girths(poses[0][self.source])

    def parts_in(self, pose):
        """Whether vertices that are joined to one are apart in a pose."""
        return bool((np.linalg.norm(pose - pose[self.group], axis=1) > 10 * JOINED * self.size).any())

    def _components(self):
        component = np.full(len(self.faces), -1)
        for start in range(len(self.faces)):
            if component[start] >= 0:
                continue
            component[start], edge = start, [start]
            while edge:
                for v in self.faces[edge.pop()].tolist():
                    new = [f for f in self.around[v] if component[f] < 0]
                    component[new] = start
                    edge += new
        return component

    def _find_joints(self, parents):
        if parents:
            joints = {(b, b) for b in range(len(parents))}
            for b, parent in enumerate(parents):
                joints |= {(b, parent), (parent, b)} if parent >= 0 else set()
            return joints
        joints = set()
        for faces in self.around:
            joints.update(itertools.permutations(set(self.place[list(faces)].tolist()), 2))
        return joints

    def _find_girths(self, rest):
        """Returns the circumference of the round limb that has the same spread as each place: its variance across is r^2 / 2."""
        corners = rest[self.faces]
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
        girth = {}
        for place in np.unique(self.place).tolist():
            own = self.place == place
            points, weight = corners[own].reshape(-1, 3), np.repeat(area[own] / 3, 3)
            total = weight.sum()
            if total > 0:
                points = points - weight @ points / total
                middle = np.linalg.eigvalsh((points * weight[:, None]).T @ points / total)[1]
            girth[place] = 2 * np.pi * np.sqrt(2 * max(0.0, middle)) if total > 0 else 0.0
        return girth

    def is_fold(self, event):
        if event.places not in self._joints:
            return False
        deep = event.depth if event.depth > 0 else event.bound
        return event.touches or deep < FOLD * min(self._girth[p] for p in event.places)

    def faces_with(self, vertices):
        return set.intersection(*(self.around[v] for v in vertices))

    def rings(self, face):
        inside = {face}
        for _ in range(RINGS):
            inside = set().union(*(self.around[v] for f in inside for v in self.faces[f].tolist()))
        return inside


def segments_of(overlap):
    return [(min(s), max(s)) for curve in overlap.curves for s in curve.faces.tolist()]


class RestCrossings:
    """What crosses at rest, such as eyes in sockets. That is how a surface is made, and no event until it has parted."""

    def __init__(self, surface, overlaps):
        self._depth = [overlap.depth or overlap.depth_bound for overlap in overlaps]
        self._pairs = {}  # the overlap of each pair
        self._near = defaultdict(set)  # face: 2 i and 2 i + 1 for the sides of pair i
        self._overlap = []  # of pair i
        self._close = defaultdict(set)  # face: overlaps near it
        self._parted, self._seen = set(), set()
        rings = {}
        for number, overlap in enumerate(overlaps):
            for pair in set(segments_of(overlap)):
                self._pairs[pair] = number
                i = len(self._overlap)
                self._overlap.append(number)
                for side, face in enumerate(pair):
                    if face not in rings:
                        rings[face] = surface.rings(face)
                    for f in rings[face]:
                        self._close[f].add(number)
                        if surface.component[pair[0]] != surface.component[pair[1]]:
                            self._near[f].add(2 * i + side)

    def __len__(self):
        return len(self._pairs)

    def explains(self, a, b):
        near = self._near.get(b, ())
        found = {self._overlap[i // 2] for i in self._near.get(a, ()) if i ^ 1 in near}
        found |= {self._pairs[a, b]} if (a, b) in self._pairs else set()
        self._seen |= found
        return bool(found - self._parted)

    def end_pose(self):
        """What has not crossed in a pose that was asked about has parted, and explains nothing when it comes back."""
        self._parted |= set(range(len(self._depth))) - self._seen
        self._seen = set()

    def depth_near(self, pairs):
        return max((self._depth[i] for a, b in pairs for i in self._close.get(a, set()) & self._close.get(b, set())), default=0.0)


class Check:
    """Asks about one surface, frame after frame. `cscd` is the Python module."""

    def __init__(self, cscd, surface, rest, thickness=0.0, leave_out_rest=True):
        self.surface, self.thickness = surface, thickness
        rest = rest[surface.source]
        near = {"rings": 1, "rest_distance": thickness} if thickness > 0 else {}
        self._body = cscd.SelfCollision(surface.faces, rest, thickness=thickness, exclude=cscd.Exclusions(ongoing=True, **near))
        self.rest = RestCrossings(surface, self._body.crossings(rest).overlaps if leave_out_rest else [])
        self._close_at_rest = self._keys(self._body.all_contacts(rest, rest).contacts) if thickness > 0 else set()
        self._events, self._touches = [], {}
        self._crossed = set()  # pairs of places that cross anywhere, the smaller number first
        self._by_vertex, self._by_pair, self._going_on = {}, {}, []
        self._last = None

    @staticmethod
    def _keys(contacts):
        return {(c.edges, *c.vertices) for c in contacts}

    def add(self, frame, positions):
        pose = positions[self.surface.source]
        if self._last is not None:
            self._add_contacts(self._last[0], self._body.all_contacts(self._last[1], pose).contacts)
        self._add_overlaps(frame, pose, self._body.crossings(pose).overlaps)
        self._last = frame, pose

    def _add_overlaps(self, frame, pose, overlaps):
        by_vertex, by_pair, going_on = defaultdict(set), defaultdict(set), []
        for overlap in overlaps:
            pairs = segments_of(overlap)
            explained = sum([self.rest.explains(*pair) for pair in pairs])
            at_rest = None
            if explained and 2 * explained >= len(pairs):
                at_rest = self.rest.depth_near(pairs)
                if not overlap.depth > DEEPER * at_rest:
                    continue
            if not pairs:  # a piece touches a wall from within, which the contacts say
                continue
            marks = [(v, self._other(overlap, region)) for region in overlap.regions for v in region.vertices.tolist()]
            self._crossed.update(tuple(sorted(both)) for both in self.surface.place[np.array(pairs)].tolist())
            places = self._places(overlap)
            number = self._continued(marks, pairs, places)
            if number is None:
                number = len(self._events)
                self._events.append(Event(places, begins=frame, deepest=frame, depth=-1))
            self._extend(self._events[number], frame, pose, overlap, places, at_rest)
            for mark in marks:
                by_vertex[mark].add(number)
            for pair in pairs:
                by_pair[pair].add(number)
            going_on.append(number)
        self.rest.end_pose()
        self._by_vertex, self._by_pair, self._going_on = by_vertex, by_pair, sorted(going_on)

    def _other(self, overlap, region):
        """The component that a region lies in."""
        curve, column = region.bounds[0].tolist()
        return self.surface.component[overlap.curves[curve].faces[0][1 - column]]

    def _places(self, overlap):
        """Which place lies in which: those of most pairs of faces along the curves that bound the deepest region."""
        own = dict(overlap.regions[0].bounds.tolist()) if overlap.regions else {}
        count = Counter()
        for number, curve in enumerate(overlap.curves):
            if own and number not in own:
                continue
            column = own.get(number, 0)
            places = self.surface.place[curve.faces]
            count.update(zip(places[:, column].tolist(), places[:, 1 - column].tolist()))
        return min(count, key=lambda places: (-count[places], places))

    def _continued(self, marks, pairs, places):
        for known, asked in ((self._by_vertex, marks), (self._by_pair, pairs)):
            votes = Counter(event for mark in asked for event in known.get(mark, ()))
            if votes:
                return min(votes, key=lambda event: (-votes[event], event))
        same = {places, places[::-1]}
        return next((event for event in self._going_on if self._events[event].places in same), None)

    @staticmethod
    def _extend(event, frame, pose, overlap, places, at_rest):
        event.ends = frame
        depth = overlap.depth if overlap.depth > 1e-9 * overlap.depth_bound else 0.0
        for region in overlap.regions:
            for v, distance in zip(region.vertices.tolist(), region.distances.tolist()):
                event.vertices[v] = max(event.vertices.get(v, 0.0), distance)
        if (depth, overlap.depth_bound) <= (event.depth, event.bound):
            return
        event.places, event.deepest, event.depth, event.bound, event.at_rest = places, frame, depth, overlap.depth_bound, at_rest
        event.lines = [curve.points[[*range(len(curve.points)), 0][:None if curve.closed else -1]] for curve in overlap.curves]
        event.point = overlap.curves[0].points[0]
        if overlap.regions and depth > 0:
            region = overlap.regions[0]
            event.point = pose[region.deepest]
            event.lines.append(np.array([event.point, event.point + region.out]))

    def _add_contacts(self, frame, contacts):
        for contact in contacts:
            if (contact.edges, *contact.vertices) in self._close_at_rest:
                continue
            two = 2 if contact.edges else 1
            first, second = (sorted(self.surface.faces_with(v)) for v in (contact.vertices[:two], contact.vertices[two:]))
            if any(self.rest.explains(min(pair), max(pair)) for pair in itertools.product(first, second)):
                continue
            places = tuple(sorted((int(self.surface.place[first[0]]), int(self.surface.place[second[0]]))))
            event = self._touches.get(places)
            if event is None:
                event = Event(places, begins=frame + contact.time, touches=True, point=np.array(contact.point))
                event.deepest = event.begins
                self._touches[places] = event
            event.ends = frame + contact.time
            event.vertices.update((v, event.vertices.get(v, 0.0)) for v in contact.vertices)
            if contact.time + frame < event.begins + 1 and len(event.lines) < 200:
                along = np.array(contact.normal) * 0.01 * self.surface.size
                event.lines.append(np.array([contact.point - along, contact.point + along]))

    def events(self):
        events = self._events + [event for places, event in self._touches.items() if places not in self._crossed]
        for event in events:
            event.names = tuple(self.surface.names[place] for place in event.places)
            event.at_joint = self.surface.is_fold(event)
        return in_order(events)

    def weights(self, events, count):
        """Returns the weight of each of `count` given vertices, as weights() does."""
        of_given = np.zeros(count)
        of_given[self.surface.source] = weights(events, len(self.surface.source))
        return of_given[self.surface.group]


def weights(events, count):
    """Returns [count] float: 0.1 for a vertex that touches up to 1 for the deepest; all 1 where nothing is deep."""
    depth = np.full(count, -1.0)
    for event in events:
        for v, own in event.vertices.items():
            depth[v] = max(depth[v], own)
    deepest = depth.max(initial=0.0)
    return np.where(depth < 0, 0.0, 0.1 + 0.9 * depth / deepest if deepest > 0 else 1.0)


def number(frame):
    return f"{round(frame, 2):g}"


def title(event, length):
    """Returns a row of the list, such as "hand_l in thigh_l: 1.2 cm". `length` writes a length."""
    one, other = event.names[0], "itself" if event.names[0] == event.names[1] else event.names[1]
    if event.touches:
        return f"{one} touches {other}"
    return f"{one} in {other}: {length(event.depth)}" if event.depth > 0 else f"{one} meets {other}: at most {length(event.bound)}"


def sentence(event, length, thickness=0.0):
    one, other = event.names[0], "itself" if event.names[0] == event.names[1] else event.names[1]
    if event.touches:
        what = f"comes within {length(thickness)} of" if thickness > 0 else "touches"
        return f"{one} {what} {other}, first at frame {number(event.begins)}"
    rest = f", deeper than at rest ({length(event.at_rest)})" if event.at_rest is not None else ""
    if event.depth > 0:
        what = f"is {length(event.depth)} deep in {other}{rest}"
    else:
        what = f"meets {other}{rest}; how deep is not known, at most {length(event.bound)}"
    if event.begins == event.ends:
        return f"{one} {what}, at frame {number(event.begins)} alone"
    return f"{one} {what}, deepest at frame {number(event.deepest)} (frames {number(event.begins)} to {number(event.ends)})"


def headline(events, length, frames, thickness=0.0):
    """Returns what is said first: the worst that is no fold at a joint. `events` are in_order()."""
    shown = [event for event in events if not event.at_joint]
    deep = [event for event in shown if event.depth > 0]
    if shown:
        return sentence(max(deep, key=lambda e: e.excess) if deep else shown[0], length, thickness) + "."
    what = f"comes within {length(thickness)} of itself" if thickness > 0 else "touches itself"
    return f"Nothing {what} in frames {number(frames[0])} to {number(frames[1])}{', apart from folds at joints' if events else ''}."


def from_answer(answer, turn):
    """Returns the events of an answer of `cscd query --json` about one clip. `turn`, [3, 3], takes its positions to those of the scene.

    Frames are those of the answer. Raises ValueError where the answer is of another kind.
    """
    if not isinstance(answer, dict) or answer.get("schema") != "cscd.query/4":
        raise ValueError("this is no answer of cscd query; write one with cscd query INPUT --json FILE")
    if "clips" in answer:
        raise ValueError("this answer is about several clips; write one about one clip with cscd query INPUT --clip NAME --json FILE")
    scale = np.linalg.norm(turn[0])
    events = []
    for one in answer["summary"]["events"]:
        depth, point = one["depth"], np.array(one["point"])
        event = Event((0, 0), (one["first"], one["second"]), one["begins"]["frame"], one["ends"]["frame"], one["deepest"]["frame"],
                      scale * depth["at_least"] if depth["at_least"] > 1e-9 * depth["at_most"] else 0.0, scale * depth["at_most"],
                      None if one["at_rest"] is None else scale * one["at_rest"], at_joint=one["at_joint"], point=turn @ point)
        if one["out"]:
            event.lines.append(np.array([event.point, turn @ (point + np.array(one["out"]))]))
        events.append(event)
    met = {frozenset((met["first"], met["second"])): met for met in answer["summary"]["met"]}
    touches = {}
    for interval in answer["intervals"]:
        for contact in interval["contacts"]:
            names = tuple(contact[side]["bone"] or contact[side]["part"] for side in ("first", "second"))
            both, moment = frozenset(names), interval["frame"] + contact["time"]
            if "event" in contact:
                event = events[contact["event"]]
            elif both in met and met[both]["start_pairs"] == 0:  # the two cross in no frame
                event = touches.setdefault(both, Event((0, 0), names, moment, moment, moment, touches=True,
                                                       at_joint=met[both]["at_joint"], point=turn @ np.array(contact["point"])))
                event.ends = moment
            else:
                continue
            event.vertices.update(dict.fromkeys(contact["vertices"], 0.0))
    return in_order([*events, *touches.values()])


def in_order(events):
    """The deepest first, then what touches, in the order of time; of each kind, folds at joints come last."""
    return sorted(events, key=lambda e: (e.touches, e.at_joint, -e.excess, -e.bound, e.begins))
