"""Models in other programs: ONNX in OpenCV, safetensors in numpy and PyTorch."""

import json
import pathlib
import struct
import sys
import tempfile
import unittest

import numpy as np

import pcednet
from support import cube

try:
    import cv2
    import torch
except ImportError:
    sys.exit(77)


def samples_of(model, count=400):
    """Descriptors from the middle of a model's range to far beyond it."""
    mean = model.tensors["standardisation.mean"]
    spread = 1 / model.tensors["standardisation.inverse_deviation"]
    random = np.random.default_rng(7).normal(size=(count, *mean.shape))
    return (mean + 3 * spread * random).astype(np.float32)


class Onnx(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = pathlib.Path(self.folder.name) / "model.onnx"

    def compare(self, model, samples):
        model.save(self.file, overwrite=True)
        network = cv2.dnn.readNetFromONNX(str(self.file))
        for rows in (samples, samples[:1]):
            network.setInput(rows.reshape(len(rows), -1))
            np.testing.assert_allclose(network.forward(), model.predict(rows), atol=1e-5)

    def test_opencv_gives_our_probabilities(self):
        for name in pcednet.shipped_models():
            with self.subTest(name):
                model = pcednet.Model.load(name)
                self.compare(model, samples_of(model))

    def test_so_it_does_for_descriptors_and_other_networks(self):
        positions, normals, labels = cube(2000)
        for options in ({"network": "fc"}, {"classes": 2}, {"gate": 0.0, "second_gate": -1.0}):
            with self.subTest(options):
                model = pcednet.train(positions, labels, normals=normals, epochs=2, scales=4,
                                      **options)
                options = {name: value for name, value in options.items() if "gate" in name}
                self.compare(model, pcednet.describe(positions, normals, scales=4, **options))
        cnn = pcednet.train(positions, labels, normals=normals, epochs=1, scales=4, network="cnn")
        with self.assertRaisesRegex(pcednet.UsageError, "ONNX: networks of the kinds"):
            cnn.save(self.file, overwrite=True)
        with self.assertRaises(FileExistsError):
            model.save(self.file)

    def test_the_file_says_what_it_wants(self):
        pcednet.Model.load("scan").save(self.file)
        content = self.file.read_bytes()
        for text in (b"descriptors", b"probabilities", b"dkappa", b"[0, 1, 2]"):
            self.assertIn(text, content)


class Safetensors(unittest.TestCase):
    def test_numpy_and_pytorch_read_it_by_its_specification(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "model.safetensors"
            model = pcednet.Model.load("cad")
            model.save(file)
            data = file.read_bytes()
        (length,) = struct.unpack("<Q", data[:8])
        header = json.loads(data[8:8 + length])
        header.pop("__metadata__")
        self.assertEqual(set(header), set(model.tensors))
        for name, entry in header.items():
            begin, end = (8 + length + place for place in entry["data_offsets"])
            as_numpy = np.frombuffer(data[begin:end], "<f4").reshape(entry["shape"])
            np.testing.assert_array_equal(as_numpy, model.tensors[name])
            as_torch = torch.frombuffer(bytearray(data[begin:end]), dtype=torch.float32)
            self.assertTrue(torch.equal(as_torch.reshape(entry["shape"]),
                                        torch.from_numpy(model.tensors[name])))


if __name__ == "__main__":
    unittest.main()
