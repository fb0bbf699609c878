#!/usr/bin/python3
"""Prints a digest of what the native library answers to the steps of a file, and how long a step takes.

    digest.py FILE PASSES                          the module `cscd` is found by PYTHONPATH
    digest.py FILE PASSES PROGRAM SCENE FROM TO    first writes the file: steps of a scene, read by the program `cscd`

After the pass that makes the digest, each question is asked in so many passes. Its time is the median over steps of the least
processor time that a step took, in milliseconds.

digest.mjs prints the same for the package. The file holds the numbers of faces, of vertices and of steps, a thickness, the faces, and
the start and the end of each step.
"""
import hashlib
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import cscd
import h5py
import numpy as np


def write(path, program, scene, begin, end):
    with tempfile.TemporaryDirectory() as folder:
        cache = pathlib.Path(folder, "frames.h5")
        subprocess.run([program, "export", scene, str(cache)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with h5py.File(cache) as file:
            faces, frames = file["triangles"][:], file["positions"][int(begin):int(end) + 1]
            # A scene's steps may end where its characters would have gone, before contacts are resolved.
            ends = file["predicted"][int(begin):int(end)] if "predicted" in file else frames[1:]
    steps = np.stack([frames[:-1], ends], axis=1)
    sides = frames[0][faces] - frames[0][np.roll(faces, 1, axis=1)]
    thickness = 0.1 * np.linalg.norm(sides, axis=2).mean()  # a tenth of an edge
    with open(path, "wb") as file:
        np.array([len(faces), frames.shape[1], len(steps), 0], "<i4").tofile(file)
        np.array([thickness], "<f8").tofile(file)
        faces.astype("<i4").tofile(file)
        if len(faces) % 2:  # doubles begin at a multiple of their size
            np.zeros(1, "<i4").tofile(file)
        steps.astype("<f8").tofile(file)


def read(path):
    with open(path, "rb") as file:
        faces, vertices, steps, _ = np.fromfile(file, "<i4", 4)
        thickness = np.fromfile(file, "<f8", 1)[0]
        corners = np.fromfile(file, "<i4", 3 * faces).reshape(-1, 3)
        file.seek(4 * (faces % 2), 1)
        return corners, thickness, np.fromfile(file, "<f8", steps * vertices * 6).reshape(steps, 2, vertices, 3)


def main(path, passes, *clip):
    if clip:
        write(path, *clip)
    faces, thickness, steps = read(path)
    digest, times, contacts = hashlib.sha256(), {}, 0

    def add(array, kind):
        digest.update((np.asarray(array) + np.zeros(1, kind)).astype(kind).tobytes())

    def add_answer(answer):
        nonlocal contacts
        contacts += len(answer.times)
        add(answer.start_crossings, "<i4")
        for ids in (answer.edges, answer.vertices, answer.faces):
            add(ids, "<i4")
        for numbers in (answer.times, answer.points, answer.normals):
            add(numbers, "<f8")

    def add_pairs(near):
        for pairs in near:
            add(pairs[np.lexsort(pairs.T[::-1])], "<i4")

    def ask(name, asked, function, take):
        for arguments in asked:
            take(function(*arguments))
        least = [math.inf] * len(asked)
        for _ in range(int(passes)):
            for i, arguments in enumerate(asked):
                begin = time.process_time()
                function(*arguments)
                least[i] = min(least[i], 1e3 * (time.process_time() - begin))
        if least[0] < math.inf:
            times[name] = statistics.median(least)

    body = cscd.SelfCollision(faces, steps[0, 0])
    ask("first contact", steps, body.first_contact, add_answer)
    ask("all contacts", steps, body.all_contacts, add_answer)
    ask("largest step", steps, body.largest_step, lambda share: add([share], "<f8"))
    thick = cscd.SelfCollision(faces, steps[0, 0], thickness=thickness)
    ask("all contacts, with a thickness", steps, thick.all_contacts, add_answer)
    ask("candidates", steps[-3:], lambda start, end: body.candidates(start, end, 0.0), add_pairs)
    ask("vertex bounds", steps[-3:], lambda start, end: body.vertex_bounds(start, 0.01), lambda bounds: add(bounds, "<f8"))
    ask("prepare", [(faces, steps[0, 0])], cscd.SelfCollision, lambda body: None)
    print(json.dumps({"digest": digest.hexdigest(), "contacts": contacts, "ms": times}))


if __name__ == "__main__":
    main(*sys.argv[1:])
