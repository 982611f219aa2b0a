"""A bar of tqdm as progress."""

import io
import sys
import unittest

import pcednet
from support import cube

try:
    from tqdm import tqdm
except ImportError:
    sys.exit(77)

POSITIONS, NORMALS, _ = cube(40_000)


class Tqdm(unittest.TestCase):
    def test_a_bar_follows_the_stages(self):
        out = io.StringIO()
        with tqdm(total=100, file=out, mininterval=0) as bar:
            pcednet.classify(POSITIONS, NORMALS, progress=bar)
            self.assertIn(bar.desc, ("describe: ", "context: ", "boundary: "))
            self.assertLessEqual(bar.n, 100)
        self.assertIn("describe", out.getvalue())


if __name__ == "__main__":
    unittest.main()
