"""Classification of clouds, their descriptors and their normals."""

import numpy as np

from . import _arrays, _clouds, _core, _models
from .errors import UsageError


class Result:
    """The result of :func:`classify`, one row per point in the input's order.

    Attributes
    ----------
    labels : ndarray, (n,) uint8
        0 non-edge, 1 smooth-edge, 2 sharp-edge, 3 boundary (the sampled surface ends there), 255
        unlabelled (the position is not finite). Of a model of own classes: numbers of its
        ``class_names``.
    class_names : list of str
        The model's classes, by number.
    p_sharp, p_smooth : ndarray, (n,) float32
        The model's probabilities of sharp-edge and smooth-edge; 0 where unlabelled, and of a model
        without these classes. Boundary points keep the model's probabilities.
    p_class : ndarray, (n,) float32, or None
        Of a model of own classes: the probability of the point's class. None for edge classes
        alone, which have ``confidence``.
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
        self.p_class = parts["p_class"]
        self.class_names = model.class_names
        self.normals = parts["normals"]
        self._averaged = parts["averaged"]
        self._moved = parts["moved"]  # positions as they were described, if not those of the cloud
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
        if self.p_class is not None:
            unknown = self.labels == _arrays.UNLABELLED
            if self.class_names[3:4] == ["boundary"]:
                unknown |= self.labels == 3
            return np.where(unknown, np.float32(np.nan), self.p_class)
        of_label = np.select([self.labels == 2, self.labels == 1, self.labels == 0],
                             [self.p_sharp, self.p_smooth, 1 - self.p_sharp - self.p_smooth],
                             np.nan)
        return of_label.astype(np.float32)

    @property
    def counts(self):
        """dict: how many points have each label, by its name."""
        return {name: int(np.count_nonzero(self.labels == number))
                for name, number in _arrays.numbers_of(self.class_names).items()}

    def __len__(self):
        return len(self.labels)

    def __repr__(self):
        counts = ", ".join(f"{count} {name}" for name, count in self.counts.items() if count)
        return f"<Result of {len(self)} points: {counts}>"

    def _parts(self):
        rows = len(self.labels)
        return {"labels": _arrays.labels(self.labels, rows, names=self.class_names),
                "p_sharp": _arrays.probabilities(self.p_sharp, rows, "p_sharp"),
                "p_smooth": _arrays.probabilities(self.p_smooth, rows, "p_smooth"),
                "p_class": _arrays.probabilities(self.p_class, rows, "p_class"),
                "normals": _arrays.vectors(self.normals, "normals", rows),
                "made_normals": self.made_normals, "scales": self.scales,
                "model": self.model._core}


def classify(xyz, normals=None, *, model="general", threads=0, progress=None, viewpoint=None,
             context=True, boundary=True, keep_orientation=False, exact=False, s_min=0.0,
             s_max=0.0):
    """Label every point: non-edge, smooth-edge, sharp-edge or boundary; or with the classes of a
    model that was trained on others.

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
        Arrays of the wrong shape or type, or options out of range (a ValueError), such as an
        `s_min` larger than the cloud.
    InsufficientError
        No finite point, or points that form no surface (a ValueError).
    ModelError, MissingFileError
        The model cannot be used, or there is none of that name.
    KeyboardInterrupt
        Ctrl-C, as soon as the step at work ends.

    Warns
    -----
    PcednetWarning
        Normals were estimated or oriented, points are not finite, scales are unusual, `s_max` is
        larger than the cloud, float32 positions are rounded to more than the points are apart.

    Examples
    --------
    >>> result = pcednet.classify(xyz)
    >>> sharp = xyz[result.labels == 2]
    """
    positions, is_float32, given, scanners = _clouds.points_of(xyz, normals, viewpoint, keep_orientation, True)
    model = _models.model_of(model)
    core = model._core if context else model._core.without_context()
    given_scales = {name: value for name, value in (("s_min", s_min), ("s_max", s_max), ("exact", exact)) if value}
    if given_scales:
        core = core.with_settings(descriptor_settings(given_scales))
    with _arrays.reporting(progress) as report:
        parts = _core.classify(core, positions, is_float32, given, scanners, bool(boundary),
                               bool(keep_orientation), report, _arrays.thread_count(threads))
    estimates = given is None and normals is None and getattr(xyz, "normals", None) is not None
    parts["notes"] = worded(parts["notes"], estimates)
    if estimates:  # estimated again, with the signs of the file
        against = (parts["normals"] * np.asarray(xyz.normals)).sum(axis=1) < 0
        parts["normals"] = np.where(against[:, None], -parts["normals"], parts["normals"])
    _arrays.warn(parts["notes"])
    return Result(parts, model)


def worded(notes, estimates=False):
    """Notes of arrays, which come from no file, or of a Cloud with normals that are estimates."""
    given = "the normals in the file are estimates" if estimates else "no normals given"
    words = {"no normals in the file": given, "write them as double": "keep them as float64"}
    for said, ours in words.items():
        notes = [note.replace(said, ours) for note in notes]
    return notes


def describe(xyz, normals=None, *, scales=16, features=6, reconstruction="sphere", gate=None,
             second_gate=None, exact=False, eps=0.1, s_min=0.0, s_max=0.0, s_max_ratio=0.0,
             octaves=False, threads=0, progress=None, viewpoint=None, keep_orientation=False,
             return_scales=False):
    """The scale-space matrix: each point described by algebraic spheres of several sizes.

    The numbers are those of ``pcednet describe``.

    Parameters
    ----------
    xyz, normals, threads, progress, viewpoint, keep_orientation
        As in :func:`classify`.
    scales : {4, 8, 16, 32, 64, 128}
        Number of support radii.
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
        If not 0 and `s_max` is: `s_max` over `s_min`, for any extent of the cloud. A missing
        `s_min` is then the preferred number (1, 1.12, 1.25, ...) nearest to the spacing.
    octaves : bool
        With `s_max_ratio`: in clouds of uneven spacing, describe points at 2, 4 or 8 times larger
        scales where they are that much sparser. What models with octaves were made for.
    return_scales : bool
        Return the scales too.

    Returns
    -------
    matrix : ndarray, (n, scales, features) float32
        Free of units; 0 where a scale has no fit, and for a point whose position is not finite. Never NaN.
    scales : ndarray, (scales,) float64
        The support radii, smallest first, with octaves of the densest points; only if
        `return_scales`.

    Raises
    ------
    UsageError, InsufficientError, KeyboardInterrupt
        As :func:`classify`.

    Warns
    -----
    PcednetWarning
        As :func:`classify`.
    """
    positions, is_float32, given, scanners = _clouds.points_of(xyz, normals, viewpoint, keep_orientation, True)
    settings = descriptor_settings({
        "scales": scales, "features": features, "reconstruction": reconstruction, "gate": gate,
        "second_gate": second_gate, "exact": exact, "eps": eps, "s_min": s_min, "s_max": s_max,
        "s_max_ratio": s_max_ratio, "octaves": octaves})
    with _arrays.reporting(progress) as report:
        matrix, radii, notes = _core.describe(positions, is_float32, given, scanners,
                                              bool(keep_orientation), settings, report, _arrays.thread_count(threads))
    _arrays.warn(worded(notes))
    return (matrix, radii) if return_scales else matrix


def descriptor_settings(options):
    """Options of a descriptor as the extension takes them."""
    def checked(name, value):
        if name in ("scales", "features"):
            return _arrays.whole(value, name)
        if name == "reconstruction":
            return _arrays.text(value, name)
        if name in ("exact", "octaves"):
            return bool(value)
        without = value is None and name in ("gate", "second_gate")
        return None if without else _arrays.real(value, name)

    settings = {name: checked(name, value) for name, value in options.items()}
    if settings.get("octaves") and not settings.get("s_max_ratio"):
        raise UsageError("octaves: an s_max_ratio is needed with it")
    return settings


def estimate_normals(xyz, normals=None, *, neighbours=0, viewpoint=None, threads=0,
                     progress=None):
    """Unit normals, consistent and outwards, as ``pcednet normals`` makes them.

    Parameters
    ----------
    xyz : array_like, (n, 3), or Cloud
        The normals of a Cloud are ignored.
    normals : array_like, (n, 3), optional
        Keep these except for their signs; estimate only those that are ``(0, 0, 0)`` or not finite.
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
    positions, _, _, scanners = _clouds.points_of(xyz, None, viewpoint)
    given = _arrays.optional_vectors(normals, "normals", len(positions))
    with _arrays.reporting(progress) as report:
        made, unusable = _core.make_normals(positions, given, scanners, _arrays.whole(neighbours, "neighbours"),
                                            report, _arrays.thread_count(threads))
    if unusable:
        _arrays.warn([f"{unusable} points without a normal: not finite, or on a line of points"])
    return made
