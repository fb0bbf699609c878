#!/usr/bin/python3
"""A strip of cloth is rolled up onto itself; every step stops short of its first contact."""
import cscd
import numpy as np

n = 60
along, across = np.meshgrid(np.arange(n), np.arange(2), indexing="ij")
rest = np.stack([along.ravel(), 3.0 * across.ravel(), 0 * along.ravel()], axis=1).astype(float)
quads = np.arange(2 * (n - 1)).reshape(-1, 2)[:, 0]
faces = np.vstack([np.stack([quads, quads + 2, quads + 1], 1), np.stack([quads + 1, quads + 2, quads + 3], 1)]).astype(np.int32)


def rolled(turns):
    """The strip wound about an axis into so many turns of a circle."""
    if turns == 0:
        return rest
    angle = 2 * np.pi * turns * rest[:, 0] / (n - 1)
    radius = (n - 1) / (2 * np.pi * turns)
    return np.stack([radius * np.sin(angle), rest[:, 1], radius * (1 - np.cos(angle))], 1)


cloth = cscd.SelfCollision(faces, rest)
x, times = rest, []
for turns in np.linspace(0, 1.5, 60)[1:]:
    wanted = rolled(turns)
    answer = cloth.first_contact(x, wanted)
    assert not answer.intersects_at_start, "a step that stops before its contact leaves nothing crossing"
    times.append(1 if answer.time is None else answer.time)
    x = x + cloth.largest_step(x, wanted) * (wanted - x)
print(sum(t < 1 for t in times), "of", len(times), "steps had contacts; no step started with crossings")
