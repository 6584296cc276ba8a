// SPDX-License-Identifier: BSD-3-Clause
// The front of the verifier: from the case and the files of a run to what is true of its answer.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "verify/real.hpp"

namespace kacanov::verify {

struct Verdict {
  bool fulfilled = false;  ///< the answer meets its tolerance, and the result says nothing else than is found
  std::string table;  ///< a line an entry: what the result says, what is found, what rounding leaves unknown
  std::string sentence;  ///< what it comes to
};

/// Recomputes the certificate of a run from its case and its files alone, in long double.
/// - document: the case, which the program has accepted; folder: where its relative paths start.
/// - output: the folder of the run, with result.json, body.vtu (or body.pvtu of an older version) and, with
/// contact, contact.vtu. Throws Failure where a file is missing, damaged or of another mesh, or the case has
/// what the verifier does not know.
Verdict verify(nlohmann::json document, const std::filesystem::path& folder,
               const std::filesystem::path& output);

}  // namespace kacanov::verify
