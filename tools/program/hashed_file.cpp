// SPDX-License-Identifier: BSD-3-Clause
// Writes and verifies pieces and their hashes.
#include "program/hashed_file.hpp"

#include <filesystem>

#include <kacanov/checkpoint.hpp>
#include <kacanov/error.hpp>

namespace kacanov {

HashedWriter::HashedWriter(const std::string& path, std::string_view magic, const nlohmann::json& header)
    : file_(path) {
  const std::string text = header.dump();
  std::string front(magic);
  const std::uint64_t length = text.size();
  front.append(reinterpret_cast<const char*>(&length), sizeof length);
  front += text;
  write(front.data(), front.size());
  file_.write(&hash_, sizeof hash_);
}

void HashedWriter::write(const void* data, std::size_t bytes) {
  file_.write(data, bytes);
  hash_ = hash_bytes(data, bytes, hash_);
}

void HashedWriter::commit() {
  file_.write(&hash_, sizeof hash_);
  file_.commit(AtomicFile::Durable::yes);
}

HashedReader::HashedReader(const std::string& path, std::string_view magic, const std::string& kind)
    : path_(path), kind_(kind) {
  std::error_code error;
  // Opening a pipe without a writer would block forever.
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    throw InputError(path + ": is not a regular file");
  stream_.open(path, std::ios::binary);
  size_ = left_ = std::filesystem::file_size(path, error);
  if (error) throw InputError(path + ": cannot be read: " + error.message());
  if (!stream_) throw InputError(path + ": cannot be read");
  std::string front(magic.size(), '\0');
  if (size_ >= magic.size()) take(front.data(), front.size());
  const std::string_view without_number = magic.substr(0, magic.rfind(' ') + 1);
  if (front != magic && std::string_view(front).starts_with(without_number))
    throw InputError(path + ": this " + kind +
                     " was written by another version of kacanov, and not in a form " +
                     "that this version reads");
  if (front != magic)
    throw InputError(path + ": this is no " + kind + " that this version of kacanov can read");
  std::uint64_t length = 0;
  take(&length, sizeof length);
  expect(length, 1);
  front.append(reinterpret_cast<const char*>(&length), sizeof length);
  front.resize(front.size() + length);
  take(front.data() + front.size() - length, length);
  hash_ = hash_bytes(front.data(), front.size(), hash_);
  check_hash();
  constexpr int most_levels = 64;  // same limit as for cases
  const auto watch = [&](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
    if (depth > most_levels) fail("has a header with more than 64 levels of brackets");
    return true;
  };
  header_ = nlohmann::json::parse(std::string_view(front).substr(front.size() - length), watch, false);
  if (!header_.is_object()) fail("has a header that is no JSON object");
}

void HashedReader::expect(std::uint64_t entries, std::size_t bytes_each) const {
  if (entries > left_ / bytes_each) fail("is cut short: " + std::to_string(size_) + " bytes");
}

void HashedReader::read(void* data, std::size_t bytes) {
  take(data, bytes);
  hash_ = hash_bytes(data, bytes, hash_);
}

void HashedReader::finish() {
  check_hash();
  if (left_ != 0) fail("is damaged: its content does not match its hash");
}

void HashedReader::fail(const std::string& what) const {
  throw InputError(path_ + ": this " + kind_ + " " + what);
}

void HashedReader::take(void* data, std::size_t bytes) {
  expect(bytes, 1);
  if (!stream_.read(static_cast<char*>(data), static_cast<std::streamsize>(bytes)))
    throw InputError(path_ + ": cannot be read to its end");
  left_ -= bytes;
}

void HashedReader::check_hash() {
  std::uint64_t hash = 0;
  take(&hash, sizeof hash);
  if (hash != hash_) fail("is damaged: its content does not match its hash");
}

}  // namespace kacanov
