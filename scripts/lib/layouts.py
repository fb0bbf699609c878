"""One program in several layouts: the same object files, linked in an order drawn from a seed.

Where functions lie decides which of them share cache lines and branch-predictor entries, and with that moves times by
several per cent without any change of the source (Mytkowicz et al., ASPLOS 2009). A comparison over several layouts keeps that
from being taken for a change.
"""
import pathlib
import random
import shlex
import subprocess


def ninja(build, *words):
    return subprocess.run(["ninja", "-C", str(build), *words], check=True, capture_output=True, text=True).stdout


def objects_of(build, archive):
    """The object files that ninja puts into a static library."""
    lines = ninja(build, "-t", "query", archive).splitlines()
    inputs = lines[lines.index(next(l for l in lines if l.startswith("  input:"))) + 1:lines.index("  outputs:")]
    return [line.strip() for line in inputs if line.strip().endswith(".o")]


def link_layout(build, seed, target="cscd"):
    """Links `target` of a ninja folder with its objects in the seed's order; returns the program's path.

    Programs that the target starts beside itself are linked to, so that it finds them.
    """
    build = pathlib.Path(build)
    words = shlex.split(ninja(build, "-t", "commands", "-s", target).strip().splitlines()[-1])
    words = words[words.index("&&") + 1:]
    words = words[:words.index("&&")]
    folder = build / f"layout-{seed}"
    folder.mkdir(exist_ok=True)
    own = [word for word in words if word.endswith((".a", ".o")) and not word.startswith(("/", "-"))]
    objects = [o for word in own for o in (objects_of(build, word) if word.endswith(".a") else [word])]
    random.Random(seed).shuffle(objects)
    kept = [word for word in words if word not in own]
    place = kept.index("-o")
    kept[place + 1] = f"layout-{seed}/{target}"
    subprocess.run(kept[:place] + objects + kept[place:], cwd=build, check=True)
    helper = build / "cscd-import"
    if helper.exists() and not (folder / helper.name).exists():
        (folder / helper.name).symlink_to(helper.resolve())
    return folder / target
