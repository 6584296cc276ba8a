# SPDX-License-Identifier: BSD-3-Clause
# Warnings for the project's own targets only: those that link kacanov_warnings.
add_library(kacanov_warnings INTERFACE)
target_compile_options(kacanov_warnings INTERFACE
  -Wall -Wextra $<$<COMPILE_LANGUAGE:CXX>:-Wconversion -Wshadow>
  $<$<BOOL:${KACANOV_WERROR}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION MATCHES "^12\\.")
  # It sees overlaps in "text" + std::string that are not there (bug 105651).
  target_compile_options(kacanov_warnings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-restrict>)
elseif(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # GCC's -Wconversion leaves the sign alone.
  target_compile_options(kacanov_warnings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-sign-conversion>)
endif()
