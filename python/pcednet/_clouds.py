"""Clouds of points with their fields."""

import hashlib

import numpy as np

from . import _arrays, _core


class Cloud:
    """The points of a file, or of arrays, with all their fields. Clouds can be pickled and copied.

    Wherever a function takes `xyz` it takes a Cloud as well, and uses its normals and scanners.

    Parameters
    ----------
    xyz : array_like, (n, 3)
        Positions. Kept as float64; files get float32 only where these are float32.
    normals : array_like, (n, 3), optional
        Of any length; files hold unit normals.
    colours : array_like, (n, 3) uint8, optional
    labels : array_like, (n,), optional
        0 non-edge, 1 smooth-edge, 2 sharp-edge, 3 boundary, 255 unlabelled; or numbers of
        ``class_names``.
    attributes : dict of str to array_like, (n,) or (n, k), optional
        Other numbers of the points, by name. Files get integers of 64 bits in 32 if they fit, unless they were read so.
    name : str, optional

    Attributes
    ----------
    xyz, normals, colours, labels, attributes, name
        As the parameters; unknown ones are None. Arrays may be changed in place or replaced.
    comments : list of str
    class_names : list of str
        The classes by number: those that the comments of the file name, or the edge classes.
    scanners : ndarray, (m, 3)
        Where the scanners of an E57 stood; the attribute ``scan`` says which saw a point.
    curves : list of Curve
        The true edges of a generated cloud.
    """

    def __init__(self, xyz, normals=None, colours=None, labels=None, attributes=None, name=""):
        xyz = _arrays.numbers(xyz, "xyz")
        self._is_float32 = _arrays.is_float32(xyz)
        self._kept, self._kept_rows = None, 0
        self._wide = frozenset()  # names of the attributes that have integers of 64 bits in the file
        self._estimates = None  # digest of positions and normals, if a file says that they are estimates
        self._predictions = None  # digest of the labels of a file that says that it is a result, or _CHANGED
        self.xyz = _arrays.vectors(xyz, "xyz")
        self.normals = normals
        self.colours = colours
        self.labels = labels
        self.attributes = dict(attributes or {})
        self.comments = []
        self.scanners = np.zeros((0, 3))
        self.curves = []
        self.name = name

    @classmethod
    def _of(cls, parts, name):
        cloud = cls(parts["xyz"], parts["normals"], parts["colours"], parts["labels"],
                    parts["attributes"], name)
        cloud.comments, cloud.scanners = parts["comments"], parts["scanners"]
        cloud._is_float32 = parts["is_float32"]
        cloud._kept, cloud._kept_rows = parts["kept"], len(cloud)
        cloud._wide = frozenset(name for name, values in cloud.attributes.items() if _arrays.is_wide(values))
        if _core.ESTIMATED_NORMALS in cloud.comments:
            cloud._estimates = _digest(cloud.xyz, cloud.normals)
        if cloud._truth_of_result() is not None:
            cloud._predictions = _digest(cloud.labels)
        return cloud

    def __len__(self):
        return len(self.xyz)

    def _class_lines(self):
        return _core.class_lines([str(line) for line in self.comments])

    @property
    def class_names(self):
        """list of str: the classes by number, from the comments or else the edge classes."""
        return _core.class_names(self._class_lines())

    def _has_estimates(self):
        """Whether the normals are those that pcednet once estimated for these points, as the file says."""
        return self._estimates is not None and self._estimates == _digest(self.xyz, self.normals)

    def __array__(self, dtype=None, copy=None):
        return np.array(self.xyz, dtype) if copy else np.asarray(self.xyz, dtype)

    def __getitem__(self, name):
        """The attribute `name`."""
        if not isinstance(name, str):
            raise TypeError(f"the name of an attribute is needed, not {type(name).__name__}; some points are "
                            "cloud.select(points), their positions cloud.xyz[points]")
        if name not in self.attributes:
            raise KeyError(f"no attribute {name!r}: there are {', '.join(map(str, self.attributes)) or 'none'}")
        return self.attributes[name]

    def __setitem__(self, name, values):
        self.attributes[name] = values

    def __repr__(self):
        fields = [name for name in ("normals", "colours", "labels")
                  if getattr(self, name) is not None] + list(self.attributes)
        return f"<Cloud {self.name!r}: {len(self)} points; {', '.join(fields) or 'no fields'}>"

    def _scalar(self, name):
        """The attribute `name`, also as CloudCompare spells it; None if there is none."""
        return self.attributes.get(f"scalar_{name}", self.attributes.get(name))

    def _own_labels(self):
        """The labels as uint8, with 255 for unlabelled; None if there are none."""
        return None if self.labels is None else _arrays.labels(self.labels, len(self), names=self.class_names)

    def _labels(self):
        """The labels, or else those of a column that other programs give to edges, with a warning, as for the program."""
        if self.labels is not None:
            return self._own_labels()
        columns = {str(name): _arrays.attribute(name, values, len(self)) for name, values in self.attributes.items()
                   if "edge" in str(name).lower() or "label" in str(name).lower()}
        labels, column = _core.edge_column(columns, len(self)) or (None, None)
        if column is not None:
            _arrays.warn([f"{self.name or 'the cloud'}: labels from its column {column}"])
        return labels

    def _classes(self):
        """What a classification left, unless the labels were changed since the result was read, otherwise the labels."""
        found = self._scalar("edge_class")
        return self._labels() if found is None or self._corrected() is not None else found

    def _has_float32(self):
        """Whether the positions are those of float32 and were not changed to others."""
        if not self._is_float32:
            return False
        xyz = _arrays.vectors(self.xyz, "xyz")
        with np.errstate(over="ignore"):
            return np.array_equal(xyz, xyz.astype(np.float32), equal_nan=True)

    def _has_predictions(self):
        """Whether the labels are those that a file of a result came with."""
        if self._predictions is None or self.labels is None:
            return False
        return self._predictions == _digest(self._own_labels())

    def _truth_of_result(self):
        columns = {name: _arrays.attribute(name, self.attributes[name], len(self))
                   for name in _core.TRUTH_COLUMNS + _core.RESULT_COLUMNS if name in self.attributes}
        return _core.truth_of_result([str(line) for line in self.comments], columns, self._own_labels())

    def _truth(self, name):
        """The labels to learn from or to score against. Of a result, as for the program: those that were painted or
        those of its input, with a warning that begins with `name`, unless the labels were changed since it was read."""
        found = self._truth_of_result() if self.labels is None or self._has_predictions() else None
        if found is None:
            return self._labels()
        labels, note = found
        _arrays.warn([f"{self.name or name}: {note}"])
        return self._labels() if labels is None else labels

    def _corrected(self):
        """The labels, if they were changed in a result since it was read: they are true; otherwise None."""
        if self._predictions is None or self.labels is None or self._truth_of_result() is None:
            return None
        return None if self._has_predictions() else self._own_labels()

    @property
    def faces(self):
        """int: how many faces the file has. Only their vertices are points; see :meth:`sample`."""
        return self._kept.faces if self._kept is not None and len(self) == self._kept_rows else 0

    def sample(self, points, seed=1):
        """Points on the faces of a mesh, uniform by area, as ``pcednet convert --sample`` makes them.

        Parameters
        ----------
        points : int
        seed : int

        Returns
        -------
        Cloud
            With the normals of the faces and, if the vertices have them, colours.

        Raises
        ------
        InsufficientError
            There are no faces, or they have no area.
        """
        parts = _core.sample_faces(self._parts(), _arrays.whole(points, "points", 1), _arrays.seed(seed))
        return Cloud._of(parts, self.name)

    def _parts(self):
        """As the extension takes a cloud."""
        rows, attributes = len(self), {}
        for name, values in self.attributes.items():
            array = _arrays.attribute(name, values, rows)
            attributes[str(name)] = array if name in self._wide else _arrays.narrowed(array)
        corrected = self._corrected()
        if corrected is not None:  # as labels alone, a reader of the file would take them for predictions
            attributes[PAINTED] = corrected
            for name in {"scalar_edge_class", "edge_class"} & set(attributes):  # what other programs show, and lines reads
                attributes[name] = corrected.astype(attributes[name].dtype)
        comments = [str(line) for line in self.comments
                    if line != _core.ESTIMATED_NORMALS or self._has_estimates()]
        return {"xyz": _arrays.vectors(self.xyz, "xyz"),
                "normals": _arrays.optional_vectors(self.normals, "normals", rows),
                "colours": _arrays.colours(self.colours, rows),
                "labels": self._own_labels(),
                "attributes": attributes, "comments": comments,
                "scanners": _arrays.vectors(self.scanners, "scanners"),
                "kept": self._kept if rows == self._kept_rows else None, "is_float32": self._is_float32}

    def viewpoint(self):
        """The scanner position of each point, (n, 3) float64 with NaN where unknown; None if no
        scanner is known."""
        known = _arrays.vectors(self.scanners, "scanners")
        scan = self.attributes.get("scan")
        if not np.isfinite(known).all(axis=1).any() or (scan is None and len(known) > 1):
            return None
        scan = np.zeros(len(self)) if scan is None else np.asarray(scan, np.float64)
        inside = (scan >= 0) & (scan < len(known))
        places = np.full((len(self), 3), np.nan)
        places[inside] = known[scan[inside].astype(np.int64)]
        return places

    def select(self, points):
        """The Cloud of some points.

        Parameters
        ----------
        points : array_like
            Indices, or a mask of (n,) bool.

        Returns
        -------
        Cloud
            With the coordinate system of the whole, without its faces.
        """
        chosen = _arrays.indices(points, len(self), "points")
        part = Cloud(np.asarray(self.xyz)[chosen], name=self.name)
        part._is_float32, part._wide = self._is_float32, self._wide
        for name in ("normals", "colours", "labels"):
            values = getattr(self, name)
            setattr(part, name, None if values is None else np.asarray(values)[chosen])
        part.attributes = {name: np.asarray(values)[chosen]
                           for name, values in self.attributes.items()}
        part.comments, part.scanners = list(self.comments), self.scanners
        if self._kept is not None:
            part._kept, part._kept_rows = self._kept.of_part(), len(part)
        if self._has_estimates():
            part._estimates = _digest(part.xyz, part.normals)
        if self._predictions is not None:
            part._predictions = _digest(part.labels) if self._has_predictions() else _CHANGED
        return part


_CHANGED = b""  # no labels have this digest
PAINTED = _core.TRUTH_COLUMNS[0]


def _digest(*arrays):
    digest = hashlib.blake2b()
    for array in arrays:
        digest.update(np.ascontiguousarray(array if array is not None else []))
    return digest.digest()


def points_of(xyz, normals=None, viewpoint=None, estimates=True, tells_of_faces=False):
    """Positions, whether they are as in float32, normals and scanners of a call, from arrays or from a Cloud, with or
    without normals that are estimates. `tells_of_faces`: a mesh is a warning."""
    if isinstance(xyz, Cloud):
        if tells_of_faces and xyz.faces:
            _arrays.warn([f"{xyz.name or 'the cloud'}: {xyz.faces} faces are not used, only their vertices: "
                          "Cloud.sample(n) samples points on faces"])
        is_float32 = xyz._has_float32()
        if normals is None and (estimates or not xyz._has_estimates()):
            normals = xyz.normals
        viewpoint = xyz.viewpoint() if viewpoint is None else viewpoint
        positions = _arrays.vectors(xyz.xyz, "xyz")
    else:
        array = _arrays.numbers(xyz, "xyz")
        is_float32, positions = _arrays.is_float32(array), _arrays.vectors(array, "xyz")
    return (positions, is_float32, _arrays.optional_vectors(normals, "normals", len(positions)),
            _arrays.scanners(viewpoint, len(positions)))
