"""Reading what `cscd` writes, and refusing what it did not write."""
import functools
import gzip
import json
import pathlib
import zlib

from script import answer_of, refuse


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


@functools.cache
def document_of(program, *paths):
    """The document of figures that `cscd report` makes of records: texts, marks and sums that pages and charts place."""
    if not program.exists():
        refuse(f"{program}: is not there; build it with scripts/reproduce, or name another with --program")
    return answer_of(program, "report", *paths)
