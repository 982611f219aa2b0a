"""Models: networks with their descriptors."""

import os
import pathlib
import tempfile

import numpy as np

from . import _arrays, _classify, _core, _files, _onnx, _train
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
    """A trained network with its descriptor.

    Made by :func:`train`, :meth:`load` or :meth:`adapt`. Models can be pickled.

    Attributes
    ----------
    name : str
    seed : int
    classes : list of int
        The class of each output: ``[0, 1, 2]``, or ``[0, 2]`` without smooth-edge; of own classes
        their numbers.
    class_names : list of str
        The names of classes by number: the edge classes or own ones.
    descriptor : dict
        The description of a point: ``scales``, ``features`` per scale, ... as
        ``describe(xyz, **model.descriptor)`` takes them. ``s_min``, ``s_max``, ``exact`` and ``eps`` are in it if
        the model was trained here with them; a file does not keep them.
    columns : list of str
        The names of the numbers per scale.
    has_context : bool
        Whether a context network refines the result from the predictions around each point.
    weights : int
        Parameters of the first network and of its context network, without those of experts.
    metadata : dict of str to str
        The file's metadata on the first network and its training.
    history : list of dict
        For a model trained here: ``epoch``, ``loss`` and, with enough points, ``validation_loss``
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
            The file is damaged, or not an edge model.
        """
        shipped = _SHIPPED / f"{os.fsdecode(name)}.safetensors"
        if not os.path.isfile(name) and shipped.exists():
            return cls(_core.EdgeModel(shipped))
        try:
            return cls(_core.EdgeModel(_files.existing(name)))
        except FileNotFoundError as error:
            raise type(error)(f"{os.fsdecode(name)}: neither a file nor a shipped model "
                              f"({', '.join(shipped_models())})") from None

    def save(self, path, *, overwrite=False):
        """Write a model file (.safetensors), which ``pcednet classify --model`` takes too.

        The same model gives the same bytes. A path that ends in ``.onnx`` (in any case) gets the first network,
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
            Another extension. ONNX: of a CNN, or of a model trained with another symmetry than its average.

        Warns
        -----
        PcednetWarning
            The file does not keep the ``s_min``, ``s_max``, ``exact`` or ``eps`` of the training: give them to
            :func:`classify`.
        """
        path = os.fsdecode(path)
        extension = os.path.splitext(path)[1].lower()
        if extension == ".safetensors":
            self._core.save(path, overwrite)
            lost = self._unsaved()
            _arrays.warn([f"{path}: does not keep {', '.join(lost)}, which the model was trained with: give "
                          "s_min, s_max and exact to classify"] if lost else [])
            return
        if extension != ".onnx":
            raise UsageError(f"{path}: a name that ends in .safetensors or .onnx is needed")
        facts = {"name": self.name, "classes": str(self.classes), "columns": str(self.columns),
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
        return _classify.classify(xyz, normals, model=self, **options)

    def adapt(self, clouds, labels, **options):
        """:func:`train` with ``start=`` this model."""
        return _train.train(clouds, labels, start=self, **options)

    def predict(self, descriptors):
        """The predictions of the first network for described points, without context.

        Parameters
        ----------
        descriptors : array_like, (n, scales, features)
            As :func:`describe` gives them with this model's ``descriptor``. It has zeros for a point without
            a finite position, which :func:`classify` leaves unlabelled.

        Returns
        -------
        ndarray, (n, classes) float32
            The probability of each of ``classes``; rows sum to 1, or are NaN where a number of the
            description is not finite.
        """
        rows = _arrays.numbers(descriptors, "descriptors")
        shape = (self.descriptor["scales"], len(self.columns))
        if rows.shape[1:] not in (shape, (shape[0] * shape[1],)):
            raise UsageError(f"descriptors: shape (n, {shape[0]}, {shape[1]}) is needed, not "
                             f"{rows.shape}")
        rows = np.require(rows, np.float32, ["C", "A"])
        predicted = self._core.network.predict(rows)
        predicted[~np.isfinite(rows).all(axis=tuple(range(1, rows.ndim)))] = np.nan
        return predicted

    @property
    def name(self):
        """str: the name in the file; it may be set."""
        return self._core.name

    @name.setter
    def name(self, name):
        self._core.name = str(name)

    @property
    def seed(self):
        """int: the seed of the training."""
        return self._core.seed

    @property
    def classes(self):
        """list of int: the class of each output."""
        return self._core.classes

    @property
    def class_names(self):
        """list of str: the names of classes by number."""
        return _core.class_names(self._core.class_lines)

    @property
    def columns(self):
        """list of str: the names of the numbers per scale."""
        return self._core.columns

    @property
    def descriptor(self):
        """dict: the description of a point, as ``describe(xyz, **model.descriptor)`` takes it."""
        return self._core.descriptor

    @property
    def has_context(self):
        """bool: whether a context network refines the result."""
        return self._core.context is not None

    @property
    def weights(self):
        """int: the parameters of the first network and of its context network."""
        context = self._core.context
        return self._core.network.weights + (context.weights if context is not None else 0)

    @property
    def metadata(self):
        """dict of str to str: the file's metadata on the first network and its training."""
        return self._core.network.metadata

    def _unsaved(self):
        """The settings of the descriptor that a file does not keep."""
        return {name: value for name, value in self.descriptor.items() if name in ("s_min", "s_max", "exact", "eps")}

    def __reduce__(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "model.safetensors"
            self._core.save(path, False)
            return _unpickled, (path.read_bytes(), self.history, self._unsaved())

    def __repr__(self):
        return f"<Model {self.name!r}: classes {self.classes}, {self.weights} weights>"


def _unpickled(content, history, settings=None):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "model.safetensors"
        path.write_bytes(content)
        return Model(_core.EdgeModel(path).with_settings(settings or {}), history)


def model_of(model):
    return model if isinstance(model, Model) else Model.load(model)
