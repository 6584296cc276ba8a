# SPDX-License-Identifier: BSD-3-Clause
# Compiler warnings for targets of this project only: those that link kacanov_warnings.
add_library(kacanov_warnings INTERFACE)
target_compile_options(kacanov_warnings INTERFACE
  -Wall -Wextra $<$<COMPILE_LANGUAGE:CXX>:-Wconversion -Wshadow>
  $<$<BOOL:${KACANOV_WERROR}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION MATCHES "^12\\.")
  # GCC reports overlaps in "text" + std::string that do not exist (bug 105651).
  target_compile_options(kacanov_warnings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-restrict>)
elseif(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # GCC's -Wconversion does not include sign conversions.
  target_compile_options(kacanov_warnings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-sign-conversion>)
endif()
