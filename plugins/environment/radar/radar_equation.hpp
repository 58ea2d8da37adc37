// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "altiplan/environment.hpp"

namespace altiplan::radar {

inline constexpr double kBoltzmann = 1.380649e-23;  // J/K

/// A ratio, given as a plain number or in decibels.
struct Ratio {
  std::optional<double> linear;
  std::optional<double> db;

  bool is_given() const { return linear.has_value() || db.has_value(); }
  double value(double otherwise) const {
    return linear ? *linear : db ? std::pow(10, *db / 10) : otherwise;
  }
};

/// Paper 000, eq. (1), in SI units:
/// R_max = [ P_t G_t G_r λ² σ / ((4π)³ L_r L_t F_r k T B_r D_d) ]^(1/4).
struct RadarEquation {
  double power_w = 0;           ///< P_t
  Ratio transmit_gain;          ///< G_t
  Ratio receive_gain;           ///< G_r; default: G_t
  double wavelength_m = 0;      ///< λ
  double cross_section_m2 = 0;  ///< σ
  Ratio receive_loss;           ///< L_r
  Ratio transmit_loss;          ///< L_t
  Ratio noise_figure;           ///< F_r
  double temperature_k = 290;   ///< T
  double bandwidth_hz = 0;      ///< B_r
  Ratio detection_factor;       ///< D_d

  void describe(Fields& f) {
    f("power_w", power_w).unit("W").greater_than(0).required().doc("transmit power P_t");
    describe(f, transmit_gain, "transmit_gain", "antenna gain G_t");
    describe(f, receive_gain, "receive_gain", "antenna gain G_r; default: transmit_gain");
    f("wavelength_m", wavelength_m).unit("m").greater_than(0).required().doc("wavelength λ");
    f("cross_section_m2", cross_section_m2)
        .unit("m²")
        .greater_than(0)
        .required()
        .doc("mean radar cross-section σ of the vehicle");
    describe(f, receive_loss, "receive_loss", "feed loss L_r; default: 1");
    describe(f, transmit_loss, "transmit_loss", "feed loss L_t; default: 1");
    describe(f, noise_figure, "noise_figure", "noise figure F_r; default: 1");
    f("temperature_k", temperature_k).unit("K").greater_than(0).doc("noise temperature T");
    f("bandwidth_hz", bandwidth_hz).unit("Hz").greater_than(0).required().doc("bandwidth B_r");
    describe(f, detection_factor, "detection_factor", "detection factor D_d");
    f.check(transmit_gain.is_given(), "transmit_gain or transmit_gain_db is missing");
    f.check(detection_factor.is_given(), "detection_factor or detection_factor_db is missing");
  }

  double range_m() const {
    const double gain = transmit_gain.value(1) * receive_gain.value(transmit_gain.value(1));
    const double losses = receive_loss.value(1) * transmit_loss.value(1) * noise_figure.value(1);
    const double noise = kBoltzmann * temperature_k * bandwidth_hz * detection_factor.value(1);
    return std::pow(power_w * gain * wavelength_m * wavelength_m * cross_section_m2 /
                        (std::pow(4 * kPi, 3) * losses * noise),
                    0.25);
  }

 private:
  static void describe(Fields& f, Ratio& ratio, const std::string& name, const std::string& doc) {
    f(name, ratio.linear).greater_than(0).doc(doc + " (a plain ratio)");
    f(name + "_db", ratio.db).unit("dB").range(-300, 300).doc("the same in decibels");
    f.check(!(ratio.linear && ratio.db), "give " + name + " or " + name + "_db, not both");
  }
};
}  // namespace altiplan::radar
