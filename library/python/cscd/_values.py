"""Reads the arrays and numbers that callers give.

One rule: a value is taken if it has the right shape and each of its numbers can be held exactly, positions and lengths in
double precision, indices and counts in 32-bit integers. So arrays of any real type and any layout are taken, and lists of
numbers, and a float that is whole may be an index. Booleans, complex numbers, text, None, masked entries and arrays of
Python objects are no numbers. What is not taken raises ValueError with one line.
"""
import numpy as np

INDEX, REAL = np.dtype(np.int32), np.dtype(np.float64)
KINDS = {"b": "booleans", "c": "complex numbers", "O": "Python objects", "U": "text", "S": "bytes"}


def numbers(value, name, dtype, *shape):
    """Returns the value as an array of INDEX or REAL, row by row; the caller's own memory where that is so already.

    `shape` has an entry for each axis: a size, or what there may be any number of.
    """
    if type(value) is np.ndarray and value.dtype == dtype and fits(value, shape) and is_row_by_row(value):
        return value  # the usual case, in a microsecond
    array = as_array(value, name)
    if array.dtype.kind not in "iuf":
        raise ValueError(f"{name}: {KINDS.get(array.dtype.kind, array.dtype)} given; give {kind_of(dtype)}")
    if not fits(array, shape):
        raise ValueError(f"{name}: {wrong_shape(array, shape)}")
    with np.errstate(all="ignore"):
        exact = held_by_index(array) if dtype == INDEX else held_by_real(array)
        if not exact.all():
            where = tuple(map(int, np.argwhere(~exact)[0]))
            place = f" at {list(where)}" if where else ""
            raise ValueError(f"{name}: {array[where]!s}{place} is not among {kind_of(dtype)}")
        return np.require(array, dtype, "CA")


def fits(array, shape):
    return array.ndim == len(shape) and (shape[-1:] in ((), array.shape[-1:]) or isinstance(shape[-1], str))


def is_row_by_row(array):
    return array.flags.c_contiguous and array.flags.aligned


def as_array(value, name):
    if np.ma.is_masked(value):
        raise ValueError(f"{name}: has masked entries; fill them or leave them out")
    try:
        array = np.asarray(value)
        # numpy makes doubles of lists in which some whole number needs the 64th bit, and rounds them.
        if array.dtype == REAL and isinstance(value, (list, tuple)) and (np.abs(array) > 2**53).any():
            if any(isinstance(n, (int, np.integer)) for n in np.asarray(value, dtype=object).flat if abs(n) > 2**53):
                raise ValueError("a whole number is beyond 2^53")
        return array
    except MemoryError:
        raise
    except Exception as error:  # whatever an object's own conversion raises
        reason = (str(error) or type(error).__name__).splitlines()[0]
        raise ValueError(f"{name}: cannot be read as an array of numbers: {reason}") from None


def wrong_shape(array, shape):
    if not shape:
        return "is no single number"
    wanted = ", ".join(map(str, shape))
    text = f"has shape {array.shape}; give [{wanted}]"
    if shape[-1] == 3 and array.ndim == 1 and array.size and array.size % 3 == 0:
        return f"{text}, for example by reshape(-1, 3)"
    if shape[-1] == 3 and array.ndim == 2 and array.shape[0] == 3:
        return f"{text}, for example the transpose"
    if shape == ("faces", 3) and array.ndim == 2 and array.shape[1] == 4:
        return f"{text}; split quads into triangles"
    return text


def held_by_index(array):
    return (array >= -2**31) & (array < 2**31) & (array % 1 == 0)


def held_by_real(array):
    if array.dtype.kind != "f":
        return (array >= -2**53) & (array <= 2**53)
    return (array.astype(REAL).astype(array.dtype) == array) | (array != array)  # NaN is found later, by its vertex


def kind_of(dtype):
    return "whole numbers of at most 32 bits" if dtype == INDEX else "real numbers in double precision"


def flag(value, name):
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"{name}: give True or False")
    return bool(value)
