# SPDX-License-Identifier: Apache-2.0
"""statistics_scipy_test.py PROGRAM: the statistics of studies against SciPy and NumPy, to 1e-9.

PROGRAM answers a JSON line per call; see statistics_lines.cpp.
"""
import json
import subprocess
import sys
import unittest
import warnings

import numpy as np
from scipy import optimize, stats

PROGRAM = None
TOLERANCE = 1e-9


class Statistics(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(6)
        warnings.simplefilter("ignore")  # SciPy's about small samples and zeros

    def compare(self, calls, expected, absolute=0.0):
        """Each call's answer with what is expected of it, numbers to TOLERANCE of their size."""
        lines = "".join(json.dumps(call) + "\n" for call in calls)
        done = subprocess.run([PROGRAM], input=lines, capture_output=True, text=True, check=True)
        answers = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual(len(answers), len(expected))
        self.assertGreater(len(answers), 0)
        for call, answer, value in zip(calls, answers, expected):
            found, wanted = flat(answer), flat(value)
            self.assertEqual(len(found), len(wanted), call)
            for one, other in zip(found, wanted):
                # To write the message of each that is right would take most of the time.
                if not abs(one - other) <= max(TOLERANCE * abs(other), absolute):
                    self.fail(f"{call}: expected {wanted}, found {found}")

    def sample(self, n, digits):
        """Differences of paired measurements; the fewer digits, the more ties and zeros."""
        return np.round(self.random.normal(0.2, 1, n) * self.random.choice([1, 100]), digits)

    def test_normal(self):
        z = list(np.linspace(-8, 37, 200))
        self.compare([{"call": "normal_tail", "of": x} for x in z], stats.norm.sf(z))
        p = [10.0**e for e in range(-300, 0, 10)] + list(np.linspace(0.001, 0.999, 200))
        p = [x for x in p if x != 0.5] + [1 - 1e-12]
        self.compare([{"call": "normal_quantile", "of": x} for x in p], stats.norm.ppf(p))
        self.compare([{"call": "normal_quantile", "of": 0.5}], [0.0], absolute=1e-15)

    def test_chi_squared(self):
        pairs = [(x, k) for k in range(1, 31) for x in self.random.exponential(2 * k, 20)]
        pairs += [(600.0, k) for k in range(1, 31)]
        self.compare(
            [{"call": "chi_squared_tail", "of": x, "degrees": k} for x, k in pairs],
            [stats.chi2.sf(x, k) for x, k in pairs],
        )

    def test_studentized_range(self):
        ks = [2, 3, 4, 5, 7, 10, 16, 25, 50, 100]
        pairs = [(q, k) for k in ks for q in np.linspace(0.5, 8, 16)]
        self.compare(
            [{"call": "studentized_range", "of": q, "k": k} for q, k in pairs],
            [stats.studentized_range.cdf(q, k, np.inf) for q, k in pairs],
            absolute=1e-12,
        )
        pairs = [(p, k) for k in ks for p in [0.5, 0.8, 0.9, 0.95, 0.99, 0.999]]
        self.compare(
            [{"call": "studentized_range_quantile", "of": p, "k": k} for p, k in pairs],
            [stats.studentized_range.ppf(p, k, np.inf) for p, k in pairs],
        )

    def test_summaries(self):
        for n in [1, 2, 3, 4, 5, 10, 101, 1000]:
            samples = [self.sample(n, digits) for digits in (0, 1, 8) for _ in range(5)]
            rows = [list(sample) for sample in samples]
            self.compare([{"call": "median", "of": x} for x in rows], np.median(samples, axis=1))
            self.compare(
                [{"call": "mean", "of": x} for x in rows],
                np.mean(samples, axis=1),
                absolute=1e-12,  # sums in another order
            )
            self.compare(
                [{"call": "ranks", "of": x} for x in rows], [stats.rankdata(x) for x in rows]
            )
            for q in [0, 0.01, 0.25, 0.3, 0.5, 0.75, 0.9, 0.99, 1]:
                self.compare(
                    [{"call": "quantile", "of": x, "q": q} for x in rows],
                    np.quantile(samples, q, axis=1),
                    absolute=1e-13,
                )

    def test_wilson(self):
        calls, expected = [], []
        for trials in [1, 2, 5, 10, 57, 1000, 100000]:
            for successes in {0, 1, trials // 3, trials // 2, trials - 1, trials}:
                for confidence in [0.5, 0.9, 0.95, 0.99, 0.999]:
                    calls.append(
                        {
                            "call": "wilson",
                            "successes": successes,
                            "trials": trials,
                            "confidence": confidence,
                        }
                    )
                    test = stats.binomtest(successes, trials)
                    found = test.proportion_ci(confidence, method="wilson")
                    expected.append([found.low, found.high])
        self.compare(calls, expected, absolute=1e-15)

    def test_mcnemar(self):
        pairs = [(a, b) for a in range(12) for b in range(12) if a + b > 0]
        pairs += [(int(a), int(b)) for a, b in self.random.integers(0, 3000, (200, 2))]
        pairs += [(0, 1000), (3, 900), (4990, 5010), (20000, 20500)]
        self.compare(
            [{"call": "mcnemar", "first": a, "second": b} for a, b in pairs],
            [stats.binomtest(a, a + b).pvalue for a, b in pairs],
            absolute=1e-300,
        )

    def test_wilcoxon(self):
        kinds = {"ties": 0, "zeros": 0, "exact": 0}
        calls, expected = [], []
        for n in [1, 2, 3, 5, 8, 13, 25, 49, 50, 51, 52, 80, 200, 1000]:
            for digits in (0, 0, 1, 1, 2, 10, 10, 10):
                for without_zeros in (False, True):
                    sample = self.sample(n, digits)
                    sample = np.where(sample == 0, 3, sample) if without_zeros else sample
                    if not np.any(sample):
                        continue
                    zeros = bool(np.any(sample == 0))
                    ties = len(set(abs(sample[sample != 0]))) < np.count_nonzero(sample)
                    automatic = "exact" if np.count_nonzero(sample) <= 50 else "approx"
                    kinds["zeros"] += zeros
                    kinds["ties"] += ties
                    kinds["exact"] += automatic == "exact"
                    # SciPy 1.10 has no exact distribution of ties and zeros: see the next test.
                    modes = {"approx": "approx"}
                    if automatic == "approx" or (not zeros and not ties):
                        modes["auto"] = automatic
                    if not zeros and not ties and n <= 200:
                        modes["exact"] = "exact"
                    for mode, scipys in modes.items():
                        calls.append({"call": "wilcoxon", "of": list(sample), "mode": mode})
                        found = stats.wilcoxon(
                            sample, zero_method="wilcox", correction=False, mode=scipys
                        )
                        expected.append([found.statistic, found.pvalue])
                    if not ties and not zeros:  # then ours is SciPy's own choice
                        found = stats.wilcoxon(sample)
                        calls.append({"call": "wilcoxon", "of": list(sample), "mode": "auto"})
                        expected.append([found.statistic, found.pvalue])
        self.assertGreater(min(kinds.values()), 20, kinds)
        self.assertGreater(len(calls), 300)
        self.compare(calls, expected)

    def test_wilcoxon_of_ties_and_zeros_is_the_permutation_test(self):
        def above_less_below(sample, axis):
            return np.sum(np.sign(sample) * stats.rankdata(np.abs(sample), axis=axis), axis=axis)

        tied, calls, expected = 0, [], []
        for n in range(2, 14):
            for digits in (0, 0, 0, 1, 10):
                sample = self.sample(n, digits)
                nonzero = sample[sample != 0]
                if len(nonzero) < 2:
                    continue
                tied += len(set(abs(nonzero))) < len(nonzero)
                calls.append({"call": "wilcoxon", "of": list(sample), "mode": "auto"})
                ranks = stats.rankdata(abs(nonzero))
                statistic = min(np.sum(ranks[nonzero > 0]), np.sum(ranks[nonzero < 0]))
                found = stats.permutation_test(
                    (nonzero,), above_less_below, permutation_type="samples", vectorized=True,
                    n_resamples=np.inf, alternative="two-sided")
                expected.append([statistic, found.pvalue])
        self.assertGreater(tied, 20)
        self.compare(calls, expected)

    def test_wilcoxon_of_many_ties_counts_all_choices_of_signs(self):
        calls, expected = [], []
        for n in list(range(14, 51, 4)) + [50]:
            for scale in (1, 3, 30):
                sample = np.round(self.random.normal(0.3, 1, n) * scale)
                nonzero = sample[sample != 0]
                ranks = [int(2 * rank) for rank in stats.rankdata(abs(nonzero))]
                above = sum(rank for rank, value in zip(ranks, nonzero) if value > 0)
                choices = {0: 1}  # twice the sum: how many choices of signs have it
                for rank in ranks:
                    more = dict(choices)
                    for total, count in choices.items():
                        more[total + rank] = more.get(total + rank, 0) + count
                    choices = more
                less = sum(count for total, count in choices.items() if total <= above)
                greater = sum(count for total, count in choices.items() if total >= above)
                calls.append({"call": "wilcoxon", "of": list(sample), "mode": "auto"})
                expected.append([min(above, sum(ranks) - above) / 2,
                                 min(1, 2 * min(less, greater) / 2 ** len(ranks))])
        self.compare(calls, expected)

    def test_vargha_delaney(self):
        calls, expected = [], []
        for n, m in [(1, 1), (2, 5), (10, 10), (40, 7), (300, 200)]:
            for digits in (0, 1, 8):
                x, y = self.sample(n, digits), self.sample(m, digits)
                calls.append({"call": "vargha_delaney", "x": list(x), "y": list(y)})
                expected.append(stats.mannwhitneyu(x, y).statistic / (n * m))
        self.compare(calls, expected, absolute=1e-15)

    def test_friedman(self):
        calls, expected = [], []
        for k in [3, 4, 5, 8, 15]:
            for n in [1, 2, 5, 20, 100, 400]:
                for digits in (0, 1, 8):
                    rows = [np.round(self.random.normal(0.1 * i, 1, n), digits) for i in range(k)]
                    found = stats.friedmanchisquare(*rows)
                    if np.isnan(found.statistic):
                        continue
                    ranks = np.mean(np.apply_along_axis(stats.rankdata, 0, rows), axis=1)
                    calls.append({"call": "friedman", "of": [list(row) for row in rows]})
                    expected.append([found.statistic, found.pvalue, list(ranks)])
        self.compare(calls, expected, absolute=1e-12)

    def test_student(self):
        """By its inverse: scipy.stats.t.ppf of 1.10 has nine digits."""
        pairs = [(p, k) for p in [0.001, 0.025, 0.3, 0.9, 0.975, 0.9999] for k in [1, 2, 5, 30, 1000]]
        lines = "".join(json.dumps({"call": "student_quantile", "of": p, "degrees": k}) + "\n" for p, k in pairs)
        done = subprocess.run([PROGRAM], input=lines, capture_output=True, text=True, check=True)
        for (p, k), line in zip(pairs, done.stdout.splitlines()):
            self.assertAlmostEqual(stats.t.cdf(json.loads(line), k), p, 13, (p, k))

    def test_tango(self):
        """The score at each end, from the likelihood itself, is the normal quantile."""
        def score(gained, lost, pairs, difference):
            def unlikely(q):  # q: of a loss, q + difference: of a gain
                terms = ((gained, q + difference), (lost, q), (pairs - gained - lost, 1 - 2 * q - difference))
                return -sum(n * np.log(max(p, 1e-300)) for n, p in terms if n)
            q = optimize.minimize_scalar(unlikely, bounds=(max(0, -difference), (1 - difference) / 2),
                                         method="bounded", options={"xatol": 1e-13}).x
            return (gained - lost - pairs * difference) / np.sqrt(pairs * (2 * q + difference - difference**2))

        cases = [(9, 2, 40), (1, 0, 12), (3, 3, 30), (0, 7, 25), (20, 11, 200), (12.5, 4.25, 33.5)]
        lines = "".join(json.dumps({"call": "tango", "gained": g, "lost": l, "pairs": n}) + "\n" for g, l, n in cases)
        done = subprocess.run([PROGRAM], input=lines, capture_output=True, text=True, check=True)
        for case, line in zip(cases, done.stdout.splitlines()):
            low, high = json.loads(line)
            self.assertAlmostEqual(score(*case, low), stats.norm.ppf(0.975), 4, case)
            self.assertAlmostEqual(score(*case, high), stats.norm.ppf(0.025), 4, case)

    def test_quantile_interval(self):
        calls, expected = [], []
        for q, n in [(0.5, 6), (0.5, 25), (0.1, 60), (0.95, 72), (0.95, 300), (0.99, 400)]:
            for confidence in (0.9, 0.95) if n != 6 else (0.95,):
                sample = self.sample(n, 6)
                ranks = [optimize.brentq(lambda r, p=p: stats.beta.cdf(q, r, n + 1 - r) - p, 1, n, xtol=1e-13)
                         for p in ((1 + confidence) / 2, (1 - confidence) / 2)]
                calls.append({"call": "quantile_interval", "of": list(sample), "q": q, "units": n,
                              "confidence": confidence})
                expected.append(list(np.interp(ranks, np.arange(1, n + 1), np.sort(sample))))
        self.compare(calls, expected, absolute=1e-9)


def flat(value):
    if isinstance(value, (list, tuple, np.ndarray)):
        return [number for part in value for number in flat(part)]
    return [float("nan") if value is None else float(value)]


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
