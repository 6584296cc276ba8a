/* SPDX-License-Identifier: BSD-3-Clause */
/* One tetrahedron through the installed C interface. */
#include <kacanov/kacanov.h>
#include <math.h>
#include <stdio.h>

int main(void) {
  const double coordinates[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const int32_t connectivity[4] = {0, 1, 2, 3};
  kacanov_law law = {0};
  law.struct_size = sizeof law;
  if (kacanov_elastic_law(1.0, 0.25, &law)) return 1;
  kacanov_description body = {0};
  body.struct_size = sizeof body;
  body.element = KACANOV_TET4;
  body.nodes = 4;
  body.coordinates = coordinates;
  body.elements = 1;
  body.connectivity = connectivity;
  body.laws = 1;
  body.law = &law;
  char message[128];
  kacanov_operator* op;
  if (kacanov_create(&body, &op, message, sizeof message)) {
    puts(message);
    return 1;
  }
  const double uniform[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}; /* u = x: tr eps = 3, dev eps = 0 */
  double energy;
  if (kacanov_energy(op, 12, uniform, &energy)) {
    puts(kacanov_message(op));
    return 1;
  }
  kacanov_destroy(op);
  return fabs(energy - 0.5 * law.bulk * 9.0 / 6.0) < 1e-14 ? 0 : 1;
}
