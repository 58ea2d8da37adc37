// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/value.hpp"
#include "host/config/yaml_source.hpp"

namespace altiplan::host {

/// The tree of a text that is JSON, which is YAML too, in a third of the time; none if it is no
/// JSON, or is to be refused, which the reader of YAML does.
std::optional<Value> read_if_json(const YamlSource& source);
}  // namespace altiplan::host
