// SPDX-License-Identifier: Apache-2.0
// Point queries in a k-d tree compared with linear search: the nearest, and the lowest weighted sum
// of the distances to a sample and the goal. Points lie anywhere, or where trees grow over the
// volume of uav_rrt's main layout without obstacles.
#include <functional>
#include <memory>
#include <vector>

#include "altiplan/kit/sampling/kd_tree.hpp"
#include "altiplan/random.hpp"
#include "rows.hpp"

namespace altiplan::bench {
namespace {

constexpr std::size_t kQueries = 16'384;
constexpr std::size_t kCompared = 64;  ///< their answers, before a row is timed

const Box kVolume{{0, 0, 0}, {27000, 28000, 2500}};
const Vec3 kStart(4000, 5000, 700);
const Vec3 kGoal(23000, 23500, 700);
constexpr double kStep = 150;

using kit::KdTree;

Vec3 stepped(const Vec3& from, const Vec3& to) {
  const double distance = (to - from).norm();
  return distance <= kStep ? to : Vec3(from + (kStep / distance) * (to - from));
}

void scatter(KdTree& tree, std::size_t count) {
  RandomStream random(1);
  while (tree.size() < count) {
    tree.insert(random.in(kVolume));
  }
}

/// Extends the nearest node toward the sample.
void grow_nearest(KdTree& tree, std::size_t count) {
  RandomStream random(2);
  tree.insert(kStart);
  while (tree.size() < count) {
    const Vec3 sample = random.in(kVolume);
    tree.insert(stepped(tree.point(tree.nearest(sample)), sample));
  }
}

/// Extends the node with the minimum sum of distances, once toward the goal, then toward the
/// sample. The goal is walled in, otherwise the nodes form a star around it; a node that has failed
/// 50 times is erased.
void grow_min_sum(KdTree& tree, std::size_t count) {
  constexpr double kWall = 2000;
  constexpr int kMaxFailures = 50;
  struct Node {
    bool tried;
    int failures;
  };
  RandomStream random(3);
  std::vector<Node> nodes{{false, 0}};
  tree.insert(kStart);
  while (tree.size() < count) {
    const Vec3 sample = random.in(kVolume);
    const std::size_t near = tree.min_sum(sample, 1, kGoal, 1);
    const bool toward_goal = !nodes[near].tried && random.uniform() >= 0.5;
    nodes[near].tried = nodes[near].tried || toward_goal;
    const Vec3 p = stepped(tree.point(near), toward_goal ? kGoal : sample);
    if ((p - kGoal).norm() > kWall) {
      tree.insert(p);
      nodes.push_back({false, 0});
    } else if (++nodes[near].failures == kMaxFailures) {
      tree.erase(near);
    }
  }
}

using Grow = void (*)(KdTree&, std::size_t);
using Ask = std::size_t (*)(const KdTree&, const Vec3&);

std::size_t nearest(const KdTree& tree, const Vec3& sample) { return tree.nearest(sample); }

std::size_t nearest_linear(const KdTree& tree, const Vec3& sample) {
  std::size_t best = KdTree::kNone;
  double min_found = kInfinity;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const double square = (tree.point(i) - sample).squaredNorm();
    if (square < min_found) {
      min_found = square;
      best = i;
    }
  }
  return best;
}

std::size_t min_sum(const KdTree& tree, const Vec3& sample) {
  return tree.min_sum(sample, 1, kGoal, 1);
}

std::size_t min_sum_linear(const KdTree& tree, const Vec3& sample) {
  std::size_t best = KdTree::kNone;
  double min_found = kInfinity;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const double sum = (tree.point(i) - sample).norm() + (tree.point(i) - kGoal).norm();
    if (sum < min_found && tree.contains(i)) {
      min_found = sum;
      best = i;
    }
  }
  return best;
}

struct Points {
  KdTree tree;
  std::vector<Vec3> samples;

  Points(Grow grow, std::size_t count) {
    grow(tree, count);
    RandomStream random(4);
    for (std::size_t n = 0; n < kQueries; ++n) {
      samples.push_back(random.in(kVolume));
    }
  }
};

/// Created on first use; the tree and the linear row share it.
class LatePoints {
 public:
  LatePoints(Grow grow, std::size_t count) : grow_(grow), count_(count) {}
  const Points& get() {
    if (!points_) {
      points_ = std::make_unique<Points>(grow_, count_);
    }
    return *points_;
  }

 private:
  Grow grow_;
  std::size_t count_;
  std::unique_ptr<Points> points_;
};

void add_row(const std::string& name, const std::shared_ptr<LatePoints>& late, Ask ask, Ask other) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    const Points& points = late->get();
    for (std::size_t n = 0; n < kCompared; ++n) {
      if (ask(points.tree, points.samples[n]) != other(points.tree, points.samples[n])) {
        throw WrongAnswer(name + ": query " + std::to_string(n) + " has two answers");
      }
    }
    std::size_t n = 0;
    for (auto _ : state) {
      benchmark::DoNotOptimize(ask(points.tree, points.samples[n]));
      n = (n + 1) % kQueries;
    }
  });
}

/// Mean time per node of a tree grown from empty.
void add_growth_row(const std::string& name, Grow grow, std::size_t count) {
  benchmark::RegisterBenchmark(
      (name + std::to_string(count)).c_str(), [=](benchmark::State& state) {
        KdTree tree;
        for (auto _ : state) {
          tree.clear();
          grow(tree, count);
        }
        using benchmark::Counter;
        state.counters["per_node"] =
            Counter(double(count), Counter::kIsIterationInvariantRate | Counter::kInvert);
      });
}
/// Mean time to erase and reinsert a point: half the tree at once, as when a branch is cut off.
void add_pruning_row(const std::string& name, const std::shared_ptr<LatePoints>& late) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    KdTree tree = late->get().tree;
    const Vec3 middle = (kVolume.min + kVolume.max) / 2;
    std::vector<std::size_t> half;
    tree.within(Box{kVolume.min, {middle.x(), kVolume.max.y(), kVolume.max.z()}}, half);
    for (auto _ : state) {
      for (const std::size_t number : half) {
        tree.erase(number);
      }
      for (const std::size_t number : half) {
        tree.restore(number);
      }
    }
    using benchmark::Counter;
    state.counters["per_point"] =
        Counter(double(half.size()), Counter::kIsIterationInvariantRate | Counter::kInvert);
  });
}
}  // namespace

void add_point_rows() {
  for (const std::size_t count : {1'000, 10'000, 100'000, 1'000'000}) {
    const std::string of = "/" + std::to_string(count) + "/";
    const auto scattered = std::make_shared<LatePoints>(scatter, count);
    const auto basic = std::make_shared<LatePoints>(grow_nearest, count);
    const auto improved = std::make_shared<LatePoints>(grow_min_sum, count);
    add_row("nearest/scattered" + of + "tree", scattered, nearest, nearest_linear);
    add_row("nearest/scattered" + of + "linear", scattered, nearest_linear, nearest);
    add_row("nearest/grown" + of + "tree", basic, nearest, nearest_linear);
    add_row("nearest/grown" + of + "linear", basic, nearest_linear, nearest);
    add_row("min_sum/scattered" + of + "tree", scattered, min_sum, min_sum_linear);
    add_row("min_sum/scattered" + of + "linear", scattered, min_sum_linear, min_sum);
    add_row("min_sum/grown" + of + "tree", improved, min_sum, min_sum_linear);
    add_row("min_sum/grown" + of + "linear", improved, min_sum_linear, min_sum);
    add_pruning_row("erase_and_restore" + of + "tree", basic);
  }
  for (const std::size_t count : {100, 10'000, 100'000, 1'000'000}) {
    add_growth_row("growth/nearest/", grow_nearest, count);
    add_growth_row("growth/min_sum/", grow_min_sum, count);
  }
}
}  // namespace altiplan::bench
