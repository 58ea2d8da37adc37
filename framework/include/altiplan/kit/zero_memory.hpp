// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>

namespace altiplan::kit {

/// Memory that is zero until written; the system gives none to pages that nothing touches.
class ZeroMemory {
 public:
  ZeroMemory() = default;
  /// std::bad_alloc if the system refuses.
  explicit ZeroMemory(std::size_t bytes) : bytes_(bytes) {
    if (bytes < kHugePage) {
      memory_ = values_ = std::calloc(bytes, 1);
    } else {
      mapped_ = bytes + kHugePage;
      memory_ = ::mmap(nullptr, mapped_, PROT_READ | PROT_WRITE,
                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
      memory_ = memory_ == MAP_FAILED ? nullptr : memory_;
    }
    if (memory_ == nullptr) {
      throw std::bad_alloc();
    }
    if (mapped_ > 0) {
      values_ = memory_;
      std::size_t left = mapped_;
      std::align(kHugePage, bytes, values_, left);
      if (bytes <= kHuge) {
        ::madvise(values_, bytes, MADV_HUGEPAGE);
      }
    }
  }
  ZeroMemory(ZeroMemory&& other) noexcept { *this = std::move(other); }
  ZeroMemory& operator=(ZeroMemory&& other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(values_, other.values_);
    std::swap(bytes_, other.bytes_);
    std::swap(mapped_, other.mapped_);
    return *this;
  }
  ~ZeroMemory() {
    if (mapped_ > 0) {
      ::munmap(memory_, mapped_);
    } else {
      std::free(memory_);
    }
  }

  void* data() const { return values_; }
  std::size_t size() const { return bytes_; }

 private:
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;
  /// Up to this size, memory is backed by huge pages: it is touched far faster, but of a larger one
  /// a few places of each may be written.
  static constexpr std::size_t kHuge = std::size_t{512} << 20;

  void* memory_ = nullptr;
  void* values_ = nullptr;  // on a huge page if mapped
  std::size_t bytes_ = 0;
  std::size_t mapped_ = 0;  // 0: allocated
};
}  // namespace altiplan::kit
