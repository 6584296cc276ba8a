// SPDX-License-Identifier: BSD-3-Clause
// What a solve takes care of in a process that is not its own: one run at a time, the thread's locale, MPI.
#pragma once

#include <locale.h>
#include <clocale>

namespace kacanov::embedding {

/// The libraries beneath know one run a process: others wait. Throws Fault where this thread is at one.
class OneAtATime {
 public:
  OneAtATime();
  ~OneAtATime();
  OneAtATime(const OneAtATime&) = delete;
  OneAtATime& operator=(const OneAtATime&) = delete;
};

/// This thread's numbers are written with a point as long as it lives. Throws bad_alloc.
class PlainLocale {
 public:
  PlainLocale();
  ~PlainLocale();
  PlainLocale(const PlainLocale&) = delete;
  PlainLocale& operator=(const PlainLocale&) = delete;

  /// Does `work` in the host's locale.
  template <class Work>
  auto in_hosts(const Work& work) const {
    uselocale(hosts_);
    struct Back {
      locale_t plain;
      ~Back() { uselocale(plain); }
    } const back{plain_};
    return work();
  }

 private:
  locale_t plain_, hosts_;
};

/// Starts MPI unless it is there. Throws Fault where it has been ended, or not for this thread.
void require_mpi();

}  // namespace kacanov::embedding
