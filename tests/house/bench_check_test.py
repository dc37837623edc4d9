"""The benchmarks' gate must fail where it should: a checker that never fails checks nothing."""

import sys
import unittest

sys.path.insert(0, sys.argv.pop())

import check  # noqa: E402
import results  # noqa: E402


class Gate(unittest.TestCase):
    def test_counts_may_grow_a_tenth(self):
        self.assertIsNone(check.worse("b", "steps", 100, 110))
        self.assertIn("steps", check.worse("b", "steps", 100, 111))
        self.assertIsNone(check.worse("b", "steps", 100, 50))

    def test_results_stay(self):
        self.assertIsNone(check.worse("b", "stations", 251, 251))
        self.assertIn("stations", check.worse("b", "stations", 251, 250))
        self.assertIn("digest", check.worse("b", "digest", 7, 8))

    def test_times_may_grow_by_three_tenths(self):
        self.assertIsNone(check.worse("b", "time", 2.0, 2.59))
        self.assertIn("time", check.worse("b", "time", 2.0, 2.61))

    def test_errors_below_a_billionth_are_nothing(self):
        self.assertIsNone(check.worse("b", "error_max", 1e-14, 9e-10))
        self.assertIn("error_max", check.worse("b", "error_max", 1e-14, 2e-9))
        self.assertIn("error_mean", check.worse("b", "error_mean", 1e-3, 1.2e-3))

    def test_wrong_answers_fail_and_missing_data_does_not(self):
        found = {"a": {"error_occurred": True, "error_message": "differs from CGAL"},
                 "b": {"error_occurred": True, "error_message": "no data folder"},
                 "c": {"cpu_time": 1}}
        self.assertEqual([name for name, _ in results.failed(found)], ["a"])

    def test_the_gate_as_a_whole(self):
        baseline = check.json.loads(check.BASELINE.read_text())
        slower = {name: dict(values) for name, values in baseline.items()}
        slower["exact_field/town"]["steps"] *= 1.2
        gone = {name: values for name, values in baseline.items() if name != "stage_plan/city"}
        half = {name: dict(values) for name, values in baseline.items()}
        half["stage_plan/city"]["stations"] /= 2
        silent = {name: dict(values) for name, values in baseline.items()}
        del silent["exact_field/town"]["steps"]
        new = {**baseline, "stage_new/town": {"cells": 1}}
        for now, wrong, want in ((baseline, [], 0), (slower, [], 1), (gone, [], 1), (half, [], 1),
                                 (silent, [], 1), (new, [], 1),
                                 (baseline, [("x", "differs")], 1)):
            check.measure = lambda with_times, now=now, wrong=wrong: (now, wrong)
            self.assertEqual(check.main(["--counts"]), want)


if __name__ == "__main__":
    unittest.main()
