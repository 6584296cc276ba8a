// SPDX-License-Identifier: BSD-3-Clause
// Checkpoint: the data from which a run continues after an outer step, in the user's numbering, on any number
// of ranks.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <kacanov/part.hpp>

namespace kacanov {

/// Named numbers and fields. Fields are in the numbering of Problem::mesh and Problem::contact. Older
/// versions ignore entries that later versions add.
struct Checkpoint {
  std::map<std::string, double> numbers;
  std::map<std::string, std::vector<double>> fields;

  /// Whether the checkpoint contains at least one completed outer step.
  bool begun() const;
  /// These accessors throw InputError that names a missing entry, or gives its size and the expected one.
  double number(const std::string& name) const;
  /// Returns a number that must be an integer from 0 to `most`.
  std::int64_t count(const std::string& name, std::int64_t most) const;
  const std::vector<double>& field(const std::string& name, std::size_t entries) const;
};

/// Hashes of the parts of a problem that determine its solution, taken after build_problem(): two case files
/// that describe the same problem in different words have equal hashes.
struct Fingerprint {
  /// Hash per section: "mesh", "material", "boundary", "contact" and, with load curves, "steps".
  std::map<std::string, std::uint64_t> sections;

  /// Returns the names of the sections in which the two problems differ.
  std::vector<std::string> differences(const Fingerprint& other) const;
};
/// Fingerprint of a complete problem, before keep_boundary(). On one rank.
Fingerprint fingerprint(const Problem& problem);

/// Returns a 64-bit hash of the bytes; pass the previous hash as `seed` to chain several pieces. Not
/// cryptographic.
std::uint64_t hash_bytes(const void* data, std::size_t bytes, std::uint64_t seed = 0);

/// The inverse of gather_nodal() and gather_contact(): returns this rank's entries, ghosts included, of a
/// field that rank 0 holds in the numbering of Problem::mesh (nodes × components) or Problem::contact (points
/// × components). On other ranks `all` is ignored. Collective.
std::vector<double> scatter_nodal(const Part& part, std::span<const double> all, int components,
                                  CallSite at = CallSite());
std::vector<double> scatter_contact(const Part& part, std::span<const double> all, int components,
                                    CallSite at = CallSite());

/// Gathers or scatters `each` numbers per element, in the numbering of Problem::mesh on rank 0. Collective.
std::vector<double> gather_elements(const Part& part, std::span<const double> local, int each,
                                    CallSite at = CallSite());
std::vector<double> scatter_elements(const Part& part, std::span<const double> all, int each,
                                     CallSite at = CallSite());

}  // namespace kacanov
