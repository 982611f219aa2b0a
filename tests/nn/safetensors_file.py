"""Reads a safetensors file by hand, as its specification says."""
import json
import struct

import numpy as np


def read(path):
    """Returns the tensors and the metadata."""
    with open(path, "rb") as file:
        data = file.read()
    (length,) = struct.unpack("<Q", data[:8])
    header = json.loads(data[8 : 8 + length])
    metadata = header.pop("__metadata__", {})
    body = data[8 + length :]
    tensors = {}
    for name, entry in header.items():
        assert entry["dtype"] == "F32"
        begin, end = entry["data_offsets"]
        numbers = np.frombuffer(body[begin:end], "<f4")
        tensors[name] = numbers.reshape(entry["shape"]).copy()
    return tensors, metadata


def prepare(samples, tensors, metadata):
    """Standardises samples; returns them and, if answers are averaged, their flipped twins."""
    scales, features = int(metadata["nn.scales"]), int(metadata["nn.features"])
    x = samples.reshape(-1, scales, features)
    x = (x - tensors["standardisation.mean"]) * tensors["standardisation.inverse_deviation"]
    bound = tensors["standardisation.bound"][0]
    x = np.clip(x, -bound, bound)
    signs = 1 - 2 * np.array(json.loads(metadata["nn.odd_features"]))
    if metadata["nn.symmetry"] == "canonical":
        deciding = int(metadata["nn.deciding_feature"])
        flip = x[:, :, deciding].sum(axis=1) < 0
        x = np.where(flip[:, None, None], x * signs, x)
    twins = x * signs if metadata["nn.symmetry"] == "average" else None
    return x.astype("f4"), None if twins is None else twins.astype("f4")
