// SPDX-License-Identifier: Apache-2.0
#include "guarded_run.hpp"
#include "host/gate/route_returns.hpp"

namespace altiplan::cli {

decltype(host::RunOptions::judge_returns) returns_judge() { return host::judge_route_returns; }
}  // namespace altiplan::cli
