#!/usr/bin/env python3
"""Checks that numpy alone can read our model files and repeat our answers (PCEDNet, FC)."""
import glob
import sys

try:
    import numpy as np
except ImportError:
    sys.exit(77)

import safetensors_file


def sigmoid(x):
    return 1 / (1 + np.exp(-x))


def logits(x, tensors):
    x = x.reshape(len(x), -1)
    level = 0
    while f"tree.{level}.weight" in tensors:
        weight, bias = tensors[f"tree.{level}.weight"], tensors[f"tree.{level}.bias"]
        pairs = x.reshape(len(x), weight.shape[0], weight.shape[2])
        x = sigmoid(np.einsum("npi,poi->npo", pairs, weight) + bias).reshape(len(x), -1)
        level += 1
    level = 0
    while f"fc.{level}.weight" in tensors:
        x = sigmoid(x @ tensors[f"fc.{level}.weight"].T + tensors[f"fc.{level}.bias"])
        level += 1
    for level in (0, 1):
        x = sigmoid(x @ tensors[f"mlp.{level}.weight"].T + tensors[f"mlp.{level}.bias"])
    return x @ tensors["mlp.2.weight"].T + tensors["mlp.2.bias"]


def main(folder):
    checked = 0
    for path in sorted(glob.glob(f"{folder}/*.model.safetensors")):
        tensors, metadata = safetensors_file.read(path)
        if metadata["nn.kind"] == "CNN":
            continue
        assert metadata["seed"] == "21"
        answers, _ = safetensors_file.read(path.replace(".model.", ".answers."))
        x, twins = safetensors_file.prepare(answers["samples"], tensors, metadata)
        z = logits(x, tensors)
        if twins is not None:
            z = (z + logits(twins, tensors)) / 2
        p = np.exp(z - z.max(axis=1, keepdims=True))
        p /= p.sum(axis=1, keepdims=True)
        # A few roundings of float per layer.
        np.testing.assert_allclose(answers["probabilities"], p, atol=3e-6)
        checked += 1
    assert checked >= 6


if __name__ == "__main__":
    main(sys.argv[1])
