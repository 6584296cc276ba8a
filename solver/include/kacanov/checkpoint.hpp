// SPDX-License-Identifier: BSD-3-Clause
// What a run needs to go on from the end of an outer step, in the user's numbering: on any number of ranks.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <kacanov/part.hpp>

namespace kacanov {

/// Named numbers and fields. Fields are in the numbering of Problem::mesh and Problem::contact; entries that
/// a later version adds do not disturb an earlier one.
struct Checkpoint {
  std::map<std::string, double> numbers;
  std::map<std::string, std::vector<double>> fields;

  /// Whether any outer step lies behind it.
  bool begun() const;
  /// Throw InputError naming what is missing, or what it is and should be.
  double number(const std::string& name) const;
  /// A number that has to be whole and from 0 to `most`.
  std::int64_t count(const std::string& name, std::int64_t most) const;
  const std::vector<double>& field(const std::string& name, std::size_t entries) const;
};

/// The parts of a problem that decide its solution, as hashes of what build_problem made of them: two case
/// files that say the same in other words agree.
struct Fingerprint {
  std::map<std::string, std::uint64_t>
      sections;  ///< "mesh", "material", "boundary", "contact", with curves "steps"

  /// Names of the sections in which two problems differ.
  std::vector<std::string> differences(const Fingerprint& other) const;
};
/// Of a whole problem, before keep_boundary(). On one rank.
Fingerprint fingerprint(const Problem& problem);

/// 64 bits of any bytes; `seed` chains several pieces. Not cryptographic.
std::uint64_t hash_bytes(const void* data, std::size_t bytes, std::uint64_t seed = 0);

/// The converse of gather_nodal and gather_contact: hands every rank its entries, ghosts included, of a field
/// that rank 0 has in the numbering of Problem::mesh (nodes × components) or Problem::contact (points ×
/// components); elsewhere `all` is not looked at. Collective.
std::vector<double> scatter_nodal(const Part& part, std::span<const double> all, int components,
                                  CallSite at = CallSite());
std::vector<double> scatter_contact(const Part& part, std::span<const double> all, int components,
                                    CallSite at = CallSite());

/// `each` numbers per element, in the numbering of Problem::mesh on rank 0, and back. Collective.
std::vector<double> gather_elements(const Part& part, std::span<const double> local, int each,
                                    CallSite at = CallSite());
std::vector<double> scatter_elements(const Part& part, std::span<const double> all, int each,
                                     CallSite at = CallSite());

}  // namespace kacanov
