"""Edges as curves."""

import math
import os

import numpy as np

from . import _arrays, _clouds, _core, _files
from ._classify import Result, classify, worded
from .errors import UsageError

_SHORT = {1: "smooth", 2: "sharp", 3: "boundary"}
_LONG = {"smooth-edge": "smooth", "sharp-edge": "sharp"}
_KINDS = ("segment", "arc", "circle", "polyline")


class Lines(list):
    """A list of Curve, in the unit and coordinates of their cloud. A slice of it is one, too."""

    _kept = None  # of the file of the cloud: its coordinate system
    _fit_tolerance = 0.0

    def _with(self, curves):
        """Lines of these curves, of the same cloud."""
        some = Lines(curves)
        some._kept, some._fit_tolerance = self._kept, self._fit_tolerance
        return some

    def __getitem__(self, index):
        found = super().__getitem__(index)
        return self._with(found) if isinstance(index, slice) else found

    def copy(self):
        """Lines of the same curves."""
        return self._with(self)

    @property
    def length(self):
        """The length of all curves together."""
        return sum(curve.length for curve in self)

    def write(self, path, *, epsg=None, unit=None, tolerance=0.0, dxf_version="2000",
              dxf_arcs="all", view="top", overwrite=False):
        """Write the curves in the format of the extension: .dxf, .gpkg, .geojson, .obj, .ply or .svg.

        Parameters
        ----------
        path : str or path-like
        epsg : int, optional
            Code of the coordinate system, for GeoPackage, GeoJSON and the unit of DXF. Unless given,
            that of the LAS file that the cloud was read from.
        unit : {'none', 'mm', 'cm', 'm', 'in', 'ft', 'us-ft'}, optional
            Of the coordinates. SVG: gives the drawing its true size.
        tolerance : float
            How far the polylines that stand for arcs may be from them, in formats without arcs;
            0: a thousandth of the radius, or the tolerance of the fit if that is less.
        dxf_version : {'2000', 'r12'}
        dxf_arcs : {'all', 'flat', 'none'}
            The arcs and circles of DXF that are such: all, those in horizontal planes, or none; the others
            are polylines, for programs that misplace arcs in tilted planes, as FreeCAD.
        view : {'top', 'front', 'side'}
            SVG: where it is seen from.
        overwrite : bool
            Replace an existing file.

        Raises
        ------
        ExistsError
            The file exists and `overwrite` is False.
        UsageError
            Another extension, a tolerance below 0, or a number that is no code of a coordinate
            system.
        """
        if not 0.0 <= _arrays.real(tolerance, "tolerance") < math.inf:
            raise UsageError(f"tolerance: {tolerance}: a length of 0 or more is needed")
        settings = {"epsg": None if epsg is None else _arrays.whole(epsg, "epsg", *_core.EPSG_CODES),
                    "unit": None if unit is None else _arrays.text(unit, "unit"),
                    "tolerance": float(tolerance), "fit_tolerance": self._fit_tolerance,
                    "dxf_version": str(dxf_version), "dxf_arcs": _arrays.text(dxf_arcs, "dxf_arcs"),
                    "view": _arrays.text(view, "view"), "overwrite": bool(overwrite)}
        _core.write_lines(os.fspath(path), list(self), settings, self._kept)

    def __repr__(self):
        return f"<Lines: {len(self)} curves, length {self.length:.6g}>"


def lines(xyz, labels=None, normals=None, *, p_sharp=None, p_smooth=None,
          classes=("sharp", "boundary"), kinds=_KINDS, boundaries=False, min_length=0.0, gap=0.0,
          angle=30.0, tolerance=0.0, regularise=False, min_confidence=0.0, stage="curves",
          viewpoint=None, threads=0, progress=None):
    """Draw the edges as curves that meet in corners: segments, arcs, circles and polylines.

    The curves are those of ``pcednet lines``.

    Parameters
    ----------
    xyz : array_like, (n, 3), or Cloud
    labels : Result or array_like (n,), optional
        A Result brings its normals and probabilities. None: those of a Cloud, its ``edge_class`` (which a
        classification leaves) or else its labels or a column ``is_edge``, ``edge`` or ``edge_label``, with its
        ``p_sharp`` and ``p_smooth``; without any, or if all are 255, the points are classified first.
    normals : array_like, (n, 3), optional
        With an array of labels. Estimated if missing.
    p_sharp, p_smooth : array_like, (n,), optional
        With an array of labels: probabilities, for the curves' confidences.
    classes : sequence of {'sharp', 'smooth', 'boundary'}
        The classes to draw; ``'smooth-edge'`` and ``'sharp-edge'`` are possible, too.
    kinds : sequence of {'segment', 'arc', 'circle', 'polyline'}
    boundaries : bool
        Also draw where the surface ends, as on roofs.
    min_length, gap, tolerance : float
        In the unit of the cloud: leave out shorter curves; join edge points over gaps up to it; how far points
        may be from their curve. 0: from the spacing.
    angle : float
        Degrees: curves are split where they bend by more.
    regularise : bool
        Make nearly parallel and nearly right angles exactly so.
    min_confidence : float
        Leave out curves whose points are edges with a lower mean probability.
    stage : {'curves', 'pieces', 'chains', 'creases'}
        Return the result of this step.
    viewpoint, threads, progress
        As in :func:`classify`.

    Returns
    -------
    Lines
        A list of Curve with ``write(path)``.

    Raises
    ------
    UsageError, InsufficientError, KeyboardInterrupt
        As :func:`classify`. A UsageError also for own classes without the edge classes.

    Warns
    -----
    PcednetWarning
        As :func:`classify`, and where options leave out every curve.
    """
    classes = _some(classes, _SHORT.values(), "classes", _LONG)
    kinds = _some(kinds, _KINDS, "kinds")
    if p_smooth is not None and p_sharp is None and not isinstance(xyz, _clouds.Cloud):
        raise UsageError("p_smooth: p_sharp is needed with it")
    min_confidence = _arrays.share(min_confidence, "min_confidence")
    if labels is None and isinstance(xyz, _clouds.Cloud):
        labels = xyz._classes()
        if labels is not None:
            labels = _arrays.labels(labels, len(xyz), names=xyz.class_names)
            if xyz.labels is not None and not np.array_equal(labels, xyz._own_labels()):
                _arrays.warn([f"{xyz.name or 'the cloud'}: its columns edge_class and label differ: edge_class is drawn"])
            labels = None if (labels == _arrays.UNLABELLED).all() else labels
        if labels is not None:
            _core.check_edges(xyz._class_lines(), "lines", False)
            p_sharp = _probability(xyz, "p_sharp") if p_sharp is None else p_sharp
            p_smooth = _probability(xyz, "p_smooth") if p_smooth is None else p_smooth
    told = labels is None
    if labels is None:
        labels = classify(xyz, normals, viewpoint=viewpoint, threads=threads, progress=progress)
    positions, is_float32, given, scanners = _clouds.points_of(xyz, normals, viewpoint, estimates=False,
                                                               tells_of_faces=not told)
    rows = len(positions)
    prepared = isinstance(labels, Result)
    if prepared:
        _arrays.check_result(labels, rows)
        _core.check_edges(labels.model._core.class_lines, "lines", False)
        positions = positions if labels._moved is None else _arrays.vectors(labels._moved, "positions", rows)
        # Averages of thick noise are made again, with normals of their own.
        given = None if labels._averaged else _arrays.vectors(labels.normals, "normals", rows)
        p_sharp, p_smooth, own = labels.p_sharp, labels.p_smooth, labels.class_names
        labels = _arrays.labels(labels.labels, rows, names=own)
    if p_sharp is None:
        p_smooth = None
    elif p_smooth is None:
        p_smooth = [0.0] * rows
    labels = _arrays.labels(labels, rows)
    lengths = {"min_length": min_length, "gap": gap, "angle": angle, "tolerance": tolerance}
    settings = {**{name: _arrays.real(value, name) for name, value in lengths.items()},
                "regularise": bool(regularise), "boundaries": bool(boundaries),
                "stage": _arrays.text(stage, "stage")}
    with _arrays.reporting(progress) as report:
        curves, notes, fit_tolerance = _core.find_lines(
            positions, is_float32, given, scanners, given is not None and prepared, labels,
            _arrays.probabilities(p_sharp, rows, "p_sharp"),
            _arrays.probabilities(p_smooth, rows, "p_smooth"), settings, report,
            _arrays.thread_count(threads))
    others = int(np.isin(labels, [0, 1, 2, 3, 255], invert=True).sum())
    if others and not prepared:
        notes.append(f"{others} labels are not edge classes (1 smooth, 2 sharp, 3 boundary): "
                     "counted as non-edge")
    found = Lines(curve for curve in curves
                  if _SHORT[curve.label] in classes and curve.kind in kinds
                  and curve.confidence >= min_confidence)
    if curves and not found:
        notes.append(f"all {len(curves)} curves are left out by classes, kinds or min_confidence")
    _arrays.warn(worded(notes))
    found._fit_tolerance = fit_tolerance
    found._kept = xyz._kept if isinstance(xyz, _clouds.Cloud) else None
    return found


def read_lines(path):
    """Read the lines of an OBJ (``l``) or PLY (``edge``) file, each as a polyline.

    Parameters
    ----------
    path : str or path-like

    Returns
    -------
    Lines

    Raises
    ------
    MissingFileError
        There is no such file.
    UnreadableError
        It is truncated or of another format.
    InsufficientError
        It has points but no lines.
    """
    return Lines(_core.read_curves(_files.existing(path)))


def _probability(cloud, name):
    values = cloud._scalar(name)
    values = None if values is None else _arrays.numbers(values, name)
    if values is not None and not ((values >= 0) & (values <= 1)).all():
        raise UsageError(f"{name}: not all numbers of the cloud are from 0 to 1")
    return values


def _some(names, known, what, longer=()):
    """The names as a list; ``longer`` has other names of some."""
    names = [names] if isinstance(names, str) else list(names)
    if not names:
        raise UsageError(f"{what}: at least one of {', '.join(known)} is needed")
    for name in names:
        if name not in known and name not in tuple(longer):
            raise UsageError(f"{what}: {name!r}: there are {', '.join(known)}")
    return [longer[name] if name in tuple(longer) else name for name in names]
