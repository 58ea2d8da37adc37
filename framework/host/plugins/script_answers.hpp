// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/request.hpp"
#include "host/plugins/script_worker.hpp"

namespace altiplan::host {

/// The answer to what a planner in Python asks about the world of its request. Throws PluginError
/// for what is no question, and what layers and constraints throw.
ScriptMessage script_answer(const ScriptMessage& question, const Request& request);
}  // namespace altiplan::host
