"""Training, from scratch and from a model."""

import numpy as np

from . import _arrays, _classify, _clouds, _core, _models
from .errors import InsufficientError, UsageError

_DESCRIPTOR = ("scales", "features", "reconstruction", "gate", "second_gate", "exact", "eps", "s_min",
               "s_max", "s_max_ratio", "octaves")


def _descriptor(options):
    for name in options:
        if name not in _DESCRIPTOR:
            raise TypeError(f"unexpected keyword argument {name!r}; a descriptor has "
                            f"{', '.join(_DESCRIPTOR)}")
    given = {name: value for name, value in options.items()
             if value is not None or name in ("gate", "second_gate")}
    return _classify.descriptor_settings(given)


def _check_adapts(options):
    """Options of a new network, which a model that learns more has already."""
    unused = [name for name, (value, default) in options.items() if value is not default and value != default]
    if unused:
        raise UsageError(f"{', '.join(unused)}: not with start, whose network and training are as they are")


def train(clouds, labels=None, *, normals=None, start=None, name="model", classes=3, seed=1,
          epochs=None, context=False, balance=1.0, distil=0, recipe="adam", network="pcednet",
          threads=0, progress=None, keep_orientation=False, **descriptor):
    """Train a model on labelled points.

    With ``start``, an existing model learns the labelled points without unlearning the rest, as
    the annotator does with a few strokes. Otherwise a new network is trained, and the labels
    must cover everything that it is to learn.

    Parameters
    ----------
    clouds : array_like (n, 3), Cloud, or list of these
    labels : array_like or dict, or a list of one per cloud
        The class of every point: 0 non-edge, 1 smooth-edge, 2 sharp-edge, 3 boundary (learnt as
        non-edge), 255 or -1 not to learn from. Or a dict from class, by number or name, to indices
        or a mask: ``{"sharp-edge": painted, "non-edge": others}``, no point in two. None: those of the Clouds. Of
        a Cloud that was read from a result of pcednet, unless its labels were changed since, these are no truth: the
        labels that were painted count, or else those of its input, with a warning.
        Clouds with own ``class_names`` give a model of these; arrays have those of `start`.
    normals : array_like (n, 3), or a list of one per cloud, optional
    start : str, path-like or Model, optional
        The model to start from, such as ``"general"``. Options of a new network, from `classes` to
        `network` and those of the descriptor, are refused with it.
    name : str
        Goes into the model.
    classes : {3, 2}
        2: sharp-edge and all other points. Own classes are all learnt.
    seed : int
        The same input and seed give the same model, for any number of threads.
    epochs : int, optional
        40 unless given.
    context : bool
        Also train a context network.
    balance : float
        0 (natural class frequencies, fewer false edges) to 1 (equal frequencies).
    distil : int
        Train this many networks first and learn their mean.
    recipe : {'adam', 'paper'}
    network : {'pcednet', 'fc', 'cnn'}
    threads, progress, keep_orientation
        As in :func:`classify`.
    **descriptor
        ``scales``, ``features``, ... as in :func:`describe`. Unless ``s_max_ratio`` or ``s_max`` is given, the scales
        grow with the diagonal of a cloud, so that pieces and larger clouds are not seen alike; those of ``start="general"``
        follow the spacing of the points. A model file does not keep ``s_min``, ``s_max``, ``exact`` and ``eps``.

    Returns
    -------
    Model
        Its ``history`` has the epochs.

    Raises
    ------
    UsageError
        Arrays or options that do not fit or do not apply, or numbers that are no classes.
    InsufficientError
        A cloud without a labelled point, a class without points, or Clouds of different classes.
    KeyboardInterrupt
        Ctrl-C.

    Warns
    -----
    PcednetWarning
        As :func:`classify`, and for Clouds that were read from results of pcednet.
    """
    several = isinstance(clouds, (list, tuple)) and not _is_points(clouds)
    clouds = list(clouds) if several else [clouds]
    labels = _one_each(labels, clouds, several, "labels")
    normals = _one_each(normals, clouds, several, "normals")
    if not clouds:
        raise UsageError("train: no clouds")
    if start is not None:
        given = {"classes": (classes, 3), "epochs": (epochs, None), "context": (bool(context), False),
                 "balance": (balance, 1.0), "distil": (distil, 0), "recipe": (recipe, "adam"),
                 "network": (network, "pcednet")}
        given.update((name, (value, None)) for name, value in descriptor.items() if name in _DESCRIPTOR)
        _check_adapts(given)
        start = _models.model_of(start)
    table = _class_lines(clouds, start)
    names = _core.class_names(table)
    arrays = [_labelled(k, *one, names, keep_orientation)
              for k, one in enumerate(zip(clouds, normals, labels))]
    name, seed = _arrays.text(name, "name"), _arrays.seed(seed)
    settings = {"descriptor": _descriptor(descriptor),
                "classes": _arrays.whole(classes, "classes", 2, 3), "seed": seed,
                "epochs": None if epochs is None else _arrays.whole(epochs, "epochs"),
                "context": bool(context), "balance": _arrays.share(balance, "balance"),
                "distil": _arrays.whole(distil, "distil", 0, 100), "recipe": _arrays.text(recipe, "recipe"),
                "network": _arrays.text(network, "network")}
    if start is None and settings["classes"] == 3:
        _check_has_smooth(arrays, names)
    with _arrays.reporting(progress) as report:
        if start is None:
            core, history, notes = _core.train(arrays, table, name, bool(keep_orientation),
                                               settings, report, _arrays.thread_count(threads))
        else:
            core, history, notes = _core.adapt(start._core, arrays, table, name,
                                               bool(keep_orientation), seed, report,
                                               _arrays.thread_count(threads))
    _arrays.warn(_classify.worded(notes))
    return _models.Model(core, history)


def _is_points(clouds):
    """Whether a list is one cloud written as rows of three numbers."""
    return len(clouds) > 0 and all(np.ndim(row) == 1 and np.size(row) == 3 for row in clouds)


def _one_each(values, clouds, several, name):
    if values is None:
        return [None] * len(clouds)
    if not several:
        return [values]
    if not isinstance(values, (list, tuple)) or len(values) != len(clouds):
        raise UsageError(f"{name}: a list of one per cloud is needed, for {len(clouds)} clouds")
    return values


def _name(number, cloud):
    return getattr(cloud, "name", "") or f"cloud {number}"


def _class_lines(clouds, start):
    """The classes of all clouds. Arrays do not say theirs: those of the model to start from."""
    of_arrays = _core.class_lines([]) if start is None else start._core.class_lines
    tables = [cloud._class_lines() if isinstance(cloud, _clouds.Cloud) else of_arrays
              for cloud in clouds]
    for number, (cloud, table) in enumerate(zip(clouds, tables)):
        if table != tables[0]:
            its, first = (", ".join(_core.class_names(one)) for one in (table, tables[0]))
            raise InsufficientError(f"{_name(number, cloud)}: its classes are {its}, those of the "
                                    f"first cloud {first}")
    return tables[0]


def _check_has_smooth(arrays, names):
    """Three edge classes cannot be learnt from labels of two."""
    if tuple(names) != _arrays.EDGES:
        return
    present = set().union(*(np.unique(labels).tolist() for *_, labels in arrays))
    if 2 in present and 1 not in present:
        raise InsufficientError("train: no point is labelled smooth-edge (1); classes=2 learns "
                                "sharp-edge (2) alone")


def _labelled(number, cloud, normals, labels, names, keep_orientation):
    positions, is_float32, given, scanners = _clouds.points_of(cloud, normals, estimates=keep_orientation)
    name = _name(number, cloud)
    if labels is None and isinstance(cloud, _clouds.Cloud):
        labels = cloud._truth(name)
    if labels is None:
        raise UsageError(f"{name}: has no labels")
    labels = _arrays.labels(labels, len(positions), names=names, strict=True)
    if (labels == _arrays.UNLABELLED).all():
        raise InsufficientError(f"{name}: no point is labelled")
    return name, positions, is_float32, given, scanners, labels
