// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace altiplan::testing {

/// Whether a sanitizer is at work, which takes memory of its own and answers crashes in its own
/// way.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kInstrumented = true;
#elif defined(__has_feature)
inline constexpr bool kInstrumented =
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kInstrumented = false;
#endif
}  // namespace altiplan::testing
