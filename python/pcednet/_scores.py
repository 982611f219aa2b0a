"""Scores of labels and of lines."""

import json

import numpy as np

from . import _arrays, _clouds, _core
from ._classify import Result
from .errors import InsufficientError, UsageError


class _Values:
    """Numbers by name."""

    def __init__(self, values):
        self.__dict__.update(values)

    def __repr__(self):
        return f"<{type(self).__name__}: " + ", ".join(
            f"{name} {value:.3f}" if isinstance(value, float) else f"{name} {value}"
            for name, value in self.__dict__.items()) + ">"


class Scores(_Values):
    """The scores of Himeur et al. 2021, appendix B; one whose denominator is zero is 0.

    Attributes
    ----------
    precision, recall, mcc, f1, accuracy, iou : float
    tp, fp, tn, fn : int
    """


class LineScores(_Values):
    """The scores of lines of ``pcednet evaluate --truth``; lengths are relative to the cloud. A score that has no
    value without lines is NaN.

    Attributes
    ----------
    lines, true_curves : int
    cd, hd : float
        Mean squared and largest distances, both ways.
    precision_01, recall_01, precision_02, recall_02 : float
        Shares of the length within .01 and .02 of the other side.
    found, pieces, corners : float
        True curves that one line covers; lines on a true curve; F1 of ends and bends.
    """


def evaluate(truth, predicted, positive="sharp"):
    """Score predicted edge classes against true ones.

    Parameters
    ----------
    truth : array_like, (n,), Result, or Cloud
        Points of the class 255 (or -1) are left out. Of a Cloud: its labels; if it was read from a result of pcednet,
        the labels that were painted or those of its input, with a warning, unless its labels were changed since.
    predicted : array_like, (n,), Result, or Cloud
        Of a Cloud: its ``edge_class``, which a classification leaves, or else its labels.
    positive : {'sharp', 'edge', 'boundary'}
        The classes that count as positive; ``'edge'`` is sharp-edge and smooth-edge.

    Returns
    -------
    Scores

    Raises
    ------
    UsageError
        Different numbers of points, numbers that are not classes, or own classes.
    InsufficientError
        A Cloud without labels, or no labelled point in `truth`.

    Warns
    -----
    PcednetWarning
        `truth` is a Cloud that was read from a result of pcednet. With ``'sharp'``, `truth` or `predicted` has
        smooth-edge points and no sharp-edge one, as where edges are marked by 1: scores are 0.
    """
    for one in (truth, predicted):
        if isinstance(one, Result):
            _core.check_edges(one.model._core.class_lines, "scores", True)
        elif isinstance(one, _clouds.Cloud):
            _core.check_edges(one._class_lines(), "scores", True)
    if isinstance(truth, _clouds.Cloud):
        truth = truth._truth("truth")
    elif isinstance(truth, Result):
        truth = truth.labels
    if isinstance(predicted, Result):
        predicted = predicted.labels
    elif isinstance(predicted, _clouds.Cloud):
        predicted = predicted._classes()
    for name, labels in (("truth", truth), ("predicted", predicted)):
        if labels is None:
            raise InsufficientError(f"{name}: the cloud has no labels")
    rows = len(_arrays.numbers(truth, "truth").reshape(-1))
    truth = _arrays.labels(truth, rows, "truth", strict=True)
    predicted = _arrays.labels(predicted, rows, "predicted", strict=True)
    positive = _arrays.text(positive, "positive")
    if (truth == _arrays.UNLABELLED).all():
        raise InsufficientError("truth: no point is labelled")
    scores = Scores(_core.evaluate(truth, predicted, positive))
    for name, labels in (("truth", truth), ("predicted", predicted)):
        note = _core.none_is_positive(*(int(np.count_nonzero(labels == edge)) for edge in (1, 2)), positive)
        _arrays.warn([f"{name}: {note}"] if note else [])
    return scores


def _curves(some, name):
    curves = list(some) if not isinstance(some, _clouds.Cloud) else [some]
    if not all(isinstance(one, _core.Curve) for one in curves):
        raise UsageError(f"{name}: Lines, or a list of Curve, are needed; those of a file are pcednet.read_lines(path)")
    return curves


def evaluate_lines(truth, predicted, cloud=None):
    """Score lines against true curves, of all classes on both sides.

    Parameters
    ----------
    truth, predicted : Lines or sequence of Curve
        As ``Cloud.curves`` of :func:`generate`, :func:`lines` and :func:`read_lines` give them.
    cloud : array_like, (n, 3), or Cloud, optional
        The points: lengths are relative to these, or else to the box of the true curves.

    Returns
    -------
    LineScores

    Raises
    ------
    UsageError
        No curves of pcednet.
    InsufficientError
        No true curves, or points that all coincide.
    """
    points = None if cloud is None else _clouds.points_of(cloud)[0]
    text = _core.score_lines(_curves(predicted, "predicted"), _curves(truth, "truth"), points)
    scores = json.loads(text)["clouds"][0]
    return LineScores({name: float("nan") if value is None else value
                       for name, value in scores.items() if name != "name"})
