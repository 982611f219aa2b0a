"""The package as it is shipped: stubs that tell the truth, docstrings, a wheel that stands alone."""

import ast
import importlib.util
import inspect
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zipfile

import pcednet
from support import SOURCE

STUBS = SOURCE / "python" / "pcednet" / "__init__.pyi"
BUILD = os.environ["PCEDNET_BUILD_DIR"]


def names_of(function):
    """Its arguments with their defaults, as text."""
    arguments = function.args
    named = [*arguments.posonlyargs, *arguments.args]
    plain = [None] * (len(named) - len(arguments.defaults)) + arguments.defaults
    pairs = [*zip(named, plain), *zip(arguments.kwonlyargs, arguments.kw_defaults)]
    return {one.arg: ast.literal_eval(default) if default is not None else inspect.Parameter.empty
            for one, default in pairs}


class Stubs(unittest.TestCase):
    def check(self, stub, function):
        parameters = inspect.signature(function).parameters.values()
        runtime = {p.name: p.default for p in parameters if p.kind != p.VAR_KEYWORD}
        self.assertEqual(names_of(stub), runtime, stub.name)

    def test_they_are_the_signatures(self):
        tree = ast.parse(STUBS.read_text())
        functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
        classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
        variables = {node.target.id for node in tree.body if isinstance(node, ast.AnnAssign)}
        aliases = {alias.asname for node in tree.body if isinstance(node, ast.ImportFrom)
                   for alias in node.names if alias.asname}
        known = {*functions, *classes, *variables, *aliases} - {"_Bar"}
        self.assertEqual(known, set(pcednet.__all__))
        for name, stub in functions.items():
            self.check(stub, getattr(pcednet, name))
        for name in ("Cloud", "Result", "Model", "Lines"):
            self.check_class(classes[name], getattr(pcednet, name))
        for node in classes["Curve"].body:
            self.assertTrue(hasattr(pcednet.Curve, node.name), node.name)

    def check_class(self, stub, real):
        for node in stub.body:
            if isinstance(node, ast.FunctionDef):
                decorators = {word.id for word in node.decorator_list}
                member = inspect.getattr_static(real, node.name)
                if "property" in decorators:
                    self.assertIsInstance(member, property, node.name)
                else:
                    self.check(node, getattr(member, "__func__", member))
        public = {name for name in vars(real) if not name.startswith("_")}
        stubbed = {getattr(node, "name", None) or node.target.id for node in stub.body}
        self.assertLessEqual(public, stubbed)

    def test_everything_has_a_docstring_that_names_its_arguments(self):
        for name in pcednet.__all__:
            thing = getattr(pcednet, name)
            if not callable(thing):
                continue
            self.assertTrue(thing.__doc__, name)
            for member, its in vars(thing).items() if inspect.isclass(thing) else ():
                if isinstance(its, property):
                    self.assertTrue(its.__doc__, f"{name}.{member}")
            if inspect.isfunction(thing):
                for argument in inspect.signature(thing).parameters:
                    self.assertRegex(thing.__doc__, rf"\b{argument}\b", f"{name}: {argument}")


class Wheel(unittest.TestCase):
    def test_it_stands_alone(self):
        """Built from the build folder of the tests, installed without a network in an environment
        that sees Debian's numpy, and used from elsewhere."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            environment = {key: value for key, value in os.environ.items()
                           if key not in ("PYTHONPATH", "PCEDNET_BUILD_DIR")}

            def run(*command):
                done = subprocess.run([str(word) for word in command], cwd=folder, text=True,
                                      env=environment, stdout=subprocess.PIPE,
                                      stderr=subprocess.STDOUT)
                self.assertEqual(done.returncode, 0, done.stdout)
                return done.stdout

            # The pip of the system, if it has one, which takes seconds less than to install another.
            without = ["--without-pip"] if importlib.util.find_spec("pip") else []
            run(sys.executable, "-m", "venv", "--system-site-packages", *without, "env")
            python = folder / "env" / "bin" / "python"
            run(python, "-m", "pip", "wheel", "--no-index", "--no-deps", "-w", "wheels",
                f"--config-settings=build-dir={BUILD}", SOURCE)
            (wheel,) = (folder / "wheels").glob("pcednet-*.whl")
            self.assertIn(f"cp{sys.version_info[0]}{sys.version_info[1]}", wheel.name)
            held = set(zipfile.ZipFile(wheel).namelist())
            modules = {f"pcednet/{path.name}" for path in STUBS.parent.iterdir() if path.is_file()}
            models = {f"pcednet/models/{path.name}"
                      for path in (SOURCE / "models").glob("*.safetensors")}
            self.assertLessEqual(modules | models, held)
            self.assertTrue(any(entry.endswith("dist-info/LICENSE") for entry in held))
            run(python, "-m", "pip", "install", "--no-index", wheel)
            said = run(python, "-c", "import pcednet, numpy as np\n"
                       "xyz = next(pcednet.generate('lines', only='roof_mansard')).xyz\n"
                       "n = pcednet.estimate_normals(xyz)\n"
                       "print(pcednet.__file__, pcednet.__version__, pcednet.shipped_models())\n"
                       "print(np.bincount(pcednet.classify(xyz, n).labels, minlength=4).tolist())")
            self.assertIn(str(folder), said)
            self.assertIn("'general'", said)
            import numpy as np
            xyz = next(pcednet.generate("lines", only="roof_mansard")).xyz
            ours = pcednet.classify(xyz, pcednet.estimate_normals(xyz)).labels
            self.assertIn(str(np.bincount(ours, minlength=4).tolist()), said)
            for line in subprocess.run(["readelf", "-d", next(folder.rglob("_core*.so"))],
                                       capture_output=True, text=True).stdout.splitlines():
                self.assertNotRegex(line, "R(UN)?PATH")


if __name__ == "__main__":
    unittest.main()
