// SPDX-License-Identifier: BSD-3-Clause
// ABI compatibility of the C interface: clients of other versions whose structs are shorter or longer.
#include <cstddef>
#include <cstring>

#include "c_example.hpp"

namespace {

/// A struct of this header as a newer client declares it, with `more` appended.
template <class Struct>
struct Longer {
  Struct known{};
  std::int64_t more = 0;
  Longer() { known.struct_size = sizeof *this; }
};

int created(const void* description, std::string& text) {
  kacanov_operator* op = nullptr;
  char message[256];
  const int code =
      kacanov_create(static_cast<const kacanov_description*>(description), &op, message, sizeof message);
  kacanov_destroy(op);
  text = message;
  return code;
}

}  // namespace

TEST_CASE("what a newer client's struct has beyond this library has to be zero") {
  const Example example;
  std::string text;
  Longer<kacanov_description> body;
  body.known = example.description;
  body.known.struct_size = sizeof body;
  CHECK(created(&body, text) == KACANOV_OK);
  body.more = 1;
  CHECK(created(&body, text) == KACANOV_ERROR_VALUE);
  CHECK(text.find("kacanov_description") != std::string::npos);

  body.more = 0;
  std::vector<Longer<kacanov_law>> laws(2);
  for (Longer<kacanov_law>& law : laws) {
    law.known = logarithmic();
    law.known.struct_size = sizeof law;
  }
  body.known.law = &laws[0].known;
  CHECK(created(&body, text) == KACANOV_OK);
  laws[1].more = 1;
  CHECK(created(&body, text) == KACANOV_ERROR_VALUE);
  CHECK(text.find("law[1].") != std::string::npos);
  laws[1].more = 0;
  laws[1].known.struct_size = sizeof(kacanov_law);
  CHECK(created(&body, text) == KACANOV_ERROR_SIZE);
  CHECK(text.find("law[1].struct_size") != std::string::npos);
}

TEST_CASE("what the library writes fits the client's struct, and the rest of it is zero") {
  const Example example;
  const Handle op = example.create();
  Longer<kacanov_information> about;
  about.more = -1;
  REQUIRE(kacanov_inspect(op.get(), &about.known) == KACANOV_OK);
  CHECK(about.known.struct_size == sizeof about);
  CHECK(about.known.unknowns == example.n());
  CHECK(about.more == 0);
}

TEST_CASE("a struct without its size is refused by name") {
  Example example;
  std::string text;
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{8}, offsetof(kacanov_description, orphans), std::size_t{1} << 40}) {
    example.description.struct_size = size;
    CHECK(created(&example.description, text) == KACANOV_ERROR_SIZE);
    CHECK(text.find("struct_size") != std::string::npos);
  }
  kacanov_law law{};
  CHECK(kacanov_elastic_law(1.0, 0.3, &law) == KACANOV_ERROR_SIZE);
  const Example right;
  const Handle op = right.create();
  kacanov_information about{};
  CHECK(kacanov_inspect(op.get(), &about) == KACANOV_ERROR_SIZE);
  CHECK(std::string(kacanov_message(op.get())).find("information.struct_size") != std::string::npos);
  kacanov_fields fields{};
  const Vector u(right.n(), 0.0);
  CHECK(kacanov_stress(op.get(), u.size(), u.data(), &fields) == KACANOV_ERROR_SIZE);
}

TEST_CASE("every code has words of its own, and the header its library's version") {
  std::vector<std::string> words;
  for (int code = KACANOV_OK; code <= KACANOV_ERROR_CASE; ++code) words.emplace_back(kacanov_code_text(code));
  words.emplace_back(kacanov_code_text(-1));
  CHECK(words.back() == kacanov_code_text(1000));
  for (std::size_t i = 0; i < words.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) CHECK(words[i] != words[j]);
  CHECK(std::string(kacanov_version()) == KACANOV_PROJECT_VERSION);
}
