# SPDX-License-Identifier: BSD-3-Clause
# Tests of case files, file formats, pictures, and the program as users run it.
find_package(nlohmann_json REQUIRED)
kacanov_test(case
  SOURCES tools/case_errors_test.cpp tools/case_values_test.cpp
  LIBRARIES kacanov_case)
add_library(kacanov_program_runner OBJECT tools/program_runner.cpp)
target_compile_features(kacanov_program_runner PUBLIC cxx_std_20)
target_link_libraries(kacanov_program_runner PUBLIC nlohmann_json::nlohmann_json kacanov_warnings)
target_compile_definitions(kacanov_program_runner PRIVATE KACANOV_PROGRAM="$<TARGET_FILE:kacanov>")
find_package(ZLIB REQUIRED)
add_library(kacanov_png_writer OBJECT tools/png_writer.cpp)
target_compile_features(kacanov_png_writer PUBLIC cxx_std_20)
target_link_libraries(kacanov_png_writer PUBLIC ZLIB::ZLIB PRIVATE kacanov_warnings)
# Tests of the program as users run it. Most runs use one rank, and waiting ranks yield: two tests at a time take two
# thirds of the sequential time.
foreach(area conditions decks errors failures files history memory meshes mixed obstacles partition readers restart runs series signals temperature)
  kacanov_test(program_${area} IN program SOURCES tools/program_${area}_test.cpp LIBRARIES kacanov_program_runner)
endforeach()
kacanov_test(program_warm_plate IN program
  SOURCES tools/program_warm_plate_test.cpp LIBRARIES kacanov_program_runner)
target_link_libraries(test_program PRIVATE kacanov_png_writer)
if(KACANOV_SANITIZE)  # half of the time of all tests; the tests of the solver, tests/fuzz and the other areas cover the same code
  kacanov_slow(program_conditions program_history program_mixed program_obstacles program_partition)
endif()
kacanov_test(program_crafted IN program
  SOURCES tools/program_crafted_test.cpp
  LIBRARIES kacanov_program_runner kacanov_program kacanov_solver_internal)
# Collective decisions on up to eight ranks of one communicator. All combinations, which take more than twenty minutes:
# mpiexec -n 8 test_collective --no-skip
kacanov_test(collective MPI SOURCES tools/collective_test.cpp LIBRARIES kacanov_program RANKS 8)
kacanov_test(program_hard IN program NUMBERS
  SOURCES tools/program_hard_test.cpp LIBRARIES kacanov_program_runner)
kacanov_test(program_verify IN program
  SOURCES tools/program_verify_test.cpp tools/program_verify_finer_test.cpp tools/mesh_writer.cpp
  LIBRARIES kacanov_program_runner kacanov_formats)
kacanov_test(program_coarser IN program
  SOURCES tools/program_coarser_test.cpp tools/mesh_writer.cpp
  LIBRARIES kacanov_program_runner kacanov_formats)
kacanov_test(program_supports IN program
  SOURCES tools/program_supports_test.cpp tools/program_turned_box_test.cpp tools/mesh_writer.cpp
  LIBRARIES kacanov_program_runner kacanov_formats)
find_package(Threads REQUIRED)
add_library(kacanov_early_thread MODULE tools/early_thread.cpp)
target_link_libraries(kacanov_early_thread PRIVATE Threads::Threads kacanov_warnings)
target_compile_features(kacanov_early_thread PRIVATE cxx_std_20)
target_compile_definitions(test_program PRIVATE
  KACANOV_PROGRAM="$<TARGET_FILE:kacanov>" KACANOV_MPIEXEC="${MPIEXEC_EXECUTABLE}"
  KACANOV_EARLY_THREAD="$<TARGET_FILE:kacanov_early_thread>"
  KACANOV_HARD_CASES="${PROJECT_SOURCE_DIR}/tests/cases/hard")
add_dependencies(test_program kacanov kacanov_early_thread)

find_package(Python3 COMPONENTS Interpreter)

# The solve interface in C; its C client is also the one that consumes an installation.
kacanov_test(solve_c SOURCES tools/solve_c_test.cpp LIBRARIES kacanov_program_runner kacanov_solve)
add_dependencies(test_solve_c kacanov)
kacanov_test(host_locale SOURCES tools/host_locale_test.cpp LIBRARIES kacanov_program_runner kacanov_solve)
kacanov_test(solve_c_mpi MPI SOURCES tools/solve_c_mpi_test.cpp
  LIBRARIES kacanov_solve MPI::MPI_CXX RANKS 1 2)
add_executable(solve_client install/consumer/use_solve.c)
set_target_properties(solve_client PROPERTIES C_STANDARD 99 C_EXTENSIONS OFF)
target_link_libraries(solve_client PRIVATE kacanov_solve kacanov_warnings m)
if(KACANOV_SANITIZE)
  set_target_properties(solve_client PROPERTIES LINKER_LANGUAGE CXX)
endif()
add_test(NAME solve_c_client COMMAND solve_client)
kacanov_test_properties(solve_c_client 1)
set_tests_properties(solve_c_client PROPERTIES FAIL_REGULAR_EXPRESSION ".")  # the client prints nothing
if(Python3_FOUND AND CMAKE_NM AND NOT KACANOV_SANITIZE)
  add_test(NAME solve_c_symbols COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/embedding/symbols.py"
    $<TARGET_FILE:kacanov_solve> "${PROJECT_SOURCE_DIR}/tools/include/kacanov/kacanov_solve.h")
  kacanov_test_properties(solve_c_symbols 1)
endif()

kacanov_test(gmsh
  SOURCES tools/mesh_roundtrip_test.cpp tools/mesh_messages_test.cpp tools/mesh_writer.cpp
  LIBRARIES kacanov_formats)
target_compile_definitions(test_gmsh PRIVATE KACANOV_EXAMPLES="${PROJECT_SOURCE_DIR}/tools/examples")

kacanov_test(deck SOURCES tools/deck_mesh_test.cpp LIBRARIES kacanov_formats)
kacanov_test(deck_rules SOURCES tools/deck_rules_test.cpp LIBRARIES kacanov_program)

kacanov_test(memory_model NUMBERS SOURCES tools/memory_model_test.cpp LIBRARIES kacanov_program)

kacanov_test(files SOURCES tools/control_group_test.cpp tools/mapped_file_test.cpp tools/png_heights_test.cpp
  LIBRARIES kacanov_program kacanov_formats kacanov_png_writer)

kacanov_test(terminal SOURCES tools/terminal_test.cpp LIBRARIES kacanov_program)

kacanov_test(launch SOURCES tools/launch_test.cpp LIBRARIES kacanov_program)

kacanov_test(vtu SOURCES tools/vtu_test.cpp tools/vtu_reader_test.cpp LIBRARIES kacanov_formats)

kacanov_test(picture SOURCES tools/picture_test.cpp LIBRARIES kacanov_pictures)

# The schema of case files, with a validator if there is one (Debian: python3-jsonschema), otherwise without.
if(Python3_FOUND)
  set(python "${Python3_EXECUTABLE}")
  execute_process(COMMAND /usr/bin/python3 -c "import jsonschema" RESULT_VARIABLE without OUTPUT_QUIET ERROR_QUIET)
  if(NOT without)
    set(python /usr/bin/python3)
  endif()
  if(NOT KACANOV_SANITIZE)  # hundreds of cases; tests/fuzz covers them there
    add_test(NAME case_schema
      COMMAND "${python}" -B "${CMAKE_CURRENT_SOURCE_DIR}/tools/schema_test.py" $<TARGET_FILE:kacanov> "${PROJECT_SOURCE_DIR}")
    kacanov_test_properties(case_schema 1)
  endif()
  add_test(NAME shell
    COMMAND "${python}" -B "${CMAKE_CURRENT_SOURCE_DIR}/tools/shell_test.py" $<TARGET_FILE:kacanov>)
  kacanov_test_properties(shell 1)
  if(NOT KACANOV_SANITIZE)  # whole solves with many small steps
    add_test(NAME presets
      COMMAND "${Python3_EXECUTABLE}" -B "${CMAKE_CURRENT_SOURCE_DIR}/tools/presets_test.py" $<TARGET_FILE:kacanov>
        "${PROJECT_SOURCE_DIR}")
    kacanov_test_properties(presets 2)
  endif()
endif()

kacanov_test(report_data SOURCES tools/report_page_test.cpp LIBRARIES kacanov_program)

# report.html as HTML, and in a browser if there is one (Debian: chromium).
if(Python3_FOUND)
  find_program(KACANOV_CHROMIUM chromium)
  mark_as_advanced(KACANOV_CHROMIUM)
  add_test(NAME report_page
    COMMAND "${Python3_EXECUTABLE}" -B "${CMAKE_CURRENT_SOURCE_DIR}/tools/report_test.py" $<TARGET_FILE:kacanov>)
  kacanov_test_properties(report_page 1)
  if(KACANOV_CHROMIUM AND NOT KACANOV_SANITIZE)
    add_test(NAME report_in_browser
      COMMAND "${Python3_EXECUTABLE}" -B "${CMAKE_CURRENT_SOURCE_DIR}/tools/report_test.py" $<TARGET_FILE:kacanov>
        "${KACANOV_CHROMIUM}")
    kacanov_test_properties(report_in_browser 1)
    set_tests_properties(report_in_browser PROPERTIES COST 2)  # the longest test starts early
    kacanov_slow(report_in_browser)
  endif()
endif()
if(Python3_FOUND AND NOT KACANOV_SANITIZE)  # a test of accuracy
  add_test(NAME first_part
    COMMAND "${Python3_EXECUTABLE}" -B "${CMAKE_CURRENT_SOURCE_DIR}/tools/first_part_test.py" $<TARGET_FILE:kacanov>
      "${PROJECT_SOURCE_DIR}")
  kacanov_test_properties(first_part 1)
endif()

# Output files read by other programs' readers, if installed (Debian: python3-meshio, python3-vtk9).
set(libraries meshio vtk)
if(KACANOV_SANITIZE)  # the sanitizers run the writers with our own readers
  set(libraries "")
endif()
foreach(library IN LISTS libraries)
  foreach(python "${Python3_EXECUTABLE}" /usr/bin/python3)
    if(NOT TEST opened_by_${library} AND EXISTS "${python}")
      execute_process(COMMAND "${python}" -c "import ${library}" RESULT_VARIABLE without OUTPUT_QUIET ERROR_QUIET)
      if(NOT without)
        add_test(NAME opened_by_${library}
          COMMAND "${python}" -B "${CMAKE_CURRENT_SOURCE_DIR}/tools/foreign_readers.py" $<TARGET_FILE:kacanov> ${library})
        kacanov_test_properties(opened_by_${library} 1)
      endif()
    endif()
  endforeach()
endforeach()
