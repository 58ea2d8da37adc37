// SPDX-License-Identifier: Apache-2.0
// Worlds of Gazebo (SDF, .world): what vehicles may collide with, as it stands when the simulation
// begins. BARN's worlds are of cylinders alone: D. Perille et al., "Benchmarking Metric Ground
// Navigation", IEEE SSRR 2020, doi:10.1109/SSRR50563.2020.9292572.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <string_view>

#include "altiplan/environment.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;
using Node = pugi::xml_node;

constexpr int kMaxDepth = 64;      // of models in models
constexpr double kUpright = 1e-9;  // rad

struct Params {
  Path file;

  void describe(Fields& f) { f("file", file).doc("world of Gazebo (.world, .sdf)").required(); }
};

/// Where a part of a world stands, metres and radians; upright unless it is tilted.
struct Pose {
  Vec3 at{0, 0, 0};
  double yaw = 0;
  bool tilted = false;

  /// Of a part within this one.
  Pose of(const Pose& part) const {
    const double c = std::cos(yaw);
    const double s = std::sin(yaw);
    return {at + Vec3(c * part.at.x() - s * part.at.y(), s * part.at.x() + c * part.at.y(),
                      part.at.z()),
            yaw + part.yaw, tilted || part.tilted};
  }
};

class WorldReader {
 public:
  explicit WorldReader(const std::string& file) : file_(file) {
    if (const std::string why = formats::why_unreadable(file); !why.empty()) {
      throw ParameterError("file", file + ": " + why);
    }
    text_ = formats::read_file(file);
  }

  std::vector<Shape> shapes() {
    pugi::xml_document document;
    const auto parsed = document.load_buffer(text_.data(), text_.size());
    if (!parsed) {
      refuse(parsed.offset, parsed.description());
    }
    const Node world = document.child("sdf").child("world");
    if (!world || world.next_sibling("world")) {
      refuse(0, "expected one <world> in <sdf>");
    }
    for (const char* change : {"insertions", "deletions"}) {
      if (const Node node = world.child("state").child(change).first_child()) {
        refuse(node, "a state with <" + std::string(change) + "> is not read");
      }
    }
    for (const Node model : world.child("state").children("model")) {
      if (model.child("pose")) {
        saved_[model.attribute("name").value()] = pose_of(model);
      }
    }
    for (const Node part : world.children()) {
      const std::string_view name = part.name();
      if (name == "model") {
        const auto saved = saved_.find(part.attribute("name").value());
        add_model(part, saved == saved_.end() ? pose_of(part) : saved->second, 1);
      } else if (name == "include" || name == "actor" || name == "population" || name == "road") {
        refuse(part, "<" + std::string(name) + "> is not read: expected models of the world's own");
      }
    }
    return std::move(shapes_);
  }

 private:
  [[noreturn]] void refuse(std::ptrdiff_t offset, const std::string& why) const {
    const auto end = text_.begin() + std::clamp<std::ptrdiff_t>(offset, 0, text_.size());
    throw ParameterError(
        "file",
        file_ + ":" + std::to_string(1 + std::count(text_.begin(), end, '\n')) + ": " + why);
  }
  [[noreturn]] void refuse(const Node& node, const std::string& why) const {
    refuse(node.offset_debug(), why);
  }

  template <std::size_t kCount>
  std::array<double, kCount> numbers(const Node& node) const {
    std::array<double, kCount> all{};
    if (node.first_child() != node.last_child()) {
      refuse(node, "expected a text of one piece, without comments");
    }
    std::string_view text = node.text().get();
    const std::string found = excerpt(std::string(text));
    for (double& number : all) {
      text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
      if (error != std::errc() || !std::isfinite(number)) {
        refuse(node, "expected " + std::to_string(kCount) + " numbers in <" + node.name() +
                         ">, found " + found);
      }
      text.remove_prefix(std::size_t(end - text.data()));
    }
    if (text.find_first_not_of(" \t\r\n") != text.npos) {
      refuse(node, "expected " + std::to_string(kCount) + " numbers in <" + node.name() +
                       ">, found " + found);
    }
    return all;
  }

  double size(const Node& of, const char* name) const {
    const Node node = of.child(name);
    if (!node) {
      refuse(of, "expected <" + std::string(name) + "> in <" + of.name() + ">");
    }
    const double number = numbers<1>(node)[0];
    if (number <= 0) {
      refuse(node, "expected a <" + std::string(name) + "> above 0, found " + node.text().get());
    }
    return number;
  }

  /// That of <pose> in the node; without one that of what it is part of.
  Pose pose_of(const Node& of) const {
    const Node node = of.child("pose");
    if (!node) {
      return {};
    }
    for (const char* name : {"frame", "relative_to", "degrees", "rotation_format"}) {
      if (*node.attribute(name).value() != 0) {
        refuse(node, "a pose with '" + std::string(name) + "' is not read");
      }
    }
    const auto [x, y, z, roll, pitch, yaw] = numbers<6>(node);
    return {{x, y, z}, yaw, std::max(std::abs(roll), std::abs(pitch)) > kUpright};
  }

  void add_model(const Node& model, const Pose& pose, int depth) {
    if (depth > kMaxDepth) {
      refuse(model, "models are nested more than " + std::to_string(kMaxDepth) + " levels deep");
    }
    for (const Node part : model.children()) {
      const std::string_view name = part.name();
      if (name == "link") {
        const Pose of_link = pose.of(pose_of(part));
        for (const Node collision : part.children("collision")) {
          add_geometry(collision, of_link.of(pose_of(collision)));
        }
      } else if (name == "model") {
        add_model(part, pose.of(pose_of(part)), depth + 1);
      } else if (name == "plugin") {
        refuse(part, "a model with a plugin may move, and is not read");
      } else if (name == "include") {
        refuse(part, "<include> is not read: expected models of the world's own");
      }
    }
  }

  void add_geometry(const Node& collision, const Pose& pose) {
    const Node shape = collision.child("geometry").first_child();
    const std::string_view name = shape.name();
    const Vec3& at = pose.at;
    if (name == "plane" || name == "empty") {
      return;  // ground: the scenario's volume ends at it
    }
    if (name == "sphere") {
      shapes_.push_back(Sphere{at, size(shape, "radius")});
      return;
    }
    if (name != "cylinder" && name != "box") {
      refuse(shape ? shape : collision,
             "expected a <cylinder>, <box>, <sphere> or <plane>, found " +
                 (shape ? "<" + std::string(name) + ">" : std::string("no geometry")));
    }
    if (pose.tilted) {
      refuse(collision, "expected <" + std::string(name) + "> upright: roll and pitch are not 0");
    }
    if (name == "cylinder") {
      const double half = size(shape, "length") / 2;
      shapes_.push_back(
          Cylinder{at.x(), at.y(), size(shape, "radius"), at.z() - half, at.z() + half});
      return;
    }
    const Node node = shape.child("size");
    const auto sides = numbers<3>(node ? node : shape);
    if (*std::min_element(sides.begin(), sides.end()) <= 0) {
      refuse(node, "expected a <size> above 0, found " + std::string(node.text().get()));
    }
    Prism prism;
    prism.floor = at.z() - sides[2] / 2;
    prism.ceiling = at.z() + sides[2] / 2;
    constexpr std::array<std::array<int, 2>, 4> kCorners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    for (const std::array<int, 2>& to : kCorners) {
      const Pose corner = pose.of({{to[0] * sides[0] / 2, to[1] * sides[1] / 2, 0}, 0, false});
      prism.outline.push_back({corner.at.x(), corner.at.y()});
    }
    shapes_.push_back(std::move(prism));
  }

  const std::string file_;
  std::string text_;
  std::map<std::string, Pose, std::less<>> saved_;  ///< of models, in <state>
  std::vector<Shape> shapes_;
};

class Gazebo final : public kit::ShapeLayer {
 public:
  Gazebo(const Params& params, const Site&) : ShapeLayer(WorldReader(params.file.text).shapes()) {}
};
}  // namespace

ALTIPLAN_PLUGIN(Environment, "gazebo", Gazebo, Params,
                "the cylinders, boxes and spheres of a world of Gazebo (SDF)")
