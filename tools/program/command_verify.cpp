// SPDX-License-Identifier: BSD-3-Clause
// kacanov verify: recomputes the certificate of a run from its files alone.
#include <iostream>

#include <kacanov/error.hpp>
#include "program/commands.hpp"
#include "program/output_folder.hpp"
#include "verify/verify.hpp"

namespace kacanov {

int verify_command(const Command& command, const Case& input) {
  try {
    const verify::Verdict verdict =
        verify::verify(input.document, std::filesystem::path(command.case_file).parent_path(),
                       output_folder(command, input));
    std::cout << verdict.table + "\n" + verdict.sentence + "\n";
    return verdict.fulfilled ? exit_converged : exit_not_converged;
  } catch (const verify::Failure& failure) {
    throw InputError(failure.what());
  } catch (const std::logic_error& failure) {  // a file has unexpected content
    throw InputError("the mesh or the files of the run are not what the verifier expects: " +
                     std::string(failure.what()));
  } catch (const nlohmann::json::exception& failure) {
    throw InputError(std::string("the case or result.json has not what the verifier expects: ") +
                     failure.what());
  }
}

}  // namespace kacanov
