// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/request.hpp"
#include "host/scripts/worker.hpp"

namespace altiplan::host {

/// What a plugin in Python may ask about.
struct ScriptAsked {
  const World* world = nullptr;      ///< null: of none is anything known
  const Request* request = nullptr;  ///< in which it plans, or null
  const Frame* frame = nullptr;      ///< in which it builds a layer, or null: the world's
};

/// The answer to a question. Throws PluginError for what is no question, and what layers and
/// constraints throw.
ScriptMessage script_answer(const ScriptMessage& question, const ScriptAsked& asked);
}  // namespace altiplan::host
