"""Continuous self-collision detection of deforming triangle meshes.

    import cscd
    body = cscd.SelfCollision(faces, rest)           # [faces, 3] int, [vertices, 3] float
    answer = body.first_contact(before, after)       # [vertices, 3] float each
    print(answer.free, answer.time, answer.points)

read() gives the frames of a character or a point cache through the program `cscd`.
"""
import pathlib
import shutil
import subprocess
import tempfile

from ._cscd import Answer, Contact, Exclusions, SelfCollision, instruction_set

__all__ = ["Answer", "Contact", "Exclusions", "SelfCollision", "instruction_set", "read"]


def read(path, *options, program="cscd"):
    """Returns (faces, frames) of a model file, a point cache or a scene: [faces, 3] int32, [frames, vertices, 3] float64.

    The program `cscd` reads the file in a process of its own. `options` are those of `cscd export`, such as "--clip",
    "walk". Needs h5py. Raises ValueError where the file cannot be read, FileNotFoundError where there is no program.
    """
    import h5py

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
