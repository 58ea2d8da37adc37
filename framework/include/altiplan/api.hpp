// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks what libaltiplan.so exports; everything else is hidden.
#define ALTIPLAN_API __attribute__((visibility("default")))

/// Version of the plugin interface. A library built for another major, or for a newer minor, is
/// refused.
#define ALTIPLAN_API_MAJOR 0
#define ALTIPLAN_API_MINOR 1
