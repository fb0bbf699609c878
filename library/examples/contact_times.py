#!/usr/bin/python3
"""Draws when in each step of a clip the mesh first touches itself: contact_times.py character.glb times.png

The program `cscd` reads the clip, any that `cscd export` takes: a model file, a point cache, the name of a scene.
"""
import os
import sys

import cscd
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

clip, picture = sys.argv[1:]
faces, frames = cscd.read(clip, program=os.environ.get("CSCD_PROGRAM", "cscd"))
body = cscd.SelfCollision(faces, frames[0])
answers = [body.first_contact(a, b) for a, b in zip(frames[:-1], frames[1:])]
times = np.array([np.nan if answer.time is None else answer.time for answer in answers])
crossing = [step for step, answer in enumerate(answers) if answer.intersects_at_start]

figure, axes = plt.subplots(figsize=(7, 2.5), layout="constrained")
steps = np.arange(len(times))
axes.vlines(steps, 0, 1, color="#dddddd", linewidth=1)
axes.plot(steps, times, "o", color="#d55e00", markersize=4, label="first contact")
if crossing:
    axes.plot(crossing, np.zeros(len(crossing)), "x", color="#0072b2", label="crosses at the start")
axes.set(xlabel="step", ylabel="t of the first contact", ylim=(-0.05, 1.05), title=os.path.basename(clip))
axes.legend(loc="upper left", bbox_to_anchor=(1, 1), frameon=False)
figure.savefig(picture, dpi=120)
print(np.isfinite(times).sum(), "of", len(times), "steps touch;", len(crossing), "start with crossings")
