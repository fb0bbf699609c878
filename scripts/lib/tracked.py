"""The files that git tracks. What else lies in a checkout, such as a record of a user's own, is on no page and fails no test."""
import pathlib
import subprocess
import sys

from script import ROOT


def git(root, *words):
    """The lines that git prints, or None where it cannot tell."""
    try:
        done = subprocess.run(["git", "-C", str(root), *words], capture_output=True, text=True)
    except FileNotFoundError:
        return None
    return [line for line in done.stdout.rstrip("\n").split("\0") if line] if done.returncode == 0 else None


def is_checkout(root):
    """Whether git tracks this tree. An archive may be unpacked inside the checkout of another project, which tracks none of it."""
    top = git(root, "rev-parse", "--show-toplevel")
    return bool(top) and pathlib.Path(top[0]).resolve() == root.resolve()


def tracked_files(folder=".", root=ROOT):
    """Paths of the tracked files below a folder that exist, sorted. Where the tree is no checkout, all files below the folder."""
    names = git(root, "ls-files", "-z", "--", str(folder)) if is_checkout(root) else None
    paths = (root / folder).rglob("*") if names is None else [root / name for name in names]
    return sorted(path for path in paths if path.is_file())


def say_what_is_passed_over(folder):
    """Warns whoever writes a page of the files below a folder that are not on it."""
    names = git(ROOT, "ls-files", "-z", "--others", "--exclude-standard", "--", str(folder)) if is_checkout(ROOT) else None
    if names:
        print(f"passed over {len(names)} files that git does not track, such as {names[0]}; to have them on the page, git add them "
              "first", file=sys.stderr)
