// SPDX-License-Identifier: BSD-3-Clause
// The file of a checkpoint: written often, whole or not at all, read only for the case it belongs to.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>

#include <kacanov/checkpoint.hpp>
#include "case/case_file.hpp"
#include "program/hashed_file.hpp"

namespace kacanov {

/// Name of the file in the output folder.
constexpr const char* checkpoint_name = "checkpoint.kacanov";

/// The checkpoint of one run, of a problem with this fingerprint. Everything happens on the first rank. The
/// case has to outlive it.
class CheckpointFile {
 public:
  CheckpointFile(const std::filesystem::path& folder, const Case& input, Fingerprint print)
      : path_(folder / checkpoint_name), input_(&input), print_(std::move(print)) {}

  /// Throws InputError: no such file, not a checkpoint, cut short, damaged, or of another case, with what
  /// differs.
  Checkpoint read() const;

  /// Whether a checkpoint is worth its time: the last one took less than a fiftieth of the time since then.
  bool due() const;
  /// Replaces the file. Where the system refuses, the one before stays, and a warning is printed (once for
  /// each reason).
  void write(const Checkpoint& checkpoint);
  void remove() const;

  const std::filesystem::path& path() const noexcept { return path_; }
  bool written() const noexcept { return written_; }

 private:
  using Clock = std::chrono::steady_clock;

  Checkpoint take(HashedReader& reader) const;

  std::filesystem::path path_;
  const Case* input_;
  Fingerprint print_;
  Clock::time_point last_ = Clock::now();
  std::chrono::duration<double> cost_{2e-3};  // a guess, until there is one
  bool written_ = false;
  std::string warned_;
};

}  // namespace kacanov
