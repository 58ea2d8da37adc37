// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>

#include "altiplan/environment.hpp"
#include "altiplan/height_field.hpp"
#include "dem.hpp"
#include "place.hpp"

namespace terrain {

/// An elevation model in the world's frame. Of a large one only the posts around the scenario's
/// volume are read initially; the whole is read if a query goes beyond them, so that every result
/// is the whole model's.
class Model {
 public:
  Model(const Params& params, const altiplan::Site& site);

  /// A field that contains all posts within, and around, the horizontal box.
  const altiplan::HeightField& over(const altiplan::Box& box) const {
    return (covered_.min.array() <= box.min.array()).all() &&
                   (box.max.array() <= covered_.max.array()).all()
               ? field_
               : whole();
  }
  const altiplan::HeightField& over(const altiplan::Vec3& p) const {
    return over(altiplan::Box{p, p});
  }
  /// Horizontal distance between a position and the edge of the part read initially; infinite if
  /// that is the whole.
  double to_edge(const altiplan::Vec3& p) const;
  /// The part read initially.
  const altiplan::HeightField& field() const { return field_; }

  /// Bounds of the whole, its heights left open.
  const altiplan::Box& bounds() const { return bounds_; }
  const Layout& layout() const { return layout_; }
  const Dem& dem() const { return dem_; }
  std::size_t voids() const { return voids_; }  ///< filled, in the part read initially
  bool joined() const { return joined_; }       ///< to neighbouring ground

 private:
  altiplan::HeightField read(const Part& part);
  altiplan::HeightField read_whole() const;
  const altiplan::HeightField& whole() const;

  Params params_;
  Dem dem_;
  Layout layout_;
  std::size_t voids_ = 0;
  altiplan::HeightField field_;
  bool joined_ = false;
  altiplan::Box bounds_;
  altiplan::Box covered_;  ///< queries within it use field_; infinite if that is the whole
  mutable std::once_flag once_;
  mutable std::unique_ptr<const altiplan::HeightField> whole_;
};
}  // namespace terrain
