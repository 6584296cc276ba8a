/* SPDX-License-Identifier: BSD-3-Clause */
/* A block pressed onto a plane through the installed solve interface in C: the obstacle carries the load. */
#include <kacanov/kacanov_solve.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char* text =
    "{\"mesh\": {\"box\": {\"size\": [1, 1, 1], \"cells\": [3, 3, 3], \"element\": \"tet4\"}},"
    " \"material\": [{\"on\": \"all\", \"young\": 1.0, \"poisson\": 0.3, \"law\": {\"type\": \"linear\"}}],"
    " \"boundary\": [{\"on\": \"top\", \"pressure\": 0.01},"
    "   {\"on\": \"left\", \"displacement\": [0, null, null]},"
    "   {\"on\": \"front\", \"displacement\": [null, 0, null]}],"
    " \"contact\": [{\"on\": \"bottom\","
    "   \"obstacle\": {\"plane\": {\"point\": [0, 0, 0], \"normal\": [0, 0, 1]}}}]}";

static int steps_of_run = 0;

static void count_step(void* data, const kacanov_progress* step) {
  if (step->struct_size == sizeof *step && step->outer > 0) *(int*)data += 1;
}

int main(void) {
  char message[256];
  kacanov_solution* solution;
  kacanov_solve_options options = {0};
  kacanov_solution_information about = {0};
  const double *normal, *pressure, *u;
  size_t count, i;
  double largest = 0.0;

  options.struct_size = sizeof options;
  options.progress = count_step;
  options.data = &steps_of_run;
  if (kacanov_solve(text, &options, &solution, message, sizeof message)) {
    puts(message);
    return 1;
  }
  about.struct_size = sizeof about;
  if (kacanov_solution_inspect(solution, &about) || about.status != KACANOV_CONVERGED) return 2;
  if (about.dimension != 3 || about.nodes != 64 || about.contact_points != 16 || steps_of_run == 0) return 3;

  u = kacanov_solution_field(solution, KACANOV_FIELD_DISPLACEMENT, &count);
  if (u == NULL || count != 3 * about.nodes) return 4;
  pressure = kacanov_solution_field(solution, KACANOV_FIELD_CONTACT_PRESSURE, &count);
  normal = kacanov_solution_field(solution, KACANOV_FIELD_CONTACT_NORMAL, NULL);
  if (pressure == NULL || count != about.contact_points) return 5;
  for (i = 0; i < count; ++i) {
    if (fabs(normal[3 * i + 2] + 1.0) > 1e-14) return 6;
    if (pressure[i] > largest) largest = pressure[i];
  }
  if (fabs(largest - 0.01) > 1e-6) return 7;
  if (strstr(kacanov_solution_json(solution), "\"status\": \"converged\"") == NULL) return 8;
  kacanov_solution_destroy(solution);

  if (kacanov_solve("{\"mesh\": 3, \"material\": [], \"boundary\": []}", NULL, &solution, message,
                    sizeof message) != KACANOV_ERROR_CASE)
    return 9;
  if (solution != NULL || strstr(message, "mesh: expected") == NULL) return 10;
  return strlen(kacanov_code_text(KACANOV_ERROR_CASE)) > 0 ? 0 : 11;
}
