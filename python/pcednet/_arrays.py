"""Converts callers' data to the arrays that the extension takes."""

import contextlib
import operator
import os
import sys
import warnings

import numpy as np

from .errors import PcednetWarning, UsageError

EDGES = ("non-edge", "smooth-edge", "sharp-edge", "boundary")
UNLABELLED = 255
SHORT = {"plain": 0, "smooth": 1, "sharp": 2}


def numbers(values, name):
    """`values` as an array of real numbers, of any type; masked ones become NaN."""
    if isinstance(values, (str, os.PathLike)):
        raise UsageError(f"{name}: an array is needed, not a name; a file is read by "
                         f"pcednet.read({os.fspath(values)!r})")
    if isinstance(values, np.ma.MaskedArray):
        values = (values if values.dtype.kind == "f" else values.astype(np.float64)).filled(np.nan)
    try:
        array = np.asarray(values)
        if array.dtype == object or array.dtype.kind in "US":
            array = array.astype(np.float64)
    except (TypeError, ValueError, RuntimeError) as error:  # the last of tensors that need gradients
        raise UsageError(f"{name}: not an array of numbers: {error}") from None
    if array.dtype.names:
        columns = ", ".join(f"{name}[{field!r}]" for field in array.dtype.names[:3])
        raise UsageError(f"{name}: a structured array; np.column_stack([{columns}]) makes columns of its fields")
    if array.dtype.kind not in "fiub":
        complex_too = ". Complex data not supported" if array.dtype.kind == "c" else ""
        raise UsageError(f"{name}: real numbers are needed, not {array.dtype}{complex_too}")
    return array


def is_float32(array):
    """Whether its numbers are of that type, in either byte order."""
    return array.dtype.newbyteorder("=") == np.float32


def _remedy(shape, name):
    if len(shape) == 2 and shape[0] == 3:
        return f"; its transpose is {name}.T"
    return f"; the first three columns are {name}[:, :3]" if len(shape) == 2 and shape[1] > 3 else ""


def vectors(values, name, rows=None):
    """`values` as (n, 3) float64, without a copy where they are so already."""
    array = numbers(values, name)
    if array.size == 0 and array.ndim <= 2:
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise UsageError(f"{name}: shape (n, 3) is needed, not {array.shape}{_remedy(array.shape, name)}")
    if rows is not None and len(array) != rows:
        raise UsageError(f"{name}: {len(array)} rows for {rows} points")
    return np.require(array, np.float64, ["C", "A"])


def optional_vectors(values, name, rows):
    return None if values is None else vectors(values, name, rows)


def colours(values, rows):
    if values is None:
        return None
    array = numbers(values, "colours")
    if array.dtype != np.uint8 or array.shape != (rows, 3):
        raise UsageError(f"colours: uint8 of shape ({rows}, 3) are needed, not {array.dtype} of {array.shape}")
    return np.require(array, requirements=["C", "A"])


def scanners(places, rows):
    """The scanner position of each point, from one for all or one for each; None if unknown."""
    if places is None:
        return None
    array = numbers(places, "viewpoint")
    if array.shape == (3,):
        if not np.isfinite(array).all():
            raise UsageError(f"viewpoint: {array}: a place is needed")
        array = np.broadcast_to(array, (rows, 3))
    array = vectors(array, "viewpoint", rows)
    return array if np.isfinite(array).all(axis=1).any() else None


def numbers_of(names):
    """The number of each class, and of unlabelled, by name."""
    return {**{name: number for number, name in enumerate(names)}, "unlabelled": UNLABELLED}


def class_number(name, names=EDGES):
    """The number of a class from its name or number."""
    known = numbers_of(names)
    if isinstance(name, str):
        short = SHORT if tuple(names[:len(EDGES)]) == EDGES else {}
        if name in known or name in short:
            return {**short, **known}[name]
        raise UsageError(f"class {name!r}: there are {', '.join(known)}")
    number = int(name)
    if number not in known.values():
        raise UsageError(f"class {number}: there are {', '.join(map(str, known.values()))}")
    return number


def labels(values, rows, name="labels", names=EDGES, strict=False):
    """One class per point as (n,) uint8: from an array of classes (-1, 255 and masked ones are unlabelled), or
    from a dict that gives the indices, or the mask, of the points of each class, each in one at most. `names` has the
    classes by number; uint8, which files have, may hold other numbers unless `strict`."""
    if isinstance(values, dict):
        array, given = np.full(rows, UNLABELLED, np.uint8), np.zeros(rows, bool)
        for key, some in values.items():
            points = np.arange(rows)[indices(some, rows, f"{name}[{key!r}]")]
            number = class_number(key, names)
            twice = points[given[points] & (array[points] != number)]
            if twice.size:
                called = {its: known for known, its in numbers_of(names).items()}
                raise UsageError(f"{name}: point {twice[0]} is in two classes, "
                                 f"{called[int(array[twice[0]])]} and {called[number]}")
            array[points], given[points] = number, True
        return array
    if isinstance(values, np.ma.MaskedArray):
        values = values.filled(-1 if values.dtype.kind == "i" else UNLABELLED)
    array = numbers(values, name)
    if array.dtype == bool:
        raise UsageError(f"{name}: classes are needed, and a mask does not say which: "
                         'np.where(mask, 2, 0), or {"sharp-edge": mask} for some points')
    if array.ndim == 2 and 1 in array.shape:
        array = array.reshape(-1)
    if array.shape != (rows,):
        raise UsageError(f"{name}: shape ({rows},) is needed, not {array.shape}")
    if strict or array.dtype != np.uint8:
        wrong = ~np.isin(array, [-1, *range(len(names)), UNLABELLED])
        if wrong.any():
            known = ", ".join(f"{number} {its}" for number, its in enumerate(names))
            raise UsageError(f"{name}: {array[wrong][0]} is no class: {known}, 255 or -1 "
                             "unlabelled")
    if array.dtype != np.uint8:
        array = np.where(array == -1, UNLABELLED, array)
    return np.require(array, np.uint8, ["C", "A"])


def indices(some, rows, name):
    array = np.asarray(some)
    if array.dtype == bool:
        if array.shape != (rows,):
            raise UsageError(f"{name}: a mask of {array.shape} for {rows} points")
        return array
    if array.size == 0:
        return np.zeros(0, np.int64)
    if array.dtype.kind not in "iu" or array.ndim != 1:
        raise UsageError(f"{name}: indices of points, or a mask, are needed")
    if array.min() < 0 or array.max() >= rows:
        raise UsageError(f"{name}: indices from 0 to {rows - 1} are possible")
    return array


def attribute(name, values, rows):
    """The numbers of an attribute, of a type that files have."""
    array = numbers(values, f"attribute {name}")
    if array.ndim not in (1, 2) or len(array) != rows:
        raise UsageError(f"attribute {name}: shape ({rows},) or ({rows}, k) is needed, not {array.shape}")
    wanted = {"b": np.dtype(np.uint8)}.get(array.dtype.kind, array.dtype.newbyteorder("="))
    wanted = np.dtype(np.float32) if wanted == np.float16 else wanted
    return np.require(array, wanted, ["C", "A"])


def is_wide(array):
    return array.dtype.kind in "iu" and array.dtype.itemsize == 8


def narrowed(array):
    """Integers of 64 bits, which numpy makes by itself, in 32 if they fit: PLY has none of 64, but two columns."""
    if not is_wide(array):
        return array
    narrow = np.int32 if array.dtype.kind == "i" else np.uint32
    fits = array.size == 0 or (np.iinfo(narrow).min <= array.min() and array.max() <= np.iinfo(narrow).max)
    return array.astype(narrow) if fits else array


def probabilities(values, rows, name):
    if values is None:
        return None
    array = numbers(values, name)
    if array.shape != (rows,):
        raise UsageError(f"{name}: shape ({rows},) is needed, not {array.shape}")
    return np.require(array, np.float32, ["C", "A"])


def check_result(result, rows):
    if len(result.labels) != rows:
        raise UsageError(f"a Result of {len(result.labels)} points, the cloud has {rows}")


def thread_count(threads):
    return whole(threads, "threads", 0, 4096)


def whole(value, name, least=0, most=2**31 - 1):
    """A whole number from `least` to `most`."""
    try:
        number = operator.index(value)
    except TypeError:
        number = None
    if number is None or not least <= number <= most:
        raise UsageError(f"{name}: a whole number from {least} to {most} is needed, not {value!r}")
    return number


def seed(value):
    return whole(value, "seed", most=2**64 - 1)


def real(value, name):
    try:
        return float(value)
    except (TypeError, ValueError):
        raise UsageError(f"{name}: a number is needed, not {value!r}") from None


def share(value, name):
    """A number from 0 to 1."""
    number = real(value, name)
    if not 0.0 <= number <= 1.0:
        raise UsageError(f"{name}: {value}: a number from 0 to 1 is needed")
    return number


def text(value, name):
    if not isinstance(value, str):
        raise UsageError(f"{name}: a text is needed, not {value!r}")
    return value


@contextlib.contextmanager
def reporting(progress):
    """The callback for (stage, fraction): `progress` itself, or a function that moves a bar in
    tqdm's way. A class is instantiated."""
    if progress is None:
        yield None
        return
    made = progress(total=100) if isinstance(progress, type) else None
    bar = progress if made is None else made
    if not (hasattr(bar, "update") and hasattr(bar, "total")):
        if not callable(bar):
            raise UsageError("progress: a function of (stage, fraction) or a bar of tqdm is needed")
        yield bar
        return

    def move(stage, fraction):
        bar.total = bar.total or 100
        if hasattr(bar, "set_description"):
            bar.set_description(stage, refresh=False)
        bar.update(fraction * bar.total - bar.n)

    try:
        yield move
    finally:
        if made is not None:
            made.close()


def warn(notes):
    """Each note as a warning at the line that called pcednet."""
    package = os.path.dirname(__file__) + os.sep
    depth, frame = 1, sys._getframe()
    while frame is not None and frame.f_code.co_filename.startswith(package):
        depth, frame = depth + 1, frame.f_back
    for note in notes:
        warnings.warn(note, PcednetWarning, stacklevel=depth)
