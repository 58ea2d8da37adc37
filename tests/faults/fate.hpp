// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

/// Calls of the system that are made to fail, as the environment says (see injector.py):
///
///   FAULTS_STATE   a file of zeros of the size of State: counts, and what has failed
///   FAULTS_CALLS   kinds, as bits in the order of Call
///   FAULTS_NTH     which call of these kinds is the first to fail, from 1; 0: none, only count
///   FAULTS_TIMES   how many fail; 0: all from then on
///   FAULTS_ERROR   errno; -1: SIGKILL; -2: half of what was asked is read or written
///   FAULTS_SCOPE   tree: one count for all processes; process: one for each; children: one for
///                  all but the first
///   FAULTS_BELOW   folders, with colons between, whose files alone are meant; "": all but those
///                  of /proc, /sys and /dev, and what is no file
namespace faults {

enum Call : unsigned {
  kOpen,
  kRead,
  kWrite,
  kSync,
  kTruncate,
  kRename,
  kLink,
  kUnlink,
  kMkdir,
  kStat,
  kClose,
  kLock,
  kFork,
  kMap,
  kDescriptor,
  kCalls,
};

using Path = std::array<char, 1024>;

/// Of an open file; "pipe:[4711]" and the like where it has no name.
Path path_of(long file);
constexpr long kWorkingFolder = -100;  // AT_FDCWD
/// The name from the root. It need not be the shortest.
Path path_of(const char* name, long folder = kWorkingFolder);

/// Whether the call fails; then errno says so.
bool fails(Call call, const Path& path = {});
/// Bytes that may be read or written: none where the call fails.
std::size_t granted(Call call, long file, std::size_t asked);
/// After a fork: a process counts its own calls.
void begin_own_count();
}  // namespace faults
