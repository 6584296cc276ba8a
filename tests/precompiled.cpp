// SPDX-License-Identifier: BSD-3-Clause
// An empty source file: CMake needs a target with a source to precompile headers.
