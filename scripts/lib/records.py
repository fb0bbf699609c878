"""Reading what `cscd` writes, and refusing what it did not write."""
import gzip
import json
import pathlib
import re
import sys
import zlib

SCRIPT = pathlib.Path(sys.argv[0]).name


def refuse(text):
    """Ends the script with one line on standard error and status 2."""
    print(f"{SCRIPT}: {text}", file=sys.stderr)
    sys.exit(2)


def read_json(path):
    """The document of a JSON file, compressed with gzip or not. Raises OSError or ValueError."""
    content = pathlib.Path(path).read_bytes()
    try:
        return json.loads(gzip.decompress(content) if content[:2] == b"\x1f\x8b" else content)
    except (EOFError, zlib.error) as error:
        raise ValueError(str(error)) from error


def read_record(path, schema, command):
    """A record of that schema, which `command` writes; refuses anything else."""
    try:
        record = read_json(path)
    except (OSError, ValueError) as error:
        refuse(f"{path}: cannot be read ({error}); name a file that `{command}` wrote")
    if not isinstance(record, dict) or record.get("schema") != schema:
        refuse(f"{path}: its schema is not {schema}; write it anew with `{command}`")
    return record


def plain(name):
    """A scene's name as part of a file's name. A record may call its scene anything, even by a path."""
    stem = name.rsplit("/", 1)[-1]
    return re.sub(r"[^\w.-]|^[.-]", "_", stem)[:64] or "unnamed"


def existing_folder(path):
    if not path.is_dir():
        refuse(f"{path}: is not a folder; make it first")
    return path


def run(main):
    """Runs a script; a file that cannot be written ends it with one line."""
    try:
        main()
    except OSError as error:
        refuse(f"{error.filename or 'output'}: cannot be written ({error.strerror}); choose another place or make room")
