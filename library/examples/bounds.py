#!/usr/bin/python3
"""A strip of cloth is rolled up onto itself; each vertex moves no farther than it may, and nothing comes too close."""
import cscd
import numpy as np

n = 60
along, across = np.meshgrid(np.arange(n), np.arange(2), indexing="ij")
rest = np.stack([along.ravel(), 3.0 * across.ravel(), 0 * along.ravel()], axis=1).astype(float)
quads = np.arange(2 * (n - 1)).reshape(-1, 2)[:, 0]
faces = np.vstack([np.stack([quads, quads + 2, quads + 1], 1), np.stack([quads + 1, quads + 2, quads + 3], 1)]).astype(np.int32)


def rolled(turns):
    """The strip wound about an axis into so many turns of a circle."""
    angle = 2 * np.pi * turns * rest[:, 0] / (n - 1)
    radius = (n - 1) / (2 * np.pi * turns)
    return np.stack([radius * np.sin(angle), rest[:, 1], radius * (1 - np.cos(angle))], 1)


cloth = cscd.SelfCollision(faces, rest, thickness=0.1)
x, cap, held_back = rest, 0.2, 0
for turns in np.linspace(0, 1.5, 300)[1:]:
    way = rolled(turns) - x
    bounds = cloth.vertex_bounds(x, cap)
    length = np.linalg.norm(way, axis=1)
    share = np.minimum(1, 0.999 * bounds / np.maximum(length, 1e-300))  # a little less than may be, as sums round
    moved = x + share[:, None] * way
    assert cloth.is_free(x, moved), "nothing comes too close"
    held_back += np.count_nonzero((share < 1) & (bounds < cap))
    x = moved
assert held_back > 0
print(held_back, "times a vertex was held back; no step came too close")
