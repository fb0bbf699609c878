#!/usr/bin/python3
"""Sheets of cloth that cross themselves a little are untangled step by step, and what could not be is said.

A vertex that lies on the wrong side of another sheet moves along its way to that sheet and a little beyond. Both sheets go
half of the way where both are cut off, and one goes all of it where the other is open. Where no vertex lies on a wrong side,
vertices move so that the curves of the crossing shorten. Nothing else holds the cloth together here: a simulation would go
on from each step.
"""
import cscd
import numpy as np

SIDE, STEPS = 20, 30


def sheet(rows, columns):
    along, across = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    faces = np.vstack([np.stack([first, first + columns, first + 1], 1),
                       np.stack([first + 1, first + columns, first + columns + 1], 1)])
    return faces, np.stack([along.ravel(), across.ravel(), 0 * along.ravel()], 1).astype(float)


def two_sheets():
    faces, flat = sheet(SIDE, SIDE)
    return np.vstack([faces, faces + len(flat)]), np.vstack([flat, flat + [0.31, 0.17, 1]])


def bump(height):
    """A bump of the lower sheet goes through the upper one."""
    faces, rest = two_sheets()
    pose, lower = rest.copy(), slice(0, SIDE**2)
    pose[lower, 2] += (1 + height) * np.exp(-((rest[lower, :2] - 9.4) / 3)**2).prod(1)
    return faces, rest, pose


def corner(depth):
    """A corner of the upper sheet hangs through the lower one."""
    faces, rest = two_sheets()
    pose, upper = rest.copy(), slice(SIDE**2, None)
    share = np.clip(rest[upper, :2].sum(1) - 28, 0, None)
    pose[upper, :2] -= 6
    pose[upper, 2] -= (1 + depth) * share / share.max()
    return faces, rest, pose


def crumpled(amount):
    """Two sheets that lie on each other, each vertex somewhere near its place."""
    faces, rest = two_sheets()
    rest[SIDE**2:, 2] = 0.3
    return faces, rest, rest + amount * np.random.default_rng(1).normal(size=rest.shape) * [0, 0, 1]


def fold(beyond):
    """A strip is bent back onto itself, and its end goes through it from border to border."""
    faces, rest = sheet(40, 12)
    radius, turn = 3, np.pi + beyond
    angle = np.clip((rest[:, 0] - 15) / radius, 0, turn)
    after = np.clip(rest[:, 0] - 15 - radius * turn, 0, None)
    x = np.where(rest[:, 0] < 15, rest[:, 0], 15 + radius * np.sin(angle) + after * np.cos(turn))
    return faces, rest, np.stack([x, rest[:, 1], radius * (1 - np.cos(angle)) + after * np.sin(turn)], 1)


def step(overlaps, x, edge):
    moves, votes = np.zeros_like(x), np.zeros(len(x))
    for overlap in overlaps:
        for region in overlap.regions:
            beyond = 0.05 * edge / np.maximum(region.distances, 1e-300)
            np.add.at(moves, region.vertices, (1 + beyond)[:, None] * region.ways / len(overlap.regions))
            np.add.at(votes, region.vertices, 1)
        if not overlap.regions:
            length = np.linalg.norm(overlap.gradient, axis=1)
            np.add.at(moves, overlap.vertices, -0.1 * edge * overlap.gradient / np.sqrt(1 + length**2)[:, None])
            np.add.at(votes, overlap.vertices, 1)
    return x + moves / np.maximum(votes, 1)[:, None]


def untangle(name, faces, rest, start):
    body = cscd.SelfCollision(faces, rest)
    sides = start[faces] - start[np.roll(faces, 1, axis=1)]
    edge = np.linalg.norm(sides, axis=2).mean()
    x, steps = start, 0
    overlaps = before = body.crossings(x).overlaps
    while overlaps and steps < STEPS:
        x, steps = step(overlaps, x, edge), steps + 1
        overlaps = body.crossings(x).overlaps
    depth = max(o.depth for o in before)  # 0 where nothing is cut off
    said = f"{name}: crosses itself in {len(before)} places" + (f", up to {depth:.2f} deep" if depth > 0 else "")
    free = body.is_free(x, x)  # exact: nothing touches, and nothing crosses
    if free:
        stretch = np.linalg.norm(x[faces] - x[np.roll(faces, 1, axis=1)], axis=2) / np.linalg.norm(sides, axis=2)
        print(f"{said}; untangled by step {steps}; edges {stretch.min():.2f} to {stretch.max():.2f} of what they were")
    else:
        where = [np.round(o.curves[0].points.mean(0), 1).tolist() for o in overlaps]
        print(f"{said}; not untangled by step {steps}: still crosses around {where}")
    return free


done = [untangle(f"bump through a sheet, {h}", *bump(h)) for h in (0.2, 0.6, 2)]
done += [untangle(f"corner through a sheet, {h}", *corner(h)) for h in (0.3, 1)]
done += [untangle(f"crumpled, {h}", *crumpled(h)) for h in (0.1, 0.2)]
assert all(done), "shallow crossings that cut off a piece can be untangled"
untangle("fold through itself, 0.6", *fold(0.6))
