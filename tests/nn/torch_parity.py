#!/usr/bin/env python3
"""Checks answers, loss and every derivative of our networks against PyTorch's."""
import glob
import sys

try:
    import numpy as np
    import torch
except ImportError:
    sys.exit(77)

import safetensors_file


class PairLayer(torch.nn.Module):
    """Neighbouring vectors joined, each pair in a dense layer of its own."""

    def __init__(self, pairs, neurons, inputs):
        super().__init__()
        self.weight = torch.nn.Parameter(torch.empty(pairs, neurons, inputs))
        self.bias = torch.nn.Parameter(torch.empty(pairs, neurons))

    def forward(self, x):
        pairs, _, inputs = self.weight.shape
        x = x.reshape(len(x), pairs, inputs)
        return (torch.einsum("npi,poi->npo", x, self.weight) + self.bias).flatten(1)


class Net(torch.nn.Module):
    def __init__(self, tensors):
        super().__init__()
        shapes = {k[: -len(".weight")]: v.shape for k, v in tensors.items() if k.endswith(".weight")}
        names = lambda part: sorted(k for k in shapes if k.startswith(part))
        self.tree = torch.nn.ModuleList(PairLayer(*shapes[k]) for k in names("tree."))
        self.fc = torch.nn.ModuleList(torch.nn.Linear(*shapes[k][::-1]) for k in names("fc."))
        self.conv = torch.nn.ModuleList(
            torch.nn.Conv1d(shapes[k][1], shapes[k][0], shapes[k][2], padding=2)
            for k in names("conv.")
        )
        self.mlp = torch.nn.ModuleList(torch.nn.Linear(*shapes[k][::-1]) for k in names("mlp."))

    def forward(self, x):
        for layer in self.conv:
            x = torch.relu(layer(x))
        x = x.flatten(1)
        for layer in [*self.tree, *self.fc, *self.mlp[:-1]]:
            x = torch.sigmoid(layer(x))
        return self.mlp[-1](x)


def check(path):
    tensors, metadata = safetensors_file.read(path)
    answers, _ = safetensors_file.read(path.replace(".model.", ".answers."))
    weights = {k: v for k, v in tensors.items() if not k.startswith("standardisation.")}
    net = Net(weights)
    net.load_state_dict({k: torch.from_numpy(v) for k, v in weights.items()})  # strict
    net.double()
    x, twins = safetensors_file.prepare(answers["samples"], tensors, metadata)
    z = net(torch.from_numpy(x).double())
    if twins is not None:
        z = (z + net(torch.from_numpy(twins).double())) / 2
    # A few roundings of float per layer; derivatives are sums over 200 samples of such numbers.
    p = torch.softmax(z, 1).detach().numpy()
    np.testing.assert_allclose(answers["probabilities"], p, atol=3e-6)
    labels = torch.from_numpy(answers["labels"]).long()
    loss = torch.nn.functional.cross_entropy(z, labels)
    np.testing.assert_allclose(answers["loss"], loss.item(), atol=2e-6)
    loss.backward()
    for name, parameter in net.named_parameters():
        wanted = parameter.grad.numpy()
        np.testing.assert_allclose(answers[f"gradient.{name}"], wanted, atol=1e-6, err_msg=name)


def main(folder):
    paths = sorted(glob.glob(f"{folder}/*.model.safetensors"))
    assert len(paths) >= 8
    for path in paths:
        check(path)


if __name__ == "__main__":
    main(sys.argv[1])
