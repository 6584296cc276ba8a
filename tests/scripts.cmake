# SPDX-License-Identifier: BSD-3-Clause
# Tests by scripts, which sanitizers do not cover: documents, structure of the source, perf/.
find_package(Python3 3.9 COMPONENTS Interpreter)
if(Python3_FOUND)
  # Links, labels of the theory, tables of figures.
  add_test(NAME documents COMMAND "${Python3_EXECUTABLE}" -B "${CMAKE_CURRENT_SOURCE_DIR}/docs/documents_test.py" "${PROJECT_SOURCE_DIR}")
  # Which folder includes which, the head and the length of every file.
  add_test(NAME include_graph
    COMMAND "${Python3_EXECUTABLE}" -B "${CMAKE_CURRENT_SOURCE_DIR}/structure/include_graph.py" "${PROJECT_SOURCE_DIR}")
  add_test(NAME include_graph_script COMMAND "${Python3_EXECUTABLE}" -B "${CMAKE_CURRENT_SOURCE_DIR}/structure/include_graph_test.py")
  add_test(NAME perf_scripts COMMAND "${Python3_EXECUTABLE}" -B "${CMAKE_CURRENT_SOURCE_DIR}/perf/scripts_test.py" "${PROJECT_SOURCE_DIR}")
  kacanov_test_properties(documents 1)
  kacanov_test_properties(perf_scripts 1)
endif()

# The site itself, if mkdocs is found.
find_program(MKDOCS mkdocs)
if(MKDOCS)
  add_test(NAME documents_site COMMAND "${MKDOCS}" build --strict --quiet --config-file "${PROJECT_SOURCE_DIR}/mkdocs.yml"
    --site-dir "${CMAKE_CURRENT_BINARY_DIR}/site")
  kacanov_test_properties(documents_site 1)
endif()

# The benchmarks on tiny sizes.
if(KACANOV_PERF)
  add_test(NAME perf_bench COMMAND bench_operator --unknowns 3000 --rounds 1)
  add_test(NAME perf_count COMMAND count "${CMAKE_COMMAND}" -E true)
  add_test(NAME perf_threads COMMAND bench_threads --regions 5 --work 0.01)
  kacanov_test_properties(perf_bench 2)
  kacanov_test_properties(perf_threads 2)
  kacanov_test_properties(perf_count 1)
  # The output is one line: the counts, or the reason why there are none.
  set_tests_properties(perf_count PROPERTIES PASS_REGULAR_EXPRESSION "\"cycles\": |hardware counters: ")
endif()
