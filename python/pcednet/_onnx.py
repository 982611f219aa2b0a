"""A network as an ONNX file (https://onnx.ai), written without the onnx package."""

import json

import numpy as np

from .errors import UsageError

_OPSET, _IR_VERSION = 9, 4
_FLOAT = 1  # of TensorProto.DataType, and of AttributeProto.AttributeType


# Protocol buffers: a field is its number and wire type, then its bytes.

def _varint(number):
    out = b""
    while number > 0x7F:
        out += bytes([number & 0x7F | 0x80])
        number >>= 7
    return out + bytes([number])


def _field(number, value):
    if isinstance(value, int):
        return _varint(number << 3) + _varint(value)
    if isinstance(value, float):
        return _varint(number << 3 | 5) + np.float32(value).tobytes()
    data = value.encode() if isinstance(value, str) else value
    return _varint(number << 3 | 2) + _varint(len(data)) + data


def _message(*fields):
    return b"".join(_field(number, value) for number, value in fields)


# The messages of onnx.proto that a network needs.

def _tensor(name, values):
    values = np.asarray(values, "<f4")
    return _message(*((1, size) for size in values.shape), (2, _FLOAT), (8, name),
                    (9, values.tobytes()))


def _attribute(name, value):
    return _message((1, name), (2, value), (20, 1)) if isinstance(value, float) else _message(
        (1, name), (3, value), (20, 2))


def _node(operator, inputs, output, **attributes):
    return _message(*((1, name) for name in inputs), (2, output), (3, output), (4, operator),
                    *((5, _attribute(*one)) for one in attributes.items()))


def _value(name, shape):
    sizes = b"".join(_field(1, _field(2, size) if isinstance(size, str) else _field(1, size))
                     for size in shape)
    return _message((1, name), (2, _field(1, _message((1, _FLOAT), (2, sizes)))))


class _Graph:
    def __init__(self):
        self.nodes, self.tensors = [], {}

    def constant(self, name, values):
        self.tensors[name] = _tensor(name, values)
        return name

    def add(self, operator, inputs, output, **attributes):
        self.nodes.append(_node(operator, inputs, output, **attributes))
        return output


def _dense(weight):
    """The pairs' own layers, (pairs, outputs, inputs), as one matrix."""
    if weight.ndim == 2:
        return weight
    pairs, outputs, inputs = weight.shape
    matrix = np.zeros((pairs, outputs, pairs, inputs), np.float32)
    matrix[np.arange(pairs), :, np.arange(pairs)] = weight
    return matrix.reshape(pairs * outputs, pairs * inputs)


def _layers(tensors):
    """The names of the layers in their order; all but the last end in a sigmoid."""
    return [f"{part}.{level}" for part in ("tree", "fc", "mlp") for level in range(len(tensors))
            if f"{part}.{level}.weight" in tensors]


class _Writer:
    """The graph of a network. Constants are folded into dense layers, which every runtime has."""

    def __init__(self, tensors):
        self.tensors, self.graph = tensors, _Graph()

    def dense(self, name, values, weight, bias):
        names = [self.graph.constant(f"{name}.weight", weight),
                 self.graph.constant(f"{name}.bias", bias.reshape(-1))]
        return self.graph.add("Gemm", [values, *names], name, transB=1)

    def standardised(self, values):
        mean, inverse = (self.tensors[f"standardisation.{part}"].reshape(-1).astype(np.float64)
                         for part in ("mean", "inverse_deviation"))
        bound = float(self.tensors["standardisation.bound"][0])
        values = self.dense("scaled", values, np.diag(inverse), -mean * inverse)
        return self.graph.add("Clip", [values], "standardised", min=-bound, max=bound)

    def logits(self, values, branch, signs, share):
        """Those of the inputs times `signs`, times `share`."""
        layers = _layers(self.tensors)
        for layer in layers:
            weight, bias = (self.tensors[f"{layer}.{part}"] for part in ("weight", "bias"))
            weight = _dense(weight)
            if layer == layers[0]:
                weight = weight * signs
            last = share if layer == layers[-1] else 1
            values = self.dense(f"{branch}.{layer}", values, weight * last, bias * last)
            if layer != layers[-1]:
                values = self.graph.add("Sigmoid", [values], f"{branch}.{layer}.sigmoid")
        return values


def encode(network, facts, classes):
    """The bytes of the file: descriptors (n, scales x columns) in, probabilities (n, classes) out.

    `network` has tensors and metadata as in a model file; `facts` go into the file as they are.
    """
    tensors, metadata = network.tensors, network.metadata
    if metadata["nn.kind"] == "CNN" or metadata["nn.symmetry"] == "canonical":
        raise UsageError("ONNX: networks of the kinds pcednet and fc are possible, with the "
                         "symmetries average and none")
    scales, columns = tensors["standardisation.mean"].shape
    inputs = scales * columns
    writer = _Writer(tensors)
    graph = writer.graph
    values = writer.standardised("descriptors")
    if metadata["nn.symmetry"] == "average":  # with what the flipped normals would give
        odd = np.array(json.loads(metadata["nn.odd_features"]), np.float32)
        logits = graph.add("Add", [writer.logits(values, "as_given", np.ones(inputs), 0.5),
                                   writer.logits(values, "flipped", np.tile(1 - 2 * odd, scales),
                                                 0.5)], "logits")
    else:
        logits = writer.logits(values, "as_given", np.ones(inputs), 1)
    graph.add("Softmax", [logits], "probabilities", axis=1)
    content = _message(*((1, node) for node in graph.nodes), (2, "pcednet"),
                       *((5, tensor) for tensor in graph.tensors.values()),
                       (11, _value("descriptors", ["n", inputs])),
                       (12, _value("probabilities", ["n", classes])))
    return _message((1, _IR_VERSION), (2, "pcednet"), (7, content), (8, _message((2, _OPSET))),
                    *((14, _message((1, key), (2, value))) for key, value in facts.items()))
