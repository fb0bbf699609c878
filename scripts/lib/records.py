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


@functools.cache
def document_of(program, *paths):
    """The document of figures that `cscd report` makes of records: texts, marks and sums that pages and charts place."""
    return answer_of(program, "report", *paths)


def study_of(program, path, study):
    """What the document of a record says of a study."""
    found = document_of(program, path)[study]
    if not found:
        refuse(f"{path}: is a record of something else; name one of the study")
    return found["data"]
