// SPDX-License-Identifier: BSD-3-Clause
// Reports all mistakes of an input in one error, and suggests corrections for mistyped words.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include <kacanov/error.hpp>

namespace kacanov {

/// Several mistakes; the message has one line for each of the first ten.
class InputErrors : public InputError {
 public:
  /// `where`: the source of the mistakes, such as a file name.
  explicit InputErrors(std::vector<std::string> mistakes, const std::string& where = "the case")
      : InputError(text(mistakes, where)), mistakes_(std::move(mistakes)) {}
  const std::vector<std::string>& mistakes() const noexcept { return mistakes_; }

 private:
  static std::string text(const std::vector<std::string>& mistakes, const std::string& where) {
    constexpr std::size_t most = 10;
    std::string all = where + " has " + std::to_string(mistakes.size()) + " mistakes";
    all += mistakes.size() > most ? ", of which the first " + std::to_string(most) + " are:" : ":";
    for (std::size_t i = 0; i < mistakes.size() && i < most; ++i) all += "\n  " + mistakes[i];
    return all;
  }

  std::vector<std::string> mistakes_;
};

/// Collects mistakes, so that later checks still run after one throws an InputError.
class Mistakes {
 public:
  template <class Check>
  void in(const Check& check) {
    try {
      check();
    } catch (const InputErrors& errors) {
      for (const std::string& mistake : errors.mistakes()) note(mistake);
    } catch (const InputError& error) {
      note(error.what());
    }
  }
  void note(const std::string& mistake) {
    for (const std::string& other : all_)
      if (other == mistake) return;
    all_.push_back(mistake);
  }
  /// Throws InputError for one mistake, InputErrors for several.
  void raise() const {
    if (all_.size() == 1) throw InputError(all_[0]);
    if (!all_.empty()) throw InputErrors(all_);
  }

 private:
  std::vector<std::string> all_;
};

/// Runs `work` and attributes several mistakes to this file.
template <class Work>
void naming_file(const std::string& file, const Work& work) {
  try {
    work();
  } catch (const InputErrors& errors) {
    throw InputErrors(errors.mistakes(), file.empty() ? "the case" : file);
  }
}

/// Returns the candidate closest to a mistyped word, or an empty string if none is close.
std::string closest_word(const std::string& word, std::span<const std::string> candidates);

}  // namespace kacanov
