// SPDX-License-Identifier: BSD-3-Clause
// Writes the outer steps of a run as comma-separated values.
#include "program/history.hpp"

#include <limits>
#include "mesh/classic_locale_stream.hpp"

namespace kacanov {

std::string History::csv() const {
  PlainText out;
  out.precision(std::numeric_limits<double>::max_digits10);
  out << "step,method,contact_iterations,cg_iterations,r,energy,equilibrium,penetration,tension,"
         "complementarity,"
         "friction_cone,force_balance,duality_gap,worst,seconds\n";
  for (const ProgressStep& step : steps_) {
    const Certificate& c = step.certificate;
    out << step.outer << ',' << step.phase << ',' << step.contact_iterations << ',' << step.cg_iterations;
    for (const double value :
         {step.r, step.energy, c.equilibrium, c.penetration, c.tension, c.complementarity, c.friction_cone,
          c.force_balance, c.duality_gap, c.worst(), step.seconds})
      out << ',' << value;
    out << '\n';
  }
  return out.str();
}

}  // namespace kacanov
