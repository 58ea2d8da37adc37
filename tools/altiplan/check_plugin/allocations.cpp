// SPDX-License-Identifier: Apache-2.0
// Counts the allocations of each thread: a pilot's step must not allocate. A build with sanitizers
// keeps their operators.
#include <cstdlib>
#include <new>

#include "plugin_test.hpp"

namespace {
thread_local std::uint64_t allocations = 0;
}  // namespace

#ifndef ALTIPLAN_SANITIZED
void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) {
    return memory;
  }
  throw std::bad_alloc();
}
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // when only one of the two is inlined
#endif
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
#endif

std::uint64_t altiplan::cli::allocations_of_this_thread() { return allocations; }
