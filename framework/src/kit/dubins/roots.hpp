// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace altiplan::kit {

/// Where f changes its sign between a and b, to the last digits; `fa` and `fb` are its values
/// there, of opposite signs. Inverse quadratic interpolation where the last three values promise it
/// to converge, otherwise bisection: T. R. Chandrupatla: A New Hybrid Quadratic/Bisection Algorithm
/// for Finding the Zero of a Nonlinear Function without Using Derivatives. Advances in Engineering
/// Software 28(3), 1997, doi:10.1016/S0965-9978(96)00051-8.
template <class Function>
double root_between(const Function& f, double a, double fa, double b, double fb) {
  double share = 0.5;
  for (int n = 0; n < 200; ++n) {  // far more than it takes, unless a value is no number
    const double x = a + share * (b - a);
    const double fx = f(x);
    double c = a;
    double fc = fa;
    if ((fx < 0) != (fa < 0)) {
      c = b;
      fc = fb;
      b = a;
      fb = fa;
    }
    a = x;
    fa = fx;
    const double best = std::abs(fa) < std::abs(fb) ? a : b;
    const double minimum = 4e-16 * std::abs(best) / std::abs(b - a);
    if (fa == 0 || minimum > 0.5) {
      return best;
    }
    const double xi = (a - b) / (c - b);
    const double phi = (fa - fb) / (fc - fb);
    share = 0.5;
    if (phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi) {
      share = fa / (fb - fa) * (fc / (fb - fc)) +
              (c - a) / (b - a) * (fa / (fc - fa)) * (fb / (fc - fb));
    }
    share = std::clamp(share, minimum, 1 - minimum);
  }
  return a;
}
}  // namespace altiplan::kit
