"""EdgeClassifier as scikit-learn's tools use it."""

import pickle
import sys
import unittest
import warnings

import numpy as np

import pcednet
from support import cube

try:
    import sklearn  # noqa: F401
    from sklearn.base import clone
    from sklearn.exceptions import NotFittedError
    from sklearn.model_selection import GridSearchCV, PredefinedSplit
    from sklearn.pipeline import make_pipeline
    from sklearn.utils import estimator_checks
except ImportError:
    sys.exit(77)

from pcednet.sklearn import EdgeClassifier  # noqa: E402

POSITIONS, NORMALS, LABELS = cube(3000)
X = np.hstack([POSITIONS, NORMALS])


class Estimator(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.fitted = EdgeClassifier(epochs=3).fit(X, LABELS)

    def test_it_is_the_training_and_the_classification(self):
        model = pcednet.train(POSITIONS, LABELS, normals=NORMALS, epochs=3)
        result = model.classify(POSITIONS, NORMALS, boundary=False)
        np.testing.assert_array_equal(self.fitted.predict(X), result.labels)
        p = self.fitted.predict_proba(X)
        np.testing.assert_allclose(p.sum(axis=1), 1)
        np.testing.assert_array_equal(p[:, 2], result.p_sharp)
        self.assertEqual(self.fitted.classes_.tolist(), [0, 1, 2])
        self.assertGreater(self.fitted.score(X, LABELS), 0.8)

    def test_its_tools_take_it(self):
        copy = clone(self.fitted)
        self.assertEqual(copy.get_params(), self.fitted.get_params())
        with self.assertRaises(NotFittedError):
            copy.predict(X)
        again = pickle.loads(pickle.dumps(self.fitted))
        np.testing.assert_array_equal(again.predict(X), self.fitted.predict(X))
        shifted = make_pipeline(EdgeClassifier(epochs=3)).fit(X, LABELS)
        np.testing.assert_array_equal(shifted.predict(X), self.fitted.predict(X))
        fold = np.where(POSITIONS[:, 0] > 0, 0, -1)  # one half is for testing
        search = GridSearchCV(EdgeClassifier(epochs=2), {"classes": [2, 3]},
                              cv=PredefinedSplit(fold), error_score="raise")
        self.assertIn(search.fit(X, LABELS).best_params_["classes"], (2, 3))

    def test_it_starts_from_a_model_and_from_a_few_points(self):
        few = np.full(3000, -1)
        few[::50] = LABELS[::50]
        found = EdgeClassifier(start="general").fit(POSITIONS, few).predict(POSITIONS)
        self.assertGreater(np.mean(found == LABELS), 0.7)

    def test_wrong_input_is_refused(self):
        with self.assertRaisesRegex(ValueError, "shape"):
            EdgeClassifier().fit(X[:, :4], LABELS)
        with self.assertRaisesRegex(ValueError, "3 features, but EdgeClassifier is expecting 6"):
            self.fitted.predict(POSITIONS)
        for balance in (-1.0, 2.0, np.nan):
            with self.assertRaisesRegex(pcednet.UsageError, "balance: .* from 0 to 1 is needed"):
                EdgeClassifier(balance=balance).fit(X, LABELS)
        own = pcednet.Cloud(POSITIONS, labels=LABELS)
        own.comments = [f"pcednet class {i} #00000{i} {name}" for i, name in enumerate("abc")]
        with self.assertRaisesRegex(pcednet.UsageError, "start: a model of the edge classes"):
            EdgeClassifier(start=pcednet.train(own, epochs=1, scales=4)).fit(X, LABELS)
        unknown = X.copy()
        unknown[5] = np.nan
        self.assertEqual(self.fitted.predict(unknown)[5], 255)
        self.assertTrue(np.isnan(self.fitted.predict_proba(unknown)[5]).all())

    def test_it_passes_scikit_learns_checks_where_they_apply(self):
        """The others want columns of another number than 3 and 6, a row that means something alone,
        or an error where a position is missing."""
        run = set()
        for estimator, check in estimator_checks.check_estimator(EdgeClassifier(start="general"),
                                                                 generate_only=True):
            name = getattr(check, "func", check).__name__
            if name in APPLY:
                run.add(name)
                with self.subTest(name):
                    check(estimator)
        self.assertEqual(run, APPLY)


APPLY = {"check_classifiers_one_label", "check_complex_data", "check_decision_proba_consistency",
         "check_dict_unchanged", "check_dont_overwrite_parameters", "check_estimators_pickle",
         "check_estimator_get_tags_default_keys", "check_estimators_unfitted",
         "check_fit_score_takes_y", "check_get_params_invariance",
         "check_methods_sample_order_invariance", "check_no_attributes_set_in_init",
         "check_parameters_default_constructible", "check_pipeline_consistency",
         "check_set_params", "check_supervised_y_no_nan"}

warnings.simplefilter("ignore", pcednet.PcednetWarning)


if __name__ == "__main__":
    unittest.main()
