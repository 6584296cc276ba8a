// SPDX-License-Identifier: BSD-3-Clause
// Entry point of the verifier: reads the case and the files of a run and recomputes the certificate.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "verify/real.hpp"

namespace kacanov::verify {

struct Verdict {
  bool fulfilled = false;  ///< the solution meets its tolerance, and the result is what was recomputed
  std::string table;       ///< one line per entry: value in the result, recomputed value, round-off
  std::string sentence;    ///< the conclusion
};

/// Recomputes the certificate of a run from its case and its files alone, in long double.
/// - document: the case, which the program has accepted; folder: where its relative paths start.
/// - output: the folder of the run, with result.json, body.vtu (or body.pvtu of an older version) and, with
///   contact, contact.vtu.
/// Throws Failure if a file is missing, damaged or of another mesh, or the case has unsupported features.
Verdict verify(nlohmann::json document, const std::filesystem::path& folder,
               const std::filesystem::path& output);

}  // namespace kacanov::verify
