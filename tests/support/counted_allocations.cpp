// SPDX-License-Identifier: Apache-2.0
#include "support/counted_allocations.hpp"

#include <cstdlib>
#include <new>

namespace altiplan::testing {
bool counting = false;
long allocations = 0;
}  // namespace altiplan::testing

void* operator new(std::size_t size) {
  altiplan::testing::allocations += altiplan::testing::counting;
  if (void* memory = std::malloc(size)) {
    return memory;
  }
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
