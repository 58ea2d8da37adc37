// SPDX-License-Identifier: Apache-2.0
#pragma once

/// ALTIPLAN_CLONES before a function: compiled for the baseline and once more for CPUs with AVX2,
/// with all that it calls (what is not inlined would be compiled for the baseline alone), selected
/// when the library is loaded. The arithmetic is that of the source (no contraction), so both give
/// the same bits. Not used with sanitizers, which start after the selection.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define ALTIPLAN_CLONES
#endif
#endif
#if !defined(ALTIPLAN_CLONES) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && defined(__x86_64__) && defined(__has_attribute)
#if __has_attribute(target_clones)
#ifdef __clang__  // knows no clones with all that they call
#define ALTIPLAN_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define ALTIPLAN_CLONES __attribute__((target_clones("avx2", "default"), flatten))
#endif
#endif
#endif
#ifndef ALTIPLAN_CLONES
#define ALTIPLAN_CLONES
#endif
