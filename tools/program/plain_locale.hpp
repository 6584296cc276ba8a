// SPDX-License-Identifier: BSD-3-Clause
// Selects the decimal point in a thread of a host process whose locale may use a comma.
#pragma once

#include <locale.h>

#include <new>

namespace kacanov {

/// Sets the "C" locale for this thread during its lifetime, so that the C library reads and writes a decimal
/// point. Throws bad_alloc. C++ streams have their own: Plain.
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

  /// Runs `work` in the host's locale.
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
