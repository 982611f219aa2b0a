"""Edges in 3D point clouds.

>>> import pcednet
>>> result = pcednet.classify(xyz)                     # (n, 3) positions of any kind
>>> sharp = xyz[result.labels == 2]
>>> pcednet.lines(xyz, result).write("edges.dxf")

Arrays go in and come out whole, in the input's order. Work is done on every core without Python's
lock; Ctrl-C stops it; anything that deserves a look is a warning.
"""

from ._classify import Result, classify, describe, estimate_normals
from ._clouds import Cloud
from ._core import Curve, __version__
from ._files import generate, read, write
from ._lines import Lines, lines, read_lines
from ._models import Model, shipped_models
from ._scores import LineScores, Scores, evaluate, evaluate_lines
from ._train import train
from .errors import (Error, ExistsError, FailureError, InsufficientError, MissingFileError,
                     ModelError, PcednetWarning, UnreadableError, UsageError)

NON_EDGE, SMOOTH_EDGE, SHARP_EDGE, BOUNDARY, UNLABELLED = 0, 1, 2, 3, 255

__all__ = ["classify", "describe", "train", "evaluate", "evaluate_lines", "estimate_normals", "lines",
           "read_lines", "generate", "read", "write", "shipped_models", "Model", "Result", "Cloud", "Curve", "Lines",
           "Scores", "LineScores", "NON_EDGE", "SMOOTH_EDGE", "SHARP_EDGE", "BOUNDARY", "UNLABELLED", "Error",
           "UsageError", "ExistsError", "UnreadableError", "MissingFileError",
           "InsufficientError", "ModelError", "FailureError", "PcednetWarning", "__version__"]
