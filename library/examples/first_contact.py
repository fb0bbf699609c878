#!/usr/bin/python3
"""When does a mesh first touch itself in one step, and where?"""
import cscd
import numpy as np

# Two tetrahedra, one above the other. The upper one falls.
faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], dtype=np.int32)
faces = np.vstack([faces, faces + 4])
corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.3, 0.3, 1]])
before = np.vstack([corners, corners + [0, 0, 2]])
after = np.vstack([corners, corners])
after[4:, 2] += 0.5

body = cscd.SelfCollision(faces, before)
answer = body.first_contact(before, after)
print(f"free: {answer.free}; first contact at t = {answer.time} in {answer.points.tolist()}")
print("the step may go to t =", body.largest_step(before, after))
assert answer.time is not None and not answer.intersects_at_start
