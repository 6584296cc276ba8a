// SPDX-License-Identifier: BSD-3-Clause
// Nothing: a target with a source is what headers are precompiled in.
