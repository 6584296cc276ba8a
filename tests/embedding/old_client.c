/* SPDX-License-Identifier: BSD-3-Clause */
/* A client built against the header of version 0.2 and run with the current library: stretches one
 * tetrahedron. */
#include "kacanov-0.2.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int failed(const char* what, int code) {
  if (code != KACANOV_OK) fprintf(stderr, "%s: %s\n", what, kacanov_code_text(code));
  return code != KACANOV_OK;
}

int main(void) {
  const double coordinates[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const int32_t nodes[4] = {0, 1, 2, 3};
  kacanov_law laws[2];
  memset(laws, 0, sizeof laws);
  for (int i = 0; i < 2; ++i) {
    laws[i].struct_size = sizeof(kacanov_law);
    if (failed("elastic_law", kacanov_elastic_law(1.0, 0.25, &laws[i]))) return 1;
  }
  const uint16_t law_of_element[1] = {1};
  kacanov_description body = {0};
  body.struct_size = sizeof body;
  body.element = KACANOV_TET4;
  body.nodes = 4;
  body.coordinates = coordinates;
  body.elements = 1;
  body.connectivity = nodes;
  body.laws = 2;
  body.law = laws;
  body.law_of_element = law_of_element;

  char message[256];
  kacanov_operator* op;
  if (kacanov_create(&body, &op, message, sizeof message) != KACANOV_OK) {
    fprintf(stderr, "%s\n", message);
    return 1;
  }
  double u[12] = {0}, f[12], stress[6], energy = 0.0;
  u[3] = 0.01; /* eps_xx = 0.01, alone: sigma_xx = (lambda + 2 mu) eps_xx = 1.2 eps_xx */
  kacanov_fields fields = {0};
  fields.struct_size = sizeof fields;
  fields.elements = 1;
  fields.stress = stress;
  kacanov_information information = {0};
  information.struct_size = sizeof information;
  if (failed("update", kacanov_update(op, 12, u)) || failed("apply", kacanov_apply(op, 12, u, f)) ||
      failed("energy", kacanov_energy(op, 12, u, &energy)) ||
      failed("stress", kacanov_stress(op, 12, u, &fields)) ||
      failed("inspect", kacanov_inspect(op, &information)))
    return 1;
  if (fabs(stress[0] - 0.012) > 1e-14 || fabs(f[3] - 0.012 / 6) > 1e-15 ||
      fabs(energy - 0.5 * 0.01 * 0.012 / 6) > 1e-17) {
    fprintf(stderr, "stress %g, force %g, energy %g\n", stress[0], f[3], energy);
    return 1;
  }
  if (information.unknowns != 12 || information.points_per_element != 1 ||
      strlen(information.instruction_set) == 0 || information.struct_size != sizeof information)
    return 1;
  kacanov_destroy(op);
  return 0;
}
