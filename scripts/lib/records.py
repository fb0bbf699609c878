"""Reading what `cscd` writes, and refusing what it did not write."""
import functools
import gzip
import json
import pathlib
import re
import sys
import zlib

from script import answer_of, refuse


def read_json(path):
    """The document of a JSON file, compressed with gzip or not. Raises OSError or ValueError."""
    content = pathlib.Path(path).read_bytes()
    try:
        return json.loads(gzip.decompress(content) if content[:2] == b"\x1f\x8b" else content)
    except (EOFError, zlib.error) as error:
        raise ValueError(str(error)) from error


def read_written(path, command):
    """The document of a file that `command` writes; refuses a file that cannot be read."""
    try:
        return read_json(path)
    except (OSError, ValueError) as error:
        refuse(f"{path}: cannot be read ({error}); name a file that `{command}` wrote")


def read_record(path, schema, command):
    """A record of that schema, which `command` writes; refuses anything else."""
    record = read_written(path, command)
    if not isinstance(record, dict) or record.get("schema") != schema:
        refuse(f"{path}: its schema is not {schema}; write it anew with `{command}`")
    return record


def read_records(paths, schema, command):
    """The records of that schema in files and folders. Other files of this project are left out; refuses a file that is none
    of these, and paths that hold no record at all."""
    records = []
    for path in paths:
        files = sorted([*path.glob("*.json"), *path.glob("*.json.gz")]) if path.is_dir() else [path]
        for file in files:
            record = read_written(file, command)
            found = record.get("schema") if isinstance(record, dict) else None
            if found == schema:
                records.append(record)
            elif str(found).startswith(schema.partition("/")[0] + "/") or not path.is_dir() and not str(found).startswith("cscd."):
                refuse(f"{file}: its schema is not {schema}; write it anew with `{command}`")
            elif not path.is_dir():
                print(f"left out: {file} is no record of `{command}` ({found})", file=sys.stderr)
    if not records:
        refuse(f"{', '.join(map(str, paths))}: no record; name what `{command}` wrote, or a folder of it")
    return records


@functools.cache
def document_of(program, *paths):
    """The document of figures that `cscd report` makes of records: texts, marks and sums that pages and charts place."""
    if not program.exists():
        refuse(f"{program}: is not there; build it with scripts/reproduce, or name another with --program")
    return answer_of(program, "report", *paths)


def plain(name):
    """A scene's name as part of a file's name. A record may call its scene anything, even by a path."""
    stem = name.rsplit("/", 1)[-1]
    return re.sub(r"[^\w.-]|^[.-]", "_", stem)[:64] or "unnamed"
