# SPDX-License-Identifier: BSD-3-Clause
kacanov_test(problem
  SOURCES solver/problem_main.cpp solver/problem_contact.cpp solver/problem_loads.cpp
          solver/problem_rigid_modes.cpp
  LIBRARIES kacanov_solver)
