// SPDX-License-Identifier: BSD-3-Clause
// The file of a checkpoint. Layout: a line with name and version; the length of the header, 8 bytes; the header, JSON,
// with the names and lengths of the fields; the fields, doubles; a hash, 8 bytes, chained from all before the fields through field after field.
#include "checkpoint_file.hpp"

#include <bit>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>

#include "atomic_file.hpp"
#include "error.hpp"

namespace kacanov {
namespace {

using nlohmann::json;

constexpr std::string_view magic = "kacanov checkpoint 2\n";
constexpr double share_of_time = 0.02;
/// The sections of a case that have to be the same; solver options may change, but for the path of the load.
constexpr std::array sections{"mesh", "material", "boundary", "contact"};

/// "/material/0/young" as material[0].young.
std::string key_path(const std::string& pointer) {
  std::string path, word;
  std::istringstream words(pointer);
  std::getline(words, word, '/');
  while (std::getline(words, word, '/')) {
    const bool number = !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
    path += number ? "[" + word + "]" : (path.empty() ? "" : ".") + word;
  }
  return path;
}

std::string value_at(const json& document, const std::string& pointer) {
  const json::json_pointer place(pointer);
  if (!document.contains(place)) return "nothing";
  const std::string text = document.at(place).dump();
  return text.size() <= 40 ? text : text.substr(0, 37) + "...";
}

/// The first keys of a section that differ, in the words of the case files.
std::string differing_keys(const json& there, const json& here, const std::string& section) {
  constexpr int most = 3;
  std::string text;
  int found = 0;
  for (const json& change : json::diff(there, here)) {
    const std::string pointer = change.at("path");
    if (pointer != "/" + section && pointer.rfind("/" + section + "/", 0) != 0) continue;
    if (++found > most) return text + ", ...";
    text += (text.empty() ? "" : ", ") + key_path(pointer) + ": " + value_at(there, pointer) + " there, " +
            value_at(here, pointer) + " here";
  }
  return text;
}

json fingerprint_json(const Fingerprint& print) {
  json out;
  for (const auto& [name, hash] : print.sections) out[name] = hash;
  return out;
}

/// Reads a file front to back.
class Cursor {
 public:
  Cursor(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  std::string_view take(std::size_t count) {
    if (count > bytes_.size() - at_) {
      throw InputError(file_ + ": this checkpoint is cut short: " + std::to_string(bytes_.size()) + " bytes");
    }
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  template <class T>
  T take_value() {
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::size_t at() const noexcept { return at_; }

 private:
  std::string_view bytes_;
  const std::string& file_;
  std::size_t at_ = 0;
};

std::string whole_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw InputError(std::filesystem::exists(path)
                         ? path.string() + ": cannot be read"
                         : "--restart: there is no checkpoint to go on from, expected the file " + path.string());
  }
  std::ostringstream text;
  text << stream.rdbuf();
  return std::move(text).str();
}

}  // namespace

Checkpoint CheckpointFile::read() const {
  const std::string file = path_.string(), bytes = whole_file(path_);
  Cursor cursor(bytes, file);
  if (bytes.size() < magic.size() || cursor.take(magic.size()) != magic)
    throw InputError(file + ": this is no checkpoint that this version of kacanov can read");
  const std::string_view header_text = cursor.take(cursor.take_value<std::uint64_t>());
  const json header = json::parse(header_text, nullptr, false);
  std::uint64_t hash = hash_bytes(bytes.data(), cursor.at());
  Checkpoint checkpoint;
  // A damaged header may be no JSON, or JSON with the wrong things in it; the hash tells, where one can be read.
  try {
    for (const auto& [name, bits] : header.at("numbers").items())
      checkpoint.numbers[name] = std::bit_cast<double>(bits.get<std::uint64_t>());
    for (const auto& [name, count] : header.at("fields").items()) {
      const auto entries = count.get<std::uint64_t>();
      if (entries > bytes.size()) cursor.take(bytes.size());
      const std::string_view data = cursor.take(entries * sizeof(double));
      auto& field = checkpoint.fields[name];
      field.resize(entries);
      if (entries > 0) std::memcpy(field.data(), data.data(), data.size());
      hash = hash_bytes(data.data(), data.size(), hash);
    }
    if (cursor.take_value<std::uint64_t>() != hash || cursor.at() != bytes.size())
      throw InputError(file + ": this checkpoint is damaged: its content does not match its hash");
  } catch (const json::exception&) {
    throw InputError(file + ": this checkpoint is damaged: its header cannot be read");
  }

  Fingerprint there;
  for (const auto& [name, value] : header.at("problem").items()) there.sections[name] = value.get<std::uint64_t>();
  const json& document = header.at("case");
  std::string text;
  for (const std::string& name : print_.differences(there)) {
    const std::string keys = differing_keys(document, input_->document, name);
    text += (text.empty() ? "" : "; ") + name + " differs" + (keys.empty() ? "" : " (" + keys + ")");
  }
  const json steps = input_->model.solver.load_steps;
  if (header.at("load_steps") != steps) {
    text += (text.empty() ? "" : "; ") + ("solver.load_steps differs (factors " + header.at("load_steps").dump()) +
            " there, " + steps.dump() + " here)";
  }
  if (!text.empty()) throw InputError("--restart: " + file + " belongs to another case: " + text);
  return checkpoint;
}

bool CheckpointFile::due() const { return Clock::now() - last_ > cost_ / share_of_time; }

void CheckpointFile::write(const Checkpoint& checkpoint) {
  const auto start = Clock::now();
  json header;
  header["problem"] = fingerprint_json(print_);
  header["load_steps"] = input_->model.solver.load_steps;
  for (const char* section : sections)
    if (input_->document.contains(section)) header["case"][section] = input_->document[section];
  // As bits: JSON has no infinity.
  for (const auto& [name, value] : checkpoint.numbers) header["numbers"][name] = std::bit_cast<std::uint64_t>(value);
  for (const auto& [name, values] : checkpoint.fields) header["fields"][name] = values.size();
  const std::string text = header.dump();
  std::string bytes(magic);
  const std::uint64_t length = text.size();
  bytes.append(reinterpret_cast<const char*>(&length), sizeof length);
  bytes += text;
  std::uint64_t hash = hash_bytes(bytes.data(), bytes.size());
  try {
    AtomicFile file(path_.string());
    file.write(bytes);
    for (const auto& [name, values] : checkpoint.fields) {
      file.write(values.data(), values.size() * sizeof(double));
      hash = hash_bytes(values.data(), values.size() * sizeof(double), hash);
    }
    file.write(&hash, sizeof hash);
    file.commit(AtomicFile::Durable::yes);
    written_ = true;
  } catch (const InternalError& refusal) {
    // A run of hours does not end because its disk is full now.
    if (warned_ != refusal.what()) {
      std::cerr << std::string("kacanov: warning: ") + refusal.what() +
                       (std::filesystem::exists(path_) ? "; the checkpoint before it stays\n" : "; there is no checkpoint\n");
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
