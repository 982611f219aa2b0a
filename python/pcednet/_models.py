"""Models, and what they find in clouds."""

import os
import pathlib
import tempfile

import numpy as np

from . import _arrays, _clouds, _core, _onnx
from .errors import UsageError

_SHIPPED = pathlib.Path(__file__).parent / "models"


def shipped_models():
    """The names of the models that come with the package.

    Returns
    -------
    list of str
        ``'general'`` is the default.
    """
    return sorted(path.stem for path in _SHIPPED.glob("*.safetensors"))


class Model:
    """A trained network with the description of points that it was trained on.

    Made by :func:`train`, :meth:`load` or :meth:`adapt`. Models can be pickled.

    Attributes
    ----------
    name : str
    seed : int
    classes : list of int
        The class of each output: ``[0, 1, 2]``, or ``[0, 2]`` without smooth-edge.
    descriptor : dict
        What describes a point: ``scales``, ``features`` per scale, ``columns`` (their names), ...
    has_context : bool
        Whether a second network decides in the end, on what was found around each point.
    weights : int
        Parameters of all networks.
    metadata : dict of str to str
        What the file says of the first network and of its training.
    history : list of dict
        Of a model trained here: ``epoch``, ``loss`` and, with enough points, ``validation_loss``
        and ``validation_accuracy`` of each epoch. Otherwise empty.
    """

    def __init__(self, core, history=()):
        self._core = core
        self.history = list(history)

    @classmethod
    def load(cls, name="general"):
        """A shipped model by its name, or a model file.

        Parameters
        ----------
        name : str or path-like

        Raises
        ------
        MissingFileError
            Neither a file nor a shipped model.
        ModelError
            The file is damaged, or no model of edges.
        """
        shipped = _SHIPPED / f"{os.fspath(name)}.safetensors"
        if not os.path.exists(name) and shipped.exists():
            return cls(_core.EdgeModel(shipped))
        try:
            return cls(_core.EdgeModel(_clouds.existing(name)))
        except FileNotFoundError as error:
            raise type(error)(f"{os.fspath(name)}: neither a file nor a shipped model "
                              f"({', '.join(shipped_models())})") from None

    def save(self, path, *, overwrite=False):
        """Write a model file (safetensors), which ``pcednet classify --model`` takes too.

        The same model gives the same bytes. A path that ends in ``.onnx`` gets the first network,
        without a context network, for other runtimes: input ``descriptors``, (n, scales x
        columns) float32, the rows that :func:`describe` gives, flattened; output ``probabilities``, (n, classes), equal to
        :meth:`predict` up to rounding.

        Parameters
        ----------
        path : str or path-like
        overwrite : bool
            Replace an existing file.

        Raises
        ------
        ExistsError
            The file exists and `overwrite` is False.
        UsageError
            ONNX: of a CNN, or of a model trained with another symmetry than its average.
        """
        path = os.fspath(path)
        if not path.endswith(".onnx"):
            self._core.save(path, overwrite)
            return
        facts = {"name": self.name, "classes": str(self.classes),
                 **{key: str(value) for key, value in self.descriptor.items()}}
        content = _onnx.encode(self._core.network, facts, len(self.classes))
        _core.write_file(path, content, overwrite)

    @property
    def tensors(self):
        """dict of str to ndarray, float32: the weights of the first network by their names in the
        file, copied."""
        return self._core.network.tensors

    def classify(self, xyz, normals=None, **options):
        """:func:`classify` with this model."""
        return classify(xyz, normals, model=self, **options)

    def adapt(self, clouds, labels, **options):
        """:func:`train` with ``start=`` this model."""
        return train(clouds, labels, start=self, **options)

    def predict(self, descriptors):
        """What the first network says of described points, before any context.

        Parameters
        ----------
        descriptors : array_like, (n, scales, features)
            As :func:`describe` gives them with this model's ``descriptor``.

        Returns
        -------
        ndarray, (n, classes) float32
            The probability of each of ``classes``; rows sum to 1.
        """
        rows = _arrays.numbers(descriptors, "descriptors")
        shape = (self.descriptor["scales"], len(self.descriptor["columns"]))
        if rows.shape[1:] not in (shape, (shape[0] * shape[1],)):
            raise UsageError(f"descriptors: shape (n, {shape[0]}, {shape[1]}) is needed, not "
                             f"{rows.shape}")
        return self._core.network.predict(np.require(rows, np.float32, ["C", "A"]))

    @property
    def name(self):
        return self._core.name

    @name.setter
    def name(self, name):
        self._core.name = str(name)

    @property
    def seed(self):
        return self._core.seed

    @property
    def classes(self):
        return self._core.classes

    @property
    def descriptor(self):
        return self._core.descriptor

    @property
    def has_context(self):
        return self._core.context is not None

    @property
    def weights(self):
        context = self._core.context
        return self._core.network.weights + (context.weights if context is not None else 0)

    @property
    def metadata(self):
        return self._core.network.metadata

    def __reduce__(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "model.safetensors"
            self.save(path)
            return _unpickled, (path.read_bytes(), self.history)

    def __repr__(self):
        return f"<Model {self.name!r}: classes {self.classes}, {self.weights} weights>"


def _unpickled(content, history):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "model.safetensors"
        path.write_bytes(content)
        return Model(_core.EdgeModel(path), history)


def model_of(model):
    return model if isinstance(model, Model) else Model.load(model)


class Result:
    """What :func:`classify` found, one row per point in the input's order.

    Attributes
    ----------
    labels : ndarray, (n,) uint8
        0 non-edge, 1 smooth-edge, 2 sharp-edge, 3 boundary (the sampled surface ends there), 255
        unlabelled (the position is not finite).
    p_sharp, p_smooth : ndarray, (n,) float32
        The model's probabilities of sharp-edge and smooth-edge; 0 where unlabelled. Those of
        boundary points say what the model thought of them.
    normals : ndarray, (n, 3) float64
        The normals in use: the given ones, unit, or estimated; ``(0, 0, 0)`` where there is none.
    made_normals : bool
        Whether they were estimated or got new signs.
    scales : tuple of float
        The smallest and the largest scale, in the unit of the cloud.
    model : Model
    notes : list of str
        The texts of the warnings.
    """

    def __init__(self, parts, model):
        self.labels = parts["labels"]
        self.p_sharp = parts["p_sharp"]
        self.p_smooth = parts["p_smooth"]
        self.normals = parts["normals"]
        self.made_normals = parts["made_normals"]
        self.scales = parts["scales"]
        self.notes = parts["notes"]
        self.model = model

    @property
    def p_edge(self):
        """(n,) float32: the probability of being a sharp or a smooth edge."""
        return self.p_sharp + self.p_smooth

    @property
    def confidence(self):
        """(n,) float32: the model's probability of the point's label; NaN for boundary, which
        geometry decides, and where unlabelled."""
        of_label = np.select([self.labels == 2, self.labels == 1, self.labels == 0],
                             [self.p_sharp, self.p_smooth, 1 - self.p_sharp - self.p_smooth],
                             np.nan)
        return of_label.astype(np.float32)

    @property
    def counts(self):
        """dict: how many points have each label, by its name."""
        return {name: int(np.count_nonzero(self.labels == number))
                for name, number in _arrays.CLASSES.items()}

    def __len__(self):
        return len(self.labels)

    def __repr__(self):
        counts = ", ".join(f"{count} {name}" for name, count in self.counts.items() if count)
        return f"<Result of {len(self)} points: {counts}>"

    def _parts(self):
        rows = len(self.labels)
        return {"labels": _arrays.labels(self.labels, rows),
                "p_sharp": _arrays.probabilities(self.p_sharp, rows, "p_sharp"),
                "p_smooth": _arrays.probabilities(self.p_smooth, rows, "p_smooth"),
                "normals": _arrays.vectors(self.normals, "normals", rows),
                "made_normals": self.made_normals, "scales": self.scales,
                "model": self.model._core}


def classify(xyz, normals=None, *, model="general", threads=0, progress=None, viewpoint=None,
             context=True, boundary=True, keep_orientation=False, exact=False, s_min=0.0,
             s_max=0.0):
    """Label every point: non-edge, smooth-edge, sharp-edge or boundary.

    The labels are those of ``pcednet classify``, the same for any number of threads and any order
    of the points.

    Parameters
    ----------
    xyz : array_like, (n, 3), or Cloud
        Positions in any unit; float64 keeps national grids. Float64 in C order is used in place.
        Points that are not finite are kept, unlabelled.
    normals : array_like, (n, 3), optional
        Of any length. Missing ones are estimated, and mixed signs made consistent, both with a
        warning.
    model : str, path-like or Model
        A shipped model (:func:`shipped_models`), a model file, or a Model.
    threads : int
        0: every core. Calls in several threads of Python run side by side.
    progress : callable or tqdm bar, optional
        Called with ``(stage, fraction)`` on the calling thread; or a bar such as
        ``tqdm(total=100)``, or the class ``tqdm`` itself. An exception in it stops the work, as
        Ctrl-C does.
    viewpoint : array_like, (3,) or (n, 3), optional
        Where the scanner stood, for all points or for each: estimated normals are turned there.
    context : bool
        False leaves out the model's context network: faster, less accurate.
    boundary : bool
        False leaves the three classes of the model.
    keep_orientation : bool
        Use the normals as they are even if their signs are mixed.
    exact : bool
        Exact neighbourhoods in double precision, slow.
    s_min, s_max : float
        Smallest and largest scale in the unit of the cloud; 0: from the spacing of the points.

    Returns
    -------
    Result
        In the order of the input.

    Raises
    ------
    UsageError
        Arrays of the wrong shape or type, or options out of range (a ValueError).
    InsufficientError
        No finite point, or points that form no surface (a ValueError).
    ModelError, MissingFileError
        The model cannot be used, or there is none of that name.
    KeyboardInterrupt
        Ctrl-C, as soon as the step at work ends.

    Warns
    -----
    PcednetWarning
        Normals were estimated or oriented, points are not finite, scales are unusual.

    Examples
    --------
    >>> result = pcednet.classify(xyz)
    >>> sharp = xyz[result.labels == 2]
    """
    positions, given, scanners = _clouds.points_of(xyz, normals, viewpoint)
    model = model_of(model)
    core = model._core if context else model._core.without_context()
    if s_min or s_max or exact:
        core = core.with_scales(float(s_min), float(s_max), bool(exact))
    with _arrays.reporting(progress) as report:
        parts = _core.classify(core, positions, given, scanners, bool(boundary),
                               bool(keep_orientation), report, _arrays.thread_count(threads))
    parts["notes"] = _worded(parts["notes"])
    _arrays.warn(parts["notes"])
    return Result(parts, model)


def _worded(notes):
    """Notes of arrays, which come from no file."""
    return [note.replace("no normals in the file", "no normals given") for note in notes]


_DESCRIPTOR = ("scales", "features", "reconstruction", "gate", "second_gate", "exact", "eps", "s_min",
               "s_max", "s_max_ratio")


def _descriptor(options):
    for name in options:
        if name not in _DESCRIPTOR:
            raise TypeError(f"unexpected keyword argument {name!r}; a descriptor has "
                            f"{', '.join(_DESCRIPTOR)}")
    return {name: value for name, value in options.items()
            if value is not None or name in ("gate", "second_gate")}


def describe(xyz, normals=None, *, scales=16, features=6, reconstruction="sphere", gate=None,
             second_gate=None, exact=False, eps=0.1, s_min=0.0, s_max=0.0, s_max_ratio=0.0,
             threads=0, progress=None, viewpoint=None, keep_orientation=False,
             return_scales=False):
    """The scale-space matrix: what algebraic spheres of several sizes say of each point.

    The numbers are those of ``pcednet describe``.

    Parameters
    ----------
    xyz, normals, threads, progress, viewpoint, keep_orientation
        As in :func:`classify`.
    scales : {4, 8, 16, 32, 64, 128}
        How many support radii.
    features : {28, 7, 6, 4, 3}
        Numbers per scale; 6 are the paper's ``tau kappa k1 dtau dkappa phi``.
    reconstruction : {'sphere', 'sphere-mls', 'covariance-plane', 'plane-mls'}
        The surface to fit.
    gate, second_gate : float, optional
        Leave out neighbours whose normal has a cosine below this with the point's own, -1 to 1. A
        second gate doubles the columns.
    exact : bool
        Exact neighbourhoods in double precision, slow.
    eps : float
        Voxel size over scale of the fast engine, 0.01 to 1.
    s_min, s_max : float
        Smallest and largest scale in the unit of the cloud; 0: the mean point spacing, and 10 % of
        the diagonal of the bounding box.
    s_max_ratio : float
        If not 0 and `s_max` is: `s_max` over `s_min`, whatever the extent of the cloud.
    return_scales : bool
        Return the scales too.

    Returns
    -------
    matrix : ndarray, (n, scales, features) float32
        Free of units; 0 where a scale has no fit. Never NaN.
    scales : ndarray, (scales,) float64
        The support radii, smallest first; only if `return_scales`.

    Raises
    ------
    UsageError, InsufficientError, KeyboardInterrupt
        As :func:`classify`.
    """
    positions, given, scanners = _clouds.points_of(xyz, normals, viewpoint)
    settings = {"scales": scales, "features": features, "reconstruction": reconstruction,
                "gate": gate, "second_gate": second_gate, "exact": bool(exact), "eps": eps,
                "s_min": s_min, "s_max": s_max, "s_max_ratio": s_max_ratio}
    with _arrays.reporting(progress) as report:
        matrix, radii, notes = _core.describe(positions, given, scanners, bool(keep_orientation),
                                              settings, report, _arrays.thread_count(threads))
    _arrays.warn(_worded(notes))
    return (matrix, radii) if return_scales else matrix


def train(clouds, labels=None, *, normals=None, start=None, name="model", classes=3, seed=1,
          epochs=None, context=False, balance=1.0, distil=0, recipe="adam", network="pcednet",
          threads=0, progress=None, keep_orientation=False, **descriptor):
    """Train a model on labelled points.

    With ``start`` a model that exists learns the labelled points without unlearning the rest: what
    the annotator does with a few strokes. Otherwise a new network is trained, for which the labels
    must cover all that it is to know.

    Parameters
    ----------
    clouds : array_like (n, 3), Cloud, or list of these
    labels : array_like or dict, or a list of one per cloud
        The class of every point: 0 non-edge, 1 smooth-edge, 2 sharp-edge, 3 boundary (learnt as
        non-edge), 255 or -1 not to learn from. Or a dict from class, by number or name, to indices
        or a mask: ``{"sharp-edge": painted, "non-edge": others}``. None: those of the Clouds.
    normals : array_like (n, 3), or a list of one per cloud, optional
    start : str, path-like or Model, optional
        What to start from, such as ``"general"``. Only `name` and `seed` apply besides.
    name : str
        Goes into the model.
    classes : {3, 2}
        2: sharp-edge and all other points.
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
        ``scales``, ``features``, ... as in :func:`describe`.

    Returns
    -------
    Model
        Its ``history`` has the epochs.

    Raises
    ------
    UsageError
        Arrays or options that do not fit.
    InsufficientError
        A cloud without a labelled point, or a class without points.
    KeyboardInterrupt
        Ctrl-C.
    """
    several = isinstance(clouds, (list, tuple)) and not _is_points(clouds)
    clouds = list(clouds) if several else [clouds]
    labels = _one_each(labels, clouds, several, "labels")
    normals = _one_each(normals, clouds, several, "normals")
    arrays = [_labelled(k, *one) for k, one in enumerate(zip(clouds, normals, labels))]
    if not arrays:
        raise UsageError("train: no clouds")
    settings = {"descriptor": _descriptor(descriptor), "classes": int(classes), "seed": int(seed),
                "epochs": epochs, "context": bool(context), "balance": float(balance),
                "distil": int(distil), "recipe": recipe, "network": network}
    with _arrays.reporting(progress) as report:
        if start is None:
            core, history, notes = _core.train(arrays, name, bool(keep_orientation), settings,
                                               report, _arrays.thread_count(threads))
        else:
            core, history, notes = _core.adapt(model_of(start)._core, arrays, name,
                                               bool(keep_orientation), int(seed), report,
                                               _arrays.thread_count(threads))
    _arrays.warn(_worded(notes))
    return Model(core, history)


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


def _labelled(number, cloud, normals, labels):
    positions, given, scanners = _clouds.points_of(cloud, normals)
    name = getattr(cloud, "name", "") or f"cloud {number}"
    if labels is None:
        labels = getattr(cloud, "labels", None)
    if labels is None:
        raise UsageError(f"{name}: has no labels")
    return name, positions, given, scanners, _arrays.labels(labels, len(positions))


class Scores:
    """The scores of Himeur et al. 2021, appendix B; one whose denominator is zero is 0.

    Attributes
    ----------
    precision, recall, mcc, f1, accuracy, iou : float
    tp, fp, tn, fn : int
    """

    def __init__(self, values):
        self.__dict__.update(values)

    def __repr__(self):
        return "<Scores: " + ", ".join(
            f"{name} {value:.3f}" if isinstance(value, float) else f"{name} {value}"
            for name, value in self.__dict__.items()) + ">"


def evaluate(truth, predicted, positive="sharp"):
    """Score predicted classes against true ones.

    Parameters
    ----------
    truth : array_like, (n,), or Cloud
        Points of the class 255 (or -1) are left out.
    predicted : array_like, (n,), or Result
    positive : {'sharp', 'edge', 'boundary'}
        The classes that count as positive; ``'edge'`` is sharp-edge and smooth-edge.

    Returns
    -------
    Scores

    Raises
    ------
    UsageError
        Different numbers of points, or numbers that are no class.
    """
    truth = truth.labels if isinstance(truth, _clouds.Cloud) else truth
    predicted = predicted.labels if isinstance(predicted, Result) else predicted
    rows = len(_arrays.numbers(truth, "truth").reshape(-1))
    return Scores(_core.evaluate(_arrays.labels(truth, rows, "truth"),
                                 _arrays.labels(predicted, rows, "predicted"), positive))


def estimate_normals(xyz, normals=None, *, neighbours=0, viewpoint=None, threads=0,
                     progress=None):
    """Unit normals, consistent and outwards, as ``pcednet normals`` makes them.

    Parameters
    ----------
    xyz : array_like, (n, 3), or Cloud
        The normals of a Cloud do not count.
    normals : array_like, (n, 3), optional
        Keep these but for their signs; estimate only those that are ``(0, 0, 0)`` or not finite.
    neighbours : int
        Points around each to estimate from; 0: 12, more on noisy clouds.
    viewpoint : array_like, (3,) or (n, 3), optional
        Turn the normals to face it, rather than outwards. From a Cloud: its scanners.
    threads, progress
        As in :func:`classify`.

    Returns
    -------
    ndarray, (n, 3) float64
        ``(0, 0, 0)`` where there is none: not finite, or on a line of points.

    Raises
    ------
    UsageError, KeyboardInterrupt
        As :func:`classify`.

    Warns
    -----
    PcednetWarning
        Points without a normal.
    """
    positions, _, scanners = _clouds.points_of(xyz, None, viewpoint)
    given = _arrays.optional_vectors(normals, "normals", len(positions))
    with _arrays.reporting(progress) as report:
        made, _, unusable = _core.make_normals(positions, given, scanners, int(neighbours), report,
                                               _arrays.thread_count(threads))
    if unusable:
        _arrays.warn([f"{unusable} points without a normal: not finite, or on a line of points"])
    return made
