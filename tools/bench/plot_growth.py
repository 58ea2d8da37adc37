#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plots the time of an expansion against the size of the map, from the output of `search`.

altiplan-bench search --json > growth.json
plot_growth.py growth.json docs/images/growth.svg
"""
import json
import re
import statistics
import sys
from collections import defaultdict

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "altiplan"  # equal figures, equal file
from matplotlib import pyplot  # noqa: E402

TITLES = {"city_3d": "city, 26 neighbours", "city_2d": "city, 8 neighbours"}


def read(path):
    """{city: {planner: {cells over the smallest: [nanoseconds an expansion]}}}"""
    curves = defaultdict(lambda: defaultdict(lambda: defaultdict(list)))
    with open(path, encoding="utf-8") as file:
        rows = json.load(file)["benchmarks"]
    for row in rows:
        match = re.fullmatch(r"(\w+)/(\d+)x/(\w+)", row["name"].removesuffix("_median"))
        if match and row.get("aggregate_name", "median") == "median":
            city, factor, planner = match.groups()
            curves[city][planner][int(factor)].append(1e9 * row["per_expansion"])
    return curves


def main(source, target):
    curves = read(source)
    figure, axes = pyplot.subplots(1, len(curves), figsize=(9, 3.6), squeeze=False)
    for axis, (city, planners) in zip(axes[0], sorted(curves.items())):
        for planner, times in sorted(planners.items()):
            if planner == "jps":  # its expansions are scans: another unit
                continue
            factors = sorted(times)
            medians = [statistics.median(times[f]) for f in factors]
            axis.plot(factors, medians, marker="o", label=planner)
        axis.set_xscale("log", base=2)
        axis.set_yscale("log")
        axis.set_xticks(factors, [f"{f}×" for f in factors])
        axis.set_xlabel("cells")
        axis.set_ylabel("ns an expansion")
        axis.set_title(TITLES.get(city, city))
        axis.grid(True, which="both", alpha=0.3)
        axis.legend()
    figure.tight_layout()
    figure.savefig(target, metadata={"Date": None})


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
