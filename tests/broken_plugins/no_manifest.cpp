// SPDX-License-Identifier: Apache-2.0
// A shared library that has nothing to do with altiplan, but for the fact that running any of its
// code ends the process.
#include <cstdlib>

namespace {
__attribute__((constructor)) void end_the_process() { std::abort(); }
}  // namespace
