"""Training and classification in scikit-learn's way, for its tools for choosing parameters and for
pipelines. Needs scikit-learn, which nothing else in pcednet does."""

import numpy as np
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.utils.validation import check_is_fitted

from . import _arrays
from ._classify import classify
from ._models import model_of
from ._train import train
from .errors import UsageError

__all__ = ["EdgeClassifier"]


class EdgeClassifier(ClassifierMixin, BaseEstimator):
    """Edges of one cloud, learnt from labelled points and found in other clouds.

    The rows of `X` are the points of one cloud, which describe each other: a row alone means
    nothing, and splitting rows at random thins the cloud. To fit to several clouds use
    :func:`pcednet.train`.

    Parameters
    ----------
    start : str, path-like or Model, optional
        The model of edge classes to start from, such as ``"general"``; None trains a new network.
    classes : {3, 2}
    seed : int
    epochs : int, optional
    context : bool
    balance : float
    threads : int
        All as in :func:`pcednet.train`.

    Attributes
    ----------
    model_ : Model
    classes_ : ndarray of int
        0 non-edge, 1 smooth-edge, 2 sharp-edge.
    n_features_in_ : int
        3, or 6 with normals.
    """

    def __init__(self, *, start=None, classes=3, seed=1, epochs=None, context=False, balance=1.0,
                 threads=0):
        self.start = start
        self.classes = classes
        self.seed = seed
        self.epochs = epochs
        self.context = context
        self.balance = balance
        self.threads = threads

    def fit(self, X, y):
        """Train on the points of a cloud.

        Parameters
        ----------
        X : array_like, (n, 3) or (n, 6)
            Positions, or positions and normals.
        y : array_like, (n,)
            The class of each point; -1 and 255 are not learnt from.

        Returns
        -------
        self
        """
        xyz, normals = self._split(X)
        if self.start is not None and tuple(model_of(self.start).class_names) != _arrays.EDGES:
            raise UsageError("start: a model of the edge classes alone is needed")
        self.model_ = train(xyz, y, normals=normals, start=self.start, classes=self.classes,
                            seed=self.seed, epochs=self.epochs, context=self.context,
                            balance=self.balance, threads=self.threads)
        self.classes_ = np.array(self.model_.classes)
        self.n_features_in_ = 3 if normals is None else 6
        return self

    def predict(self, X):
        """The class of every point, (n,) int64, one of ``classes_``; 255 where a position is not
        finite."""
        return self._found(X).labels.astype(np.int64)

    def predict_proba(self, X):
        """The probability of every class, (n, classes) float64; rows sum to 1, or are NaN where a
        position is not finite."""
        found = self._found(X)
        sharp, smooth = found.p_sharp.astype(np.float64), found.p_smooth.astype(np.float64)
        by_class = {0: 1 - sharp - smooth, 1: smooth, 2: sharp}
        p = np.column_stack([by_class[label] for label in self.classes_])
        p[found.labels == 255] = np.nan
        return p

    def _found(self, X):
        check_is_fitted(self)
        xyz, normals = self._split(X)
        columns = 3 if normals is None else 6
        if columns != self.n_features_in_:
            raise UsageError(f"X has {columns} features, but {type(self).__name__} is expecting "
                             f"{self.n_features_in_} features as input")
        return classify(xyz, normals, model=self.model_, boundary=False, threads=self.threads)

    def _split(self, X):
        X = _arrays.numbers(X, "X")
        if X.ndim != 2 or X.shape[1] not in (3, 6):
            raise UsageError(f"X: shape (n, 3) or (n, 6) is needed, not {X.shape}")
        return X[:, :3], X[:, 3:] if X.shape[1] == 6 else None
