// SPDX-License-Identifier: BSD-3-Clause
// Checkpoint file: a header with names and lengths of the fields, then the fields.
#include "program/checkpoint_file.hpp"

#include <bit>
#include <iostream>

#include <kacanov/error.hpp>
#include "formats/printable.hpp"
#include "program/case_identity.hpp"
#include "program/hashed_file.hpp"

namespace kacanov {
namespace {

constexpr std::string_view magic = "kacanov checkpoint 5\n";
constexpr double share_of_time = 0.02;
/// Sections of a case that must agree; solver options may change, except for the load path.
constexpr const char* sections[] = {"plane", "thickness", "mesh", "material", "boundary", "contact", "steps"};

}  // namespace

Checkpoint CheckpointFile::read() const {
  const std::string file = path_.string();
  if (!std::filesystem::exists(path_))
    throw InputError("--restart: there is no checkpoint to go on from, expected the file " + file);
  HashedReader reader(file, magic, "checkpoint");
  return reading_header(file, [&] { return take(reader); });
}

Checkpoint CheckpointFile::take(HashedReader& reader) const {
  const std::string file = path_.string();
  const nlohmann::json& header = reader.header();
  Checkpoint checkpoint;
  for (const auto& [name, bits] : header.at("numbers").items())
    checkpoint.numbers[name] = std::bit_cast<double>(bits.get<std::uint64_t>());
  for (const auto& [name, count] : header.at("fields").items()) {
    const auto entries = count.get<std::uint64_t>();
    reader.expect(entries, sizeof(double));
    auto& field = checkpoint.fields[name];
    field.resize(entries);
    reader.read(field.data(), entries * sizeof(double));
  }
  reader.finish();

  std::string text = describe_differences(header.at("case"), input_->document,
                                          print_.differences(parse_fingerprint(header.at("problem"))));
  const nlohmann::json steps = input_->model.solver.load_steps;
  if (header.at("load_steps") != steps) {
    text += (text.empty() ? "" : "; ") +
            ("solver.load_steps differs (factors " + header.at("load_steps").dump()) + " there, " +
            steps.dump() + " here)";
  }
  if (!text.empty()) throw InputError("--restart: " + file + " belongs to another case: " + text);
  return checkpoint;
}

bool CheckpointFile::due() const { return Clock::now() - last_ > cost_ / share_of_time; }

void CheckpointFile::write(const Checkpoint& checkpoint) {
  const auto start = Clock::now();
  nlohmann::json header = nlohmann::json::object();
  header["problem"] = fingerprint_json(print_);
  header["load_steps"] = input_->model.solver.load_steps;
  header["case"] = case_sections(input_->document, sections);
  header["numbers"] = header["fields"] = nlohmann::json::object();
  // Stored as bits, because JSON has no infinity.
  for (const auto& [name, value] : checkpoint.numbers)
    header["numbers"][name] = std::bit_cast<std::uint64_t>(value);
  for (const auto& [name, values] : checkpoint.fields) header["fields"][name] = values.size();
  try {
    HashedWriter file(path_.string(), magic, header);
    for (const auto& [name, values] : checkpoint.fields)
      file.write(values.data(), values.size() * sizeof(double));
    file.commit();
    written_ = true;
  } catch (const InternalError& refusal) {
    // A full disk must not end a run that has taken hours.
    if (warned_ != refusal.what()) {
      std::cerr << "kacanov: warning: " + printable(refusal.what()) +
                       (std::filesystem::exists(path_) ? "; the checkpoint before it stays\n"
                                                       : "; there is no checkpoint\n");
    }
    warned_ = refusal.what();
  }
  last_ = Clock::now();
  cost_ = last_ - start;
}

void CheckpointFile::remove() const {
  std::error_code nothing;
  std::filesystem::remove(path_, nothing);
}

}  // namespace kacanov
