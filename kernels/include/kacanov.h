/* SPDX-License-Identifier: BSD-3-Clause */
/* The C interface under its old name, for programs written against it: <kacanov/kacanov.h> is the header. */
#include <kacanov/kacanov.h>
