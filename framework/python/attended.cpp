// SPDX-License-Identifier: Apache-2.0
#include "python/attended.hpp"

namespace altiplan::python {

std::optional<py::error_already_set> attend(
    const std::function<bool(std::chrono::milliseconds)>& wait, const std::stop_source& stop) {
  constexpr std::chrono::milliseconds kLookEvery(50);
  constexpr std::chrono::milliseconds kPatience(2000);
  std::optional<py::error_already_set> raised;
  const py::gil_scoped_release released;
  while (!wait(kLookEvery)) {
    {
      const py::gil_scoped_acquire held;
      if (PyErr_CheckSignals() == 0) {
        continue;
      }
      raised.emplace();
    }
    stop.request_stop();
    wait(kPatience);
    break;
  }
  return raised;
}
}  // namespace altiplan::python
