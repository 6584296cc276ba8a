# SPDX-License-Identifier: BSD-3-Clause
# Case files, file formats, pictures, and the program as its users start it.
find_package(nlohmann_json REQUIRED)
kacanov_test(case
  SOURCES tools/case_errors_test.cpp tools/case_values_test.cpp
  LIBRARIES kacanov_case)
add_library(kacanov_program_runner OBJECT tools/program_runner.cpp)
target_compile_features(kacanov_program_runner PUBLIC cxx_std_20)
target_link_libraries(kacanov_program_runner PUBLIC nlohmann_json::nlohmann_json kacanov_warnings)
target_compile_definitions(kacanov_program_runner PRIVATE KACANOV_PROGRAM="$<TARGET_FILE:kacanov>")
foreach(area program_conditions program_decks program_errors program_failures program_files program_memory program_meshes program_obstacles program_partition program_restart program_runs program_series program_signals)
  kacanov_test(${area} SOURCES tools/${area}_test.cpp LIBRARIES kacanov_program_runner)
  target_compile_definitions(test_${area} PRIVATE
    KACANOV_PROGRAM="$<TARGET_FILE:kacanov>" KACANOV_MPIEXEC="${MPIEXEC_EXECUTABLE}"
    KACANOV_HARD_CASES="${PROJECT_SOURCE_DIR}/tests/cases/hard")
  add_dependencies(test_${area} kacanov)
  # Ranks of two runs at a time on two cores wait for each other, and take five times as long.
  set_tests_properties(${area} PROPERTIES PROCESSORS 2)
endforeach()

kacanov_test(program_crafted
  SOURCES tools/program_crafted_test.cpp
  LIBRARIES kacanov_program_runner kacanov_program kacanov_solver_internal)
add_dependencies(test_program_crafted kacanov)

kacanov_test(program_verify
  SOURCES tools/program_verify_test.cpp tools/mesh_writer.cpp
  LIBRARIES kacanov_program_runner kacanov_formats)
add_dependencies(test_program_verify kacanov)
set_tests_properties(program_verify PROPERTIES PROCESSORS 2)

kacanov_test(program_supports
  SOURCES tools/program_supports_test.cpp tools/mesh_writer.cpp
  LIBRARIES kacanov_program_runner kacanov_formats)
add_dependencies(test_program_supports kacanov)
set_tests_properties(program_supports PROPERTIES PROCESSORS 2)

# Small random cases, each verified from its files; perf/verify_answers draws 500 by itself.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  add_test(NAME verified_answers
    COMMAND "${Python3_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/perf/verify_answers" $<TARGET_FILE:kacanov> --count 60)
  kacanov_test_properties(verified_answers 1)
  add_test(NAME verified_conditions
    COMMAND "${Python3_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/perf/verify_answers" $<TARGET_FILE:kacanov>
      --count 30 --conditions)
  kacanov_test_properties(verified_conditions 1)
endif()

# What a small run does where files, memory or the power fail, and when it is killed: places far apart here,
# every one with perf/endure by itself. The preloaded library and the sanitizers do not mix.
add_library(kacanov_faults MODULE tools/faults.cpp)
target_link_libraries(kacanov_faults PRIVATE ${CMAKE_DL_LIBS} kacanov_warnings)
target_compile_features(kacanov_faults PRIVATE cxx_std_20)
if(Python3_FOUND AND NOT KACANOV_SANITIZE)
  add_test(NAME endured_faults
    COMMAND "${Python3_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/perf/endure" $<TARGET_FILE:kacanov>
      $<TARGET_FILE:kacanov_faults> --every 61 --kills 3)
  kacanov_test_properties(endured_faults 1)
endif()

kacanov_test(program_hard SOURCES tools/program_hard_test.cpp LIBRARIES kacanov_program_runner)
target_compile_definitions(test_program_hard PRIVATE KACANOV_HARD_CASES="${PROJECT_SOURCE_DIR}/tests/cases/hard")
add_dependencies(test_program_hard kacanov)

kacanov_test(gmsh
  SOURCES tools/mesh_roundtrip_test.cpp tools/mesh_messages_test.cpp tools/mesh_writer.cpp
  LIBRARIES kacanov_formats)
target_compile_definitions(test_gmsh PRIVATE KACANOV_EXAMPLES="${PROJECT_SOURCE_DIR}/tools/examples")

kacanov_test(deck SOURCES tools/deck_mesh_test.cpp LIBRARIES kacanov_formats)

kacanov_test(memory_model SOURCES tools/memory_model_test.cpp LIBRARIES kacanov_program)

kacanov_test(files SOURCES tools/control_group_test.cpp tools/mapped_file_test.cpp LIBRARIES kacanov_program)

kacanov_test(terminal SOURCES tools/terminal_test.cpp LIBRARIES kacanov_program)

kacanov_test(vtu SOURCES tools/vtu_test.cpp tools/vtu_reader_test.cpp LIBRARIES kacanov_formats)

kacanov_test(picture SOURCES tools/picture_test.cpp LIBRARIES kacanov_pictures)

# What other people's readers make of our files, where there are any (Debian: python3-meshio, python3-vtk9).
foreach(library meshio vtk)
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
