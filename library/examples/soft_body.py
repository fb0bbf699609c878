#!/usr/bin/python3
"""A soft ball falls onto a floor, which is an obstacle at rest. What would touch is held where it is; nothing ever crosses."""
import cscd
import numpy as np

rings, around = 9, 12
r, k = np.meshgrid(np.arange(rings), np.arange(around), indexing="ij")
u, w = np.pi * ((r + 1) / (rings + 1) - 0.5), 2 * np.pi * k / around
ball = np.stack([np.cos(u) * np.cos(w), np.cos(u) * np.sin(w), np.sin(u)], 2).reshape(-1, 3)
rest = np.vstack([ball, [[0, 0, 1], [0, 0, -1]]]) + [0, 0, 1.5]
top, bottom = rings * around, rings * around + 1


def at(ring, place):
    return bottom if ring < 0 else top if ring == rings else ring * around + place % around


faces, springs = [], []
for i in range(rings + 1):
    for j in range(around):
        if i > 0:
            faces.append((at(i - 1, j), at(i - 1, j + 1), at(i, j)))
        springs.append((at(i - 1, j), at(i, j)))
        if i < rings:
            faces.append((at(i - 1, j + 1), at(i, j + 1), at(i, j)))
            springs += [(at(i, j), at(i, j + 1)), (at(i, j), at(rings - 1 - i, j + around // 2))]
a, b = np.array(springs).T
lengths = np.linalg.norm(rest[b] - rest[a], axis=1)
share = 1 / np.bincount(np.r_[a, b])[:, None]

floor = (np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32), np.array([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], float))
body = cscd.SelfCollision(np.array(faces, dtype=np.int32), rest, obstacles=[floor])
x, velocity, held, dt = rest, np.zeros_like(rest), 0, 0.02
for step in range(300):
    velocity[:, 2] -= 9.8 * dt
    wanted = x + dt * velocity
    for _ in range(8):
        d = wanted[b] - wanted[a]
        d *= (1 - lengths / np.linalg.norm(d, axis=1))[:, None]
        move = np.zeros_like(wanted)
        np.add.at(move, a, d)
        np.add.at(move, b, -d)
        wanted += share * move
    while not (answer := body.all_contacts(x, wanted)).free:
        assert not answer.intersects_at_start
        touching = np.unique(answer.vertices)
        touching = touching[touching < len(x)]  # vertices of the floor are numbered behind the ball's
        wanted[touching] = x[touching]
        held += len(touching)
    velocity, x = 0.99 / dt * (wanted - x), wanted
print(held, "vertices held; the lowest stands", x[:, 2].min(), "above the floor")
assert held > 0 and 0 < x[:, 2].min() < 1
