// SPDX-License-Identifier: BSD-3-Clause
// What the operators check before they start, in either precision.
#pragma once

#include <cstddef>

#include <kacanov/operator.hpp>

namespace kacanov {

/// Throws std::invalid_argument unless `actual` is `wanted`; `what` is named.
void expect_size(std::size_t actual, std::size_t wanted, const char* what);

/// Returns the body, or throws std::invalid_argument naming what is wrong with it or with the options.
const Body& checked(const Body& body, const OperatorOptions& options);

/// What of that is not about the mesh.
void check_options(const Body& body, const OperatorOptions& options);
void check_laws(const Body& body);

}  // namespace kacanov
