import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Literal, Protocol, SupportsIndex, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import Error as Error
from .errors import ExistsError as ExistsError
from .errors import FailureError as FailureError
from .errors import InsufficientError as InsufficientError
from .errors import MissingFileError as MissingFileError
from .errors import ModelError as ModelError
from .errors import PcednetWarning as PcednetWarning
from .errors import UnreadableError as UnreadableError
from .errors import UsageError as UsageError

_Path = str | bytes | os.PathLike[str] | os.PathLike[bytes]
_Points = ArrayLike | "Cloud"
_Labels = ArrayLike | Mapping[Any, ArrayLike]
_Set = Literal["default", "cad", "worn", "scan", "varied", "sparse", "drawn", "pieces",
               "lines", "sample"]
_Positive = Literal["sharp", "edge", "boundary"]
_Class = Literal["smooth", "sharp", "boundary", "smooth-edge", "sharp-edge"]
_Kind = Literal["segment", "arc", "circle", "polyline"]

class _Bar(Protocol):
    total: Any
    n: Any
    def update(self, n: Any, /) -> Any: ...

_Progress = Callable[[str, float], Any] | _Bar | type | None

__version__: str
NON_EDGE: int
SMOOTH_EDGE: int
SHARP_EDGE: int
BOUNDARY: int
UNLABELLED: int

class Cloud:
    xyz: NDArray[np.float64]
    normals: Any
    colours: Any
    labels: Any
    attributes: dict[str, Any]
    comments: list[str]
    scanners: Any
    curves: list[Curve]
    name: str
    @property
    def class_names(self) -> list[str]: ...
    def __init__(self, xyz: ArrayLike, normals: ArrayLike | None = None,
                 colours: ArrayLike | None = None, labels: ArrayLike | None = None,
                 attributes: Mapping[str, ArrayLike] | None = None, name: str = "") -> None: ...
    def __len__(self) -> int: ...
    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]: ...
    def __getitem__(self, name: str) -> Any: ...
    def __setitem__(self, name: str, values: ArrayLike) -> None: ...
    @property
    def faces(self) -> int: ...
    def sample(self, points: int, seed: int = 1) -> Cloud: ...
    def viewpoint(self) -> NDArray[np.float64] | None: ...
    def select(self, points: ArrayLike) -> Cloud: ...

class Curve:
    @property
    def kind(self) -> _Kind: ...
    @property
    def label(self) -> int: ...
    @property
    def points(self) -> NDArray[np.float64]: ...
    @property
    def closed(self) -> bool: ...
    @property
    def centre(self) -> NDArray[np.float64]: ...
    @property
    def axis(self) -> NDArray[np.float64]: ...
    @property
    def radius(self) -> float: ...
    @property
    def confidence(self) -> float: ...
    @property
    def dihedral_angle(self) -> float: ...
    @property
    def support(self) -> int: ...
    @property
    def length(self) -> float: ...
    def sampled(self, tolerance: float) -> NDArray[np.float64]: ...

class Lines(list[Curve]):
    @overload
    def __getitem__(self, index: SupportsIndex, /) -> Curve: ...
    @overload
    def __getitem__(self, index: slice, /) -> Lines: ...
    def copy(self) -> Lines: ...
    @property
    def length(self) -> float: ...
    def write(self, path: _Path, *, epsg: int | None = None,
              unit: Literal["none", "mm", "cm", "m", "in", "ft", "us-ft"] | None = None,
              tolerance: float = 0.0, dxf_version: Literal["2000", "r12"] = "2000",
              dxf_arcs: Literal["all", "flat", "none"] = "all",
              view: Literal["top", "front", "side"] = "top", overwrite: bool = False) -> None: ...

class Result:
    labels: NDArray[np.uint8]
    p_sharp: NDArray[np.float32]
    p_smooth: NDArray[np.float32]
    p_class: NDArray[np.float32] | None
    class_names: list[str]
    normals: NDArray[np.float64]
    made_normals: bool
    scales: tuple[float, float]
    model: Model
    notes: list[str]
    @property
    def p_edge(self) -> NDArray[np.float32]: ...
    @property
    def confidence(self) -> NDArray[np.float32]: ...
    @property
    def counts(self) -> dict[str, int]: ...
    def __len__(self) -> int: ...

class Scores:
    precision: float
    recall: float
    mcc: float
    f1: float
    accuracy: float
    iou: float
    tp: int
    fp: int
    tn: int
    fn: int

class LineScores:
    lines: int
    true_curves: int
    cd: float
    hd: float
    precision_01: float
    recall_01: float
    precision_02: float
    recall_02: float
    found: float
    pieces: float
    corners: float

class Model:
    name: str
    history: list[dict[str, Any]]
    @classmethod
    def load(cls, name: _Path = "general") -> Model: ...
    def save(self, path: _Path, *, overwrite: bool = False) -> None: ...
    def classify(self, xyz: _Points, normals: ArrayLike | None = None,
                 **options: Any) -> Result: ...
    def adapt(self, clouds: _Points | Sequence[_Points],
              labels: _Labels | Sequence[_Labels] | None, **options: Any) -> Model: ...
    def predict(self, descriptors: ArrayLike) -> NDArray[np.float32]: ...
    @property
    def seed(self) -> int: ...
    @property
    def classes(self) -> list[int]: ...
    @property
    def class_names(self) -> list[str]: ...
    @property
    def columns(self) -> list[str]: ...
    @property
    def descriptor(self) -> dict[str, Any]: ...
    @property
    def has_context(self) -> bool: ...
    @property
    def weights(self) -> int: ...
    @property
    def tensors(self) -> dict[str, NDArray[np.float32]]: ...
    @property
    def metadata(self) -> dict[str, str]: ...

def shipped_models() -> list[str]: ...
def read(path: _Path) -> Cloud: ...
def write(path: _Path, xyz: _Points, result: Result | None = None, *,
          normals: ArrayLike | None = None, colours: ArrayLike | None = None,
          labels: ArrayLike | None = None, attributes: Mapping[str, ArrayLike] | None = None,
          class_colours: bool = False, ascii: bool = False, overwrite: bool = False) -> None: ...
def generate(name: _Set = "default", seed: int = 1, only: str = "") -> Iterator[Cloud]: ...
def classify(xyz: _Points, normals: ArrayLike | None = None, *, model: _Path | Model = "general",
             threads: int = 0, progress: _Progress = None, viewpoint: ArrayLike | None = None,
             context: bool = True, boundary: bool = True, keep_orientation: bool = False,
             exact: bool = False, s_min: float = 0.0, s_max: float = 0.0) -> Result: ...
def describe(xyz: _Points, normals: ArrayLike | None = None, *, scales: int = 16,
             features: int = 6,
             reconstruction: Literal["sphere", "sphere-mls", "covariance-plane",
                                     "plane-mls"] = "sphere",
             gate: float | None = None, second_gate: float | None = None, exact: bool = False,
             eps: float = 0.1, s_min: float = 0.0, s_max: float = 0.0, s_max_ratio: float = 0.0,
             octaves: bool = False, threads: int = 0, progress: _Progress = None, viewpoint: ArrayLike | None = None,
             keep_orientation: bool = False, return_scales: bool = False) -> Any: ...
def train(clouds: _Points | Sequence[_Points], labels: _Labels | Sequence[_Labels] | None = None,
          *, normals: ArrayLike | Sequence[ArrayLike] | None = None,
          start: _Path | Model | None = None, name: str = "model", classes: Literal[2, 3] = 3,
          seed: int = 1, epochs: int | None = None, context: bool = False, balance: float = 1.0,
          distil: int = 0, recipe: Literal["adam", "paper"] = "adam",
          network: Literal["pcednet", "fc", "cnn"] = "pcednet", threads: int = 0,
          progress: _Progress = None, keep_orientation: bool = False,
          **descriptor: Any) -> Model: ...
def evaluate(truth: ArrayLike | Result | Cloud, predicted: ArrayLike | Result | Cloud,
             positive: _Positive = "sharp") -> Scores: ...
def evaluate_lines(truth: Sequence[Curve], predicted: Sequence[Curve],
                   cloud: _Points | None = None) -> LineScores: ...
def read_lines(path: _Path) -> Lines: ...
def estimate_normals(xyz: _Points, normals: ArrayLike | None = None, *, neighbours: int = 0,
                     viewpoint: ArrayLike | None = None, threads: int = 0,
                     progress: _Progress = None) -> NDArray[np.float64]: ...
def lines(xyz: _Points, labels: Result | ArrayLike | None = None,
          normals: ArrayLike | None = None, *, p_sharp: ArrayLike | None = None,
          p_smooth: ArrayLike | None = None,
          classes: _Class | Sequence[_Class] = ("sharp", "boundary"),
          kinds: _Kind | Sequence[_Kind] = ("segment", "arc", "circle", "polyline"),
          boundaries: bool = False, min_length: float = 0.0, gap: float = 0.0,
          angle: float = 30.0, tolerance: float = 0.0, regularise: bool = False,
          min_confidence: float = 0.0,
          stage: Literal["curves", "pieces", "chains", "creases"] = "curves",
          viewpoint: ArrayLike | None = None, threads: int = 0,
          progress: _Progress = None) -> Lines: ...
