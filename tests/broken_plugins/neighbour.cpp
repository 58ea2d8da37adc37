// SPDX-License-Identifier: Apache-2.0
// A library of its own that lies beside the plugin which uses it.
extern "C" __attribute__((visibility("default"))) int neighbours_answer() { return 42; }
