// SPDX-License-Identifier: BSD-3-Clause
// Numbers with a point in a thread of a host whose locale has commas.
#pragma once

#include <locale.h>

#include <new>

namespace kacanov {

/// The C library reads and writes this thread's numbers with a point as long as it lives. Throws bad_alloc.
/// Streams of C++ have their own: Plain.
class PlainLocale {
 public:
  PlainLocale() : plain_(newlocale(LC_ALL_MASK, "C", nullptr)) {
    if (plain_ == locale_t{}) throw std::bad_alloc();
    hosts_ = uselocale(plain_);
  }
  ~PlainLocale() {
    uselocale(hosts_);
    freelocale(plain_);
  }
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

}  // namespace kacanov
