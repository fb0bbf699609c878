"""Commands of several kinds: scripts/ENTRY KIND runs scripts/lib/ENTRY/KIND.py, whose main() it calls, or KIND.sh."""
import ast
import importlib.util
import itertools
import os
import pathlib
import sys

from script import refuse, run


def says(path):
    """What a script says of itself: its docstring, or the comment below its first line."""
    text = path.read_text()
    if path.suffix == ".py":
        return ast.get_docstring(ast.parse(text))
    return "\n".join(line[2:] for line in itertools.takewhile(lambda line: line.startswith("#"), text.splitlines()[1:]))


def run_kind(entry, description, usual=None):
    """Runs the kind that the first argument names. Where it names a file or an option, it is an argument of the kind `usual`."""
    entry, words = pathlib.Path(entry), sys.argv[1:]
    kinds = {path.stem: path for path in sorted((entry.parent / "lib" / entry.name).iterdir()) if path.suffix in (".py", ".sh")}
    if not words or words[0] in ("-h", "--help"):
        lines = [f"  {name:<12} {says(path).splitlines()[0]}" for name, path in kinds.items()]
        print(f"usage: scripts/{entry.name} {f'[KIND, usually {usual}]' if usual else 'KIND'} [ARGUMENT...]\n\n{description.strip()}\n\n"
              + "\n".join(lines) + f"\n\nscripts/{entry.name} KIND --help says more of one.")
        sys.exit(0 if words else 2)
    if words[0] not in kinds and usual and (words[0].startswith("-") or pathlib.Path(words[0]).exists()):
        words = [usual, *words]
    name, *rest = words
    if name not in kinds:
        refuse(f"no kind {name}{' and no such file' if usual else ''}; choose {', '.join(kinds)}")
    sys.argv = [f"{entry.name} {name}", *rest]
    if kinds[name].suffix == ".py":
        spec = importlib.util.spec_from_file_location("kind", kinds[name])
        kind = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(kind)
        run(kind.main)
    if rest and rest[0] in ("-h", "--help"):
        print(says(kinds[name]))
        sys.exit(0)
    os.execve("/bin/bash", ["bash", str(kinds[name]), *rest], {**os.environ, "CSCD_SCRIPT": sys.argv[0]})
