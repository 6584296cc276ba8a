// SPDX-License-Identifier: BSD-3-Clause
// A host that may not start threads: creating an operator for two threads returns an error instead of ending
// the host, and an existing operator works on any thread with bitwise the same results.
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <kacanov/kacanov.h>
#include "small_meshes.hpp"

namespace {

std::vector<double> product(kacanov_operator* op, std::size_t n) {
  std::vector<double> x(n), y(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = 1.0 / static_cast<double>(1 + i % 97);
  return kacanov_apply(op, n, x.data(), y.data()) == KACANOV_OK ? y : std::vector<double>();
}

}  // namespace

int main() {
  const SmallMesh mesh = small_mesh(KACANOV_TET4, 14);
  kacanov_law law{};
  law.struct_size = sizeof law;
  if (kacanov_elastic_law(1.0, 0.3, &law) != KACANOV_OK) return 1;
  kacanov_description body{};
  body.struct_size = sizeof body;
  body.element = KACANOV_TET4;
  body.threads = 2;
  body.nodes = mesh.nodes();
  body.coordinates = mesh.coordinates.data();
  body.elements = mesh.elements();
  body.connectivity = mesh.connectivity.data();
  body.laws = 1;
  body.law = &law;

  kacanov_operator* op = nullptr;
  char message[256];
  if (kacanov_create(&body, &op, message, sizeof message) != KACANOV_OK) return 1;
  const std::size_t n = mesh.coordinates.size();
  const std::vector<double> want = product(op, n);
  std::vector<double> got;
  std::atomic<bool> limited = false;
  // Not a std::jthread, for which the early return below would wait.
  std::thread other([&] {
    limited.wait(false);
    got = product(op, n);
  });

  const rlimit none{1, 1};
  constexpr uid_t nobody = 65534;  // the limit does not apply to root
  if (setrlimit(RLIMIT_NPROC, &none) != 0 || (getuid() == 0 && setuid(nobody) != 0)) {
    std::perror("the limit could not be set");
    std::_Exit(77);
  }
  limited = true;
  limited.notify_all();
  other.join();
  if (want.empty() || got != want) return 1;
  kacanov_destroy(op);

  body.threads = 3;
  const int code = kacanov_create(&body, &op, message, sizeof message);
  std::printf("%s: %s\n", kacanov_code_text(code), message);
  const char* whose = std::getenv("KACANOV_THREADS");
  const bool kept = whose != nullptr && std::string(whose) == "openmp";  // the team of the first operator
  const std::string want_message = kept ? "threads: only 2 of 3" : "threads: only 1 of 3";
  if (code != KACANOV_ERROR_MEMORY || std::string(message).find(want_message) == std::string::npos) return 1;
  body.threads = 1;
  if (kacanov_create(&body, &op, message, sizeof message) != KACANOV_OK) return 1;
  kacanov_destroy(op);
  return 0;
}
