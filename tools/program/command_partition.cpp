// SPDX-License-Identifier: BSD-3-Clause
// kacanov partition: partitions a case once into files that the ranks of later runs read separately.
#include <iostream>

#include <kacanov/error.hpp>
#include "formats/printable.hpp"
#include "program/commands.hpp"
#include "program/part_files.hpp"

namespace kacanov {

int partition_command(const Command& command, const Case& input) {
  if (input.mesh.adapt)
    throw InputError("mesh.adapt: expected a mesh that stays as it is, to be split before it is solved");
  Problem problem = load_problem(input, {*command.ranks, 0});
  print_warnings(input, problem);
  const std::size_t elements = problem.mesh.element_count(), nodes = problem.mesh.node_count();
  write_parts(command.output, input, std::move(problem), *command.ranks);
  std::cout << std::to_string(elements) + " elements, " + std::to_string(nodes) + " nodes in " +
                   std::to_string(*command.ranks) + " parts: " + printable(command.output) + "\n";
  return exit_converged;
}

}  // namespace kacanov
