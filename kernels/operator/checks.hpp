// SPDX-License-Identifier: BSD-3-Clause
// Input checks of the operators, in either precision.
#pragma once

#include <cstddef>

#include <kacanov/operator.hpp>

namespace kacanov {

/// Throws std::invalid_argument, with the name `what`, unless `actual` equals `wanted`.
void expect_size(std::size_t actual, std::size_t wanted, const char* what);

/// Returns the body, or throws std::invalid_argument with the error in it or in the options.
const Body& checked(const Body& body, const OperatorOptions& options);

/// The checks that do not concern the mesh.
void check_options(const Body& body, const OperatorOptions& options);
void check_laws(const Body& body);

}  // namespace kacanov
