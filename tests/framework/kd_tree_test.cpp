// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/sampling/kd_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "altiplan/random.hpp"

namespace altiplan::kit::kd_tree_test {
namespace {

/// Looks at each point.
struct Plain {
  std::vector<Vec3> points;
  std::vector<bool> in;

  std::size_t least(const std::function<double(const Vec3&)>& figure) const {
    std::size_t best = KdTree::kNone;
    double least = kInfinity;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (in[i] && figure(points[i]) < least) {
        least = figure(points[i]);
        best = i;
      }
    }
    return best;
  }
  std::vector<std::size_t> all(const std::function<bool(const Vec3&)>& is_meant) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (in[i] && is_meant(points[i])) {
        found.push_back(i);
      }
    }
    return found;
  }
};

/// Where the points of a tree lie, and what is asked.
struct Kind {
  std::string name;
  std::function<Vec3(RandomStream&, const Plain&)> draw;
};

double whole(RandomStream& random, int most) { return double(random.integer(0, most)); }

Vec3 anywhere(RandomStream& random) { return random.in({{0, 0, 0}, {1000, 800, 90}}); }

const std::vector<Kind> kKinds{
    {"scattered", [](RandomStream& random, const Plain&) { return anywhere(random); }},
    {"raster",
     [](RandomStream& random, const Plain&) {
       const double x = whole(random, 7);
       const double y = whole(random, 7);
       return Vec3(x, y, whole(random, 3) / 2);
     }},
    {"one place", [](RandomStream&, const Plain&) { return Vec3(3, 4, 5); }},
    {"line", [](RandomStream& random,
                const Plain&) { return Vec3(Vec3(1, 2, 0.5) * whole(random, 100'000)); }},
    {"level",
     [](RandomStream& random, const Plain&) {
       const Vec3 p = anywhere(random);
       return Vec3(p.x(), p.y(), 120);
     }},
    {"far",
     [](RandomStream& random, const Plain&) {
       return Vec3(Vec3(612'000, 5'300'000, 400) + anywhere(random) / 50);
     }},
    {"forward",
     [](RandomStream&, const Plain& plain) { return Vec3(double(plain.points.size()), 0, 0); }},
    {"frontier",
     [](RandomStream& random, const Plain& plain) {
       const Vec3 to = anywhere(random);
       const std::size_t near = plain.least([&](const Vec3& x) { return (x - to).squaredNorm(); });
       if (near == KdTree::kNone) {
         return Vec3(500, 400, 50);
       }
       const Vec3 from = plain.points[near];
       return Vec3(from + (to - from) * std::min(10 / (to - from).norm(), 1.0));
     }},
};

void expect_equal(const KdTree& tree, const Plain& plain, const Vec3& p, const Vec3& q,
                  RandomStream& random) {
  EXPECT_EQ(tree.nearest(p), plain.least([&](const Vec3& x) { return (x - p).squaredNorm(); }));
  for (const double p_weight : {1.0, 0.0}) {
    const double q_weight = whole(random, 3) / 2;
    EXPECT_EQ(tree.min_sum(p, p_weight, q, q_weight), plain.least([&](const Vec3& x) {
      return p_weight * (x - p).norm() + q_weight * (x - q).norm();
    })) << p_weight
        << ' ' << q_weight;
  }
  std::vector<std::size_t> found{7};
  const double radius = (p - q).norm() / (1 + whole(random, 5));
  tree.within(p, radius, found);
  EXPECT_EQ(found,
            plain.all([&](const Vec3& x) { return (x - p).squaredNorm() <= radius * radius; }));
  const std::size_t count = std::size_t(whole(random, 40));
  tree.nearest(p, count, found);
  std::vector<std::size_t> nearest = plain.all([](const Vec3&) { return true; });
  std::stable_sort(nearest.begin(), nearest.end(), [&](std::size_t a, std::size_t b) {
    return (plain.points[a] - p).squaredNorm() < (plain.points[b] - p).squaredNorm();
  });
  nearest.resize(std::min(nearest.size(), count));
  EXPECT_EQ(found, nearest);
  const Box box = Box::empty().with(p).with(q);
  tree.within(box, found);
  EXPECT_EQ(found, plain.all([&](const Vec3& x) { return box.contains(x); }));
}

/// Steps of each sort come in spells, so that the tree also gets empty.
void run_kind(const Kind& kind, KdTree& tree) {
  RandomStream random = RandomStream(5).sub(kind.name);
  Plain plain;
  tree.clear();
  const auto some = [&] { return std::size_t(whole(random, int(plain.points.size()) - 1)); };
  for (int step = 0; step < 2600; ++step) {
    const int spell = step / 200 % 4;
    const int sort = int(random.integer(0, 9)) < 7 ? spell : int(random.integer(0, 3));
    if (sort < 2 || plain.points.empty()) {
      plain.points.push_back(kind.draw(random, plain));
      plain.in.push_back(true);
      ASSERT_EQ(tree.insert(plain.points.back()), plain.points.size() - 1);
    } else {
      const std::size_t number = some();
      if (plain.in[number] && sort == 2) {
        tree.erase(number);
        plain.in[number] = false;
      } else if (!plain.in[number] && sort == 3) {
        tree.restore(number);
        plain.in[number] = true;
      }
      ASSERT_EQ(tree.contains(number), plain.in[number]);
    }
    if (step % 13 == 0 || step < 60) {
      const Vec3 p = kind.draw(random, plain);
      const Vec3 q = random.integer(0, 1) == 0 ? kind.draw(random, plain) : plain.points[some()];
      expect_equal(tree, plain, p, q, random);
      ASSERT_FALSE(::testing::Test::HasFailure()) << kind.name << ", step " << step;
    }
  }
  for (std::size_t number = 0; number < plain.points.size(); ++number) {
    if (plain.in[number]) {
      tree.erase(number);
      plain.in[number] = false;
    }
  }
  expect_equal(tree, plain, {1, 2, 3}, {4, 5, 6}, random);
  EXPECT_EQ(tree.depth(), 0u);
}

TEST(KdTree, EqualsLookingAtEachPoint) {
  KdTree tree;
  EXPECT_EQ(tree.nearest({0, 0, 0}), KdTree::kNone);
  EXPECT_EQ(tree.min_sum({0, 0, 0}, 1, {1, 0, 0}, 1), KdTree::kNone);
  for (const Kind& kind : kKinds) {
    run_kind(kind, tree);
  }
}

TEST(KdTree, IsAsDeepWhateverTheOrder) {
  constexpr int kCount = 20'000;
  const std::vector<std::function<Vec3(int, RandomStream&)>> orders{
      [](int, RandomStream& random) { return anywhere(random); },
      [](int i, RandomStream&) { return Vec3(i, 0, 0); },
      [](int i, RandomStream&) { return Vec3(-i, i, 2 * i); },
      [](int i, RandomStream&) { return Vec3(i % 2 == 0 ? i : -i, 0, 0); },
      [](int i, RandomStream&) { return Vec3(std::pow(0.99, i), 0, 0); },
      [](int i, RandomStream&) { return Vec3(i * std::cos(i), i * std::sin(i), 0); },
      [](int, RandomStream&) { return Vec3(1, 1, 1); },
  };
  for (std::size_t order = 0; order < orders.size(); ++order) {
    RandomStream random(6);
    KdTree tree;
    for (int i = 0; i < kCount; ++i) {
      tree.insert(orders[order](i, random));
    }
    EXPECT_LE(tree.depth(), 8u) << order;
    const std::size_t before = tree.depth();
    for (std::size_t i = 0; i < kCount; i += 2) {
      tree.erase(i);
    }
    for (std::size_t i = 0; i < kCount; i += 2) {
      tree.restore(i);
    }
    tree.restore(0);  // is in
    EXPECT_LE(tree.depth(), before + 1) << order;
  }
}

TEST(KdTree, EqualsLookingAtEachOfManyPoints) {
  RandomStream random(7);
  KdTree tree;
  Plain plain;
  tree.reserve(30'000);
  for (int i = 0; i < 30'000; ++i) {
    plain.points.push_back(anywhere(random));
    plain.in.push_back(i % 3 != 0);
    tree.insert(plain.points.back());
  }
  for (std::size_t i = 0; i < plain.points.size(); i += 3) {
    tree.erase(i);
  }
  for (int n = 0; n < 60; ++n) {
    const Vec3 p = anywhere(random);
    const Vec3 q = anywhere(random);
    expect_equal(tree, plain, p, n % 5 == 0 ? p : q, random);
  }
}
}  // namespace
}  // namespace altiplan::kit::kd_tree_test
