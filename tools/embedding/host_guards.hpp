// SPDX-License-Identifier: BSD-3-Clause
// What a solve takes care of in a process that is not its own: one run at a time, MPI.
#pragma once

namespace kacanov::embedding {

/// The libraries beneath know one run a process: others wait. Throws Fault where this thread is at one.
class OneAtATime {
 public:
  OneAtATime();
  ~OneAtATime();
  OneAtATime(const OneAtATime&) = delete;
  OneAtATime& operator=(const OneAtATime&) = delete;
};

/// Starts MPI unless it is there. Throws Fault where it has been ended, or not for this thread.
void require_mpi();

}  // namespace kacanov::embedding
