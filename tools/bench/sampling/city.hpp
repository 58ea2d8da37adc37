// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "altiplan/planner.hpp"
#include "host/config/config.hpp"
#include "host/config/yaml.hpp"

namespace altiplan::bench {

/// Towers on three tenths of the ground of 80 x 80 x 100 cells of a metre, and ways across it: free
/// cells' centres at least half the diagonal apart; `low`: both ends in the lowest fifth, most of
/// them with towers in the straight way.
class City {
 public:
  City(bool low, std::size_t queries);
  const std::vector<Request>& queries() const { return queries_; }
  /// Ways whose straight leg is free.
  std::size_t open() const { return open_; }

 private:
  std::vector<Request> queries_;
  std::size_t open_ = 0;
};

/// A planner of this build, with parameters as a user writes them.
inline std::shared_ptr<const Planner> planner(const std::string& name, const std::string& with) {
  static host::Registry registry(host::Registry::search_path({}));
  const Value parameters = host::parse_yaml(with, name);
  return host::plugin(registry, "planner", name).planner(&parameters);
}

/// The value below which that share of the values lies.
inline double quantile(std::vector<double> values, double share) {
  const std::size_t n = std::min(values.size() - 1, std::size_t(share * double(values.size())));
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(n), values.end());
  return values[n];
}
}  // namespace altiplan::bench
