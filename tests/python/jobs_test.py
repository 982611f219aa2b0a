"""Long work from Python: progress, interruption, threads side by side."""

import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np

import pcednet
from support import cube

POSITIONS, NORMALS, _ = cube(20_000)


class Bar:
    """A bar as tqdm has them."""

    made = []

    def __init__(self, total=None):
        self.total, self.n, self.stages, self.closed = total, 0, [], False
        Bar.made.append(self)

    def update(self, n):
        self.n += n

    def set_description(self, text, refresh=True):
        if not self.stages or self.stages[-1] != text:
            self.stages.append(text)

    def close(self):
        self.closed = True


class Progress(unittest.TestCase):
    def test_a_function_is_called_on_the_calling_thread(self):
        seen = []
        pcednet.classify(POSITIONS, NORMALS, progress=lambda stage, fraction: seen.append(
            (stage, fraction, threading.get_ident())))
        self.assertEqual({thread for _, _, thread in seen}, {threading.get_ident()})
        fractions = [fraction for stage, fraction, _ in seen if stage == "describe"]
        self.assertGreater(len(fractions), 1)
        self.assertEqual(fractions, sorted(fractions))
        self.assertTrue(all(0 <= fraction <= 1 for _, fraction, _ in seen))

    def test_a_bar_moves(self):
        bar = Bar(total=50)
        pcednet.classify(POSITIONS, NORMALS, progress=bar)
        self.assertIn("describe", bar.stages)
        self.assertFalse(bar.closed)
        self.assertLessEqual(bar.n, 50)
        Bar.made.clear()
        pcednet.describe(POSITIONS, NORMALS, progress=Bar)
        self.assertEqual([bar.closed for bar in Bar.made], [True])

    def test_an_exception_in_it_stops_the_work(self):
        def refuse(stage, fraction):
            if stage == "describe":
                raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            pcednet.classify(POSITIONS, NORMALS, progress=refuse)
        with self.assertRaisesRegex(ValueError, "progress: a function of"):
            pcednet.classify(POSITIONS, NORMALS, progress=3)

    def test_it_changes_no_result(self):
        plain = pcednet.classify(POSITIONS, NORMALS)
        watched = pcednet.classify(POSITIONS, NORMALS, progress=lambda *news: None, threads=3)
        np.testing.assert_array_equal(plain.p_sharp, watched.p_sharp)


class Interruption(unittest.TestCase):
    def interrupted(self, work):
        """Seconds from Ctrl-C, which comes once `work` reports that it runs, to its end."""
        sent = []

        def report(stage, fraction):
            if not sent:
                sent.append(time.monotonic())
                os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            work(report)
        return time.monotonic() - sent[0]

    def test_ctrl_c_cancels(self):
        positions, normals, _ = cube(40_000)
        whole = time.monotonic()
        pcednet.classify(positions, normals, exact=True)
        whole = time.monotonic() - whole
        took = self.interrupted(
            lambda report: pcednet.classify(positions, exact=True, progress=report))
        self.assertLess(took, 0.5 * whole)
        labels = np.arange(len(POSITIONS)) % 3
        self.interrupted(lambda report: pcednet.train(POSITIONS, labels, normals=NORMALS,
                                                      epochs=10_000, progress=report))
        pcednet.classify(POSITIONS, NORMALS)  # works as before

    def test_ctrl_c_is_seen_without_progress(self):
        """In a process of its own, whose work would take minutes."""
        script = ("import numpy as np, pcednet\n"
                  "xyz = np.random.default_rng(1).normal(size=(300_000, 3))\n"
                  "xyz /= np.linalg.norm(xyz, axis=1, keepdims=True)\n"
                  "print('begins', flush=True)\n"
                  "try:\n  pcednet.classify(xyz, xyz, exact=True)\n"
                  "except KeyboardInterrupt:\n  print('interrupted')\n")
        with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE,
                              text=True) as process:
            self.assertEqual(process.stdout.readline(), "begins\n")
            try:
                process.wait(timeout=0.4)
                self.fail("ended before it could be interrupted")
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGINT)
            self.assertEqual(process.communicate(timeout=60)[0], "interrupted\n")
        self.assertEqual(process.returncode, 0)


class Threads(unittest.TestCase):
    def test_python_goes_on_meanwhile(self):
        ticks, done = [0], threading.Event()

        def tick():
            while not done.wait(0.001):
                ticks[0] += 1

        ticker = threading.Thread(target=tick)
        ticker.start()
        before = ticks[0]
        pcednet.classify(POSITIONS, NORMALS, threads=1)
        during = ticks[0] - before
        done.set()
        ticker.join()
        self.assertGreater(during, 5)

    def test_calls_run_side_by_side(self):
        """Each of two calls waits in its progress for the other, so that neither could end alone."""
        expected = pcednet.classify(POSITIONS, NORMALS).labels
        both = threading.Barrier(2, timeout=120)
        found, failed = [None, None], []

        def classify(k):
            met = []

            def report(stage, fraction):
                if stage == "describe" and not met:
                    met.append(both.wait())

            try:
                found[k] = pcednet.classify(POSITIONS, NORMALS, threads=k + 1, progress=report)
            except Exception as error:
                failed.append(error)

        threads = [threading.Thread(target=classify, args=[k]) for k in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failed, [])
        for result in found:
            np.testing.assert_array_equal(result.labels, expected)

    def test_the_number_of_threads_changes_no_bit(self):
        results = [pcednet.classify(POSITIONS, NORMALS, threads=n) for n in (0, 1, 2, 8)]
        for result in results[1:]:
            np.testing.assert_array_equal(result.p_sharp, results[0].p_sharp)
            np.testing.assert_array_equal(result.labels, results[0].labels)


if __name__ == "__main__":
    unittest.main()
