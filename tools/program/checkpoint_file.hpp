// SPDX-License-Identifier: BSD-3-Clause
// Checkpoint file: written often, always complete, and read only for the case it belongs to.
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

/// Checkpoint of one run of a problem with this fingerprint. Reads and writes on the first rank only. The
/// case must outlive it.
class CheckpointFile {
 public:
  CheckpointFile(const std::filesystem::path& folder, const Case& input, Fingerprint print)
      : path_(folder / checkpoint_name), input_(&input), print_(std::move(print)) {}

  /// Throws InputError if there is no such file, it is not a checkpoint, is truncated or damaged, or belongs
  /// to another case, with the differences.
  Checkpoint read() const;

  /// Returns whether a checkpoint is cheap enough: the last one took less than 1/50 of the time since then.
  bool due() const;
  /// Replaces the file. On a system error the previous one stays and a warning is printed, once per reason.
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
  std::chrono::duration<double> cost_{2e-3};  // initial guess
  bool written_ = false;
  std::string warned_;
};

}  // namespace kacanov
