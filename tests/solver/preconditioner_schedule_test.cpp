// SPDX-License-Identifier: BSD-3-Clause
// When a preconditioner is set up again, with made-up numbers: no body, no solve.
#include <doctest/doctest.h>

#include <vector>

#include "nonlinear/contact_preconditioner.hpp"

using namespace kacanov;

TEST_CASE(
    "preconditioner: stale without one, fresh after a setup, stale once a step costs what a setup does") {
  const Tuning defaults;
  PreconditionerSchedule schedule(defaults);
  CHECK(schedule.stale());
  schedule.built();
  CHECK(!schedule.stale());
  schedule.watch(2.0, 20);  // the reference: ten iterations per digit
  CHECK(!schedule.stale());
  schedule.watch(0.0, 0);
  schedule.watch(2.0, 20 + static_cast<int>(defaults.setup_worth));
  CHECK(!schedule.stale());
  schedule.watch(1.0, 11 + static_cast<int>(defaults.setup_worth));
  CHECK(schedule.stale());
  CHECK(schedule.stale(1.0));
  CHECK(!schedule.stale(0.9 * defaults.setup_worth / (defaults.setup_worth + 1.0)));  // too little to gain
  schedule.built();
  schedule.watch(2.0, 40);  // a new reference
  CHECK(!schedule.stale());
  schedule.mark_stale();
  CHECK(schedule.stale(0.0));
}

TEST_CASE("preconditioner: what it was built for, and what has moved since") {
  const Tuning defaults;
  PreconditionerSchedule schedule(defaults);
  schedule.built_for(Penalty{2.0, 1.0});
  CHECK(!schedule.penalty_moved({2.9 / 3.0 * 2.0, 1.0}, true));
  CHECK(schedule.penalty_moved({2.0 * 1.01 * defaults.penalty_worth, 1.0}, false));
  CHECK(schedule.penalty_moved({2.0, 0.99 / defaults.penalty_worth}, true));
  CHECK(!schedule.penalty_moved({2.0, 0.99 / defaults.penalty_worth}, false));
  ActiveSet set(2);
  set.held[0] = {true, false};
  set.slip_stiffness[0] = 4.0;
  CHECK(schedule.set_moved(set));
  schedule.built_for(set);
  CHECK(!schedule.set_moved(set));
  CHECK(schedule.set_moved(set, 1.0));
  ActiveSet other = set;
  other.held[0].tangential = true;
  CHECK(schedule.set_moved(other));
  other = set;
  for (const double factor : {0.99, 1.01}) {
    other.slip_stiffness[0] = 4.0 * factor * defaults.penalty_worth;
    CHECK(schedule.set_moved(other) == (factor > 1.0));
    other.slip_stiffness[0] = 4.0 / (factor * defaults.penalty_worth);
    CHECK(schedule.set_moved(other) == (factor > 1.0));
  }
  other = set;
  other.slip_stiffness[1] = 0.1;
  CHECK(schedule.set_moved(other));
  schedule.built_for(Penalty{2.0, 1.0});  // sets a penalty, no active set
  CHECK(schedule.set_moved(set));
  CHECK(!schedule.drifted(0.9 * defaults.drift_worth * 8.0, 8.0));
  CHECK(schedule.drifted(1.1 * defaults.drift_worth * 8.0, 8.0));
}
