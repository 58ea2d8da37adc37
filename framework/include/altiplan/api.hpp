// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Exports a symbol from libaltiplan.so; everything else is hidden.
#define ALTIPLAN_API __attribute__((visibility("default")))

/// Version of the plugin interface, see docs/reference/abi.md. A library built for another major,
/// or for a newer minor, is refused.
#define ALTIPLAN_API_MAJOR 3
#define ALTIPLAN_API_MINOR 0

/// For sources built against several versions: `#if ALTIPLAN_API_AT_LEAST(3, 1)`.
#define ALTIPLAN_API_AT_LEAST(major, minor) \
  (ALTIPLAN_API_MAJOR > (major) || (ALTIPLAN_API_MAJOR == (major) && ALTIPLAN_API_MINOR >= (minor)))
