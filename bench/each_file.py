"""What the benchmarks share that measure one file after another."""

import argparse
import warnings


def each_file(doc, measure, options):
    """Calls measure(path, arguments) for every FILE of the command line, which has --model and `options`, too: the
    settings of each by its name."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+")
    parser.add_argument("--model", default="general")
    for name, settings in options.items():
        parser.add_argument(name, **settings)
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    for path in arguments.files:
        measure(path, arguments)
