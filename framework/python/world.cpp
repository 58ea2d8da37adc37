// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "host/config/yaml.hpp"
#include "host/judge/judge.hpp"
#include "host/mission/mission.hpp"
#include "host/scripts/asked_world.hpp"
#include "python/arrays.hpp"
#include "python/attended.hpp"
#include "python/records.hpp"

namespace altiplan::python {
namespace {

namespace fs = std::filesystem;

/// The world of a scenario, with the problem that is posed in it. The configuration keeps the
/// plugins that made the layers.
struct FileWorld {
  host::Config config;
  host::Mission mission;
  bool is_known = false;

  const altiplan::World& world() const { return is_known ? mission.known : mission.truth; }
};
using WorldPointer = std::shared_ptr<FileWorld>;

/// Keys of a scenario, of which `--set` speaks as "scenario.KEY".
std::vector<std::string> of_scenario(std::vector<std::string> set) {
  static const std::string kPrefix = "scenario.";
  for (std::string& assignment : set) {
    const std::size_t begin = assignment.starts_with('~') ? 1 : 0;
    if (assignment.compare(begin, kPrefix.size(), kPrefix) != 0) {
      assignment.insert(begin, kPrefix);
    }
  }
  return set;
}

WorldPointer build(const fs::path& file, host::Overrides overrides, bool known) {
  const Value tree = host::load_yaml(file);
  if (host::kind_of(tree) == host::FileKind::scenario) {
    overrides.set = of_scenario(std::move(overrides.set));
  }
  auto world = std::make_shared<FileWorld>(FileWorld{host::kind_of(tree) == host::FileKind::scenario
                                                         ? host::load_scenario(file, overrides)
                                                         : host::load_config(file, overrides),
                                                     {},
                                                     known});
  world->mission = host::build_mission(world->config, 1);
  return world;
}

WorldPointer open(const Typed<"Union[str, PathLike[str]]">& file,
                  const Typed<"Mapping[str, Any]">& set,
                  const Typed<"Sequence[Union[str, PathLike[str]]]">& plugin_path, bool known) {
  const py::module_ values = py::module_::import("altiplan._values");
  const auto path = values.attr("path")(file, "file").cast<std::string>();
  host::Overrides overrides;
  overrides.set = values.attr("assignments")(set).cast<std::vector<std::string>>();
  for (const py::handle folder : values.attr("paths")(plugin_path, "plugin_path")) {
    overrides.plugin_path.emplace_back(folder.cast<std::string>());
  }
  WorldPointer world = attended<WorldPointer>(
      [=](const auto&, const std::stop_token&) { return build(path, overrides, known); });
  for (const std::string& warning : world->mission.warnings) {
    if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 1) != 0) {
      throw py::error_already_set();
    }
  }
  return world;
}

py::list layers_of(const FileWorld& world) {
  py::list ids;
  for (const Layer& layer : world.world().layers()) {
    ids.append(layer.id);
  }
  return ids;
}

Typed<"NDArray[float64]"> clearance(const FileWorld& world, const Typed<"ArrayLike">& points) {
  const Rows rows = rows_of(points, 3, "points");
  py::array_t<double> answers(rows.shape(0));
  double* to = answers.mutable_data();
  for_each_row(rows.shape(0), [&](py::ssize_t i) {
    to[i] = host::asked_clearance(world.world(), point_at(rows, i, "points"));
  });
  return answers;
}

Typed<"NDArray[bool_]"> legs_blocked(const FileWorld& world, const Typed<"ArrayLike">& a,
                                     const Typed<"ArrayLike">& b, double radius_m) {
  const Rows from = rows_of(a, 3, "a");
  const Rows to = rows_of(b, 3, "b");
  if (from.shape(0) != to.shape(0)) {
    throw py::value_error("b: expected shape (" + std::to_string(from.shape(0)) +
                          ", 3) as of a, found (" + std::to_string(to.shape(0)) + ", 3)");
  }
  if (!(radius_m >= 0) || !std::isfinite(radius_m)) {
    throw py::value_error("radius_m: expected a finite number from 0");
  }
  py::array_t<bool> answers(from.shape(0));
  bool* answer = answers.mutable_data();
  for_each_row(from.shape(0), [&](py::ssize_t i) {
    answer[i] =
        host::asked_blocked(world.world(), point_at(from, i, "a"), point_at(to, i, "b"), radius_m);
  });
  return answers;
}

Typed<"NDArray[float64]"> ground(const FileWorld& world, const Typed<"ArrayLike">& points_xy) {
  const Rows rows = rows_of(points_xy, 2, "points_xy");
  py::array_t<double> heights(rows.shape(0));
  double* to = heights.mutable_data();
  for_each_row(rows.shape(0), [&](py::ssize_t i) {
    const double* xy = rows.data() + 2 * i;
    to[i] = host::asked_ground(world.world(), xy[0], xy[1]);
  });
  return heights;
}

Check check(const FileWorld& world, const Typed<"Union[Route, ArrayLike]">& given) {
  const py::object type = py::type::of<Route>();
  const py::object object = py::isinstance<Route>(given) ? py::object(given) : type(given);
  const auto route = object.cast<std::shared_ptr<const Route>>();
  if (route->empty()) {
    throw py::value_error("route: expected at least one point");
  }
  const py::gil_scoped_release released;
  return Check{{host::to_json(host::judge(*route, world.mission.request, world.mission.via,
                                          world.mission.runways))},
               route};
}

py::array vector_of(const Vec3& v) { return py::array_t<double>(py::ssize_t(3), v.data()); }

py::array volume_of(const FileWorld& world) {
  Rows rows = fresh_rows(2, 3);
  const Box& volume = world.mission.request.volume;
  std::copy_n(volume.min.data(), 3, rows.mutable_data());
  std::copy_n(volume.max.data(), 3, rows.mutable_data() + 3);
  return rows;
}

void add_queries(py::class_<FileWorld, WorldPointer>& world) {
  world.def(
      "clearance", &clearance, py::arg("points"),
      "Signed distances from the nearest obstacle or ground (m), negative inside, of points of\n"
      "shape (n, 3): float64 of shape (n,). Infinite in an empty world, -inf of a point that is\n"
      "not finite; ValueError for another shape.");
  world.def(
      "legs_blocked", &legs_blocked, py::arg("a"), py::arg("b"), py::arg("radius_m") = 0.0,
      "Whether a sphere of this radius (m) meets an obstacle on the straight leg from a[i] to\n"
      "b[i]; both of shape (n, 3): bool of shape (n,). True of points that are not finite;\n"
      "ValueError for other shapes.");
  world.def(
      "ground", &ground, py::arg("points_xy"),
      "Heights of the ground above sea level (m) at points of shape (n, 2): float64 of shape\n"
      "(n,), nan where there is none; ValueError for another shape.");
  world.def(
      "check", &check, py::arg("route"),
      "The judge's verdict on a Route, or on points of shape (n, 3) in metres, in the world known\n"
      "at take-off: a Check of ends, volume, every leg, limit and constraint of the file.");
}
}  // namespace

void add_world(py::module_& module) {
  py::class_<FileWorld, WorldPointer> world(
      module, "World",
      "The layers of a scenario, or of a pipeline's, with the problem posed there; nothing changes "
      "it.\n"
      "World(file, set={}, plugin_path=(), known=False): `set` replaces values of the scenario, as "
      "of\n"
      "altiplan.run. All layers count; with `known`, only those that planners know at take-off.\n"
      "altiplan.Error for files and plugins that are refused.",
      py::is_final());
  add_constructor(world, &open, py::arg("file"), py::arg("set") = py::dict(),
                  py::arg("plugin_path") = py::tuple(), py::arg("known") = false);
  world.def_property_readonly("layers", &layers_of, "list[str]: the layers' ids.");
  world.def_property_readonly(
      "volume", &volume_of,
      "NDArray[float64]: (2, 3), lowest and highest corner of the volume (m).");
  world.def_property_readonly(
      "start", [](const FileWorld& w) { return vector_of(w.mission.request.start.position); },
      "NDArray[float64]: (3,), the start (m).");
  world.def_property_readonly(
      "goal", [](const FileWorld& w) { return vector_of(w.mission.request.goal.position); },
      "NDArray[float64]: (3,), the goal (m).");
  world.def_property_readonly(
      "warnings", [](const FileWorld& w) { return w.mission.warnings; },
      "list[str]: sentences to check.");
  add_queries(world);
  world.def("__repr__", [](const FileWorld& w) {
    const std::size_t count = w.world().layers().size();
    return "<altiplan.World '" + w.config.scenario_path.stem().string() + "' of " +
           std::to_string(count) + (count == 1 ? " layer>" : " layers>");
  });
}
}  // namespace altiplan::python
