// SPDX-License-Identifier: BSD-3-Clause
// Invalid input to constraints, multigrid and solves of the C interface.
#include "multigrid_example.hpp"

TEST_CASE("bad input of constraints, multigrid and solves is named") {
  const Example example;
  const std::size_t n = example.n();
  const Handle op = example.create(), other = example.create();
  const auto says = [&](const std::string& word) {
    return std::string(kacanov_message(op.get())).find(word) != std::string::npos;
  };
  const std::int32_t beyond[] = {0, static_cast<std::int32_t>(n)}, node[] = {-1}, first[] = {0};
  CHECK(kacanov_constrain(op.get(), 2, beyond) == KACANOV_ERROR_VALUE);
  CHECK(says("unknown[1]"));
  CHECK(kacanov_constrain(op.get(), 2, nullptr) == KACANOV_ERROR_NULL);
  CHECK(kacanov_constrain(nullptr, 0, nullptr) == KACANOV_ERROR_NULL);
  Vector block(9, 0.0);
  CHECK(kacanov_set_blocks(op.get(), 1, node, block.data()) == KACANOV_ERROR_VALUE);
  CHECK(says("node[0]"));
  block[1] = 1.0;
  CHECK(kacanov_set_blocks(op.get(), 1, first, block.data()) == KACANOV_ERROR_VALUE);
  CHECK(says("block[0] is not symmetric"));
  block[1] = nan_value;
  CHECK(kacanov_set_blocks(op.get(), 1, first, block.data()) == KACANOV_ERROR_VALUE);
  block[1] = 0.0;
  block[0] = -1.0;
  CHECK(kacanov_set_blocks(op.get(), 1, first, block.data()) == KACANOV_ERROR_VALUE);
  CHECK(says("negative"));
  CHECK(kacanov_set_blocks(op.get(), 1, first, nullptr) == KACANOV_ERROR_NULL);

  kacanov_multigrid* made = nullptr;
  CHECK(kacanov_multigrid_create(op.get(), nullptr, nullptr) == KACANOV_ERROR_NULL);
  CHECK(kacanov_multigrid_create(nullptr, nullptr, &made) == KACANOV_ERROR_NULL);
  auto options = sized<kacanov_multigrid_options>();
  options.aggregate = 1.0;
  CHECK(kacanov_multigrid_create(op.get(), &options, &made) == KACANOV_ERROR_VALUE);
  CHECK(says("options.aggregate"));
  CHECK(made == nullptr);
  options.struct_size = 3;
  CHECK(kacanov_multigrid_create(op.get(), &options, &made) == KACANOV_ERROR_SIZE);
  CHECK(kacanov_multigrid_update(nullptr) == KACANOV_ERROR_NULL);
  CHECK(std::string(kacanov_multigrid_message(nullptr)) != "");

  hold(op, example.mesh);
  const MultigridHandle multigrid = multigrid_of(op);
  Vector b(n, 1.0), x(n, 0.0);
  CHECK(kacanov_multigrid_apply(multigrid.get(), n - 1, b.data(), x.data()) == KACANOV_ERROR_SIZE);
  CHECK(std::string(kacanov_multigrid_message(multigrid.get())).find("n: expected") == 0);
  CHECK(kacanov_multigrid_apply(multigrid.get(), n, b.data(), b.data()) == KACANOV_ERROR_SIZE);
  CHECK(kacanov_multigrid_apply(multigrid.get(), n, nullptr, x.data()) == KACANOV_ERROR_NULL);
  auto result = sized<kacanov_cg_result>();
  auto cg = sized<kacanov_cg_options>();
  const auto solve_with = [&] {
    return kacanov_cg(op.get(), multigrid.get(), &cg, n, b.data(), x.data(), &result);
  };
  CHECK(kacanov_cg(other.get(), multigrid.get(), nullptr, n, b.data(), x.data(), &result) ==
        KACANOV_ERROR_VALUE);
  CHECK(kacanov_cg(op.get(), multigrid.get(), nullptr, n, b.data(), x.data(), nullptr) == KACANOV_ERROR_NULL);
  cg.relative = -1.0;
  CHECK(solve_with() == KACANOV_ERROR_VALUE);
  CHECK(says("options.relative"));
  cg = sized<kacanov_cg_options>();
  cg.tangent = 1;
  CHECK(solve_with() == KACANOV_ERROR_STATE);
  CHECK(says("kacanov_update_tangent"));
  cg.tangent = 0;
  cg.most_iterations = 1;
  CHECK(solve_with() == KACANOV_OK);
  CHECK(result.iterations == 1);
  CHECK(result.converged == 0);
  b[3] = nan_value;
  CHECK(solve_with() == KACANOV_ERROR_VALUE);
  CHECK(says("b[3] is not finite"));
}
