"""Clouds that are read, written and generated."""

import os

import numpy as np

from . import _arrays, _core
from ._clouds import PAINTED, Cloud
from .errors import MissingFileError, UsageError


def existing(path):
    path = os.fsdecode(path)
    if not os.path.exists(path):
        raise MissingFileError(f"{path}: no such file")
    return path


def read(path):
    """Read a point file: PLY, PCD, OBJ, OFF, STL, LAS, LAZ, COPC, E57, PTX or text.

    Parameters
    ----------
    path : str or path-like

    Returns
    -------
    Cloud
        In the order of the file. Normals are made unit, ``(0, 0, 0)`` where unusable.

    Raises
    ------
    MissingFileError
        There is no such file.
    UnreadableError
        It is truncated or not of a known format; the message has the line or byte.
    InsufficientError
        It does not hold points with x, y and z.

    Warns
    -----
    PcednetWarning
        Remarks of the reader, such as positions that are not finite.
    """
    path = existing(path)
    parts, notes = _core.read(path)
    _arrays.warn(f"{path}: {note}" for note in notes)
    return Cloud._of(parts, os.path.splitext(os.path.basename(path))[0])


def write(path, xyz, result=None, *, normals=None, colours=None, labels=None, attributes=None,
          class_colours=False, ascii=False, overwrite=False):
    """Write a point file in the format of its extension: .ply, .pcd, .las, .laz, .copc.laz, .obj,
    .xyz, .txt, .asc, .pts or .csv.

    The file appears under its name only when it is complete.

    Parameters
    ----------
    path : str or path-like
    xyz : Cloud or array_like, (n, 3)
        The points. A Cloud that was read keeps everything that its file held, coordinates bit for
        bit. From an array, float32 coordinates are written as float32, others as float64. Labels that were
        changed in a result since it was read are true: they are written as ``scalar_painted_label``, too.
    result : Result, optional
        Adds class and probabilities, under the names that ``pcednet classify`` gives them.
    normals, colours, labels, attributes : optional
        With an array of points: as in Cloud.
    class_colours : bool
        Colour the points by class even if they have colours.
    ascii : bool
        Numbers as text in formats that have both.
    overwrite : bool
        Replace an existing file.

    Raises
    ------
    ExistsError
        The file exists and `overwrite` is False.
    UsageError
        Another extension, or arrays that do not fit together.
    FailureError
        The disk is full, or the folder is missing.

    Warns
    -----
    PcednetWarning
        Data that the format cannot hold. Changed labels replace some that were painted.
    """
    if isinstance(xyz, Cloud):
        if any(part is not None for part in (normals, colours, labels, attributes)):
            raise UsageError("write: set the fields of the Cloud instead")
        cloud = xyz
    else:
        cloud = Cloud(xyz, normals, colours, labels, attributes)
    parts = None
    if result is not None:
        _arrays.check_result(result, len(cloud))
        parts = result._parts()
    path, written = os.fsdecode(path), cloud._parts()
    losses = _core.write(path, written, parts, bool(class_colours), bool(ascii), bool(overwrite))
    _arrays.warn(f"{path} does not keep: {loss}" for loss in losses)
    painted = np.asarray(cloud.attributes.get(PAINTED, ()))
    if (painted == 255).any() and (painted != 255).any() and not np.array_equal(
            painted, written["attributes"][PAINTED]):
        _arrays.warn([f"{path}: the labels, which were changed since the cloud was read, replace its {PAINTED}"])


def generate(name="default", seed=1, only=""):
    """Labelled clouds of generated shapes, those that the shipped models are trained on.

    Parameters
    ----------
    name : {'default', 'cad', 'worn', 'scan', 'varied', 'sparse', 'drawn', 'pieces', 'lines', 'sample'}
        The set, as in ``pcednet generate``; ``'sample'`` is the building of the demo.
    seed : int
    only : str
        Only the clouds with this in their names.

    Yields
    ------
    Cloud
        With ``name``, ``labels``, mostly ``normals``, and the true edges as ``curves``. Each is
        made when it is asked for.

    Raises
    ------
    UsageError
        There is no such set, or no such cloud in it.
    """
    recipes = [recipe for recipe in _core.recipes(_arrays.text(name, "name"), _arrays.seed(seed))
               if only in recipe.name]
    if not recipes:
        raise UsageError(f"generate: no cloud of {name} has {only!r} in its name")
    return (_made(recipe) for recipe in recipes)


def _made(recipe):
    parts, curves = recipe.make()
    cloud = Cloud._of(parts, recipe.name)
    cloud.curves = curves
    return cloud
